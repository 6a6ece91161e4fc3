"""`simplify`: remove detail of a domain that is far below the requested size."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np

import metrics
from adaptmesh.arrangement.faces import find_faces
from adaptmesh.arrangement.record import Repair, Repairs, point_text
from adaptmesh.domain.domain import Domain
from adaptmesh.domain.inputs import labelled, rows_of_each
from adaptmesh.errors import DomainError
from adaptmesh.geometry.distance import distance
from adaptmesh.topology import regions_beside, used_points
from adaptmesh.types import Bools, Floats, Int64s

from .decimate import Decimated, decimate, orient
from .small_islands import find_small_loops

SHARE = 0.1
"""Default bound on the displacement of a boundary, relative to the requested size there."""


class Dropped(Repairs):
    """What `simplify` removed: printed as a report, false if there is nothing.

    Attributes
    ----------
    records : tuple of Repair
        One record for each sequence of removed points and for each removed loop.
    tolerance : float
        The bound on the displacement, relative to the requested size.
    displacement : float
        The largest displacement, in units of the coordinates.
    """

    def _nothing(self) -> str:
        return f"nothing removed (displacement bound {self.tolerance:.3g} of the size)"

    def _heading(self) -> str:
        return (
            f"{len(self)} details removed (displacement bound {self.tolerance:.3g} of the size, "
            f"largest displacement {self.displacement:.3g})"
        )


def simplify(
    domain: Domain, metric: Any, *, share: float = SHARE, loops_below: float = 0.0
) -> tuple[Domain, Dropped]:
    """Remove detail of a domain far below the size that a metric requests.

    Every corner of a domain becomes a vertex of its meshes, so that corners closer to each other
    than the requested size force triangles smaller than requested.

    Parameters
    ----------
    domain : Domain
    metric : number, callable, or control space
        As for `generate`.
    share : float
        The bound on the displacement: every point of the old boundary is within this many times
        the requested size, in the direction of the displacement, of the new boundary, and vice
        versa.
    loops_below : float
        Islands, holes and other closed loops that touch no other line are removed, with everything
        inside, if they are smaller than this in the metric. The default keeps all; the last loop of
        a named region is always kept.

    Returns
    -------
    domain : Domain
        With the same regions and names. Points at ends of edges shorter than the size are removed,
        except where lines meet or end, or a name changes; neighbours keep their common borders; by
        exact signs no line crosses or touches another one, or moves across a point.
    dropped : Dropped
        A record of each sequence of removed points and of each removed loop.

    Raises
    ------
    DomainError
        If the domain has curves. (Only their corners force small triangles, not their points.)
    MetricError
        If the metric is not valid at a point of the domain.

    Examples
    --------
    The points beside a small tip are removed. The tip stays: its sides are then longer than the
    size.

    >>> from adaptmesh import Domain, simplify
    >>> ring = [(0, 0), (1, 0), (1, 1), (0.501, 1), (0.5, 1.001), (0.499, 1), (0, 1)]
    >>> simple, dropped = simplify(Domain.polygon(ring), 0.2)
    >>> len(simple.points), simple.area
    (5, 1.0005)
    """
    if not isinstance(domain, Domain):
        raise DomainError(f"expected a Domain, got {type(domain).__name__}: see adaptmesh.repair")
    _refuse_curves(domain)
    for name, value in (("share", share), ("loops_below", loops_below)):
        if not 0 <= value < np.inf:
            raise ValueError(f"{name}: expected a finite number of at least 0, got {value!r}")
    lines = _Lines.of(domain)
    tensors = metrics.as_control_space(metric)(domain.points)
    log: list[Repair] = []
    lone = np.setdiff1d(np.arange(len(domain.points)), lines.edges)
    if loops_below:
        lines, lone = _drop_loops(domain, lines, lone, tensors, loops_below, log)
    result = decimate(domain.points, tensors, lines.edges, lines.kind, share)
    displacement = _record(domain.points, result, log)
    simple = _rebuild(domain, lines, result, lone) if log else domain
    return simple, Dropped(tuple(log), share, displacement)


def _refuse_curves(domain: Domain) -> None:
    if domain.curved.paths:
        curved = int(np.flatnonzero(domain.curved.segment_paths >= 0)[0])
        raise DomainError(
            f"expected straight segments, got a curve through "
            f"{point_text(*domain.points[domain.segments[curved, 0]])}: remove small curves before "
            "making the domain"
        )


@dataclass(frozen=True)
class _Lines:
    """The edges of a domain with their names and the regions beside them.

    Directed so that the region number on the left is not larger than on the right.
    """

    edges: Int64s
    tags: Int64s
    left: Int64s
    right: Int64s

    @classmethod
    def of(cls, domain: Domain) -> _Lines:
        n = len(domain.points)
        beside = regions_beside(domain.triangles, domain.triangle_regions, domain.pieces, n)
        sides = np.maximum(beside.astype(np.int64), -1)  # -1 is the outside
        edges, left, right = orient(domain.pieces.astype(np.int64), *sides.T)
        return cls(edges, domain.segment_tags[domain.piece_segments].astype(np.int64), left, right)

    @property
    def kind(self) -> Int64s:
        """Kind of each edge: those of one kind have the same name and the same regions beside."""
        rows = np.stack([self.tags, self.left, self.right], axis=1)
        return np.unique(rows, axis=0, return_inverse=True)[1].reshape(-1)

    def where(self, kept: Bools) -> _Lines:
        return _Lines(self.edges[kept], self.tags[kept], self.left[kept], self.right[kept])


def _drop_loops(
    domain: Domain, lines: _Lines, lone: Int64s, tensors: Floats, below: float, log: list[Repair]
) -> tuple[_Lines, Int64s]:
    """Remove small loops: return the lines and lone points that stay, and record each loop."""
    used, edges = used_points(lines.edges)
    faces = find_faces(domain.points[used], edges)
    loops = find_small_loops(domain.points[used], tensors[used], edges, faces, below)
    kept = np.ones(len(edges), bool)
    is_removed = np.zeros(faces.count, bool)
    for loop in loops:
        remaining = kept.copy()
        remaining[loop.edges] = False
        before, after = (
            np.union1d(lines.left[which], lines.right[which]) for which in (kept, remaining)
        )
        if len(before) > len(after) or not remaining.any():
            continue  # the last loop of a region, or the last edges
        kept = remaining
        is_removed[loop.faces] = True
        x, y = loop.place
        what = f"a loop of {len(loop.edges)} edges around an area of {loop.area:.4g} removed"
        log.append(Repair("loop", (x, y), what, loop.size))
    stays = [not is_removed[faces.locate(domain.points[v])] for v in lone]
    for v in lone[~np.array(stays, bool)].tolist():
        x, y = domain.points[v].tolist()
        log.append(Repair("point", (x, y), f"point {v} lies in a removed loop"))
    return lines.where(kept), lone[np.array(stays, bool)]


def _record(points: Floats, result: Decimated, log: list[Repair]) -> float:
    """Record each sequence of removed points; return the largest displacement."""
    counts = np.diff(result.starts)
    edge = np.repeat(np.arange(len(counts)), counts)
    start, end = points[result.edges[edge].T]
    off = distance(points[result.removed], start, end)[0]
    order = np.lexsort((off, edge))  # the farthest point of each edge comes last
    passing = np.flatnonzero(counts)
    farthest = order[result.starts[passing + 1] - 1]
    for (a, b), n, v, d in zip(
        points[result.edges[passing]].tolist(),
        counts[passing].tolist(),
        points[result.removed[farthest]].tolist(),
        off[farthest].tolist(),
        strict=True,
    ):
        what = (
            f"{n} point{'s' if n > 1 else ''} between {point_text(*a)} and {point_text(*b)} "
            f"removed, {d:.3g} off the line"
        )
        log.append(Repair("points", (v[0], v[1]), what, d))
    return float(off.max(initial=0.0))


def _rebuild(domain: Domain, lines: _Lines, result: Decimated, lone: Int64s) -> Domain:
    """Make a domain of the remaining edges, with the old regions and names."""
    used, edges = used_points(result.edges)
    faces = find_faces(domain.points[used], edges)
    region = np.full(faces.count, -1)
    left, right = lines.left[result.source], lines.right[result.source]
    region[faces.left], region[faces.right] = left, right
    tags = lines.tags[result.source]
    kept = np.union1d(used, lone)
    # Face 0, the outside, needs no seed.
    places = {r: faces.inner_points[mine + 1] for r, mine in rows_of_each(region[1:]).items()}
    return Domain(
        domain.points[kept],
        np.searchsorted(kept, result.edges),
        holes=places.get(-1, np.empty((0, 2))),
        regions={r: places[r] for r in np.unique(domain.seed_regions).tolist() if r in places},
        names=labelled(tags),
        tags=domain.names,
        region_tags=domain.region_names,
    )
