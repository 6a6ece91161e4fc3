"""Regions of domains as polygons of shapely."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from adaptmesh.domain.data import DomainData
from adaptmesh.topology import regions_beside
from adaptmesh.types import Floats

if TYPE_CHECKING:
    from shapely import MultiPolygon, Polygon


def regions_as_polygons(domain: DomainData) -> dict[str | None, MultiPolygon]:
    """As `adaptmesh.convert.to_shapely`."""
    import shapely

    n, pieces = len(domain.points), domain.pieces
    beside = regions_beside(domain.triangles, domain.triangle_regions, pieces, n)
    out: dict[str | None, MultiPolygon] = {}
    for name, number in [(None, 0), *domain.region_names.items()]:
        left, right = (beside == number).T
        border = np.concatenate([pieces[left & ~right], pieces[right & ~left][:, ::-1]])
        if len(border):
            inside = _faces_left_of(domain.points[border])
            out[name] = shapely.multipolygons(inside)
    return out


def _faces_left_of(segments: Floats) -> list[Polygon]:
    """The faces between segments, (k, 2, 2), that have these on their left."""
    import shapely

    directed = {(*start, *end) for start, end in segments.tolist()}
    inside = []
    for face in shapely.get_parts(shapely.polygonize(shapely.linestrings(segments))):
        start, end = face.exterior.coords[:2]
        if not face.exterior.is_ccw:
            start, end = end, start
        if (*start, *end) in directed:
            inside.append(face)
    return inside
