"""Segments made to meet only at points: merged, divided where they nearly touch, and crossed.

        b              b
    a___|___c      a___x___c      a point x where segments cross;
        |              |
        d              d

    a_______c      a___v___c      a point v nearer than the tolerance to a segment divides it:
        v              |          v moves onto the segment if it was given after it, else the
        |              w          segment bends to v.
        w

What was given first stays: of points that are nearly the same the first, of a point and a segment
the one of the earlier segment. So a border that almost matches its neighbour's is laid onto it.

Whether segments cross is decided by exact signs. New points are rounded, which can make them
touch or cross something else; the pieces of what was divided are looked at again, until nothing
is nearer than the tolerance. The exact triangulation of the result (`faces`) is the proof.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from adaptmesh._core import encounters
from adaptmesh.errors import DomainError
from adaptmesh.geometry.distance import distance, meeting, near_points
from adaptmesh.types import Bools, Floats, Int64s

from .record import Repair, at

Pairs = tuple[Int64s, Int64s]

MOST_ROUNDS = 100
"""Rounds of looking again; real and random outlines need three to ten."""

MOST_CROSSINGS = 1_000_000
"""More crossings than this are no outline: each would become a point."""

TOLERANCE = 1e-9
"""The default tolerance, as a share of the extent: smaller features are rounding, not geometry."""

ROUNDING = 4 * np.finfo(float).eps
"""No tolerance is smaller than this share of the largest coordinate: points put on segments are
rounded by as much."""

SMALLEST = 1e-75
"""Extent, whose fourth power is still a double."""


@dataclass(frozen=True)
class Words:
    """How messages call the points and segments that were given, by number."""

    point: Callable[[int], str]
    segment: Callable[[int], str]


@dataclass(frozen=True)
class Noded:
    """Pieces of segments that meet only at points.

    Attributes
    ----------
    points : (n, 2) array
        The given points, where they are now, then those put at crossings.
    pieces : (p, 2) array
        Pairs of point numbers, directed as the segment they are a piece of.
    segment : (p,) array
        That segment. Segments that overlap have pieces with the same points.
    lone : (l,) array
        Points that were given for no segment, and are not the same as another one.
    """

    points: Floats
    pieces: Int64s
    segment: Int64s
    lone: Int64s

    def drift(self, points: Floats, segments: Int64s) -> float:
        """The farthest that a point of a piece lies from the segment that was given."""
        if not len(self.pieces):
            return 0.0
        start, end = points[segments[self.segment]].transpose(1, 0, 2)
        off = [distance(self.points[self.pieces[:, k]], start, end)[0].max() for k in (0, 1)]
        return float(max(off))


def used_tolerance(points: Floats, tolerance: float | None) -> float:
    """The tolerance asked for, or the default; never below what rounding allows.

    Raises
    ------
    DomainError
        If all points are the same, or so near that squares of distances underflow; or if the
        tolerance is negative or not finite.
    """
    extent = float(np.ptp(points, axis=0).max())
    if extent == 0:
        raise DomainError(f"all points are the same, {at(*points[0])}: there is nothing to mesh")
    if extent < SMALLEST:
        raise DomainError(
            f"all points lie within {extent:.3g} of {at(*points[0])}, so that areas underflow: "
            "choose another unit of length"
        )
    if tolerance is None:
        tolerance = TOLERANCE * extent
    if not (isinstance(tolerance, (int, float, np.number)) and 0 <= tolerance < np.inf):
        raise DomainError(
            f"tolerance={tolerance!r}: a length is wanted, in units of coordinates, from 0 on"
        )
    return max(float(tolerance), ROUNDING * float(np.abs(points).max()))


def node(
    points: Floats, segments: Int64s, tolerance: float, words: Words, log: list[Repair]
) -> Noded:
    """Divide segments until they meet only at points.

    Parameters
    ----------
    points : (n, 2) array
    segments : (k, 2) array
        Pairs of point numbers. A point of no segment is kept, and divides what it lies on.
    tolerance : float
        What is nearer than this becomes one. It has to exceed the rounding of coordinates.
    words : Words
        How to call what was given.
    log : list of Repair
        Gets a record of each thing done.

    Raises
    ------
    DomainError
        If there are too many crossings, or they do not come to an end; it names a place.
    """
    work = _Noding(points, segments, tolerance, words, log)
    for _ in range(MOST_ROUNDS):
        work.merge_points()
        near, crossings = work.look()
        if len(near[0]):
            work.divide_where_near(*near, crossings)
        elif len(crossings[0]):
            work.divide_where_crossing(*crossings)
        else:
            return work.result()
    raise DomainError(
        f"near {at(*work.restless_place())} segments keep touching others however often they are "
        f"divided: the tolerance, {tolerance:.3g}, is too large for what is there; choose another"
    )


class _Noding:
    """The points and pieces at work, and which of them have to be looked at."""

    def __init__(
        self, points: Floats, segments: Int64s, tolerance: float, words: Words, log: list[Repair]
    ) -> None:
        self.points = points.copy()
        self.given = len(points)
        self.tolerance = tolerance
        self.words, self.log = words, log
        lone = np.flatnonzero(np.bincount(segments.ravel(), minlength=len(points)) == 0)
        # A point of no segment is a segment from it to itself, given after all others.
        self.pieces: Int64s = np.concatenate([segments, np.stack([lone, lone], axis=1)])
        self.n_segments = len(segments)
        self.segment: Int64s = np.arange(len(self.pieces))
        #: The first segment that each point was given for.
        self.rank: Int64s = np.full(len(points), len(self.pieces))
        np.minimum.at(self.rank, self.pieces.ravel(), np.repeat(self.segment, 2))
        self.moved: Bools = np.zeros(len(points), bool)
        #: What was changed since pieces were last compared with each other.
        self.unseen: Bools = np.ones(len(self.pieces), bool)

    def result(self) -> Noded:
        real = self.segment < self.n_segments
        lone = np.unique(self.pieces[~real])
        return Noded(self.points, self.pieces[real], self.segment[real], lone)

    def restless_place(self) -> tuple[float, float]:
        restless = self.pieces[self.unseen]
        x, y = self.points[restless[0, 0] if len(restless) else 0]
        return float(x), float(y)

    def say(self, v: int) -> str:
        """How to call a point that was given or put at a crossing."""
        return self.words.point(v) if v < self.given else f"the crossing {at(*self.points[v])}"

    def record(self, kind: str, v: int, what: str, displacement: float = 0.0) -> None:
        x, y = self.points[v]
        self.log.append(Repair(kind, (float(x), float(y)), what, displacement))

    # -- points that are nearly the same -----------------------------------------------------

    def merge_points(self) -> None:
        """Make one point of those nearer than the tolerance: the first of them."""
        used = np.flatnonzero(np.bincount(self.pieces.ravel()))
        representative = np.arange(len(self.points))
        for v, kept in near_points(self.points[used], self.tolerance):
            v, kept = int(used[v]), int(used[kept])
            representative[v] = kept
            gap = float(np.hypot(*(self.points[v] - self.points[kept])))
            if v < self.given:
                kind = "duplicate points" if gap == 0 else "nearly the same point"
                what = f"{self.words.point(v)} is {self.say(kept)}" + (
                    "" if gap == 0 else f" but for {gap:.3g}"
                )
                self.record(kind, kept, f"{what}; made one", gap)
            self.rank[kept] = min(self.rank[kept], self.rank[v])
        representative = representative[representative]  # equal to one that was merged itself
        pieces = representative[self.pieces]
        changed = (pieces != self.pieces).any(axis=1)
        self.pieces = pieces
        self.unseen |= changed
        collapsed = (pieces[:, 0] == pieces[:, 1]) & (self.segment < self.n_segments)
        self._keep(~collapsed)

    def _keep(self, which: Bools) -> None:
        self.pieces, self.segment = self.pieces[which], self.segment[which]
        self.unseen = self.unseen[which]

    # -- what is near, or crosses -------------------------------------------------------------

    def look(self) -> tuple[Pairs, Pairs]:
        """Pieces and points that lie on them, or nearly; and pairs of pieces that cross."""
        near, crossings = encounters(
            self.points,
            self.pieces.astype(np.int32),
            self.unseen,
            self.tolerance,
            MOST_CROSSINGS,
        )
        piece, v = near.astype(np.int64).T
        i, j = crossings.astype(np.int64).T
        if len(i) > MOST_CROSSINGS:
            x, y = self._meeting(i[:1], j[:1])[0]
            raise DomainError(
                f"segments cross at more than {MOST_CROSSINGS:,} places, one of them "
                f"{at(x, y)}: are these outlines, and their points in the right order?"
            )
        self.unseen[:] = False
        return (piece, v), (i, j)

    def _meeting(self, i: Int64s, j: Int64s) -> Floats:
        return meeting(self.points[self.pieces[i]], self.points[self.pieces[j]])

    # -- points near segments ----------------------------------------------------------------

    def divide_where_near(self, piece: Int64s, v: Int64s, crossings: Pairs) -> None:
        """Divide pieces at points that lie on them, or nearly."""
        for pieces in crossings:  # to be looked at again, those of them that stay
            self.unseen[pieces] = True
        a, b = self.points[self.pieces[piece]].transpose(1, 0, 2)
        off, foot = distance(self.points[v], a, b)
        moves = self._which_move(piece, v, off)
        for i in np.flatnonzero((off > 0) & (v < self.given)).tolist():
            point, segment = self.words.point(v[i]), self.words.segment(self.segment[piece[i]])
            done = "the point moved onto it" if moves[i] else "the segment bent to it"
            what = f"{point} is {off[i]:.3g} off {segment}; {done}"
            self.record("point near a segment", v[i], what, float(off[i]))
        self._move(v[moves], foot[moves])
        self._divide(piece, v)

    def _which_move(self, piece: Int64s, v: Int64s, off: Floats) -> Bools:
        """The first of the hits of each point that may move: onto the segment given first.

        A point moves once at most, and only onto what was given before all that it is an end of.
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
        self.unseen |= touched

    # -- crossings ---------------------------------------------------------------------------

    def divide_where_crossing(self, i: Int64s, j: Int64s) -> None:
        """Put a point where two pieces cross."""
        meet = self._meeting(i, j)
        new = len(self.points) + np.arange(len(i))
        for p, q, (x, y) in zip(self.segment[i], self.segment[j], meet.tolist(), strict=True):
            first, second = self.words.segment(int(min(p, q))), self.words.segment(int(max(p, q)))
            what = f"{first} and {second} cross; a point put there"
            self.log.append(Repair("crossing", (x, y), what))
        self.points = np.concatenate([self.points, meet])
        self.rank = np.append(self.rank, np.minimum(self.segment[i], self.segment[j]))
        self.moved = np.append(self.moved, np.ones(len(new), bool))
        self._divide(np.concatenate([i, j]), np.concatenate([new, new]))

    def _divide(self, piece: Int64s, v: Int64s) -> None:
        """Replace pieces by what their points, given in any order, divide them into."""
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
        self.unseen = np.concatenate([self.unseen, np.ones(len(new), bool)])
