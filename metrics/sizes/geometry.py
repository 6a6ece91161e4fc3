"""Points, curves and polygons to measure distances from."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import ArrayLike

import metrics._core as _core
from metrics.checks import as_points
from metrics.errors import MetricError
from metrics.types import Bools, Floats, Ints

from .cubics import Cubics
from .geometry_input import Part, Pieces, parts_of

__all__ = ["Geometry", "Nearest", "as_geometry"]

# A distance below this, relative to the coordinates, is nothing but rounding.
_ROUNDING = 32 * np.finfo(np.float64).eps
_LARGEST = 1e150


class Nearest(NamedTuple):
    """For n points, what of a `Geometry` is nearest to each.

    Attributes
    ----------
    distances : (n,) array of float
        Not negative, on whichever side.
    points : (n, 2) array of float
        The nearest points, exact to rounding.
    segments : (n,) array of int32
        Rows of `Geometry.segments` that they are on; of segments equally near, any.
    shares : (n,) array of float
        How far along the segment, from 0 to 1; of a piece of a curve, its parameter.
    directions : (n, 2) array of float
        Unit vectors from the nearest points: across the segment, or, at a corner or an end, from
        there. Where the distance is 0, the left normal of the segment; at a corner, of the mean of
        the directions of the segments that meet; (0, 0) at a point that is alone.
    """

    distances: Floats
    points: Floats
    segments: Ints
    shares: Floats
    directions: Floats


class Geometry:
    """Points, curves and polygons, with exact distances to them.

    Parameters
    ----------
    geometry : array_like, shapely geometry, or sequence of these
        A point (2,), a polyline (n, 2), or polylines (k, n, 2), of which segments are (k, 2, 2);
        GeoJSON as a dict, anything with a ``__geo_interface__``; anything with `points` (n, 2) and
        `segments` (k, 2); or a list of these. z is ignored. An `adaptmesh.Domain`, or some of its
        sides by name, ``domain.sides("wall")``, brings its curves: what is nearest is on the
        curves themselves, to 1e-10 of the extent; only where two places are equally near, to 1e-6
        of it, the farther of them may be taken. Other curves are given as polylines.

    Attributes
    ----------
    segments : (k, 2, 2) array of float
        Both ends of each; the same where a point is alone. A vertex that repeats the one before it
        makes no segment, and a polyline that ends where it began, to rounding, is closed. Chords,
        where they are short pieces of curves.
    is_polygonal : bool
        Whether it is made of polygons only, so that there is an inside.

    Raises
    ------
    MetricError
        For anything else, for an empty geometry, or for coordinates that are not finite.

    Examples
    --------
    >>> from metrics import Geometry
    >>> Geometry([(0, 0), (4, 0)]).nearest([[1.0, 2.0]]).distances
    array([2.])
    """

    def __init__(self, geometry: Any) -> None:
        self._build(list(parts_of(geometry)))

    @classmethod
    def of_points(cls, points: ArrayLike) -> Geometry:
        """Points (n, 2), each by itself and not joined."""
        return cls(as_points(points)[:, None])

    @classmethod
    def polygon(cls, outer: ArrayLike, holes: Sequence[ArrayLike] = ()) -> Geometry:
        """The area in a ring (n, 2), closed or not, without that in the rings of its holes."""
        rings = [as_points(ring) for ring in (outer, *holes)]
        for k, ring in enumerate(rings):
            if len(np.unique(ring, axis=0)) < 3:
                raise MetricError(f"ring {k} of the polygon has less than 3 different points")
        self = cls.__new__(cls)
        self._build([Part(ring, True) for ring in rings])
        return self

    def _build(self, parts: list[Part | Pieces]) -> None:
        pieces = [_pieces_of(part) for part in parts if len(part[0])]
        if not pieces:
            raise MetricError("the geometry is empty: there is nothing to measure distances from")
        self.is_polygonal = all(isinstance(part, Part) and part.is_ring for part in parts)
        self.segments = np.ascontiguousarray(np.concatenate([p.ends for p in pieces]))
        self.segments.flags.writeable = False
        largest = float(np.abs(self.segments).max())
        if largest > _LARGEST:
            raise MetricError(f"a coordinate of {largest:.3g} is too large: its square overflows")
        self._search = _core.Segments(self.segments.reshape(-1, 4))
        if self.is_polygonal:
            left = [np.full(len(p.ends), p.ends[..., 0].min()) for p in pieces]
            self._prepare_rings(np.concatenate(left))
        self._rounding = _ROUNDING * largest
        chords = np.repeat(np.diff(self.segments, axis=1), 2, axis=1)
        self._derivatives: Floats | None = None
        self._cubics: Cubics | None = None
        if any(p.derivatives is not None for p in pieces):
            first = np.cumsum([0, *(len(p.ends) for p in pieces)])
            for piece, i, j in zip(pieces, first[:-1].tolist(), first[1:].tolist(), strict=True):
                if piece.derivatives is not None:
                    chords[i:j] = piece.derivatives
            cubics = Cubics(self.segments, chords)
            if cubics.is_curved.any():
                self._derivatives, self._cubics = chords, cubics
        tangents = _units(chords.reshape(-1, 2)).reshape(-1, 2, 2)
        self._tangents = tangents[:, 0]
        self._end_tangents = _end_tangents(tangents, self.vertices()[1])

    def _prepare_rings(self, left: Floats) -> None:
        """Make ready for `contains`, from the lowest x of the ring of each segment."""
        self._left = left
        self._search.prepare_rings(left)

    def __getstate__(self) -> dict[str, Any]:
        return {
            "segments": self.segments,
            "left": self._left if self.is_polygonal else None,
            "derivatives": self._derivatives,
        }

    def __setstate__(self, state: dict[str, Any]) -> None:
        self._build([Pieces(state["segments"], state["derivatives"])])
        self.is_polygonal = state["left"] is not None
        if self.is_polygonal:
            self._prepare_rings(state["left"])

    def nearest(self, points: ArrayLike) -> Nearest:
        """What is nearest to points (n, 2)."""
        where = as_points(points)
        segments, shares, feet, tangents = self.feet(where)
        offsets = where - feet
        distances = np.hypot(offsets[:, 0], offsets[:, 1])
        directions = self._directions(offsets, distances, segments, shares, tangents)
        return Nearest(distances, feet, segments, shares, directions)

    def distances(self, points: ArrayLike) -> Floats:
        """Distances of points (n, 2), (n,), not negative."""
        where = as_points(points)
        offsets = where - self.feet(where)[2]
        return np.hypot(offsets[:, 0], offsets[:, 1])

    def feet(self, points: Floats) -> tuple[Ints, Floats, Floats, Floats]:
        """Segments (n,), shares (n,), the nearest points (n, 2), and unit tangents there (n, 2)."""
        segments, shares, feet = self._search.nearest(points)
        if self._cubics is None:
            return segments, shares, feet, self._tangents[segments]
        return self._cubics.project(points, segments, shares)

    def contains(self, points: ArrayLike) -> Bools:
        """Whether points (n, 2) are inside, (n,); what is in an even number of rings is outside.

        Raises
        ------
        MetricError
            If there is no inside, because it is not made of polygons.
        """
        if not self.is_polygonal:
            raise MetricError(
                "points and lines have no inside: give a shapely polygon, or "
                "metrics.Geometry.polygon(outer, holes)"
            )
        return self._search.encloses(as_points(points))

    def signed_distance(self, points: ArrayLike) -> Floats:
        """Distances of points (n, 2) to the boundary of polygons, (n,), negative inside."""
        where = as_points(points)
        distances = self.distances(where)
        return np.where(self.contains(where), -distances, distances)

    def _directions(
        self,
        offsets: Floats,
        distances: Floats,
        segments: Ints,
        shares: Floats,
        tangents: Floats,
    ) -> Floats:
        """Unit vectors from the nearest points, never made of rounding errors.

        Beside a segment they are across it, exactly, however near; past its end they point away
        from that, and are the left normals of the mean tangents where the distance is 0.
        """
        at_end = (shares == 0) | (shares == 1)
        ends = self._end_tangents[segments, (shares == 1).astype(int)]
        along = np.where(at_end[:, None], ends, tangents)
        left = np.stack([-along[:, 1], along[:, 0]], axis=1)
        out = np.where((offsets * left).sum(axis=1, keepdims=True) < 0, -left, left)
        beyond = at_end & (distances > self._rounding)
        out[beyond] = offsets[beyond] / distances[beyond, None]
        return out

    def vertices(self) -> tuple[Floats, Ints]:
        """The different ends of segments, (v, 2), and which of them each segment joins, (k, 2)."""
        ends, numbers = np.unique(self.segments.reshape(-1, 2), axis=0, return_inverse=True)
        return ends, numbers.reshape(-1, 2).astype(np.int32)

    def __repr__(self) -> str:
        return f"<Geometry: {len(self.segments)} segments>"


def as_geometry(geometry: Any) -> Geometry:
    """What a user means by a geometry."""
    return geometry if isinstance(geometry, Geometry) else Geometry(geometry)


def as_curves(geometry: Any, what: str) -> Geometry:
    """A geometry without lone points, which have no direction; `what` names it in errors."""
    curves = as_geometry(geometry)
    alone = (curves.segments[:, 0] == curves.segments[:, 1]).all(axis=1)
    if alone.any():
        x, y = curves.segments[alone.argmax(), 0].tolist()
        raise MetricError(
            f"{what} is made of curves, but the point ({x!r}, {y!r}) is alone: give at least two "
            "different points, in a row"
        )
    return curves


def _segments_of(part: Part) -> Floats:
    p = part.points
    if len(p) > 3 and np.abs(p[-1] - p[0]).max() <= _ROUNDING * np.abs(p).max():
        p = np.concatenate([p[:-1], p[:1]])  # as sin(2 pi) is not 0, but meant to be
    elif part.is_ring:
        p = np.concatenate([p, p[:1]])
    segments = np.stack([p[:-1], p[1:]], axis=1)
    kept = segments[(segments[:, 0] != segments[:, 1]).any(axis=1)]
    return kept if len(kept) else np.stack([p[:1], p[:1]], axis=1)


def _pieces_of(part: Part | Pieces) -> Pieces:
    return part if isinstance(part, Pieces) else Pieces(_segments_of(part))


def _units(vectors: Floats) -> Floats:
    """Unit vectors along vectors (k, 2); (0, 0) for those without a length."""
    lengths = np.hypot(vectors[:, 0], vectors[:, 1])[:, None]
    return np.divide(vectors, lengths, out=np.zeros_like(vectors), where=lengths > 0)


def _end_tangents(tangents: Floats, ends: Ints) -> Floats:
    """Unit vectors along the curve at both ends of each segment, (k, 2, 2), from its own there.

    The mean direction of all segments that meet there, whichever way they run: the principal axis
    of the sum of t t'. A direction without orientation is a point of the circle at twice its angle,
    z = (tx + i ty)^2, and there the mean is a sum. Where there is no mean, as at a right angle, the
    segment's own.
    """
    doubled = ((tangents[..., 0] + 1j * tangents[..., 1]) ** 2).ravel()
    sums = np.bincount(ends.ravel(), doubled.real) + 1j * np.bincount(ends.ravel(), doubled.imag)
    mean = sums[ends]
    clear = np.abs(mean) > 1e-6
    unit = np.sqrt(np.where(clear, mean / np.where(clear, np.abs(mean), 1), 1))
    return np.where(clear[..., None], np.stack([unit.real, unit.imag], axis=2), tangents)
