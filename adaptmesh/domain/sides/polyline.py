"""Polylines along the sides of a domain, refined until they have the topology of the curves.

Polylines may be taken for curves if no two of their edges cross, and if between each edge and its
curve there is no other vertex: every curve can then be drawn straight without passing over one.

::

          .--~~~--.                 the hull of the curve between a and b, with a foreign vertex v
        a ----v---- b               in it: the edge ab would leave v on the wrong side, and is
                                    halved

A straight side is one edge, and stays so.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from adaptmesh.errors import DomainError
from adaptmesh.geometry.crossing import meet
from adaptmesh.geometry.products import angles_between, cross
from adaptmesh.types import Bools, Floats, Index

from .joining import name_of_curve
from .line_rounding import nearest_to_lines
from .side import SidePoints, Sides

Hulls = NDArray[np.object_]

STEPS = 16
"""In so many steps a curve is looked at along each edge."""

ROUNDING = 1e-13
"""Edges that are off their curve by less than this share of the extent cannot be bettered."""

SHORTEST = 2.0**-40
"""Nor can those that take less than this of a curve's parameter."""

MAX_EDGES = 20_000
"""More edges than this, and 16 for each that was asked for, are not tried."""


@dataclass(frozen=True)
class Polylines:
    """Vertices on all sides, in order, and the edges between them.

    Attributes
    ----------
    points : (n, 2) array
        The corners of the domain as they were given, then the vertices between: those of curved
        sides, those of straight ones.
    side : (k,) array of int
        The side of each edge; edges are in order along their sides.
    u : (k, 2) array
        The parameters of its ends.
    ends : (k, 2) array of int
        Their numbers in `points`.
    """

    points: Floats
    side: Index
    u: Floats
    ends: Index

    @property
    def inner(self) -> SidePoints:
        """The vertices but the corners."""
        follows = np.diff(self.side, prepend=-1) == 0
        return SidePoints(self.side[follows], self.u[follows, 0])


def vertices_at(sides: Sides, points: SidePoints) -> Floats:
    """Points of sides as vertices: far from the origin rounded so as to be nearest to their sides.

    Rounding moves them along straight sides, and on periodic ones alike.
    """
    out = sides.point(*points)
    straight = np.flatnonzero(sides.is_straight[points.side])
    a, b = (sides.corners[sides.ends[: sides.n_straight, i]] for i in (0, 1))
    exact = out[straight]
    rounded = nearest_to_lines(exact, a, b, points.side[straight])
    if rounded is exact:
        return out
    out[straight] = rounded
    for i, image in sides.images.items():
        if i < image.side < sides.n_straight:
            mine, theirs = (np.flatnonzero(points.side == k) for k in (i, image.side))
            vector = b[i] - a[i]
            u = sides.image(i, (out[mine] - a[i]) @ vector / (vector @ vector))
            if len(mine) == len(theirs):
                out[theirs] = sides.point(points.side[theirs], np.sort(u))
    return out


class Edges(NamedTuple):
    """Edges of polylines, and how they lie to their curves.

    Attributes
    ----------
    side : (k,) array of int
    u : (k, 2) array
    ends : (k, 2) array of int
        As those of `Polylines`.
    turn : (k,) array
        By what angle the curve turns along each.
    height : (k,) array
        How far the curve is off it.
    reach : (k,) array
        How far the curve is off its first end.
    hulls : (k,) array of object
        The convex hull of the curve, as shapely has it.
    """

    side: Index
    u: Floats
    ends: Index
    turn: Floats
    height: Floats
    reach: Floats
    hulls: Hulls

    def where(self, chosen: Bools | Index) -> Edges:
        """Some of the edges."""
        chosen_of_each: Any = (a[chosen] for a in self)
        return Edges(*chosen_of_each)

    def joined(self, other: Edges) -> Edges:
        """These edges, then others."""
        both: Any = zip(self, other, strict=True)
        return Edges(*map(np.concatenate, both))


class Faults(NamedTuple):
    """What is wrong with edges: pairs of the number of an edge and of what it does not go with.

    Attributes
    ----------
    edges : (f,) array of int
        Those that are to be halved, ascending.
    beside : two (b,) arrays of int
        An edge and a point between it and its curve, or on it but for rounding.
    crossed : two (c,) arrays of int
        An edge and another one, or after all edges a straight side, that it crosses.
    """

    edges: Index
    beside: tuple[Index, Index]
    crossed: tuple[Index, Index]


def polylines_along(sides: Sides, points: SidePoints, max_turn: float) -> Polylines:
    """Polylines through some points of sides, on curves through more where they are needed.

    Parameters
    ----------
    sides : Sides
    points : SidePoints
    max_turn : float
        The curve turns by at most this angle along an edge, in degrees.

    Raises
    ------
    DomainError
        If curves cross, or come too near each other for polylines to tell them apart; it names both
        and the place.
    """
    straight = points.where(sides.is_straight[points.side])
    work = _Refinement.of(sides, points.where(~sides.is_straight[points.side]))
    max_edges = MAX_EDGES + 16 * len(work.edges.u)
    while len((faults := work.faults(np.radians(max_turn))).edges):
        work.refuse_what_halving_does_not_mend(faults, max_edges)
        work = work.halved(faults.edges)
    return work.result(straight)


def _chained(
    sides: Sides, which: Index, inner: SidePoints, number: Index
) -> tuple[Index, Floats, Index]:
    """Edges along some sides through their inner points, which have these numbers (k,).

    Returns the side (e,), the parameters (e, 2) and the ends (e, 2) of each edge.
    """
    side = np.repeat(which, inner.counts(len(sides))[which] + 1)
    is_first = np.diff(side, prepend=-1) != 0
    is_last = np.roll(is_first, -1)
    u, ends = np.empty((len(side), 2)), np.empty((len(side), 2), np.intp)
    for k, outer, end_u in ((0, is_first, 0.0), (1, is_last, sides.lengths[which])):
        u[outer, k], ends[outer, k] = end_u, sides.ends[which, k]
        u[~outer, k], ends[~outer, k] = inner.u, number
    return side, u, ends


@dataclass(frozen=True)
class _Refinement:
    """Polylines at work: the sides, the points so far, and the edges between them."""

    sides: Sides
    points: Floats
    edges: Edges
    extent: float
    rounding: float

    @classmethod
    def of(cls, sides: Sides, inner: SidePoints) -> _Refinement:
        curved = np.arange(sides.n_straight, len(sides))
        number = len(sides.corners) + np.arange(len(inner.u))
        side, u, ends = _chained(sides, curved, inner, number)
        points = np.concatenate([sides.corners, sides.point(*inner)])
        given = np.concatenate([sides.corners, sides.loose])
        extent = max(float(np.ptp(p, axis=0).max()) for p in (given, points))
        in_last_place = np.finfo(float).eps * float(np.abs(points).max())
        rounding = max(ROUNDING * extent, 4 * in_last_place)
        return cls(sides, points, _looked_at(sides, points, side, u, ends), extent, rounding)

    def halved(self, bad: Index) -> _Refinement:
        """The same with some of the edges halved."""
        old = self.edges.where(bad)
        side, u, ends = old.side, old.u, old.ends
        middle = 0.5 * (u[:, 0] + u[:, 1])
        new = len(self.points) + np.arange(len(bad))
        points = np.concatenate([self.points, self.sides.point(side, middle)])
        halves = _looked_at(
            self.sides,
            points,
            np.repeat(side, 2),
            np.stack([u[:, 0], middle, middle, u[:, 1]], axis=1).reshape(-1, 2),
            np.stack([ends[:, 0], new, new, ends[:, 1]], axis=1).astype(np.intp).reshape(-1, 2),
        )
        kept = np.ones(len(self.edges.u), bool)
        kept[bad] = False
        return replace(self, points=points, edges=self.edges.where(kept).joined(halves))

    def result(self, straight: SidePoints) -> Polylines:
        """These polylines and those of the straight sides through some points."""
        number = len(self.points) + np.arange(len(straight.u))
        lines = _chained(self.sides, np.arange(self.sides.n_straight), straight, number)
        curved = self.edges.where(np.lexsort((self.edges.u[:, 0], self.edges.side)))
        points = np.concatenate([self.points, vertices_at(self.sides, straight)])
        both: Any = zip(lines, curved[:3], strict=True)
        return Polylines(points, *map(np.concatenate, both))

    def faults(self, max_turn: float) -> Faults:
        """Edges that turn too much, have a foreign vertex beside them, or cross another line."""
        none: Index = np.empty(0, np.intp)
        bad = np.flatnonzero(self.edges.turn > max_turn * (1 + 1e-9))
        # With edges that turn too much, the rest would look at curves that are not resolved yet.
        if len(bad) or not len(self.edges.u):
            return Faults(bad, (none, none), (none, none))
        beside, crossed = self._beside_vertices(), self._crossing()
        return Faults(np.unique(np.concatenate([beside[0], crossed[0]])), beside, crossed)

    def _beside_vertices(self) -> tuple[Index, Index]:
        import shapely

        tree = shapely.STRtree(shapely.points(self._all_points()))
        edge, vertex = tree.query(self.edges.hulls, predicate="dwithin", distance=self.rounding)
        foreign = (self.edges.ends[edge] != vertex[:, None]).all(axis=1)
        return edge[foreign], vertex[foreign]

    def _all_points(self) -> Floats:
        return np.concatenate([self.points, self.sides.loose])

    def _crossing(self) -> tuple[Index, Index]:
        """Of each two lines that cross the edge that is further off its curve, and the other."""
        import shapely

        n = self.sides.n_straight
        ends = np.concatenate([self.edges.ends, self.sides.ends[:n]])
        tree = shapely.STRtree(shapely.linestrings(self.points[ends]))
        e, f = tree.query(tree.geometries[: len(self.edges.ends)])
        e, f = e[e < f], f[e < f]
        same = (np.sort(ends[e], axis=1) == np.sort(ends[f], axis=1)).all(axis=1)
        met = np.union1d(np.flatnonzero(same), meet(self.points, ends[e], ends[f]))
        e, f = e[met], f[met]
        height = np.append(self.edges.height, np.full(n, -1.0))
        first = height[e] >= height[f]
        return np.where(first, e, f), np.where(first, f, e)

    def refuse_what_halving_does_not_mend(self, faults: Faults, max_edges: int) -> None:
        edges, bad = self.edges, faults.edges
        stuck = edges.u[bad, 1] - edges.u[bad, 0] < SHORTEST * np.maximum(1, edges.u[bad, 1])
        stuck |= (edges.height[bad] <= self.rounding) & ~(edges.turn[bad] > 1e-3)
        edge, vertex = faults.beside
        # What is smaller than rounding all lies beside one another, however often it is halved.
        stuck |= (edges.reach[bad] <= self.rounding) & np.isin(bad, edge)
        same = self.points[edges.ends[edge]] == self._all_points()[vertex][:, None]
        stuck |= np.isin(bad, edge[same.all(axis=2).any(axis=1)])
        if len(edges.u) > max_edges:
            stuck[:] = True
        if stuck.any():
            raise DomainError(self._explain(int(bad[stuck.argmax()]), faults))

    def _explain(self, k: int, faults: Faults) -> str:
        """Why an edge would have to be halved for ever, and what to do."""
        me = _name(self.sides, self.edges.side[k], self.edges.u[k])
        at = _middle_text(self.points[self.edges.ends[k]])
        if self.edges.reach[k] <= self.rounding:
            return (
                f"{me} at {at} has parts smaller than can be told apart in a domain that is "
                f"{self.extent:g} wide: leave it out, or what makes the domain so large"
            )
        for other in faults.crossed[1][faults.crossed[0] == k].tolist():
            them = self._name_of_line(other)
            if them == me:
                return f"{me} crosses itself at {at}: cut it there (Curve.part)"
            return (
                f"{me} and {them} cross or touch at {at}: cut both there (Curve.part), or move "
                "them apart"
            )
        for v in faults.beside[1][faults.beside[0] == k].tolist():
            x, y = self._all_points()[v]
            owner = self._owner(v)
            if owner == f"the point of {me}":
                return f"{me} meets itself at ({x:.10g}, {y:.10g}): cut it there (Curve.part)"
            return (
                f"{me} passes {owner} at ({x:.10g}, {y:.10g}) nearer than chords can tell "
                "apart: where curves meet, cut them both there (Curve.part); ends that are to "
                "meet want a larger join_tolerance; or move them apart"
            )
        return (
            f"{me} has a kink at {at}: cut it there (Curve.part), or give the `breaks` of a "
            "Parametric curve"
        )

    def _name_of_line(self, k: int) -> str:
        """The curve of an edge, or of a straight side, in words."""
        n = len(self.edges.side)
        if k < n:
            return _name(self.sides, self.edges.side[k], self.edges.u[k])
        return name_of_curve(self.sides.curves, int(self.sides.straight_curves[k - n]))

    def _owner(self, v: int) -> str:
        """Whose point this is, in words."""
        on = np.flatnonzero((self.edges.ends == v).any(axis=1))
        if len(on):
            return f"the point of {self._name_of_line(int(on[0]))}"
        on = np.flatnonzero((self.sides.ends[: self.sides.n_straight] == v).any(axis=1))
        if len(on):
            return f"the end of {self._name_of_line(len(self.edges.side) + int(on[0]))}"
        return "the point"


def _looked_at(sides: Sides, points: Floats, side: Index, u: Floats, ends: Index) -> Edges:
    """Edges, and how they lie to their curves, from samples of these."""
    if not len(side):  # nothing is curved
        nothing = np.empty(0)
        return Edges(side, u, ends, nothing, nothing, nothing, np.empty(0, object))
    import shapely

    at = u[:, :1] + np.linspace(0, 1, STEPS + 1) * (u[:, 1:] - u[:, :1])
    samples = sides.point(np.repeat(side, STEPS + 1), at.ravel()).reshape(-1, STEPS + 1, 2)
    samples[:, 0], samples[:, -1] = points[ends[:, 0]], points[ends[:, 1]]

    steps = np.diff(samples, axis=1)
    turn = angles_between(steps[:, :-1], steps[:, 1:]).sum(axis=1)
    vector = samples[:, -1] - samples[:, 0]
    off = samples - samples[:, :1]
    length = np.hypot(*vector.T)
    area = np.abs(cross(off, vector[:, None])).max(axis=1)
    reach = np.hypot(off[..., 0], off[..., 1]).max(axis=1)
    height = np.where(length > 0, area / np.where(length > 0, length, 1), reach)
    turn[(length == 0) & (reach > 0)] = np.inf  # there and back again
    still = np.flatnonzero(reach == 0)
    if len(still):
        k = still[0]
        raise DomainError(
            f"{_name(sides, side[k], u[k])} stands still at {_middle_text(points[ends[k]])} from "
            f"u = {u[k, 0]:g} to {u[k, 1]:g}: it has no length there"
        )
    hulls = shapely.convex_hull(shapely.linestrings(samples))
    return Edges(side, u, ends, turn, height, reach, np.asarray(hulls))


def _name(sides: Sides, side: int, u: Floats) -> str:
    """The curve of an edge in words."""
    return name_of_curve(sides.curves, sides.path(side).curve_at(float(u.mean())))


def _middle_text(ends: Floats) -> str:
    x, y = ends.mean(axis=0)
    return f"({x:.10g}, {y:.10g})"
