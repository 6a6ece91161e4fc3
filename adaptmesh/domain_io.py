"""Domains from files: GeoJSON outlines, Triangle's .poly files, and the domains of meshes."""

from __future__ import annotations

import json
import os
from collections.abc import Iterator
from pathlib import Path
from typing import Any

from .coverage import domain_of_polygons
from .domain import Domain
from .errors import DomainError, FormatError
from .polyfile import read_poly

GEOJSON_SUFFIXES = (".geojson", ".json")
OUTLINE_SUFFIXES = (*GEOJSON_SUFFIXES, ".poly")


def read_domain(path: str | os.PathLike[str], *, make_valid: bool = False) -> Domain:
    """Read what to mesh from a file.

    ================== ==========================================================================
    suffix             what becomes of it
    ================== ==========================================================================
    .geojson .json     Each Polygon or MultiPolygon is a region, named by the property ``name`` of
                       its feature; polygons may share borders, which become interfaces.
                       Coordinates are taken as they are, in the plane: project longitudes and
                       latitudes first.
    .poly              Triangle's format, with holes; boundary markers other than 0 become names
                       of edges, and the attributes of region seeds become names of regions.
    anything else      A mesh that `adaptmesh.read` can read: its domain.
    ================== ==========================================================================

    Parameters
    ----------
    path : str or path
        The file.
    make_valid : bool
        Let shapely repair GeoJSON polygons that are not valid, as `shapely.make_valid` does it:
        rings that cross themselves are cut at the crossings. The default is to refuse them.

    Returns
    -------
    Domain

    Raises
    ------
    FormatError
        If the file is missing, truncated, or not what its suffix says.
    DomainError
        If it holds no polygon, something else than polygons, or polygons that are not valid; the
        message names the feature, the place and the remedy.
    """
    path = Path(path)
    suffix = path.suffix.lower()
    try:
        if suffix in GEOJSON_SUFFIXES:
            return _read_geojson(path, make_valid)
        if suffix == ".poly":
            return read_poly(path)
        return _domain_of_mesh_file(path)
    except DomainError as error:
        raise DomainError(f"{path}: {error}") from error


def _domain_of_mesh_file(path: Path) -> Domain:
    from .io import read

    mesh = read(path)
    return Domain.of_mesh(mesh) if mesh.domain is None else mesh.domain


def _read_geojson(path: Path, make_valid: bool) -> Domain:
    features = list(_features(_parsed(path), path))
    if not features:
        raise DomainError("it has no features: there is nothing to mesh")
    polygons = [_polygon(geometry, label, path) for label, _, geometry in features]
    return domain_of_polygons(polygons, [name for _, name, _ in features], make_valid=make_valid)


def _parsed(path: Path) -> dict[str, Any]:
    try:
        content = json.loads(path.read_text(encoding="utf-8"))
    except FileNotFoundError as error:
        raise FormatError(f"{path}: no such file") from error
    except UnicodeDecodeError as error:
        raise FormatError(f"{path} is not a text file: {error}") from error
    except json.JSONDecodeError as error:
        raise FormatError(
            f"{path} is not valid JSON at line {error.lineno}, column {error.colno} "
            f"({error.msg}): is the file complete?"
        ) from error
    except OSError as error:
        raise FormatError(f"{path} cannot be read: {error.strerror}") from error
    if not isinstance(content, dict) or "type" not in content:
        raise FormatError(f"{path} is JSON but not GeoJSON: its outermost object has no 'type'")
    return content


def _features(content: dict[str, Any], path: Path) -> Iterator[tuple[str, str | None, Any]]:
    """(how to call it in a message, name or None, geometry) of each feature."""
    if content["type"] == "FeatureCollection":
        features = content.get("features")
        if not isinstance(features, list):
            raise FormatError(f"{path}: the FeatureCollection has no list of 'features'")
    else:
        features = [content]
    for number, feature in enumerate(features):
        label = f"polygon {number}"
        if not isinstance(feature, dict):
            raise FormatError(f"{path}: feature {number} is not an object but {feature!r}")
        if feature.get("type") != "Feature":
            yield label, None, feature
            continue
        name = (feature.get("properties") or {}).get("name")
        name = None if name is None else str(name)
        yield label if name is None else f"{label} ({name!r})", name, feature.get("geometry")


def _polygon(geometry: Any, label: str, path: Path) -> Any:
    import shapely

    kind = geometry.get("type") if isinstance(geometry, dict) else None
    if kind not in ("Polygon", "MultiPolygon"):
        raise DomainError(
            f"{label} is {'nothing' if kind is None else f'a {kind}'}, and a domain is "
            "made of Polygon and MultiPolygon: remove that feature, or make a polygon of it "
            "(shapely.polygonize for closed lines, shapely.buffer for points and open ones)"
        )
    try:
        return shapely.from_geojson(json.dumps(geometry))
    except shapely.errors.GEOSException as error:
        raise FormatError(f"{path}: {label} cannot be read: {error}") from error
