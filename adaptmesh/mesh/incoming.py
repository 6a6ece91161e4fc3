"""What a file says, and the checks between that and a `Mesh`."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field

import numpy as np

from adaptmesh._core import orient2d
from adaptmesh.checks import LARGEST, is_level
from adaptmesh.errors import FormatError
from adaptmesh.types import Array

from .cleaned import edges_once
from .mesh import Mesh
from .periodic_sides import Rows, periodic_sides

_INT32 = np.iinfo(np.int32)


@dataclass
class Content:
    """Arrays and names of one file, not yet checked against one another.

    Points are (n, 2) or (n, 3); fields are at the points or at the triangles; the metric is
    packed (m11, m12, m22). What is required are vertex numbers and rows of the edges. Seeds are
    points in holes (k, 2), and by number in the parts of regions. `others` are vertex numbers of
    nodes of cells of higher order that are no corners, see `adaptmesh.mesh.second_order`;
    periodic boundaries are a list as in `adaptmesh.mesh.periodic_sides`.
    """

    points: Array
    triangles: Array
    regions: Array
    edges: Array
    edge_tags: Array
    names: dict[str, int] = field(default_factory=dict)
    region_names: dict[str, int] = field(default_factory=dict)
    point_fields: dict[str, Array] = field(default_factory=dict)
    triangle_fields: dict[str, Array] = field(default_factory=dict)
    metric: Array | None = None
    required_points: Array = field(default_factory=lambda: np.empty(0, np.int64))
    required_edges: Array = field(default_factory=lambda: np.empty(0, np.int64))
    hole_seeds: Array = field(default_factory=lambda: np.empty((0, 2)))
    region_seeds: Mapping[int, Array] = field(default_factory=dict)
    others: Array = field(default_factory=lambda: np.empty(0, np.int64))
    periodic: Rows = field(default_factory=list)


def refuse_cells(counts: Mapping[str, int]) -> None:
    """Raise for cells that are not triangles, edges or vertices; `counts` by kind."""
    found = ", ".join(f"{count} {kind}" for kind, count in counts.items() if count)
    if found:
        raise FormatError(
            f"holds {found}; only triangles with three vertices, edges with two, and lone "
            "vertices can be read. Split every other cell into such triangles first (for example "
            "`pyvista.read(path).triangulate()`), and drop solids"
        )


def mesh_of(content: Content) -> Mesh:
    """The mesh that a file holds; `FormatError` names the first thing that is wrong.

    Clockwise triangles are turned over (their last two vertices are exchanged): the order in
    which a file lists the vertices says nothing about the geometry. Nothing else is changed.
    """
    points = planar(content.points)
    triangles = np.asarray(content.triangles, dtype=np.int64)
    if not len(triangles):
        raise FormatError("holds no triangles")
    check_vertices("triangle", triangles, len(points))
    triangles = _counter_clockwise(points, triangles)
    _refuse_duplicates("triangle", triangles)
    edges = np.asarray(content.edges, dtype=np.int64)
    check_vertices("edge", edges, len(points))
    _edges_are_sides(edges, triangles, len(points))
    _check_numbers("required vertex", content.required_points, len(points))
    _check_numbers("required edge", content.required_edges, len(edges))
    tags = _tags("edge tag", content.edge_tags)
    once = edges_once(edges, tags, content.names, FormatError)
    return Mesh(
        points,
        triangles.astype(np.int32),
        regions=_tags("region", content.regions),
        edges=edges[once.rows].astype(np.int32),
        edge_tags=once.tags.astype(np.int32),
        names=_named("edge tag", content.names),
        region_names=_named("region", content.region_names),
        required_points=content.required_points,
        required_edges=np.unique(once.edge[content.required_edges]),
        periodic=periodic_sides(content.periodic, content.names),
    )


def fields_of(content: Content, mesh: Mesh) -> dict[str, Array]:
    """The fields of a file by name, the metric among them as ``metric``."""
    for place, fields, count in (
        ("points", content.point_fields, len(mesh.points)),
        ("triangles", content.triangle_fields, len(mesh.triangles)),
    ):
        for name, values in fields.items():
            if len(values) != count:
                raise FormatError(f"field {name!r} has {len(values)} rows for {count} {place}")
    metric = {} if content.metric is None else {"metric": content.metric}
    out: dict[str, Array] = {}
    for fields in (content.point_fields, content.triangle_fields, metric):
        for name, values in fields.items():
            if name in out:
                raise FormatError(
                    f"two fields are called {name!r}, at points or triangles; rename one in the "
                    "program that wrote the file"
                )
            out[name] = values
    return out


def check_vertices(kind: str, cells: Array, count: int) -> None:
    """Raise for the first cell with a vertex that is not among `count`, or that it has twice."""
    bad = np.flatnonzero(((cells < 0) | (cells >= count)).any(axis=1))
    if len(bad):
        raise FormatError(
            f"{kind} {bad[0]} has vertices {cells[bad[0]].tolist()}, but the points are numbered "
            f"from 0 to {count - 1}"
        )
    sides = np.sort(cells, axis=1)
    bad = np.flatnonzero((sides[:, 1:] == sides[:, :-1]).any(axis=1))
    if len(bad):
        raise FormatError(f"{kind} {bad[0]} has a vertex twice: {cells[bad[0]].tolist()}")


def _check_numbers(what: str, numbers: Array, count: int) -> None:
    bad = np.flatnonzero((numbers < 0) | (numbers >= count))
    if len(bad):
        raise FormatError(
            f"{what} {bad[0]} has number {numbers[bad[0]]}; there are 0 to {count - 1}"
        )


def check_coordinates(points: Array) -> None:
    """Raise for the first point with a coordinate that is no number, infinite, or too large."""
    bad = np.flatnonzero(~np.isfinite(points).all(axis=1))
    if len(bad):
        raise FormatError(f"point {bad[0]} is {tuple(points[bad[0]].tolist())}, not finite")
    bad = np.flatnonzero((np.abs(points) > LARGEST).any(axis=1))
    if len(bad):
        raise FormatError(
            f"point {bad[0]} is {tuple(points[bad[0]].tolist())}: areas and squares of coordinates "
            f"beyond {LARGEST:g} overflow; choose another unit of length"
        )


def planar(points: Array) -> Array:
    """Points without a z that is everywhere the same; a `FormatError` names one that is off."""
    points = np.asarray(points, dtype=np.float64)
    check_coordinates(points)
    if points.shape[1] == 3:
        z = points[:, 2]
        if len(z) and not is_level(z, points[:, :2]):
            off = int(np.argmax(np.abs(z - z[0])))
            raise FormatError(
                f"point {off} is {tuple(points[off].tolist())}: z is not {z[0]:g}, as that of "
                "point 0. Only plane meshes can be read; project or rotate the surface onto z = 0"
            )
    return points[:, :2]


def _counter_clockwise(points: Array, triangles: Array) -> Array:
    points = np.ascontiguousarray(points)
    signs = np.asarray(orient2d(*(points[corner] for corner in triangles.T)))
    flat = np.flatnonzero(signs == 0)
    if len(flat):
        t = flat[0]
        corners = ", ".join(str(tuple(p)) for p in points[triangles[t]].tolist())
        raise FormatError(
            f"triangle {t} (vertices {triangles[t].tolist()}) has no area: its corners {corners} "
            "are on one line; remove it or move a corner"
        )
    clockwise = signs < 0
    out: Array = triangles.copy()
    out[clockwise] = out[clockwise][:, [0, 2, 1]]
    return out


def _refuse_duplicates(kind: str, cells: Array) -> None:
    vertices = np.sort(cells, axis=1)
    order = np.lexsort(vertices.T)  # stable: of equal cells the first in the file comes first
    again = np.flatnonzero((vertices[order[1:]] == vertices[order[:-1]]).all(axis=1))
    if len(again):
        first, second = order[again[0]], order[again[0] + 1]
        raise FormatError(
            f"{kind} {second} has the same vertices {cells[second].tolist()} as {kind} {first}; "
            "remove one of them"
        )


def _edges_are_sides(edges: Array, triangles: Array, count: int) -> None:
    def keys(pairs: Array) -> Array:
        return pairs.min(axis=1) * count + pairs.max(axis=1)

    sides = np.concatenate([triangles[:, [1, 2]], triangles[:, [2, 0]], triangles[:, [0, 1]]])
    known = np.sort(keys(sides))
    place = np.searchsorted(known, keys(edges))
    bad = np.flatnonzero(np.append(known, -1)[place] != keys(edges))
    if len(bad):
        raise FormatError(
            f"edge {bad[0]} (vertices {edges[bad[0]].tolist()}) is not a side of any triangle, "
            f"one of {len(bad)} such edges; remove them, or make the triangles fit them"
        )


def _tags(kind: str, tags: Array) -> Array:
    tags = np.asarray(tags)
    bad = np.flatnonzero((tags < _INT32.min) | (tags > _INT32.max))
    if len(bad):
        raise FormatError(f"{kind} {int(tags[bad[0]])} does not fit in 32 bits")
    return tags.astype(np.int32)


def _named(kind: str, names: Mapping[str, int]) -> dict[str, int]:
    for name, tag in names.items():
        if not _INT32.min <= tag <= _INT32.max:
            raise FormatError(f"{kind} {tag}, named {name!r}, does not fit in 32 bits")
    return dict(names)
