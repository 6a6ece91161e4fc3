"""Polygons of whatever stands for them: arrays, shapely, GeoJSON, `__geo_interface__`, mappings."""

from __future__ import annotations

import warnings
from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np

from adaptmesh.errors import DomainError, FormatError, FormatWarning

from .geojson_shapes import shapes_of_geojson
from .shape import Shape

COLLECTIONS = ("Feature", "FeatureCollection")


def shapes_of(given: Any) -> list[Shape]:
    """The polygons of whatever was handed in, unchecked; see `adaptmesh.repair`."""
    if given is None:
        raise DomainError("expected polygons, rings or a file to make a domain of, got None")
    if not hasattr(given, "geom_type") and hasattr(given, "__geo_interface__"):
        given = given.__geo_interface__
    if isinstance(given, Mapping):
        if isinstance(given.get("type"), str):
            return shapes_of_geojson(given)
        return [_shape(polygon, i, str(name)) for i, (name, polygon) in enumerate(given.items())]
    if _is_polygon(given) or _is_array(given):
        return [_shape(given, 0, None)]
    items = _items(given)
    if _is_array(items[0] if items else None):
        return [_shape(items, 0, None)]
    if all(isinstance(item, Shape) for item in items):
        return items
    if all(isinstance(item, Mapping) and item.get("type") == "Feature" for item in items):
        return shapes_of_geojson({"type": "FeatureCollection", "features": items})
    return [_shape(polygon, i, None) for i, polygon in enumerate(items)]


def is_collection(given: Any) -> bool:
    """Whether it is a feature of GeoJSON, or a collection of these, perhaps with names."""
    if hasattr(given, "__geo_interface__"):
        given = given.__geo_interface__
    return isinstance(given, Mapping) and given.get("type") in COLLECTIONS


def without_empty(shapes: list[Shape], source: str = "", *, stacklevel: int = 3) -> list[Shape]:
    """The shapes that are not empty: features may have no geometry, or an empty one.

    Those passed over are named in a warning, after where they come from. If all are empty, all are
    returned, to be refused.
    """
    kept = [shape for shape in shapes if not shape.is_empty]
    if not kept or len(kept) == len(shapes):
        return shapes
    left_out = [shape.label for shape in shapes if shape.is_empty]
    more = f" and {len(left_out) - 3} more" if len(left_out) > 3 else ""
    what = f"{source}{', '.join(left_out[:3])}{more}: without geometry, passed over"
    warnings.warn(what, FormatWarning, stacklevel=stacklevel)
    return kept


def shape_of_polygon(outer: Any, holes: Sequence[Any]) -> Shape:
    """The rings that `Domain.polygon` was given."""
    is_geometry = _is_polygon(outer) or isinstance(outer, Mapping)
    if is_geometry and len(holes):
        raise DomainError("give a shapely polygon with its own holes, or rings, not both")
    try:
        return _shape(outer, 0, None) if is_geometry else Shape.of_rings(outer, holes)
    except FormatError as error:
        raise DomainError(str(error)) from None


def _shape(polygon: Any, number: int, name: str | None) -> Shape:
    """One polygon of whatever was handed in."""
    if hasattr(polygon, "geom_type"):
        return Shape.of_shapely(polygon, number, name)
    if hasattr(polygon, "__geo_interface__"):
        polygon = polygon.__geo_interface__
    if isinstance(polygon, Mapping) and polygon.get("type") == "Feature":
        polygon = polygon.get("geometry")
    if polygon is None or isinstance(polygon, Mapping):
        return Shape.of_geojson(polygon, number, name)
    rings = [polygon] if _is_array(polygon) else _items(polygon)
    return Shape.of_rings(rings[0], rings[1:], number, name) if rings else Shape.of_rings([])


def _items(given: Any) -> list[Any]:
    try:
        return list(given)
    except TypeError:
        raise DomainError(
            f"expected polygons, rings or a file to make a domain of, got {type(given).__name__}"
        ) from None


def _is_polygon(item: Any) -> bool:
    return hasattr(item, "geom_type") or hasattr(item, "__geo_interface__")


def _is_array(item: Any) -> bool:
    """Whether it is an (n, 2) array of numbers, or a sequence that can be one."""
    if item is None or _is_polygon(item) or isinstance(item, (Mapping, Shape)):
        return False
    try:
        return np.asarray(item, dtype=np.float64).ndim == 2
    except (TypeError, ValueError):
        return False
