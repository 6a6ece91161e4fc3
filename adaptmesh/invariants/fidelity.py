"""Is it a mesh of its domain?

Points placed along a slanted segment are rounded to the nearest coordinates. So a point is on a
segment if it is nearer than `TOLERANCE` times the diameter of the domain plus a few units in the
last place of the largest coordinate.
"""

from __future__ import annotations

from functools import cached_property
from typing import TYPE_CHECKING

import numpy as np

from .subject import Bools, Finding, Floats, Index, Ints, Subject, finding

if TYPE_CHECKING:
    from ..domain import Domain

TOLERANCE = 1e-12


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
    def tolerance(self) -> float:
        """How far from a segment a point may be, scaled; see the top of this file."""
        diameter = float(np.hypot(*np.ptp(self.corners, axis=0)))
        largest = float(np.abs(self.corners).max())
        return TOLERANCE * diameter + 8 * float(np.finfo(float).eps) * largest

    @property
    def true_tolerance(self) -> float:
        """The tolerance in the units of the mesh."""
        return float(np.ldexp(self.tolerance, self.exponent))

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

        a, b = (self.corners[i] for i in self.domain.segments.T)
        tree = shapely.STRtree(shapely.linestrings(np.stack([a, b], axis=1)))
        lines = shapely.linestrings(self.points[self.mesh.edges])
        edge, segment = tree.query(lines, predicate="dwithin", distance=self.tolerance)
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


def points_present(s: DomainSubject) -> Finding:
    """Every point of the domain is a point of the mesh."""
    xy = s.domain.points

    def show(i: int) -> str:
        return f"point {i} of the domain ({float(xy[i, 0])!r}, {float(xy[i, 1])!r})"

    bad = np.flatnonzero(s.vertices < 0)
    return finding(bad, f"{len(xy)} points", "points of the domain are missing", show)


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

    broken = np.ones(len(domain.segments), bool)
    broken[segment] = False  # those without a step stay broken
    broken[segment[leaves | starts_late]] = True
    mistagged = np.zeros(len(domain.segments), bool)
    mistagged[segment[other_tag]] = True

    def show(i: int) -> str:
        (x0, y0), (x1, y1) = domain.points[domain.segments[i]].tolist()
        why = "is no chain of constrained edges" if broken[i] else "has edges with another tag"
        return f"segment {i} from ({x0!r}, {y0!r}) to ({x1!r}, {y1!r}) {why}"

    good = f"{len(broken)} segments, to {s.true_tolerance:.2g}"
    wrong = "segments of the domain are missing or have another tag"
    return finding(np.flatnonzero(broken | mistagged), good, wrong, show)


def edges_on_segments(s: DomainSubject) -> Finding:
    """Every constrained edge lies on a segment of the domain."""
    stray = np.ones(len(s.mesh.edges), bool)
    stray[s.steps[1]] = False

    def show(e: int) -> str:
        return f"constrained edge {s.at(*s.mesh.edges[e])}"

    wrong = "constrained edges are on no segment of the domain"
    return finding(np.flatnonzero(stray), "", wrong, show)


def area_of_domain(s: DomainSubject) -> Finding:
    """The triangles have the area of the domain, to within what points on segments may be off."""
    a, b = (s.domain.points[i] for i in s.domain.segments.T)
    tolerance = s.true_tolerance * float(np.hypot(*(b - a).T).sum())
    found, wanted = float(s.mesh.areas.sum()), s.domain.area
    note = f"{found!r}, of the domain {wanted!r}"
    return Finding(int(not abs(found - wanted) <= tolerance), f"{note}, to {tolerance:.2g}")
