"""Seeds of holes and regions from surfaces, given as polygons of samples of their boundaries."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np

from adaptmesh.errors import DomainError
from adaptmesh.types import Floats

from .paths import places_of


def seeds_of(
    faces: Mapping[int, Any], groups: Mapping[str, Sequence[int]]
) -> tuple[list[Floats], dict[str, list[Floats]]]:
    """Points in what the surfaces leave out, and in each surface of each group.

    Parameters
    ----------
    faces : mapping of int to shapely geometry
        The area of each surface.
    groups : mapping of str to sequence of int
        Surfaces by name.
    """
    import shapely

    try:
        union = shapely.union_all(list(faces.values()))
        filled = shapely.union_all(
            [
                shapely.Polygon(part.exterior)
                for part in shapely.get_parts(union)
                if part.geom_type == "Polygon"
            ]
        )
        holes = inner_points(filled.difference(union))
    except shapely.errors.GEOSException as error:
        raise DomainError(f"a curve loop crosses itself or another: {error}") from None
    regions = {
        name: [seed for k in numbers for seed in inner_points(faces[k])]
        for name, numbers in groups.items()
    }
    return holes, regions


def inner_points(area: Any) -> list[Floats]:
    """A point in each part of an area."""
    import shapely

    parts = shapely.get_parts(area)
    parts = parts[~shapely.is_empty(parts)]
    with np.errstate(over="ignore"):  # dy/dx of a nearly upright line is infinite, rightly
        inner = shapely.point_on_surface(parts)
    return list(shapely.get_coordinates(inner))


def joined_lines(lines: Sequence[Floats], tolerance: float) -> list[Floats]:
    """The same lines, where ends within the tolerance are made equal."""
    ends = np.array([line[k] for line in lines for k in (0, -1)])
    place = places_of(ends, tolerance)
    _, first = np.unique(place, return_index=True)
    out = [line.copy() for line in lines]
    for k, line in enumerate(out):
        line[0], line[-1] = ends[first[place[2 * k]]], ends[first[place[2 * k + 1]]]
    return out
