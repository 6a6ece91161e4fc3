"""The polygon inscribed in the curves of a domain, that its other parts work with."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from adaptmesh import ragged
from adaptmesh.checks import read_only
from adaptmesh.curves import Curve
from adaptmesh.geometry.products import cross
from adaptmesh.types import Bools, Floats, Index, Ints
from adaptmesh.value import Value

from .joining import name_of_curve
from .paths import Path, points_on
from .side import Sides, in_canonical_direction

MESH_TURN = 60.0
"""Largest turn of a curve along one edge of a mesh, in degrees; a sharper joint is a corner."""

OUTLINE_LOOKS = 4
"""In so many steps a curve is looked at along each chord of an outline."""

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
            path, u = np.repeat(path, parts), ragged.equal_parts(u, parts)


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
        np.concatenate([ends, ends_of_paths(curved.paths)]),
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


def ends_of_paths(paths: Sequence[Path]) -> Ints:
    """The corners at the ends of paths, (p, 2)."""
    return np.array([path.ends for path in paths], np.int32).reshape(-1, 2)
