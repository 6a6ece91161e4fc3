"""Points, polylines and polygons, in whatever form, as parts: arrays of vertices in a row."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from typing import Any, NamedTuple

import numpy as np

from metrics.checks import as_indices, as_points
from metrics.errors import MetricError
from metrics.types import Floats

__all__ = ["Part", "Pieces", "parts_of"]


class Part(NamedTuple):
    """Vertices (n, 2) joined in a row, or one alone; a ring is closed and bounds an area."""

    points: Floats
    is_ring: bool = False


class Pieces(NamedTuple):
    """Segments (k, 2, 2), not joined; or cubics with these ends and derivatives (k, 2, 2) there."""

    ends: Floats
    derivatives: Floats | None = None


def parts_of(geometry: Any) -> Iterator[Part | Pieces]:
    """The parts of anything that `Geometry` takes.

    Raises
    ------
    MetricError
        For anything else, for no parts, and for coordinates that are not finite.
    """
    if isinstance(geometry, Mapping):
        yield from _of_geojson(geometry)
    elif hasattr(geometry, "__geo_interface__"):
        yield from _of_geojson(geometry.__geo_interface__)
    elif hasattr(geometry, "cubic_pieces"):
        pieces = geometry.cubic_pieces()
        yield Pieces(pieces.ends, pieces.derivatives)
    elif hasattr(geometry, "points") and hasattr(geometry, "segments"):
        points = as_points(geometry.points)
        yield Pieces(points[as_indices(geometry.segments, 2, len(points), "segment")])
    elif isinstance(geometry, (list, tuple)) and any(hasattr(g, "cubic_pieces") for g in geometry):
        for item in geometry:  # not one array of all: items know more than their coordinates
            yield from parts_of(item)
    else:
        yield from _of_arrays(geometry)


def _of_arrays(geometry: Any) -> Iterator[Part | Pieces]:
    try:
        array = np.asarray(geometry)
        is_numeric = array.dtype.kind in "iuf"
    except ValueError:  # polylines of different lengths
        is_numeric = False
    if not is_numeric:
        if not isinstance(geometry, (list, tuple)):
            raise MetricError(
                "a geometry is an array of points, a list of such arrays, or a shapely geometry, "
                f"not {type(geometry).__name__}"
            )
        for item in geometry:
            yield from parts_of(item)
    elif array.ndim == 3 and array.shape[1:] == (2, 2):
        yield Pieces(as_points(array.reshape(-1, 2)).reshape(-1, 2, 2))
    elif array.ndim == 3 and array.shape[2] == 2:
        yield from (Part(as_points(polyline)) for polyline in array)
    elif array.ndim == 2:
        yield Part(as_points(array))
    elif array.shape == (2,):
        yield Part(as_points(array[None]))
    else:
        raise MetricError(
            "a geometry is a point (2,), a polyline (n, 2) or polylines (k, n, 2), not an array of "
            f"the shape {array.shape}"
        )


def _of_geojson(item: Mapping[str, Any]) -> Iterator[Part]:
    kind, coordinates = item.get("type"), item.get("coordinates", ())
    if kind == "Point":
        if len(coordinates):
            yield Part(_planar([coordinates]))
    elif kind in ("LineString", "LinearRing"):
        yield Part(_planar(coordinates))
    elif kind == "Polygon":
        yield from (Part(_planar(ring), True) for ring in coordinates)
    elif kind in ("MultiPoint", "MultiLineString", "MultiPolygon"):
        single = kind.removeprefix("Multi")
        for part in coordinates:
            yield from _of_geojson({"type": single, "coordinates": part})
    elif kind == "GeometryCollection":
        for part in item["geometries"]:
            yield from _of_geojson(part)
    elif kind == "Feature":
        yield from _of_geojson(item["geometry"])
    elif kind == "FeatureCollection":
        for part in item["features"]:
            yield from _of_geojson(part)
    else:
        raise MetricError(f"a geometry of the type {kind!r} is not known")


def _planar(coordinates: Any) -> Floats:
    """Coordinates without z."""
    array = np.asarray(coordinates, np.float64)
    return as_points(array[:, :2] if array.ndim == 2 else array)
