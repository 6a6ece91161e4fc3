"""Seeds of holes and regions from surfaces, given as polygons of samples of their boundaries."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np

from adaptmesh.errors import DomainError
from adaptmesh.types import Floats

from .joining import places_of


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


def overlaps(faces: Mapping[int, Any], share: float) -> list[tuple[int, int, float]]:
    """Pairs of surfaces with more than this share of the smaller one in common, and that area."""
    import shapely

    numbers, areas = list(faces), np.array([*faces.values()], dtype=object)
    tree = shapely.STRtree(areas)
    first, second = tree.query(areas, predicate="intersects")
    out = []
    for i, j in sorted(zip(first.tolist(), second.tolist(), strict=True)):
        if i < j:
            common = areas[i].intersection(areas[j]).area
            if common > share * min(areas[i].area, areas[j].area):
                out.append((numbers[i], numbers[j], common))
    return out


def seeds_of_cells(
    lines: Sequence[Floats],
    faces: Mapping[int, Any],
    groups: Mapping[str, Sequence[int]],
    tolerance: float,
) -> tuple[list[Floats], dict[str, list[Floats]]]:
    """As `seeds_of`, of surfaces that may overlap and lines that may cross: in each cell of lines.

    A cell belongs to the first surface that it lies in, and to a hole if it lies in none. Seeds
    keep away from lines by 4 times the tolerance; what is too narrow for that has none.
    """
    import shapely

    region_of = {k: name for name, numbers in groups.items() for k in numbers}
    drawn = shapely.union_all([shapely.LineString(line) for line in lines])
    cells = shapely.get_parts(shapely.polygonize(shapely.get_parts(drawn)))
    cores = shapely.difference(cells, drawn.buffer(4 * tolerance))
    numbers, tree = list(faces), shapely.STRtree(list(faces.values()))
    holes: list[Floats] = []
    regions: dict[str, list[Floats]] = {}
    for seed in inner_points(cores):
        owners = tree.query(shapely.Point(seed), predicate="intersects")
        if not len(owners):
            holes.append(seed)
        elif (owner := numbers[owners.min()]) in region_of:
            regions.setdefault(region_of[owner], []).append(seed)
    return holes, regions


def joined_lines(lines: Sequence[Floats], tolerance: float) -> list[Floats]:
    """The same lines, where ends within the tolerance are made equal."""
    ends = np.array([line[k] for line in lines for k in (0, -1)])
    place = places_of(ends, tolerance)
    _, first = np.unique(place, return_index=True)
    out = [line.copy() for line in lines]
    for k, line in enumerate(out):
        line[0], line[-1] = ends[first[place[2 * k]]], ends[first[place[2 * k + 1]]]
    return out
