"""A polygon or several as they come, before they are checked."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from adaptmesh.checks import is_level
from adaptmesh.domain.inputs import OR_REPAIR
from adaptmesh.errors import DomainError, FormatError
from adaptmesh.types import Floats


@dataclass(frozen=True, eq=False)
class Shape:
    """A polygon or several, as given: nothing is checked.

    Attributes
    ----------
    label : str
        How messages call it.
    name : str or None
        Of its region.
    parts : sequence of sequence of (n, 2) array
        The rings of each part: its shell, then its holes; closed or not, in any direction.
    closed : bool
        Whether rings have to end where they start, as in GeoJSON.
    nested : bool
        Whether a ring inside a hole is meant as an island; else it is a mistake that is read so.
    heights : (float, float) or None
        The least and the greatest third coordinate, if points lie at different heights.
    others : tuple of str
        The kinds of geometries, other than polygons, that it has besides.
    """

    label: str
    name: str | None
    parts: Sequence[Sequence[Floats]]
    closed: bool = False
    nested: bool = False
    heights: tuple[float, float] | None = None
    others: tuple[str, ...] = ()

    @property
    def is_empty(self) -> bool:
        """Whether it has no point."""
        return not any(len(ring) for part in self.parts for ring in part)

    def refuse_what_is_left_out(self) -> None:
        """Raise a `DomainError` if it is empty, holds something else, or is not plane."""
        if self.is_empty:
            raise DomainError(f"{self.label} is empty: there is nothing to mesh")
        if self.others:
            raise DomainError(
                f"{self.label} also holds a {', a '.join(self.others)}: leave it out, {OR_REPAIR}"
            )
        if self.heights is not None:
            low, high = self.heights
            raise DomainError(
                f"points of {self.label} lie at heights from {low:g} to {high:g}, and a domain is "
                f"plane: leave the heights out (shapely.force_2d, [:, :2]), {OR_REPAIR}"
            )

    @classmethod
    def of_shapely(cls, polygon: Any, number: int = 0, name: str | None = None) -> Shape:
        """The rings of a polygon or multipolygon of shapely, or of those in a collection."""
        import shapely

        label = label_of(number, name)
        polygons, others = [], []
        for part in _leaves(polygon, label):
            if part.is_empty:
                continue
            if part.geom_type == "Polygon":
                polygons.append(part)
            else:
                others.append(part.geom_type)
        if others and not polygons:
            raise DomainError(not_a_polygon(label, polygon.geom_type))
        parts = [
            [shapely.get_coordinates(ring) for ring in shapely.get_rings(part)] for part in polygons
        ]
        shape = cls(label, name, parts, others=tuple(others))
        return shape.with_heights(shapely.get_coordinates(polygons, include_z=True)[:, 2])

    @classmethod
    def of_rings(
        cls,
        outer: ArrayLike,
        holes: Sequence[ArrayLike] = (),
        number: int = 0,
        name: str | None = None,
    ) -> Shape:
        """A ring, and rings of holes in it, or of islands in these, as in `Domain.polygon`."""
        label = label_of(number, name)
        rings = [_ring(ring, label) for ring in (outer, *holes)]
        heights = [_heights(ring) for ring in (outer, *holes)]
        return cls(label, name, [rings], nested=True).with_heights(np.concatenate(heights))

    @classmethod
    def of_geojson(cls, geometry: Any, number: int = 0, name: str | None = None) -> Shape:
        """The rings of a GeoJSON geometry; None is one without any."""
        label = label_of(number, name)
        if geometry is None:
            return cls(label, name, [])
        parts: list[Sequence[Any]] = []
        others = []
        for part in _geometries(geometry, label):
            kind = part.get("type")
            if kind in ("Polygon", "MultiPolygon"):
                coordinates: Any = part.get("coordinates")
                if not _is_sequence(coordinates):
                    raise FormatError(
                        f"{label} cannot be read: its coordinates are {coordinates!r}"
                    )
                parts += [coordinates] if kind == "Polygon" else coordinates
            elif part.get("coordinates") != [] or kind not in GEOJSON_KINDS:
                others.append(str(kind))
        kind = geometry.get("type")
        if (others and not parts) or kind in GEOJSON_KINDS:
            raise DomainError(not_a_polygon(label, None if kind is None else str(kind)))
        for item in parts:
            if not _is_sequence(item):
                raise FormatError(f"{label} cannot be read: the rings of a part are {item!r}")
        read = [[_ring(ring, label) for ring in part] for part in parts]
        read = [part for part in read if any(len(ring) for ring in part)]
        shape = cls(label, name, read, closed=True, others=tuple(others))
        points: Any = (point for part in parts for ring in part for point in ring)
        try:
            return shape.with_heights([point[2] for point in points if len(point) > 2])
        except (TypeError, ValueError, OverflowError) as error:
            raise FormatError(f"{label} cannot be read: a height in it is {error}") from None

    def with_heights(self, z: ArrayLike) -> Shape:
        """The same shape, whose points lie at these heights; not finite: at none."""
        heights = np.asarray(z, dtype=np.float64)
        heights = heights[np.isfinite(heights)]
        xy = [ring for part in self.parts for ring in part if len(ring)]
        if not len(heights) or not xy or is_level(heights, np.concatenate(xy)):
            return self
        return replace(self, heights=(float(heights.min()), float(heights.max())))


GEOJSON_KINDS = ("Point", "MultiPoint", "LineString", "MultiLineString")
"""Geometries that bound no area; an empty one is nothing at all."""


def _leaves(geometry: Any, label: str) -> list[Any]:
    """The geometries in a geometry of shapely that are no collections."""
    out, open_ = [], [geometry]
    while open_:
        item = open_.pop()
        parts = getattr(item, "geoms", None)
        if parts is not None:
            open_ += list(parts)[::-1]
        elif hasattr(item, "geom_type"):
            out.append(item)
        else:
            raise DomainError(not_a_polygon(label, type(item).__name__))
    return out


def _geometries(geometry: Any, label: str) -> list[Mapping[str, Any]]:
    """The geometries of GeoJSON in one that may be a collection, or a collection of these."""
    out: list[Mapping[str, Any]] = []
    open_ = [geometry]
    while open_:
        item = open_.pop()
        if not isinstance(item, Mapping):
            raise DomainError(not_a_polygon(label, None))
        if item.get("type") != "GeometryCollection":
            out.append(item)
            continue
        members: Any = item.get("geometries")
        if not _is_sequence(members):
            raise FormatError(f"{label} cannot be read: its geometries are {members!r}")
        open_ += [member for member in members[::-1] if member is not None]
    return out


def _is_sequence(item: object) -> bool:
    return isinstance(item, Sequence) and not isinstance(item, str)


def label_of(number: int, name: str | None) -> str:
    """How messages call a polygon."""
    return f"polygon {number}" if name is None else f"polygon {number} ({name!r})"


def not_a_polygon(label: str, kind: str | None) -> str:
    """What to do with a feature that bounds no area."""
    return (
        f"{label} is {'nothing' if kind is None else f'a {kind}'}, and a domain is made of Polygon "
        "and MultiPolygon: remove that feature, or make a polygon of it (shapely.polygonize for "
        "closed lines, shapely.buffer for points and open ones)"
    )


def _ring(points: Any, label: str) -> Floats:
    """The first two coordinates of the points of a ring."""
    if isinstance(points, np.ndarray) and points.dtype.kind == "c":
        raise FormatError(f"{label} cannot be read: its coordinates are complex")
    try:
        out = np.asarray(points, dtype=np.float64)
    except (TypeError, ValueError, OverflowError):
        try:  # some of the points may have a height
            out = np.array([point[:2] for point in points], dtype=np.float64)
        except (TypeError, ValueError, IndexError, OverflowError) as error:
            raise FormatError(f"{label} cannot be read: {error}") from None
    if out.size == 0:
        return np.empty((0, 2))
    if out.ndim != 2 or out.shape[1] < 2:
        raise FormatError(f"{label} cannot be read: a ring has the shape {out.shape}, not (n, 2)")
    return np.ascontiguousarray(out[:, :2])


def _heights(points: Any) -> Floats:
    """The third coordinates of the points of a ring that is an array, where it has any."""
    try:
        out = np.asarray(points, dtype=np.float64)
    except (TypeError, ValueError, OverflowError):
        return np.array([point[2] for point in points if len(point) > 2], dtype=np.float64)
    return out[:, 2:3].ravel() if out.ndim == 2 else np.empty(0)
