"""Regions of domains as polygons of shapely."""

from __future__ import annotations

from typing import TYPE_CHECKING

from adaptmesh.domain.domain import Domain
from adaptmesh.domain.polygons.regions_as_polygons import (
    regions_as_polygons,
)

if TYPE_CHECKING:
    from shapely import MultiPolygon

__all__ = ["to_shapely"]


def to_shapely(domain: Domain) -> dict[str | None, MultiPolygon]:
    """The regions of a domain as polygons of shapely.

    Parameters
    ----------
    domain : Domain

    Returns
    -------
    dict of str to shapely.MultiPolygon
        By the name of the region; that of what has no name is None. Lines within a region are left
        out. Neighbours share the points of their borders.
    """
    return regions_as_polygons(domain)
