"""Polygons that share borders (countries, materials, land and sea) made into one domain.

+-------+-------+        The borders are noded into segments that meet only at their ends, and
|   A   |   B   |        the faces between them are found. A face inside one polygon becomes a
|   +---+---+   |        region of that polygon's name, a face inside none becomes a hole, and
|   | hole  |   |        a face inside two is an overlap. The border between A and B is there
+---+-------+---+        once, as the interface "A|B": both sides get the same vertices.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING

import numpy as np

from adaptmesh.arrangement.faces import Faces, find_faces
from adaptmesh.arrangement.noding import node, resolve_tolerance
from adaptmesh.arrangement.record import Repair, Repairs
from adaptmesh.arrangement.winding import Passes, sum_passes
from adaptmesh.domain.given import Given
from adaptmesh.errors import DomainError
from adaptmesh.topology import unique_edges, used_points
from adaptmesh.types import Bools, Floats, Int64s

from .face_owners import owners_of_faces
from .rings import REPEATED, Rings, rings_of
from .shape import Shape

if TYPE_CHECKING:
    from shapely import MultiPolygon, Polygon


def given_of_polygons(
    polygons: Sequence[Polygon | MultiPolygon], names: Sequence[str | None]
) -> Given:
    """One domain of several polygons of shapely, each a region; see `given_of_shapes`.

    Polygons of the same name are one region.
    """
    shapes = [
        Shape.of_shapely(polygon, i, name)
        for i, (polygon, name) in enumerate(zip(polygons, names, strict=True))
    ]
    return given_of_shapes(shapes)


def given_of_shapes(shapes: Sequence[Shape]) -> Given:
    """What makes one domain of several polygons, each a region; nothing is repaired.

    Polygons may touch and share borders. What is enclosed by polygons and in none of them is a
    hole. The border between the regions A and B is named ``"A|B"``, in the order of the polygons;
    where A ends at the outside, a hole, or a region without a name, its border is named ``"A"``.

    Raises
    ------
    DomainError
        If there is anything to repair: polygons that cross themselves or overlap, borders that
        nearly but not quite coincide, ...; it names the first place.
    """
    given, repairs = repaired_shapes(shapes, None)
    faults = [record for record in repairs if record.kind != REPEATED]
    if faults:
        more = f" (and {len(faults) - 1} more such places)" if len(faults) > 1 else ""
        raise DomainError(
            f"{faults[0]}{more}: this is what adaptmesh.repair would do; let it (on the command "
            "line --repair), or mend it"
        )
    return given


def repaired_shapes(shapes: Sequence[Shape], tolerance: float | None) -> tuple[Given, Repairs]:
    """What makes one domain of several polygons, and what had to be done for it; see `repair`."""
    if not shapes:
        raise DomainError("there are no polygons to make a domain of")
    log: list[Repair] = []
    rings = rings_of(shapes, log)
    tolerance = resolve_tolerance(rings.points, tolerance)
    noded = node(rings.points, rings.segments, tolerance, rings.labels(), log)
    used, pieces = used_points(noded.pieces)
    points = noded.points[used]
    edges, edge, sign = unique_edges(pieces)
    if not len(edges):
        raise DomainError(
            f"no polygon is wider than the tolerance, {tolerance:.3g}: there is nothing to mesh"
        )
    faces = find_faces(points, edges)
    passes = sum_passes(edge, sign, rings.ring[noded.segment])
    owner = owners_of_faces(faces, edges, passes, shapes, rings.rings, log)
    kept = owner[faces.left] != owner[faces.right]
    _record_what_is_dropped(points, edges, kept, rings, passes, log)
    if not kept.any():
        raise DomainError(f"there is nothing to mesh: {log[-1]}")
    given = _given(points, edges, kept, faces, owner, shapes)
    return given, Repairs(tuple(log), tolerance, noded.displacement(rings.points, rings.segments))


def _record_what_is_dropped(
    points: Floats,
    edges: Int64s,
    kept: Bools,
    rings: Rings,
    passes: Passes,
    log: list[Repair],
) -> None:
    """Name the rings of which nothing is left, and the spikes of the others."""
    edge, ring, net = passes
    left = np.zeros(len(rings.rings), bool)
    left[ring[kept[edge]]] = True
    for r in np.flatnonzero(~left).tolist():
        lost = rings.rings[r]
        what = f"{lost.label} bounds nothing; removed (its area was {lost.area:.3g})"
        log.append(Repair("ring that bounds nothing", lost.place, what))

    spike = ~kept[edge] & (net == 0) & left[ring]
    for r in np.unique(ring[spike]).tolist():
        mine = edges[edge[spike & (ring == r)]]
        length = float(np.hypot(*(points[mine[:, 0]] - points[mine[:, 1]]).T).sum())
        ends, count = np.unique(mine, return_counts=True)
        tips = ends[(count == 1) & ~np.isin(ends, edges[kept])]
        x, y = points[tips[0] if len(tips) else ends[0]].tolist()
        what = (
            f"{rings.rings[r].label} runs there and back in the same line, over a length of "
            f"{length:.3g}; removed"
        )
        log.append(Repair("spike", (x, y), what))


def _given(
    points: Floats,
    edges: Int64s,
    kept: Bools,
    faces: Faces,
    owner: Int64s,
    shapes: Sequence[Shape],
) -> Given:
    """What makes the domain of the faces that have an owner, with a region for each name."""
    merged = faces.merge_across(~kept)
    _, first = np.unique(merged, return_index=True)
    first = first[merged[first] != merged[0]]  # the outside needs no point
    places, owners = faces.inner_points[first], owner[first]
    faces_of: dict[str, list[int]] = {shape.name: [] for shape in shapes if shape.name is not None}
    for face, o in enumerate(owners.tolist()):
        name = shapes[o].name if o >= 0 else None
        if name is not None:
            faces_of[name].append(face)
    regions = {name: places[mine] for name, mine in faces_of.items() if mine}
    borders = edges[kept]
    used, segments = used_points(borders)
    return Given(
        points[used],
        segments,
        holes=places[owners < 0],
        regions=regions,
        names=_names(owner[faces.left[kept]], owner[faces.right[kept]], shapes),
    )


def _names(left: Int64s, right: Int64s, shapes: Sequence[Shape]) -> dict[str, list[int]]:
    """The edges of each border, by the regions beside it."""
    beside = np.sort(np.stack([left, right], axis=1), axis=1)
    borders, border = np.unique(beside, axis=0, return_inverse=True)
    border = border.reshape(-1)
    mine = np.split(np.argsort(border, kind="stable"), np.cumsum(np.bincount(border))[:-1])
    edges: dict[str, list[int]] = {}
    sides: dict[str, list[str]] = {}
    for k, owners in enumerate(borders.tolist()):
        names = [shapes[owner].name for owner in owners if owner >= 0]
        named = [name for name in names if name is not None]
        if not named or (len(named) == 2 and named[0] == named[1]):
            continue  # a border of what has no name, or a line within one region
        name = "|".join(named)
        if sides.setdefault(name, named) != named:
            raise DomainError(
                f"two borders would both be named {name!r}, that of {' and '.join(named)} and that "
                f"of {' and '.join(sides[name])}: choose names of regions without '|'"
            )
        edges.setdefault(name, []).extend(mine[k].tolist())
    return edges
