"""The curves of a domain, and the polygon inscribed in them that its other parts work with."""

from __future__ import annotations

import itertools
from collections.abc import Sequence
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np

from adaptmesh._core import orient2d
from adaptmesh.checks import LARGEST, checked_points, read_only
from adaptmesh.curves import Curve
from adaptmesh.errors import DomainError
from adaptmesh.geometry.products import cross
from adaptmesh.types import Bools, Floats, Index, Ints
from adaptmesh.value import Value

from .inputs import Inside
from .joining import are_near, join, length_of, name_of_curve
from .paths import Path, points_on
from .polyline import polylines_along
from .side import SidePoints, Sides, in_canonical_direction

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

MESH_TURN = 60.0
"""And by at most so many along an edge of a mesh: where they turn by more at once is a corner."""

OUTLINE_LOOKS = 4
"""In so many steps a curve is looked at along each chord of an outline."""

LOOKS, STRAIGHT_LOOKS = np.linspace(0, 1, 9), np.array([0.0, 1.0])
"""Where a curve is looked at to see how large it is, besides its kinks; and a straight one."""

GAUSS = np.polynomial.legendre.leggauss(10)


@dataclass(frozen=True, eq=False)
class InscribedPolygon(Value):
    """Which points and segments of a domain are on curves, of which they are an inscribed polygon.

    Attributes
    ----------
    curves : tuple of Curve
        As they were given; none for a domain of points and segments.
    paths : tuple of Path
        What is curved, from corner to corner.
    segment_curves : (k,) array of int32
        The curve that each segment of the domain lies on or is a chord of; -1 for none.
    segment_paths : (k,) array of int32
        The path that it is a chord of; -1 if it is straight itself.
    segment_parameters : (k, 2) array
        The parameters of its ends on the path.
    is_vertex : (n,) array of bool
        Whether a point of the domain is a vertex of every mesh; the others only hold the chords.
    corner_angle, join_tolerance : float
        With which the curves were joined.
    """

    curves: tuple[Curve, ...]
    paths: tuple[Path, ...]
    segment_curves: Ints
    segment_paths: Ints
    segment_parameters: Floats
    is_vertex: Bools
    corner_angle: float = 0.0
    join_tolerance: float = 0.0

    @classmethod
    def nothing(cls, n_points: int, n_segments: int) -> InscribedPolygon:
        """Of a domain of points and segments."""
        none = read_only(np.full(n_segments, -1, np.int32))
        parameters = read_only(np.zeros((n_segments, 2)))
        return cls((), (), none, none, parameters, read_only(np.ones(n_points, bool)))

    def describe(self, segment: int) -> str:
        """The curve of a segment in words."""
        return name_of_curve(self.curves, int(self.segment_curves[segment]))

    def areas_beside(self, path: Index, u: Floats) -> Floats:
        """Areas between chords, given by path (k,) and parameters (k, 2), and their curves.

        Chords of a path may not overlap. Positive where the curve bends to the right of its chord.
        """
        out = np.zeros(len(path))
        order = np.lexsort((u[:, 0], path))
        first = np.flatnonzero(np.diff(path[order], prepend=-1))
        for mine in np.split(order, first)[1:]:
            out[mine] = _areas_beside(self.paths[path[mine[0]]], u[mine])
        return out

    def chords_within(self, tolerance: float) -> tuple[Index, Floats]:
        """Chords, path (k,) and parameters (k, 2), that are this near to their curves."""
        chosen = self.segment_paths >= 0
        path: Index = self.segment_paths[chosen]
        u = self.segment_parameters[chosen]
        t = np.linspace(0, 1, OUTLINE_LOOKS + 1)
        while True:
            at = u[:, :1] + t * (u[:, 1:] - u[:, :1])
            p = points_on(self.paths, np.repeat(path, len(t)), at.ravel()).reshape(-1, len(t), 2)
            d = p[:, -1] - p[:, 0]
            off = p - p[:, :1]
            height = np.abs(off[..., 0] * d[:, None, 1] - off[..., 1] * d[:, None, 0]).max(axis=1)
            parts = np.ceil(np.sqrt(height / np.hypot(*d.T) / tolerance)).clip(1).astype(np.intp)
            if (parts == 1).all():
                return path, u
            first = np.repeat(np.cumsum(parts) - parts, parts)
            k = np.arange(parts.sum()) - first
            start = np.repeat(u[:, 0], parts) + k * np.repeat((u[:, 1] - u[:, 0]) / parts, parts)
            end = np.where(
                k == np.repeat(parts, parts) - 1, np.repeat(u[:, 1], parts), np.roll(start, -1)
            )
            path, u = np.repeat(path, parts), np.stack([start, end], axis=1)


def sides_between(
    points: Floats,
    pieces: Ints,
    piece_segments: Ints,
    tags: Ints,
    curved: InscribedPolygon,
    loose: Floats,
) -> Sides:
    """The sides of a domain.

    Parameters
    ----------
    points, pieces, piece_segments : arrays
        See `Domain`.
    tags : (k,) array of int32
        Of its segments.
    curved : InscribedPolygon
    loose : (m, 2) array
        Seeds of holes and regions.
    """
    on_path, segments = curved.segment_paths >= 0, piece_segments
    straight = segments[~on_path[segments]]
    number = (np.cumsum(curved.is_vertex) - 1).astype(np.int32)
    order = np.flatnonzero(on_path)[
        np.lexsort((curved.segment_parameters[on_path, 0], curved.segment_paths[on_path]))
    ]
    each = np.split(order, np.flatnonzero(np.diff(curved.segment_paths[order])) + 1)
    inscribed = [
        np.append(curved.segment_parameters[mine, 0], curved.segment_parameters[mine[-1], 1])
        for mine in each[: len(curved.paths)]
    ]
    first = np.array([mine.min() for mine in each[: len(curved.paths)]], np.int32)
    vertices = points[curved.is_vertex]
    ends = in_canonical_direction(vertices, number[pieces[~on_path[segments]]])
    segments = np.concatenate([straight, first]).astype(np.int32)
    return Sides(
        vertices,
        np.concatenate([ends, _ends_of(curved.paths)]),
        curved.paths,
        loose,
        curved.curves,
        curved.segment_curves[straight],
        tuple(inscribed),
        segments,
        tags[segments],
        np.zeros(len(segments), bool),
    )


def _areas_beside(line: Path, u: Floats) -> Floats:
    """Areas between chords (k, 2) of a path, in order, and the curve.

    By Gauss's quadrature of (p - p0) x dp / 2, p0 where the chord begins, on halves of what is
    between knots of the curve. Joining may have moved vertices off the ends of curves::

          vertex          the way from vertex to vertex, as seen from the first, jumps where it
            |             comes onto a curve, from one curve to the next, and off the last
            '-- curve
    """
    ends = np.unique(np.concatenate([u.ravel(), line.knots]))
    ends = np.sort(np.concatenate([ends, 0.5 * (ends[1:] + ends[:-1])]))
    middle = 0.5 * (ends[1:] + ends[:-1])
    chord = np.searchsorted(u[:, 0], middle) - 1
    inside = (chord >= 0) & (middle < u[chord, 1])
    chord, part = chord[inside], middle[inside].astype(np.intp)
    start, du = ends[:-1][inside], np.diff(ends)[inside]

    p0, p1 = line.point(u[:, 0]), line.point(u[:, 1])
    x, w = 0.5 * (GAUSS[0] + 1), 0.5 * GAUSS[1]
    at = (start[:, None] + x * du[:, None]).ravel()
    p = line.point(at) - np.repeat(p0[chord], len(x), axis=0)
    swept = cross(p, line.derivative(at)).reshape(-1, len(x)) @ w * du

    onto, off = (line.point_of_part(part, at) for at in (start, start + du))
    is_last = np.append(chord[1:] != chord[:-1], True)
    to = np.where(is_last[:, None], p1[chord], np.roll(onto, -1, axis=0))
    jumps = cross(off - p0[chord], to - p0[chord])
    return 0.5 * np.bincount(chord, swept + jumps, minlength=len(u)).astype(np.float64)


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
    if not 0 <= corner_angle <= 180:
        raise DomainError(f"corner_angle={corner_angle}: expected degrees from 0 to 180")
    joined = join(curves, tags, min(corner_angle, MESH_TURN), join_tolerance, isolated)
    isolated = isolated[~are_near(isolated, joined.corners, join_tolerance)]
    vertices = np.concatenate([joined.corners, isolated])
    lines, line_curves = _divided(vertices, joined.lines, joined.line_curves)
    sides = Sides(
        vertices,
        np.concatenate([lines, _ends_of(joined.paths)]),
        joined.paths,
        np.concatenate([inside.holes, inside.seeds]),
        tuple(curves),
        line_curves,
    )
    n = len(lines)
    path: Index = np.empty(0, np.intp)
    points, u = vertices, np.empty((0, 2))
    segments, owners = lines, line_curves
    if joined.paths:
        polygon = polylines_along(sides, _first_points(sides), TURN)
        points, path, u = polygon.points, polygon.side[n:] - n, polygon.u[n:]
        segments = np.concatenate([lines, polygon.ends[n:]])
        on_paths = zip(path.tolist(), u.mean(axis=1).tolist(), strict=True)
        curved = [joined.paths[p].curve_at(middle) for p, middle in on_paths]
        owners = np.concatenate([line_curves, curved])
    inscribed = InscribedPolygon(
        tuple(curves),
        joined.paths,
        read_only(owners.astype(np.int32)),
        read_only(np.concatenate([np.full(n, -1), path]).astype(np.int32)),
        read_only(np.concatenate([np.zeros((n, 2)), u])),
        read_only(np.arange(len(points)) < len(vertices)),
        corner_angle,
        join_tolerance,
    )
    return Skeleton(
        points, read_only(segments.astype(np.int32)), read_only(tags[owners]), inscribed
    )


def _ends_of(paths: Sequence[Path]) -> Ints:
    """The corners at the ends of paths, (p, 2)."""
    return np.array([path.ends for path in paths], np.int32).reshape(-1, 2)


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
    inner = STRAIGHT_LOOKS if curve.is_straight else LOOKS
    return curve.point(np.append(inner, curve.breaks))
