"""Is it a mesh of its domain?

A point is on a segment, or on a curve, if it is as near to it as `tolerance_of` allows.
"""

from __future__ import annotations

from functools import cached_property
from typing import TYPE_CHECKING

import numpy as np

from ..on_runs import places_on_runs, tolerance_of
from .subject import Bools, Finding, Floats, Index, Ints, Subject, edge_keys, finding

if TYPE_CHECKING:
    from ..domain import Domain

QUADRATURE = 1e-9
"""Areas between curves and their chords are right to this share."""


class DomainSubject(Subject):
    """A mesh and its domain, in the scaled coordinates: which points and edges lie on what."""

    @property
    def domain(self) -> Domain:
        """The domain of the mesh; only meshes that have one are held against it."""
        if self.mesh.domain is None:
            raise ValueError("the mesh has no domain")
        return self.mesh.domain

    @cached_property
    def corners(self) -> Floats:
        """The points of the domain, scaled as those of the mesh."""
        return self.scale(self.domain.points)

    @cached_property
    def straight(self) -> Ints:
        """The segments of the domain that are no chords of curves."""
        return np.flatnonzero(self.domain.curved.segment_runs < 0)

    @cached_property
    def tolerance(self) -> float:
        """How far from a segment a point may be, scaled."""
        return float(np.ldexp(self.true_tolerance, -self.exponent))

    @property
    def true_tolerance(self) -> float:
        """The tolerance in the units of the mesh."""
        return tolerance_of(self.domain)

    @cached_property
    def vertices(self) -> Ints:
        """The point of the mesh on each point of the domain, -1 where there is none."""
        from scipy.spatial import KDTree

        distance, vertex = KDTree(self.points).query(self.corners)
        out: Ints = np.where(distance <= self.tolerance, vertex, -1)
        return out

    @cached_property
    def steps(self) -> tuple[Ints, Ints, Bools]:
        """Steps along segments, in order: the segment, the edge, and whether it is run backwards.

        ::

            A ------- v ---- w -------- B        three steps: Av, vw, wB
        """
        import shapely

        a, b = (self.corners[i] for i in self.domain.segments[self.straight].T)
        tree = shapely.STRtree(shapely.linestrings(np.stack([a, b], axis=1)))
        lines = shapely.linestrings(self.points[self.mesh.edges])
        edge, segment = tree.query(lines, predicate="dwithin", distance=self.tolerance)
        segment = self.straight[segment]
        start, end = self.mesh.edges[edge].T
        off = np.maximum(self._distance(segment, start), self._distance(segment, end))
        # An edge belongs to one segment: where two are in reach (tiny edges at a corner,
        # boundaries that nearly touch) to the nearest.
        nearest = np.lexsort((off, edge))
        first = np.diff(edge[nearest], prepend=-1) > 0
        mine = nearest[first & (off[nearest] <= self.tolerance)]
        edge, segment, start, end = edge[mine], segment[mine], start[mine], end[mine]
        at_start, at_end = self._along(segment, start), self._along(segment, end)
        order = np.lexsort((at_start + at_end, segment))
        return segment[order], edge[order], (at_start > at_end)[order]

    def _distance(self, segment: Index, vertex: Index) -> Floats:
        """Distances of points of the mesh from segments of the domain."""
        a, b = (self.corners[i] for i in self.domain.segments[segment].T)
        d, w = b - a, self.points[vertex] - a
        t = np.clip((w * d).sum(axis=1) / (d * d).sum(axis=1), 0, 1)
        out: Floats = np.hypot(*(w - t[:, None] * d).T)
        return out

    def _along(self, segment: Index, vertex: Index) -> Floats:
        """How far along its segment each point of the mesh is."""
        a, b = (self.corners[i] for i in self.domain.segments[segment].T)
        out: Floats = ((self.points[vertex] - a) * (b - a)).sum(axis=1)
        return out

    @cached_property
    def on_runs(self) -> tuple[Index, Floats, Index]:
        """Vertices of constrained edges on curves, in order: the run, the parameter, the vertex."""
        vertices = np.unique(self.mesh.edges)
        run, u, k = places_on_runs(self.domain, self.mesh.points[vertices], self.true_tolerance)
        return run, u, vertices[k]

    @cached_property
    def run_steps(self) -> tuple[Index, Floats, Index, Ints]:
        """Steps along runs, in order: the run, both parameters, both vertices, and the edge, or -1.

        A run that does not begin or end at its corner has a step without an edge too.
        """
        run, u, v = self.on_runs
        n = len(self.mesh.points)
        inner = np.flatnonzero(np.diff(run) == 0)
        pairs = np.stack([v[inner], v[inner + 1]], axis=1)
        keys = edge_keys(self.mesh.edges[:, 0], self.mesh.edges[:, 1], n)
        order = np.argsort(keys)
        wanted = edge_keys(pairs[:, 0], pairs[:, 1], n)
        place = np.minimum(np.searchsorted(keys, wanted, sorter=order), len(keys) - 1)
        edge = np.where(keys[order[place]] == wanted, order[place], -1)
        return run[inner], np.stack([u[inner], u[inner + 1]], axis=1), pairs, edge


def points_present(s: DomainSubject) -> Finding:
    """Every point of the domain is a point of the mesh."""
    xy = s.domain.points
    is_vertex = s.domain.curved.is_vertex

    def show(i: int) -> str:
        return f"point {i} of the domain ({float(xy[i, 0])!r}, {float(xy[i, 1])!r})"

    bad = np.flatnonzero((s.vertices < 0) & is_vertex)
    return finding(
        bad, f"{np.count_nonzero(is_vertex)} points", "points of the domain are missing", show
    )


def segments_present(s: DomainSubject) -> Finding:
    """Every segment of the domain is a chain of constrained edges on it, with its tag.

    The first step along it begins at its first point, each further one where the one before ends,
    and the last ends at its last point.
    """
    segment, edge, backwards = s.steps
    domain = s.domain
    begin, end = (
        s.mesh.edges[edge, backwards.astype(int)],
        s.mesh.edges[edge, 1 - backwards.astype(int)],
    )
    last = np.append(segment[1:] != segment[:-1], True)[: len(segment)]
    first = np.roll(last, 1)
    a, b = s.vertices[domain.segments].T
    leaves = np.where(last, b[segment], np.roll(begin, -1)) != end
    starts_late = first & (begin != a[segment])
    other_tag = s.mesh.edge_tags[edge] != domain.segment_tags[segment]

    broken = domain.curved.segment_runs < 0
    broken[segment] = False  # those without a step stay broken
    broken[segment[leaves | starts_late]] = True
    mistagged = np.zeros(len(domain.segments), bool)
    mistagged[segment[other_tag]] = True

    def show(i: int) -> str:
        (x0, y0), (x1, y1) = domain.points[domain.segments[i]].tolist()
        why = "is no chain of constrained edges" if broken[i] else "has edges with another tag"
        return f"segment {i} from ({x0!r}, {y0!r}) to ({x1!r}, {y1!r}) {why}"

    good = f"{len(s.straight)} segments, to {s.true_tolerance:.2g}"
    wrong = "segments of the domain are missing or have another tag"
    return finding(np.flatnonzero(broken | mistagged), good, wrong, show)


def curves_present(s: DomainSubject) -> Finding:
    """Every run of curves is a chain of constrained edges, from corner to corner, with its tag."""
    curved, domain = s.domain.curved, s.domain
    run, _, _, edge = s.run_steps
    tag = np.zeros(len(curved.runs), np.int64)
    on_run = curved.segment_runs >= 0
    tag[curved.segment_runs[on_run]] = domain.segment_tags[on_run]

    broken = np.ones(len(curved.runs), bool)
    broken[run] = False
    broken[run[edge < 0]] = True
    found, u, _ = s.on_runs
    for end in (np.zeros(len(broken)), np.array([r.length for r in curved.runs])):
        met = np.zeros(len(broken), bool)
        met[found[u == end[found]]] = True
        broken |= ~met
    mistagged = np.zeros(len(broken), bool)
    mistagged[run[(edge >= 0) & (s.mesh.edge_tags[edge] != tag[run])]] = True

    def show(r: int) -> str:
        (x0, y0), (x1, y1) = curved.runs[r].start.tolist(), curved.runs[r].end.tolist()
        first = int(np.flatnonzero(curved.segment_runs == r)[0])
        why = "is no chain of constrained edges" if broken[r] else "has edges with another tag"
        return f"{curved.describe(first)} from ({x0!r}, {y0!r}) to ({x1!r}, {y1!r}) {why}"

    good = f"{len(broken)} runs, to {s.true_tolerance:.2g}"
    wrong = "curves of the domain are missing or have another tag"
    return finding(np.flatnonzero(broken | mistagged), good, wrong, show)


def edges_on_segments(s: DomainSubject) -> Finding:
    """Every constrained edge lies on a segment of the domain, or is a chord of a curve of it."""
    stray = np.ones(len(s.mesh.edges), bool)
    stray[s.steps[1]] = False
    if s.domain.curved.runs:
        edge = s.run_steps[3]
        stray[edge[edge >= 0]] = False

    def show(e: int) -> str:
        return f"constrained edge {s.at(*s.mesh.edges[e])}"

    wrong = "constrained edges are on no segment of the domain"
    return finding(np.flatnonzero(stray), "", wrong, show)


def area_of_domain(s: DomainSubject) -> Finding:
    """The triangles have the area of the domain, to within what points on segments may be off.

    That between curves and their chords is what a mesh of curves has less, or more.
    """
    a, b = (s.domain.points[i] for i in s.domain.segments.T)
    tolerance = s.true_tolerance * float(np.hypot(*(b - a).T).sum())
    found, wanted = float(s.mesh.areas.sum()), s.domain.area
    if s.domain.curved.runs:
        beside = _areas_beyond_border(s)
        wanted -= float(beside.sum())
        tolerance += QUADRATURE * float(np.abs(beside).sum())
    note = f"{found!r}, of the domain {wanted!r}"
    return Finding(int(not abs(found - wanted) <= tolerance), f"{note}, to {tolerance:.2g}")


def _areas_beyond_border(s: DomainSubject) -> Floats:
    """Areas between border edges and their curves, positive where the curve is outside."""
    run, u, pairs, _ = s.run_steps
    n = len(s.mesh.points)
    border = s.sides.ends(s.sides.border)  # the mesh is on their left
    keys = border[:, 0] * n + border[:, 1]
    on_left = np.isin(pairs[:, 0] * n + pairs[:, 1], keys)
    on_right = np.isin(pairs[:, 1] * n + pairs[:, 0], keys)
    areas = s.domain.curved.areas_beside(run, u)
    out: Floats = areas * (on_left.astype(float) - on_right.astype(float))
    return out
