"""Node segments: divide them at crossings and near-contacts until they meet only at their ends.

        b              b
    a___|___c      a___x___c      a point x where segments cross;
        |              |
        d              d

    a_______c      a___v___c      a point v nearer than the tolerance to a segment divides it:
        v              |          v moves onto the segment if it was given after it, else the
        |              w          segment bends to v.
        w

What was given first stays: of points that nearly coincide the first one, of a point and a segment
the one of the earlier segment. So a border that almost matches its neighbour's is moved onto it.

Whether segments cross is decided by exact signs. New points are rounded, which can make their
pieces touch or cross others; so pieces that changed are compared again, until nothing is closer
than the tolerance. The exact triangulation of the result (`faces`) proves it.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from adaptmesh._core import encounters
from adaptmesh.errors import DomainError
from adaptmesh.geometry.distance import distance, meeting, near_points
from adaptmesh.types import Bools, Floats, Int64s

from .record import Repair, point_text

Pairs = tuple[Int64s, Int64s]

MAX_ROUNDS = 100
"""Maximal number of rounds of merging and dividing; real and random outlines need three to ten."""

MAX_CROSSINGS = 1_000_000
"""Input with more crossings than this is refused: each crossing would become a point."""

TOLERANCE = 1e-9
"""Default tolerance relative to the extent; smaller features are taken for rounding errors."""

ROUNDING = 4 * np.finfo(float).eps
"""Smallest tolerance relative to the largest coordinate: the rounding of points on segments."""

MIN_EXTENT = 1e-75
"""Smallest extent of the points; its fourth power is still a double."""


@dataclass(frozen=True)
class Labels:
    """Names of the given points and segments in messages, as functions of their numbers."""

    point: Callable[[int], str]
    segment: Callable[[int], str]


@dataclass(frozen=True)
class Noded:
    """Pieces of segments that meet only at their ends.

    Attributes
    ----------
    points : (n, 2) array
        The given points, some of them moved, then those added at crossings.
    pieces : (p, 2) array
        Pairs of point numbers, directed like their segments.
    segment : (p,) array
        The segment of each piece. Overlapping segments have pieces with the same points.
    lone : (l,) array
        Points of no segment that were not merged with another point.
    """

    points: Floats
    pieces: Int64s
    segment: Int64s
    lone: Int64s

    def displacement(self, points: Floats, segments: Int64s) -> float:
        """The largest distance of a point of a piece from the segment as it was given."""
        if not len(self.pieces):
            return 0.0
        start, end = points[segments[self.segment]].transpose(1, 0, 2)
        off = [distance(self.points[self.pieces[:, k]], start, end)[0].max() for k in (0, 1)]
        return float(max(off))


def resolve_tolerance(points: Floats, tolerance: float | None) -> float:
    """Return the given tolerance or the default, but no less than the rounding of coordinates.

    Raises
    ------
    DomainError
        If all points are equal, or so close that squares of distances underflow; or if the
        tolerance is negative or not finite.
    """
    extent = float(np.ptp(points, axis=0).max())
    if extent == 0:
        raise DomainError(
            f"all points are the same, {point_text(*points[0])}: there is nothing to mesh"
        )
    if extent < MIN_EXTENT:
        raise DomainError(
            f"all points lie within {extent:.3g} of {point_text(*points[0])}, so that areas "
            "underflow: choose another unit of length"
        )
    if tolerance is None:
        tolerance = TOLERANCE * extent
    if not (isinstance(tolerance, (int, float, np.number)) and 0 <= tolerance < np.inf):
        raise DomainError(f"tolerance: expected a finite length of at least 0, got {tolerance!r}")
    return max(float(tolerance), ROUNDING * float(np.abs(points).max()))


def node(
    points: Floats, segments: Int64s, tolerance: float, labels: Labels, log: list[Repair]
) -> Noded:
    """Divide segments until they meet only at their ends.

    Parameters
    ----------
    points : (n, 2) array
    segments : (k, 2) array
        Pairs of point numbers. A point of no segment is kept, and divides what it lies on.
    tolerance : float
        Points closer than this are merged. It has to exceed the rounding of coordinates.
    labels : Labels
        Names of the given points and segments in messages.
    log : list of Repair
        A record of each repair is appended.

    Raises
    ------
    DomainError
        If there are too many crossings, or the rounds do not end; the message gives a point.
    """
    work = _Noding(points, segments, tolerance, labels, log)
    for _ in range(MAX_ROUNDS):
        work.merge_points()
        near, crossings = work.find_encounters()
        if len(near[0]):
            work.divide_where_near(*near, crossings)
        elif len(crossings[0]):
            work.divide_where_crossing(*crossings)
        else:
            return work.result()
    raise DomainError(
        f"segments near {point_text(*work.unfinished_point())} still touch others after "
        f"{MAX_ROUNDS} rounds: the tolerance {tolerance:.3g} is too large there; choose another"
    )


class _Noding:
    """The points and pieces while they are divided, and which pieces are still to be compared."""

    def __init__(
        self, points: Floats, segments: Int64s, tolerance: float, labels: Labels, log: list[Repair]
    ) -> None:
        self.points = points.copy()
        self.given = len(points)
        self.tolerance = tolerance
        self.labels, self.log = labels, log
        lone = np.flatnonzero(np.bincount(segments.ravel(), minlength=len(points)) == 0)
        # A point of no segment is a segment from it to itself, given after all others.
        self.pieces: Int64s = np.concatenate([segments, np.stack([lone, lone], axis=1)])
        self.n_segments = len(segments)
        self.segment: Int64s = np.arange(len(self.pieces))
        #: The first segment that each point was given for; it decides which of two things moves.
        self.rank: Int64s = np.full(len(points), len(self.pieces))
        np.minimum.at(self.rank, self.pieces.ravel(), np.repeat(self.segment, 2))
        self.moved: Bools = np.zeros(len(points), bool)
        #: The pieces changed since pieces were last compared with each other.
        self.is_changed: Bools = np.ones(len(self.pieces), bool)

    def result(self) -> Noded:
        real = self.segment < self.n_segments
        lone = np.unique(self.pieces[~real])
        return Noded(self.points, self.pieces[real], self.segment[real], lone)

    def unfinished_point(self) -> tuple[float, float]:
        changed = self.pieces[self.is_changed]
        x, y = self.points[changed[0, 0] if len(changed) else 0]
        return float(x), float(y)

    def label(self, v: int) -> str:
        """Name a given point or a crossing in a message."""
        return (
            self.labels.point(v)
            if v < self.given
            else f"the crossing {point_text(*self.points[v])}"
        )

    def record(self, kind: str, v: int, what: str, displacement: float = 0.0) -> None:
        x, y = self.points[v]
        self.log.append(Repair(kind, (float(x), float(y)), what, displacement))

    # -- points that nearly coincide ---------------------------------------------------------

    def merge_points(self) -> None:
        """Merge points closer than the tolerance into the first of them."""
        used = np.flatnonzero(np.bincount(self.pieces.ravel()))
        representative = np.arange(len(self.points))
        for v, kept in near_points(self.points[used], self.tolerance):
            v, kept = int(used[v]), int(used[kept])
            representative[v] = kept
            gap = float(np.hypot(*(self.points[v] - self.points[kept])))
            if v < self.given:
                kind = "duplicate points" if gap == 0 else "nearly the same point"
                what = f"{self.labels.point(v)} is {self.label(kept)}" + (
                    "" if gap == 0 else f" but for {gap:.3g}"
                )
                self.record(kind, kept, f"{what}; made one", gap)
            self.rank[kept] = min(self.rank[kept], self.rank[v])
        representative = representative[representative]  # of those equal to a merged point
        pieces = representative[self.pieces]
        changed = (pieces != self.pieces).any(axis=1)
        self.pieces = pieces
        self.is_changed |= changed
        collapsed = (pieces[:, 0] == pieces[:, 1]) & (self.segment < self.n_segments)
        self._keep(~collapsed)

    def _keep(self, which: Bools) -> None:
        self.pieces, self.segment = self.pieces[which], self.segment[which]
        self.is_changed = self.is_changed[which]

    # -- encounters of pieces -------------------------------------------------------------

    def find_encounters(self) -> tuple[Pairs, Pairs]:
        """Find pieces with points on or near them, and pairs of pieces that cross."""
        near, crossings = encounters(
            self.points,
            self.pieces.astype(np.int32),
            self.is_changed,
            self.tolerance,
            MAX_CROSSINGS,
        )
        piece, v = near.astype(np.int64).T
        i, j = crossings.astype(np.int64).T
        if len(i) > MAX_CROSSINGS:
            x, y = self._meeting(i[:1], j[:1])[0]
            raise DomainError(
                f"segments cross at more than {MAX_CROSSINGS:,} points, one of them "
                f"{point_text(x, y)}: check that the points are in the right order"
            )
        self.is_changed[:] = False
        return (piece, v), (i, j)

    def _meeting(self, i: Int64s, j: Int64s) -> Floats:
        return meeting(self.points[self.pieces[i]], self.points[self.pieces[j]])

    # -- points near segments ----------------------------------------------------------------

    def divide_where_near(self, piece: Int64s, v: Int64s, crossings: Pairs) -> None:
        """Divide pieces at points on or near them."""
        for pieces in crossings:  # compared again in the next round, if they are still there
            self.is_changed[pieces] = True
        a, b = self.points[self.pieces[piece]].transpose(1, 0, 2)
        off, foot = distance(self.points[v], a, b)
        moves = self._which_move(piece, v, off)
        for i in np.flatnonzero((off > 0) & (v < self.given)).tolist():
            point, segment = self.labels.point(v[i]), self.labels.segment(self.segment[piece[i]])
            done = "the point moved onto it" if moves[i] else "the segment bent to it"
            what = f"{point} is {off[i]:.3g} off {segment}; {done}"
            self.record("point near a segment", v[i], what, float(off[i]))
        self._move(v[moves], foot[moves])
        self._divide(piece, v)

    def _which_move(self, piece: Int64s, v: Int64s, off: Floats) -> Bools:
        """Select for each point that may move the hit with the earliest segment.

        A point moves at most once, and only onto a segment given before all those that it ends.
        """
        out = np.zeros(len(v), bool)
        may = np.flatnonzero((off > 0) & (self.rank[v] > self.segment[piece]) & ~self.moved[v])
        order = may[np.lexsort((self.segment[piece[may]], v[may]))]
        _, first = np.unique(v[order], return_index=True)
        out[order[first]] = True
        return out

    def _move(self, v: Int64s, to: Floats) -> None:
        self.points[v] = to
        self.moved[v] = True
        touched = np.isin(self.pieces, v).any(axis=1)
        self.is_changed |= touched

    # -- crossings ---------------------------------------------------------------------------

    def divide_where_crossing(self, i: Int64s, j: Int64s) -> None:
        """Add a point where two pieces cross, and divide both there."""
        meet = self._meeting(i, j)
        new = len(self.points) + np.arange(len(i))
        for p, q, (x, y) in zip(self.segment[i], self.segment[j], meet.tolist(), strict=True):
            first, second = self.labels.segment(int(min(p, q))), self.labels.segment(int(max(p, q)))
            what = f"{first} and {second} cross; a point added there"
            self.log.append(Repair("crossing", (x, y), what))
        self.points = np.concatenate([self.points, meet])
        self.rank = np.append(self.rank, np.minimum(self.segment[i], self.segment[j]))
        self.moved = np.append(self.moved, np.ones(len(new), bool))
        self._divide(np.concatenate([i, j]), np.concatenate([new, new]))

    def _divide(self, piece: Int64s, v: Int64s) -> None:
        """Divide pieces at the points v, given in any order."""
        ends = self.points[self.pieces[piece]]
        along = ((self.points[v] - ends[:, 0]) * (ends[:, 1] - ends[:, 0])).sum(axis=1)
        divided = np.unique(piece)
        stops = np.concatenate([self.pieces[divided, 0], v, self.pieces[divided, 1]])
        owner = np.concatenate([divided, piece, divided])
        edge = np.full(len(divided), np.inf)
        order = np.lexsort((np.concatenate([-edge, along, edge]), owner))
        stops, owner = stops[order], owner[order]
        inner = (owner[:-1] == owner[1:]) & (stops[:-1] != stops[1:])
        new = np.stack([stops[:-1], stops[1:]], axis=1)[inner]

        segment = self.segment[owner[:-1][inner]]
        kept = np.ones(len(self.pieces), bool)
        kept[divided] = False
        self._keep(kept)
        self.pieces = np.concatenate([self.pieces, new])
        self.segment = np.concatenate([self.segment, segment])
        self.is_changed = np.concatenate([self.is_changed, np.ones(len(new), bool)])
