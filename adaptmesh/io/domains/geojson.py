"""GeoJSON: polygons with names, in and out."""

from __future__ import annotations

import json
import os
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

from adaptmesh.convert import to_shapely
from adaptmesh.domain.domain import Domain
from adaptmesh.domain.outline import Shape
from adaptmesh.errors import DomainError, FormatError
from adaptmesh.files.bounded import read_json
from adaptmesh.files.located import located
from adaptmesh.files.whole import read_text, replace_files

GEOJSON_SUFFIXES = (".geojson", ".json")


def read_geojson(path: Path) -> list[Shape]:
    """The polygons of a file, unchecked; a `FormatError` names the file."""
    text = read_text(path)
    with located(path):
        content = read_json(text)
        if not isinstance(content, dict) or "type" not in content:
            raise FormatError("is JSON but not GeoJSON: its outermost object has no 'type'")
        return shapes_of_geojson(content)


def write_geojson(path: str | os.PathLike[str], domain: Domain) -> None:
    """Write the regions of a domain as features, each with its name.

    Names of edges and lines within regions are not kept: GeoJSON has no place for them. Coordinates
    are written with all their digits.
    """
    import shapely

    features = [
        {
            "type": "Feature",
            "properties": {} if name is None else {"name": name},
            "geometry": json.loads(shapely.to_geojson(area)),
        }
        for name, area in to_shapely(domain).items()
    ]
    text = json.dumps({"type": "FeatureCollection", "features": features})
    replace_files({Path(path): text.encode()})


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
