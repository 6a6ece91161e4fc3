"""Detail of a domain that is far below the size asked for, left out."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

import metrics
from adaptmesh.arrangement import Repair, Repairs, at, find_faces
from adaptmesh.domain.domain import Domain
from adaptmesh.domain.inputs import labelled, rows_of_each
from adaptmesh.errors import DomainError
from adaptmesh.geometry.distance import distance
from adaptmesh.topology import regions_beside, used_points
from adaptmesh.types import Floats, Int64s

from .decimate import Decimated, decimate, turned
from .small_islands import small_loops

SHARE = 0.1
"""How far a boundary may be moved, in units of the size asked for there."""


class Dropped(Repairs):
    """What `simplify` left out; printed as a report, and false if that is nothing.

    Attributes
    ----------
    records : tuple of Repair
        Each chain of points left out, and each loop.
    tolerance : float
        The bound on the displacement, in units of the size asked for.
    displacement : float
        The largest displacement, in units of the coordinates.
    """

    def _nothing(self) -> str:
        return f"nothing to leave out (moving by at most {self.tolerance:.3g} of the size)"

    def _heading(self) -> str:
        return (
            f"{len(self)} details left out (moving by at most {self.tolerance:.3g} of the size "
            f"asked for; by {self.displacement:.3g} at most)"
        )


def simplify(
    domain: Domain, metric: Any, *, share: float = SHARE, loops_below: float = 0.0
) -> tuple[Domain, Dropped]:
    """Leave out detail of a domain far below the size that a metric asks for.

    Every corner of a domain becomes a vertex of its meshes, so that corners nearer to each other
    than the size asked for force triangles that are smaller than wanted.

    Parameters
    ----------
    domain : Domain
    metric : number, callable, or control space
        As for `generate`.
    share : float
        The bound on the displacement: no point of the old boundary is farther from the new one, nor
        of the new one from the old one, than this many times the size asked for there, in the
        direction of the displacement.
    loops_below : float
        Islands, holes and other closed loops that touch no other line are left out if they, with
        all that is in them, are smaller than this in the metric. The default keeps all; a loop is
        never left out if it is the last of a named region.

    Returns
    -------
    domain : Domain
        With the same regions and names. Points at ends of edges shorter than the size are left
        out, except where lines meet or end, or a name changes; borders stay shared; no line crosses
        or touches another one, or changes sides with any point, by exact signs.
    dropped : Dropped
        A record of each chain of points left out, and of each loop.

    Raises
    ------
    DomainError
        If the domain has curves; their points do not force small triangles, only their corners do.
    MetricError
        If the metric is not valid at a point of the domain.

    Examples
    --------
    The points beside a small tip go. The tip itself stays: its sides are then longer than the size.

    >>> from adaptmesh import Domain, simplify
    >>> ring = [(0, 0), (1, 0), (1, 1), (0.501, 1), (0.5, 1.001), (0.499, 1), (0, 1)]
    >>> simple, dropped = simplify(Domain.polygon(ring), 0.2)
    >>> len(simple.points), simple.area
    (5, 1.0005)
    """
    if not isinstance(domain, Domain):
        raise DomainError(f"a Domain is wanted, not {type(domain).__name__}: see adaptmesh.repair")
    _refuse_curves(domain)
    for name, value in (("share", share), ("loops_below", loops_below)):
        if not 0 <= value < np.inf:
            raise ValueError(f"{name}={value!r}: a number of sizes is wanted, from 0")
    lines = _Lines.of(domain)
    tensors = metrics.as_control_space(metric)(domain.points)
    log: list[Repair] = []
    lone = np.setdiff1d(np.arange(len(domain.points)), lines.edges)
    if loops_below:
        lines, lone = _without_loops(domain, lines, lone, tensors, loops_below, log)
    result = decimate(domain.points, tensors, lines.edges, lines.kind, share)
    displacement = _record(domain.points, result, log)
    simple = _rebuilt(domain, lines, result, lone) if log else domain
    return simple, Dropped(tuple(log), share, displacement)


def _refuse_curves(domain: Domain) -> None:
    if domain.curved.paths:
        curved = int(np.flatnonzero(domain.curved.segment_paths >= 0)[0])
        raise DomainError(
            f"the domain has curves, one of them through "
            f"{at(*domain.points[domain.segments[curved, 0]])}, and simplify is for straight "
            "segments: leave small curves out before the domain is made"
        )


@dataclass(frozen=True)
class _Lines:
    """The pieces of a domain, with their names and sides.

    Directed so that the region on the left is not above that on the right.
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
        edges, left, right = turned(domain.pieces.astype(np.int64), *sides.T)
        return cls(edges, domain.segment_tags[domain.piece_segments].astype(np.int64), left, right)

    @property
    def kind(self) -> Int64s:
        """Edges of one kind have the same name and the same sides."""
        rows = np.stack([self.tags, self.left, self.right], axis=1)
        return np.unique(rows, axis=0, return_inverse=True)[1].reshape(-1)

    def where(self, kept: NDArray[np.bool_]) -> _Lines:
        return _Lines(self.edges[kept], self.tags[kept], self.left[kept], self.right[kept])


def _without_loops(
    domain: Domain, lines: _Lines, lone: Int64s, tensors: Floats, below: float, log: list[Repair]
) -> tuple[_Lines, Int64s]:
    """The lines without small loops, the points that stay, and a record of each loop."""
    used, edges = used_points(lines.edges)
    faces = find_faces(domain.points[used], edges)
    loops = small_loops(domain.points[used], tensors[used], edges, faces, below)
    kept = np.ones(len(edges), bool)
    gone = np.zeros(faces.count, bool)
    for loop in loops:
        staying = kept.copy()
        staying[loop.edges] = False
        before, after = (
            np.union1d(lines.left[which], lines.right[which]) for which in (kept, staying)
        )
        if len(before) > len(after) or not staying.any():
            continue  # the last of a region, or of all
        kept = staying
        gone[loop.faces] = True
        x, y = loop.place
        what = f"a loop of {len(loop.edges)} edges around an area of {loop.area:.4g} left out"
        log.append(Repair("loop", (x, y), what, loop.size))
    stays = [not gone[faces.at(domain.points[v])] for v in lone]
    for v in lone[~np.array(stays, bool)].tolist():
        x, y = domain.points[v].tolist()
        log.append(Repair("point", (x, y), f"point {v} lies in a loop left out"))
    return lines.where(kept), lone[np.array(stays, bool)]


def _record(points: Floats, result: Decimated, log: list[Repair]) -> float:
    """A record of each chain of points left out; returns the largest displacement."""
    counts = np.diff(result.starts)
    edge = np.repeat(np.arange(len(counts)), counts)
    start, end = points[result.edges[edge].T]
    off = distance(points[result.passed], start, end)[0]
    order = np.lexsort((off, edge))  # of each edge, the farthest point comes last
    passing = np.flatnonzero(counts)
    farthest = order[result.starts[passing + 1] - 1]
    for (a, b), n, v, d in zip(
        points[result.edges[passing]].tolist(),
        counts[passing].tolist(),
        points[result.passed[farthest]].tolist(),
        off[farthest].tolist(),
        strict=True,
    ):
        what = (
            f"{n} point{'s' if n > 1 else ''} between {at(*a)} and {at(*b)} left out, {d:.3g} off "
            "the line"
        )
        log.append(Repair("points", (v[0], v[1]), what, d))
    return float(off.max(initial=0.0))


def _rebuilt(domain: Domain, lines: _Lines, result: Decimated, lone: Int64s) -> Domain:
    """The domain of the edges that are left, with the regions and names of before."""
    used, edges = used_points(result.edges)
    faces = find_faces(domain.points[used], edges)
    region = np.full(faces.count, -1)
    left, right = lines.left[result.source], lines.right[result.source]
    region[faces.left], region[faces.right] = left, right
    tags = lines.tags[result.source]
    kept = np.union1d(used, lone)
    # Face 0, the outside, needs no point.
    places = {r: faces.places[mine + 1] for r, mine in rows_of_each(region[1:]).items()}
    return Domain(
        domain.points[kept],
        np.searchsorted(kept, result.edges),
        holes=places.get(-1, np.empty((0, 2))),
        regions={r: places[r] for r in np.unique(domain.seed_regions).tolist() if r in places},
        names=labelled(tags),
        tags=domain.names,
        region_tags=domain.region_names,
    )
