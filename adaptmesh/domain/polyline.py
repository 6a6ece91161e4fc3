"""Runs of curves replaced by chords, so many that the chords lie to each other as the curves do.

Chords may be taken for curves if no two of them cross, and if between each and its curve there is
no other vertex: every curve can then be drawn straight without passing over one.

::

          .--~~~--.                 the hull of the curve between a and b, with a foreign vertex v
        a ----v---- b               in it: the chord ab would leave v on the wrong side, and is
                                    halved
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from adaptmesh.curves import Curve
from adaptmesh.errors import DomainError
from adaptmesh.geometry.crossing import meet
from adaptmesh.types import Floats, Index, Ints

from .paths import Run, name_of_curve, points_on

LOOKS = 16
"""A curve is looked at in so many steps along each chord."""

ROUNDING = 1e-13
"""Chords that are off their curve by less than this share of the extent cannot be bettered."""

SHORTEST = 2.0**-40
"""Nor can those that take less than this of a curve's parameter."""

MOST = 20_000
"""More chords than this, and 16 for each that was asked for, are not tried."""


@dataclass(frozen=True)
class Chords:
    """Vertices on runs, in order, and the chords between them.

    Attributes
    ----------
    points : (n, 2) array
        The corners as they were given, then the vertices between.
    run : (k,) array of int
        The run of each chord; chords are in order along their runs.
    u : (k, 2) array
        The parameters of its ends.
    ends : (k, 2) array of int
        Their numbers in `points`.
    """

    points: Floats
    run: Ints
    u: Floats
    ends: Ints

    def by_run(self, n: int) -> list[Floats]:
        """The parameters at which each of n runs is cut, ascending, with both its ends."""
        first = np.searchsorted(self.run, np.arange(1, n))
        return [np.append(u[:, 0], u[-1, 1]) for u in np.split(self.u, first)]


@dataclass(frozen=True)
class Surroundings:
    """What is there besides the runs: points to stay clear of, and straight lines.

    ``points[:n_corners]`` are the corners that runs and lines end at; the others are loose: seeds
    of holes and regions, isolated points.
    """

    points: Floats
    n_corners: int
    lines: Ints
    line_curves: Ints
    curves: Sequence[Curve]


def chords_along(
    runs: Sequence[Run], cuts: Sequence[Floats], most_turn: float, around: Surroundings
) -> Chords:
    """Chords between the cuts of each run, and more where they are needed.

    Parameters
    ----------
    runs : sequence of Run
    cuts : sequence of (m,) arrays
        Parameters of each run, ascending, both ends included.
    most_turn : float
        The curve turns by at most this angle along a chord, in degrees.
    around : Surroundings

    Raises
    ------
    DomainError
        If curves cross, or come too near each other for chords to tell them apart; it names both
        and the place.
    """
    work = _Refinement(runs, cuts, around)
    most = MOST + 16 * len(work.u)
    while len(bad := work.to_halve(np.radians(most_turn))):
        work.check_can_be_halved(bad, most)
        work.halve(bad)
    return work.chords()


class _Refinement:
    """Chords that are halved until they are right."""

    def __init__(self, runs: Sequence[Run], cuts: Sequence[Floats], around: Surroundings) -> None:
        self.runs, self.around = runs, around
        self.corners = around.points[: around.n_corners]
        self.extent = float(np.ptp(around.points, axis=0).max())
        points, run, u, ends, n = [self.corners], [], [], [], len(self.corners)
        for r, cut in enumerate(cuts):
            inner = len(cut) - 2
            points.append(runs[r].point(cut[1:-1]))
            number = np.concatenate([[runs[r].ends[0]], n + np.arange(inner), [runs[r].ends[1]]])
            run.append(np.full(inner + 1, r))
            u.append(np.stack([cut[:-1], cut[1:]], axis=1))
            ends.append(np.stack([number[:-1], number[1:]], axis=1))
            n += inner
        self.points = np.concatenate(points)
        self.extent = max(self.extent, float(np.ptp(self.points, axis=0).max()))
        in_last_place = np.finfo(float).eps * float(np.abs(self.points).max())
        self.rounding = max(ROUNDING * self.extent, 4 * in_last_place)
        self._look(np.concatenate(run), np.concatenate(u), np.concatenate(ends))

    def _look(self, run: Index, u: Floats, ends: Index) -> None:
        import shapely

        self.run, self.u, self.ends = run, u, ends
        samples = self._samples(run, u, ends)
        steps = np.diff(samples, axis=1)
        cross = steps[:, :-1, 0] * steps[:, 1:, 1] - steps[:, :-1, 1] * steps[:, 1:, 0]
        along = (steps[:, :-1] * steps[:, 1:]).sum(axis=2)
        self.turn = np.abs(np.arctan2(cross, along)).sum(axis=1)
        chord = samples[:, -1] - samples[:, 0]
        off = samples - samples[:, :1]
        length = np.hypot(*chord.T)
        height = np.abs(off[..., 0] * chord[:, None, 1] - off[..., 1] * chord[:, None, 0]).max(
            axis=1
        )
        self.reach = reach = np.hypot(off[..., 0], off[..., 1]).max(axis=1)
        self.height = np.where(length > 0, height / np.where(length > 0, length, 1), reach)
        self.turn[(length == 0) & (reach > 0)] = np.inf  # there and back again
        still = np.flatnonzero(reach == 0)
        if len(still):
            k = still[0]
            raise DomainError(
                f"{self.name(k)} stands still at {self.place(k)} from u = {u[k, 0]:g} to "
                f"{u[k, 1]:g}: it has no length there"
            )
        self.hulls = shapely.convex_hull(shapely.linestrings(samples))

    def _samples(self, run: Index, u: Floats, ends: Index) -> Floats:
        t = np.linspace(0, 1, LOOKS + 1)
        at = u[:, :1] + t * (u[:, 1:] - u[:, :1])
        out = points_on(self.runs, np.repeat(run, LOOKS + 1), at.ravel())
        out = out.reshape(-1, LOOKS + 1, 2)
        out[:, 0], out[:, -1] = self.points[ends[:, 0]], self.points[ends[:, 1]]
        return out

    def to_halve(self, most_turn: float) -> Index:
        """Chords that turn too much, have a foreign vertex beside them, or cross another line."""
        none: Index = np.empty(0, np.intp)
        self.beside: tuple[Index, Index] = (none, none)
        self.crossed: tuple[Index, Index] = (none, none)
        bad = np.flatnonzero(self.turn > most_turn * (1 + 1e-9))
        if len(bad):
            return bad  # the other checks would look at curves that are not resolved yet
        self.beside = self._beside_vertices()
        self.crossed = self._crossing()
        return np.unique(np.concatenate([self.beside[0], self.crossed[0]]))

    def _beside_vertices(self) -> tuple[Index, Index]:
        """Chords, and the points between them and their curves, or on them but for rounding."""
        import shapely

        tree = shapely.STRtree(shapely.points(self._all_points()))
        chord, vertex = tree.query(self.hulls, predicate="dwithin", distance=self.rounding)
        foreign = (self.ends[chord] != vertex[:, None]).all(axis=1)
        return chord[foreign], vertex[foreign]

    def _all_points(self) -> Floats:
        return np.concatenate([self.points, self.around.points[self.around.n_corners :]])

    def _crossing(self) -> tuple[Index, Index]:
        """Of each two lines that cross the chord that is further off its curve, and the other."""
        import shapely

        ends = np.concatenate([self.ends, self.around.lines])
        tree = shapely.STRtree(shapely.linestrings(self.points[ends]))
        e, f = tree.query(tree.geometries[: len(self.ends)])
        e, f = e[e < f], f[e < f]
        same = (np.sort(ends[e], axis=1) == np.sort(ends[f], axis=1)).all(axis=1)
        met = np.union1d(np.flatnonzero(same), meet(self.points, ends[e], ends[f]))
        e, f = e[met], f[met]
        height = np.append(self.height, np.full(len(self.around.lines), -1.0))
        first = height[e] >= height[f]
        return np.where(first, e, f), np.where(first, f, e)

    def check_can_be_halved(self, bad: Index, most: int) -> None:
        """Refuse what more chords do not mend."""
        stuck = self.u[bad, 1] - self.u[bad, 0] < SHORTEST * np.maximum(1, self.u[bad, 1])
        stuck |= (self.height[bad] <= self.rounding) & ~(self.turn[bad] > 1e-3)
        chord, vertex = self.beside
        # What is smaller than rounding all lies beside one another, however often it is halved.
        stuck |= (self.reach[bad] <= self.rounding) & np.isin(bad, chord)
        same = self.points[self.ends[chord]] == self._all_points()[vertex][:, None]
        stuck |= np.isin(bad, chord[same.all(axis=2).any(axis=1)])
        if len(self.u) > most:
            stuck[:] = True
        if stuck.any():
            raise DomainError(self._explain(int(bad[stuck.argmax()])))

    def _explain(self, k: int) -> str:
        """Why a chord would have to be halved for ever, and what to do."""
        me, at = self.name(k), self.place(k)
        if self.reach[k] <= self.rounding:
            return (
                f"{me} at {at} has parts smaller than can be told apart in a domain that is "
                f"{self.extent:g} wide: leave it out, or what makes the domain so large"
            )
        for other in self.crossed[1][self.crossed[0] == k].tolist():
            line = other - len(self.ends)
            them = (
                self.name(other)
                if line < 0
                else name_of_curve(self.around.curves, int(self.around.line_curves[line]))
            )
            if them == me:
                return f"{me} crosses itself at {at}: cut it there (Curve.part)"
            return (
                f"{me} and {them} cross or touch at {at}: cut both there (Curve.part), or move "
                "them apart"
            )
        for v in self.beside[1][self.beside[0] == k].tolist():
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

    def _owner(self, v: int) -> str:
        """Whose point this is, in words."""
        on = np.flatnonzero((self.ends == v).any(axis=1))
        if len(on):
            return f"the point of {self.name(int(on[0]))}"
        on = np.flatnonzero((self.around.lines == v).any(axis=1))
        if len(on):
            curve = int(self.around.line_curves[on[0]])
            return f"the end of {name_of_curve(self.around.curves, curve)}"
        return "the point"

    def halve(self, bad: Index) -> None:
        middle = 0.5 * (self.u[bad, 0] + self.u[bad, 1])
        new = len(self.points) + np.arange(len(bad))
        self.points = np.concatenate([self.points, points_on(self.runs, self.run[bad], middle)])
        kept = np.ones(len(self.u), bool)
        kept[bad] = False
        old = self.run, self.u, self.ends, self.turn, self.height, self.reach, self.hulls
        self._look(
            np.repeat(self.run[bad], 2),
            np.stack([self.u[bad, 0], middle, middle, self.u[bad, 1]], axis=1).reshape(-1, 2),
            np.stack([self.ends[bad, 0], new, new, self.ends[bad, 1]], axis=1).reshape(-1, 2),
        )
        looked = self.run, self.u, self.ends, self.turn, self.height, self.reach, self.hulls
        self.run, self.u, self.ends, self.turn, self.height, self.reach, self.hulls = (
            np.concatenate([a[kept], b]) for a, b in zip(old, looked, strict=True)
        )

    def chords(self) -> Chords:
        order = np.lexsort((self.u[:, 0], self.run))
        return Chords(
            self.points,
            self.run[order].astype(np.int32),
            self.u[order],
            self.ends[order].astype(np.int32),
        )

    def name(self, k: int) -> str:
        run = self.runs[self.run[k]]
        return name_of_curve(self.around.curves, run.curve_at(float(self.u[k].mean())))

    def place(self, k: int) -> str:
        x, y = self.points[self.ends[k]].mean(axis=0)
        return f"({x:.10g}, {y:.10g})"
