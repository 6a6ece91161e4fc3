"""The polygons of a GeoJSON object."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

from adaptmesh.errors import DomainError, FormatError

from .shape import Shape


def shapes_of_geojson(content: Mapping[str, Any]) -> list[Shape]:
    """The polygons of a GeoJSON object: a geometry, a feature, or a collection of features.

    Raises
    ------
    FormatError
        If it is not GeoJSON.
    DomainError
        If a feature is something else than a Polygon or MultiPolygon, or there is none.
    """
    if content["type"] == "FeatureCollection":
        features = content.get("features")
        if not isinstance(features, Sequence):
            raise FormatError("the FeatureCollection has no list of 'features'")
    else:
        features = [content]
    if not features:
        raise DomainError("it has no features: there is nothing to mesh")
    shapes = []
    for number, feature in enumerate(features):
        if not isinstance(feature, Mapping):
            raise FormatError(f"feature {number} is not an object but {feature!r}")
        geometry: Any = feature
        name = None
        if feature.get("type") == "Feature":
            geometry = feature.get("geometry")
            properties = feature.get("properties")
            name = properties.get("name") if isinstance(properties, Mapping) else None
        shapes.append(Shape.of_geojson(geometry, number, None if name in (None, "") else str(name)))
    return shapes
