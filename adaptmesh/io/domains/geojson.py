"""GeoJSON: polygons with names, in and out."""

from __future__ import annotations

import json
import os
from pathlib import Path

from adaptmesh.domain.domain import Domain
from adaptmesh.domain.polygons.geojson_shapes import shapes_of_geojson
from adaptmesh.domain.polygons.regions_as_polygons import (
    regions_as_polygons,
)
from adaptmesh.domain.polygons.shape import Shape
from adaptmesh.errors import FormatError
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
        for name, area in regions_as_polygons(domain).items()
    ]
    text = json.dumps({"type": "FeatureCollection", "features": features})
    replace_files({Path(path): text.encode()})
