"""Polygons that share borders (countries, materials, land and sea) made into one domain.

+-------+-------+        The borders are noded into segments that meet only at their ends, and
|   A   |   B   |        the faces between them are found. A face inside one polygon becomes a
|   +---+---+   |        region of that polygon's name, a face inside none becomes a hole, and
|   | hole  |   |        a face inside two is an overlap. The border between A and B is there
+---+-------+---+        once, as an interface: both sides get the same vertices.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from .domain import Domain
from .errors import DomainError

if TYPE_CHECKING:
    from shapely import MultiPolygon, Polygon

Floats = NDArray[np.float64]

GRID = 1e-9
"""Features below this share of the extent are rounding, not geometry."""


def domain_of_polygons(
    polygons: Sequence[Polygon | MultiPolygon],
    names: Sequence[str | None],
    *,
    make_valid: bool = False,
) -> Domain:
    """One domain of several polygons, each a region.

    Parameters
    ----------
    polygons : sequence of shapely Polygon or MultiPolygon
        They may touch and share borders; they may not overlap.
    names : sequence of str or None
        Name of the region of each polygon; polygons of the same name are one region.
    make_valid : bool
        Repair what is not valid with `shapely.make_valid`: rings that cross themselves are cut at
        the crossings and what was wound twice is counted once (islands may split into parts that
        touch in a point). Borders are then snapped to a grid of 1e-9 of the extent, and where
        polygons overlap the first one keeps the overlap.

    Returns
    -------
    Domain
        With a region for each name. What is enclosed by polygons and in none of them is a hole.

    Raises
    ------
    DomainError
        If a polygon is empty, not finite, not valid or overlaps another one, or if two of them
        nearly but not quite touch, unless `make_valid` repairs it.
    """
    import shapely

    if not polygons:
        raise DomainError("there are no polygons to make a domain of")
    labels = [_label(i, name) for i, name in enumerate(names)]
    checked = [_checked(p, label, make_valid) for p, label in zip(polygons, labels, strict=True)]

    grid = _grid(checked)
    boundaries = [shapely.boundary(p) for p in checked]
    lines = shapely.unary_union(boundaries, grid_size=grid if make_valid else None)
    faces = shapely.get_parts(shapely.polygonize(shapely.get_parts(lines)))
    seeds = shapely.point_on_surface(faces)
    owners = _owners(faces, seeds, checked, labels, make_valid)

    places = shapely.get_coordinates(seeds)
    regions: dict[str, Floats] = {}
    for name in dict.fromkeys(n for n in names if n is not None):
        mine = np.array([o is not None and names[o] == name for o in owners])
        if mine.any():
            regions[name] = places[mine]
    holes = places[[owner is None for owner in owners]]
    points, segments = _segments(lines)
    _check_apart(points, segments, 0.25 * grid)
    return Domain(points, segments, holes=holes, regions=regions)


def _label(number: int, name: str | None) -> str:
    return f"polygon {number}" if name is None else f"polygon {number} ({name!r})"


def _grid(polygons: Sequence[Any]) -> float:
    """The power of ten at or below `GRID` of the extent: decimal coordinates snap to themselves."""
    import shapely

    x0, y0, x1, y1 = shapely.total_bounds(np.asarray(polygons, dtype=object))
    return float(10.0 ** np.floor(np.log10(GRID * max(x1 - x0, y1 - y0))))


def _checked(polygon: Any, label: str, make_valid: bool) -> Any:
    """The polygon, in the plane, valid; or an error that says where it is not."""
    import shapely

    polygon = shapely.force_2d(polygon)
    if shapely.is_empty(polygon):
        raise DomainError(f"{label} is empty: remove it")
    xy = shapely.get_coordinates(polygon)
    bad = np.flatnonzero(~np.isfinite(xy).all(axis=1))
    if len(bad):
        raise DomainError(
            f"{label}: its point {bad[0]} is {tuple(xy[bad[0]])}, which is not finite"
        )
    if not shapely.is_valid(polygon):
        if not make_valid:
            raise DomainError(
                f"{label} is not valid: {_reason(polygon)}. Repair it with shapely.make_valid, or "
                "let it be repaired: make_valid=True (on the command line --make-valid)"
            )
        polygon = _polygonal(shapely.make_valid(polygon))
        if shapely.is_empty(polygon):
            raise DomainError(f"{label} has no area, and so no valid form: remove it")
    return polygon


def _reason(polygon: Any) -> str:
    """What shapely has against a polygon: ``Self-intersection at (1.5, 2.0)``."""
    import shapely

    what, _, where = shapely.is_valid_reason(polygon).partition("[")
    place = ", ".join(f"{float(c):.10g}" for c in where.rstrip("]").split())
    return f"{what.lower()} at ({place})" if place else what.lower()


def _polygonal(geometry: Any) -> Any:
    """The polygons of a collection; lines and points that a repair leaves over have no area."""
    import shapely

    parts = shapely.get_parts(shapely.get_parts(geometry))
    return shapely.multipolygons(parts[shapely.get_type_id(parts) == shapely.GeometryType.POLYGON])


def _owners(
    faces: Any,
    seeds: Any,
    polygons: Sequence[Any],
    labels: Sequence[str],
    make_valid: bool,
) -> list[int | None]:
    """For each face the polygon that it lies in, None for a hole."""
    import shapely

    owners: list[int | None] = []
    tree = shapely.STRtree(polygons)
    for face, seed in zip(faces, seeds, strict=True):
        inside = sorted(int(i) for i in tree.query(seed, predicate="intersects"))
        if len(inside) > 1 and not make_valid:
            raise DomainError(
                f"{labels[inside[0]]} and {labels[inside[1]]} overlap at ({seed.x:.10g}, "
                f"{seed.y:.10g}), on an area of "
                f"{shapely.area(face):.6g}: subtract one from the other (shapely.difference), or "
                "let the first one keep it: make_valid=True (on the command line --make-valid)"
            )
        owners.append(inside[0] if inside else None)
    return owners


def _segments(lines: Any) -> tuple[Floats, NDArray[np.int64]]:
    """The vertices and segments of noded lines, each once."""
    import shapely

    parts = shapely.get_parts(lines)
    xy, line = shapely.get_coordinates(parts, return_index=True)
    points, vertex = np.unique(xy, axis=0, return_inverse=True)
    vertex = vertex.reshape(-1)
    same_line = line[:-1] == line[1:]
    segments = np.stack([vertex[:-1], vertex[1:]], axis=1)[same_line]
    return points, np.unique(np.sort(segments, axis=1), axis=0)


def _check_apart(points: Floats, segments: NDArray[np.int64], least: float) -> None:
    """Refuse a point that lies almost, but not quite, on a segment: rounding made two of one."""
    import shapely

    tree = shapely.STRtree(shapely.linestrings(points[segments]))
    i, k = tree.query(shapely.points(points), predicate="dwithin", distance=least)
    near = np.flatnonzero((segments[k] != i[:, None]).all(axis=1))
    if len(near):
        x, y = points[i[near[0]]]
        (x0, y0), (x1, y1) = points[segments[k[near[0]]]].tolist()
        raise DomainError(
            f"the point ({x:.10g}, {y:.10g}) is nearer than {least:.1g} to the segment from "
            f"({x0:.10g}, {y0:.10g}) to ({x1:.10g}, {y1:.10g}), but not on it: snap the polygons "
            "to a grid with shapely.set_precision, or let it be done: make_valid=True (on the "
            "command line --make-valid)"
        )
