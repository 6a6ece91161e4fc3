"""Where points are on the sides of a domain, and how far off them."""

from __future__ import annotations

import itertools
from collections.abc import Callable
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from adaptmesh.domain.inputs import rows_of_each
from adaptmesh.domain.sides.side import SideParts, Sides
from adaptmesh.geometry.products import angles_between, cross
from adaptmesh.types import Floats, Index

from .data import DomainData

if TYPE_CHECKING:
    from shapely import LineString


REACH = 0.15
"""Curves are nearer to the chords of the domain than this share of the chord's length."""

NEWTON_STEPS = 8
"""Of the search for the nearest point of a curve; it converges quadratically from a chord of it."""

LAST_STEP = 1e-8
"""A step no longer than this leaves nothing but rounding to the next one."""

AN_END = 1e-9
"""A parameter this near to that of an end is what rounding leaves of it."""

BENT = np.radians(30)
BENT_REACH = 0.3
"""A part that turns by no more is nearer to its chord than this share of the chord's length."""

SHORTEST = 1e-12
"""Parts of paths are not halved beyond this, as a share of their parameters: a kink never ends."""

HALVINGS = 80
"""So many find a parameter to the last place, even if Newton's steps are of no use."""

ROUNDING = 4 * float(np.finfo(float).eps)
"""Of a parameter, by its share; it moves the point by so much times the derivative."""


TOLERANCE = 1e-12
"""How far off a line of a domain its vertices may be, as a share of the diameter of the domain."""


def tolerance_of(domain: DomainData) -> float:
    """How far off a side of the domain its vertices may be.

    Points along slanted segments are rounded to the nearest coordinates: that is `TOLERANCE` times
    the diameter of the domain plus a few units in the last place of the largest coordinate; and
    those of a mesh that the domain was found from may be off by what that took for straight.
    """
    diameter = float(np.hypot(*np.ptp(domain.points, axis=0)))
    largest = float(np.abs(domain.points).max())
    rounding = TOLERANCE * diameter + 8 * float(np.finfo(float).eps) * largest
    found = domain.corners_found
    return rounding if found is None else max(rounding, found.tolerance)


class Projection(NamedTuple):
    """Where points are on sides, each on one of its own.

    Attributes
    ----------
    u : (k,) array
        Parameters: on straight sides in the order of the coordinates that change most along them,
        below 0 or above 1 beyond their ends; NaN where the point is not on the curved side.
    off : (k,) array
        Distances from the side, those within the tolerance of a curved one as 0.
    """

    u: Floats
    off: Floats


def project(sides: Sides, side: Index, points: Floats, tolerance: float) -> Projection:
    """Project points (k, 2) on sides (k,), curved ones where they are as near as the tolerance."""
    u, off = np.empty(len(side)), np.empty(len(side))
    for straight, on in ((True, _on_straight), (False, _on_curved)):
        mine = sides.is_straight[side] == straight
        if mine.any():
            u[mine], off[mine] = on(sides, side[mine], points[mine], tolerance)
    return Projection(u, off)


def _on_straight(
    sides: Sides, side: Index, points: Floats, tolerance: float
) -> tuple[Floats, Floats]:
    a, b = (sides.corners[sides.ends[side, i]] for i in (0, 1))
    d, w = b - a, points - a
    exponent = np.frexp(np.abs(d).max(axis=1))[1]  # squares are neither lost nor too large
    d, w = np.ldexp(d, -exponent[:, None]), np.ldexp(w, -exponent[:, None])
    rows, major = np.arange(len(side)), np.abs(d).argmax(axis=1)
    share = np.clip((w * d).sum(axis=1) / (d * d).sum(axis=1), 0, 1)
    beyond = np.hypot(*(w - share[:, None] * d).T)
    beside = np.abs(cross(w, d)) / np.hypot(*d.T)
    off = np.where((share > 0) & (share < 1), beside, beyond)
    return w[rows, major] / d[rows, major], np.ldexp(off, exponent)


def _on_curved(
    sides: Sides, side: Index, points: Floats, tolerance: float
) -> tuple[Floats, Floats]:
    """Of a point with several places on its side, the first."""
    import shapely

    distinct, number = np.unique(points, axis=0, return_inverse=True)
    n = len(distinct)
    found, at, point = places_on_curves(sides, distinct, tolerance)
    keys, first = np.unique(found.astype(np.int64) * n + point, return_index=True)
    asked = side.astype(np.int64) * n + number.ravel()
    place = np.minimum(np.searchsorted(keys, asked), max(len(keys) - 1, 0))
    u, off = np.full(len(side), np.nan), np.zeros(len(side))
    if len(keys):
        hit = keys[place] == asked
        u[hit] = at[first[place[hit]]]
    away = np.flatnonzero(np.isnan(u))
    for s, rows in rows_of_each(side[away]).items():
        distance = shapely.distance(shape_of(sides, s), shapely.points(points[away[rows]]))
        off[away[rows]] = distance + 2 * tolerance
    return u, off


def shape_of(sides: Sides, side: int) -> LineString:
    """A side as shapely has it, a curved one as its inscribed polyline."""
    import shapely

    straight = bool(sides.is_straight[side])
    u = np.array([0.0, 1.0]) if straight else sides.inscribed[side - sides.n_straight]
    return shapely.linestrings(sides.point(np.full(len(u), side), u))


def places_on_curves(sides: Sides, points: Floats, tolerance: float) -> tuple[Index, Floats, Index]:
    """All places of curved sides that are as near as the tolerance to one of these points (n, 2).

    Returns
    -------
    side, u, point : (k,) arrays
        The side of each place, its parameter and the number of the point, in order along the sides.
        A point that several sides pass has a place on each, one where a closed side begins has two.
    """
    parts = inscribed_parts(sides)
    found = _found(sides, parts, points, tolerance, REACH, _nearest)
    missing = np.setdiff1d(np.arange(len(points)), found[2])
    if len(missing):  # where inscribed chords turn by much, Newton's steps may lead astray
        bent = _bent_little(sides, parts)
        side, u, k = _found(sides, bent, points[missing], tolerance, BENT_REACH, _nearest_bracketed)
        side, u, point = (
            np.concatenate([found[0], side]),
            np.concatenate([found[1], u]),
            np.concatenate([found[2], missing[k]]),
        )
    else:
        side, u, point = found
    order = np.lexsort((u, side))
    side, u, point = side[order], u[order], point[order]
    again = (np.diff(side, prepend=-1) == 0) & (np.diff(point, prepend=-1) == 0)
    return side[~again], u[~again], point[~again]


def inscribed_parts(sides: Sides) -> SideParts:
    """The parts of curved sides between their inscribed points."""
    counts = [len(u) - 1 for u in sides.inscribed]
    ends = [np.stack([u[:-1], u[1:]], axis=1) for u in sides.inscribed]
    side = np.repeat(np.arange(sides.n_straight, len(sides)), counts)
    return SideParts(side, np.concatenate([np.empty((0, 2)), *ends]))


def _bent_little(sides: Sides, parts: SideParts) -> SideParts:
    """The same parts, halved until none turns by more than `BENT`."""
    side, u = parts
    done = []
    while len(side):
        du = u[:, 1] - u[:, 0]
        d = [sides.derivative(side, u[:, 0] + share * du) for share in (1e-3, 0.25, 0.75, 0.999)]
        turns = [angles_between(a, b) for a, b in itertools.pairwise(d)]
        bent = (np.sum(turns, axis=0) > BENT) & (du > SHORTEST * np.maximum(1, u[:, 1]))
        done.append((side[~bent], u[~bent]))
        (low, high), side = u[bent].T, np.repeat(side[bent], 2)
        middle = 0.5 * (low + high)
        u = np.stack([low, middle, middle, high], axis=1).reshape(-1, 2)
    return SideParts(*(np.concatenate(x) for x in zip(*done, strict=True)))


def _found(
    sides: Sides,
    parts: SideParts,
    points: Floats,
    tolerance: float,
    reach: float,
    nearest: Callable[[Sides, Index, Floats, Floats], Floats],
) -> tuple[Index, Floats, Index]:
    """What of curved parts is near to points: the side, the parameter and the point, (k,)."""
    import shapely

    a, b = (sides.point(parts.side, parts.u[:, i]) for i in (0, 1))
    lines = shapely.linestrings(np.stack([a, b], axis=1))
    tree = shapely.STRtree(shapely.points(points))
    part, point = tree.query(lines, "dwithin", distance=reach * shapely.length(lines) + tolerance)
    side = parts.side[part]
    u = nearest(sides, side, parts.u[part], points[point])
    ends = sides.lengths[side]
    for end in (np.zeros(len(u)), ends):
        u = np.where(np.abs(u - end) < AN_END, end, u)
    off = sides.point(side, u) - points[point]
    rounding = ROUNDING * np.maximum(1, u) * np.hypot(*sides.derivative(side, u).T)
    on = np.hypot(*off.T) <= tolerance + rounding
    return side[on], u[on], point[on]


def _nearest(sides: Sides, side: Index, u: Floats, points: Floats) -> Floats:
    """The parameters of sides (k,), about in these ranges (k, 2), nearest to points (k, 2)."""
    a, b = (sides.point(side, u[:, i]) for i in (0, 1))
    along = ((points - a) * (b - a)).sum(axis=1) / ((b - a) ** 2).sum(axis=1)
    length = u[:, 1] - u[:, 0]
    low = np.maximum(u[:, 0] - length, 0)
    high = np.minimum(u[:, 1] + length, sides.lengths[side])
    out = np.clip(u[:, 0] + along * length, low, high)
    for _ in range(NEWTON_STEPS):
        d = sides.derivative(side, out)
        step = ((points - sides.point(side, out)) * d).sum(axis=1) / (d**2).sum(axis=1)
        out, before = np.clip(out + step, low, high), out
        if (np.abs(out - before) <= LAST_STEP).all():
            break
    return out


def _nearest_bracketed(sides: Sides, side: Index, u: Floats, points: Floats) -> Floats:
    """The same for ranges in which sides turn by little.

    There (p(u) - x) . p'(u) grows with u for a point x on the side, so that Newton's steps and
    halving, where a step would leave what is known to hold the zero, find it.
    """
    low, high = u[:, 0].copy(), u[:, 1].copy()
    out = 0.5 * (low + high)
    left = np.arange(len(out))
    for _ in range(HALVINGS):
        at = out[left]
        d = sides.derivative(side[left], at)
        g = ((sides.point(side[left], at) - points[left]) * d).sum(axis=1)
        low[left] = np.where(g <= 0, at, low[left])
        high[left] = np.where(g >= 0, at, high[left])
        squared = (d**2).sum(axis=1)
        step = at - np.divide(g, squared, out=np.zeros_like(g), where=squared > 0)
        inside = (low[left] <= step) & (step <= high[left])
        out[left] = np.where(inside, step, 0.5 * (low[left] + high[left]))
        left = left[np.abs(out[left] - at) > ROUNDING * np.maximum(1, at)]
        if not len(left):
            break
    return out
