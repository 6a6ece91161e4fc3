"""Curves joined, and a polygon inscribed in them: what a domain of curves is made of."""

from __future__ import annotations

import itertools
from collections.abc import Sequence
from typing import NamedTuple

import numpy as np

from adaptmesh._core import orient2d
from adaptmesh.checks import LARGEST, checked_points, read_only
from adaptmesh.curves import Curve
from adaptmesh.domain.inputs import Inside
from adaptmesh.errors import DomainError
from adaptmesh.types import Floats, Index, Ints

from .inscribed_polygon import MESH_TURN, InscribedPolygon, ends_of_paths
from .joining import are_near, join, length_of, name_of_curve
from .polyline import polylines_along
from .side import SidePoints, Sides

JOINED = 1e-12
JOINED_PLACES = 8
"""Ends of curves that are nearer than this share of the extent, or than so many units in the last
place of coordinates, are one, if nothing else is said."""

FIRST_CHORDS = 8
"""Chords along each curve before they are looked at."""

TURN = 15.0
"""Curves turn by at most so many degrees along a chord of the inscribed polygon."""

IN_PLACES = 1e4
"""A curve is larger than this many units in the last place of its coordinates."""

STEPS, STRAIGHT_STEPS = np.linspace(0, 1, 9), np.array([0.0, 1.0])
"""Where a curve is looked at to see how large it is, besides its kinks; and a straight one."""


class Skeleton(NamedTuple):
    """The polygon inscribed in curves, as a domain takes it."""

    points: Floats
    segments: Ints
    segment_tags: Ints
    curved: InscribedPolygon


def skeleton_of(
    curves: Sequence[Curve],
    tags: Ints,
    inside: Inside,
    isolated: Floats,
    corner_angle: float,
    join_tolerance: float | None,
) -> Skeleton:
    """Join curves and inscribe a polygon; arguments as those of `Domain.from_curves`."""
    join_tolerance = _checked_tolerance(curves, join_tolerance)
    if not 0 <= corner_angle <= 180:
        raise DomainError(f"corner_angle={corner_angle}: expected degrees from 0 to 180")
    joined = join(curves, tags, min(corner_angle, MESH_TURN), join_tolerance, isolated)
    isolated = isolated[~are_near(isolated, joined.corners, join_tolerance)]
    vertices = np.concatenate([joined.corners, isolated])
    lines, line_curves = _divided(vertices, joined.lines, joined.line_curves)
    sides = Sides(
        vertices,
        np.concatenate([lines, ends_of_paths(joined.paths)]),
        joined.paths,
        np.concatenate([inside.holes, inside.seeds]),
        tuple(curves),
        line_curves,
    )
    points, path, u, segments = _inscribed(sides)
    on_paths = zip(path.tolist(), u.mean(axis=1).tolist(), strict=True)
    curved = [joined.paths[p].curve_at(middle) for p, middle in on_paths]
    owners = np.concatenate([line_curves, curved]).astype(np.int32)
    n = len(lines)
    inscribed = InscribedPolygon(
        tuple(curves),
        joined.paths,
        read_only(owners),
        read_only(np.concatenate([np.full(n, -1), path]).astype(np.int32)),
        read_only(np.concatenate([np.zeros((n, 2)), u])),
        read_only(np.arange(len(points)) < len(vertices)),
        corner_angle,
        join_tolerance,
    )
    return Skeleton(points, read_only(segments), read_only(tags[owners]), inscribed)


def _checked_tolerance(curves: Sequence[Curve], join_tolerance: float | None) -> float:
    """How near ends of curves are one place; refuses curves and tolerances that make no domain."""
    some_points = _check_curves(curves)
    places = np.concatenate(some_points)
    extent = float(np.ptp(places, axis=0).max())
    if join_tolerance is None:
        last_place = float(np.spacing(np.abs(places).max()))
        join_tolerance = max(JOINED * extent, JOINED_PLACES * last_place)
    if not 0 <= join_tolerance < extent:
        raise DomainError(
            f"join_tolerance={join_tolerance}: expected a length from 0 to the extent, {extent:g}"
        )
    _check_extents(curves, some_points, join_tolerance)
    return join_tolerance


def _inscribed(sides: Sides) -> tuple[Floats, Index, Floats, Ints]:
    """Points, chords by their paths and parameters, and segments: straight sides, then chords."""
    n = sides.n_straight
    lines = sides.ends[:n].astype(np.int32)
    if not sides.paths:
        return sides.corners, np.empty(0, np.intp), np.empty((0, 2)), lines
    polygon = polylines_along(sides, _first_points(sides), TURN)
    segments = np.concatenate([lines, polygon.ends[n:]]).astype(np.int32)
    return polygon.points, polygon.side[n:] - n, polygon.u[n:], segments


def _first_points(sides: Sides) -> SidePoints:
    """Points on paths that are looked at first, `FIRST_CHORDS` on each curve."""
    each = [np.linspace(0, p.length, FIRST_CHORDS * len(p.parts) + 1)[1:-1] for p in sides.paths]
    side = np.repeat(np.arange(sides.n_straight, len(sides)), [len(u) for u in each])
    return SidePoints(side, np.concatenate(each))


def _check_curves(curves: Sequence[Curve]) -> list[Floats]:
    """Refuse what are no curves, or none of finite numbers; returns a few points of each."""
    if not curves:
        raise DomainError("no curves: give those that bound the domain, from adaptmesh.curves")
    for i, curve in enumerate(curves):
        if not isinstance(curve, Curve):
            raise DomainError(
                f"curve {i} is a {type(curve).__name__}: make it one of adaptmesh.curves"
            )
    each = [_some_points(curve) for curve in curves]
    if not (np.abs(np.concatenate(each)) <= LARGEST).all():
        for i, places in enumerate(each):
            checked_points(places, f"curve {i}: point", least=0)
    return each


def _check_extents(
    curves: Sequence[Curve], some_points: list[Floats], join_tolerance: float
) -> None:
    """Refuse curves that rounding has eaten, but for those within the tolerance: they vanish."""
    first = np.cumsum([0, *map(len, some_points[:-1])])
    places = np.concatenate(some_points)
    extent = np.maximum.reduceat(places, first) - np.minimum.reduceat(places, first)
    extent, far = extent.max(axis=1), np.maximum.reduceat(np.abs(places).max(axis=1), first)
    for i in np.flatnonzero(extent <= IN_PLACES * np.finfo(float).eps * far).tolist():
        if curves[i].is_closed or length_of(curves[i]) > join_tolerance:
            raise DomainError(
                f"{name_of_curve(curves, i)} is {extent[i]:.3g} long or wide, and coordinates of "
                f"{far[i]:g} are rounded to {np.spacing(far[i]):.1g}: move the origin near it"
            )


def _divided(points: Floats, lines: Ints, owners: Ints) -> tuple[Ints, Ints]:
    """Straight lines (k, 2) divided where points lie exactly on them, and the owner of each."""
    import shapely

    tree = shapely.STRtree(shapely.points(points))
    line, point = tree.query(shapely.linestrings(points[lines]))
    a, b = lines[line].T
    on = (orient2d(points[a], points[b], points[point]) == 0) & (point != a) & (point != b)
    line, point = line[on], point[on]
    along = ((points[point] - points[lines[line, 0]]) ** 2).sum(axis=1)
    order = np.lexsort([along, line])
    stops = np.searchsorted(line[order], np.arange(len(lines) + 1))
    between = [point[order[i:j]] for i, j in itertools.pairwise(stops)]
    out = [
        pair
        for (a, b), passed in zip(lines.tolist(), between, strict=True)
        for pair in itertools.pairwise([a, *passed.tolist(), b])
    ]
    out_owners = np.repeat(owners, np.diff(stops) + 1)
    return np.array(out, np.int32).reshape(-1, 2), out_owners.astype(np.int32)


def extent_of(curves: Sequence[Curve]) -> float:
    """The longer side of the box around curves, from a few places on each."""
    points = np.concatenate([_some_points(curve) for curve in curves])
    return float(np.ptp(points, axis=0).max())


def _some_points(curve: Curve) -> Floats:
    """Points on a curve, its ends and kinks among them; no others of one that is straight."""
    inner = STRAIGHT_STEPS if curve.is_straight else STEPS
    return curve.point(np.append(inner, curve.breaks))
