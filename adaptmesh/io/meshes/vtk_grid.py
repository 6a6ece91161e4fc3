"""Grids of VTK, in `.vtu` and `.vtk` alike: which of their arrays say what.

One grid holds the triangles (VTK type 5) and after them the constrained edges (type 3)::

    PointData   u, v, ...     nodal fields; one with 2 columns is written with a third of zeros,
                              so that ParaView takes it for a vector
                metric        9 columns, the symmetric tensor m11 m12 0  m12 m22 0  0 0 0 of each
                              point, as ParaView's tensor glyphs want it
    CellData    regions       region of each triangle, 0 on edges
                edge_tags     tag of each edge, 0 on triangles
                q, ...        fields of the triangles, NaN (or 0 for integers) on edges
    FieldData   edge_tags: inlet    tag of the edges that have a name
                regions: steel      number of a named region
                columns: u          2 for a field that had 2 columns
                shape: s            that of the values of a field with more than one axis
                periodic: ["a","b"] the motion from boundary a to b: its turn by row, and shift

Names are in the names of arrays because meshio, through which many read VTK's files, stops at
arrays of strings. There ``% " & < >`` and control characters are %25, %22, ..., since VTK does not
escape them when it saves a `.vtu` file again.
"""

from __future__ import annotations

import json
import re
from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import NamedTuple

import numpy as np

from adaptmesh.errors import FormatError
from adaptmesh.files.bounded import read_json
from adaptmesh.mesh.incoming import Content, refuse_cells
from adaptmesh.mesh.periodic_sides import checked_rows
from adaptmesh.types import Array

from .spatial import (
    flat,
    plane_fields,
    shaped,
    shapes,
    spatial,
    spatial_tensor,
    take_metric,
)

_VERTICES, _LINE, _TRIANGLE = (1, 2), 3, 5
_KINDS = {
    4: "polylines", 6: "triangle strips", 7: "polygons", 8: "pixels", 9: "quadrilaterals",
    10: "tetrahedra", 11: "voxels", 12: "hexahedra", 13: "wedges", 14: "pyramids",
    23: "quadratic quadrilaterals",
    42: "polyhedra",
}  # fmt: skip
_EDGES = (_LINE, 21, 35, 68, 75)  # linear, quadratic, cubic, of Lagrange and Bézier
_TRIANGLES = (_TRIANGLE, 22, 34, 69, 76)
_EDGE, _REGION, _COLUMNS, _SHAPE = "edge_tags: ", "regions: ", "columns: ", "shape: "
_PERIODIC = "periodic: "
_OURS = (_EDGE, _REGION, _COLUMNS, _SHAPE, _PERIODIC)


@dataclass
class Grid:
    """An unstructured grid.

    Points are (n, 3); cell i has the vertices ``connectivity[offsets[i]:offsets[i + 1]]`` and VTK's
    number of its kind, ``types[i]``. Arrays by name are (n,) or (n, c).
    """

    points: Array
    connectivity: Array
    offsets: Array
    types: Array
    point_data: dict[str, Array] = field(default_factory=dict)
    cell_data: dict[str, Array] = field(default_factory=dict)
    fields: dict[str, Array] = field(default_factory=dict)


# ---------------------------------------------------------------------------------------- writing


def grid_of(content: Content) -> Grid:
    """The grid that a file of this content holds."""
    m, k = len(content.triangles), len(content.edges)
    point_data = {name: flat(spatial(a)) for name, a in content.point_fields.items()}
    if content.metric is not None:
        point_data["metric"] = spatial_tensor(content.metric)
    cell_data = {
        "regions": np.concatenate([content.regions, np.zeros(k, np.int32)]),
        "edge_tags": np.concatenate([np.zeros(m, np.int32), content.edge_tags]),
    }
    for name, values in content.triangle_fields.items():
        cell_data[name] = _padded(flat(spatial(values)), k)
    numbers = {
        **{f"{_EDGE}{_escaped(name)}": tag for name, tag in content.names.items()},
        **{f"{_REGION}{_escaped(name)}": tag for name, tag in content.region_names.items()},
        **{f"{_COLUMNS}{name}": 2 for name in plane_fields(content)},
        **{f"{_SHAPE}{name}": shape for name, shape in shapes(content).items() if len(shape) > 1},
    }
    return Grid(
        np.column_stack([content.points, np.zeros(len(content.points))]),
        np.concatenate([content.triangles.ravel(), content.edges.ravel()]),
        np.concatenate([3 * np.arange(m + 1), 3 * m + 2 * np.arange(1, k + 1)]),
        np.repeat(np.array([_TRIANGLE, _LINE], np.uint8), [m, k]),
        point_data,
        cell_data,
        {
            **{name: np.array(number, np.int32).reshape(-1) for name, number in numbers.items()},
            **{
                _PERIODIC + _escaped(json.dumps([first, second], ensure_ascii=False)): np.array(row)
                for first, second, row in content.periodic
            },
        },
    )


def _padded(values: Array, count: int) -> Array:
    nothing = np.nan if values.dtype.kind == "f" else 0
    return np.concatenate([values, np.full((count, *values.shape[1:]), nothing, values.dtype)])


def _escaped(name: str) -> str:
    return re.sub(r"[%\"&<>\x00-\x1f\x7f]", lambda match: f"%{ord(match[0]):02X}", name)


def _unescaped(name: str) -> str:
    return re.sub(r"%([0-9A-F]{2})", lambda match: chr(int(match[1], 16)), name)


# ---------------------------------------------------------------------------------------- reading


def content_of(grid: Grid) -> Content:
    """The triangles, edges and fields of a grid, without the names."""
    points = grid.points
    if points.ndim != 2 or points.shape[1] != 3:
        raise FormatError(f"expected points of three coordinates, got shape {points.shape}")
    triangles, edges, is_triangle, is_edge, others = _cells(grid)
    _same_lengths("points", grid.point_data, len(points))
    _same_lengths("cells", grid.cell_data, len(grid.types))
    point_data, cell_data = dict(grid.point_data), dict(grid.cell_data)
    metric = take_metric(point_data)
    return Content(
        points,
        triangles,
        regions=_tags(cell_data, "regions", is_triangle),
        edges=edges,
        edge_tags=_tags(cell_data, "edge_tags", is_edge),
        point_fields=point_data,
        triangle_fields={name: values[is_triangle] for name, values in cell_data.items()},
        metric=metric,
        others=others,
    )


def _same_lengths(what: str, arrays: Mapping[str, Array], count: int) -> None:
    for name, values in arrays.items():
        if len(values) != count:
            raise FormatError(
                f"array {name!r} has {len(values)} rows for {count} {what}: the file is damaged"
            )


class _Cells(NamedTuple):
    """Triangles and edges by their corners, which cells they are, and all other nodes of them."""

    triangles: Array
    edges: Array
    is_triangle: Array
    is_edge: Array
    others: Array


def _cells(grid: Grid) -> _Cells:
    vertices, ends, types = grid.connectivity, grid.offsets, grid.types
    rises = len(ends) and ends[0] == 0 and (ends[1:] >= ends[:-1]).all()
    if not rises or ends[-1] != len(vertices) or len(types) != len(ends) - 1:
        raise FormatError("the vertices of the cells, their numbers and types do not fit together")
    starts, sizes = ends[:-1], np.diff(ends)
    known = np.isin(types, [0, *_VERTICES, *_EDGES, *_TRIANGLES])
    others, counts = np.unique(types[~known], return_counts=True)
    found = zip(others.tolist(), counts.tolist(), strict=True)
    refuse_cells({_KINDS.get(t, f"cells of VTK type {t}"): count for t, count in found})
    vertices = vertices.astype(np.int64)
    is_triangle, is_edge = np.isin(types, _TRIANGLES), np.isin(types, _EDGES)
    corners, no_corners = [], []
    for cells, count, linear in ((is_triangle, 3, _TRIANGLE), (is_edge, 2, _LINE)):
        exactly = types == linear
        if (sizes[cells] < count).any() or (sizes[exactly] != count).any():
            raise FormatError("a triangle without 3 or a line without 2 vertices")
        corners.append(vertices[starts[cells, None] + np.arange(count)])
        curved = np.flatnonzero(cells & ~exactly)
        rest = [vertices[starts[k] + count : ends[k + 1]] for k in curved.tolist()]
        no_corners.append(np.concatenate([np.empty(0, np.int64), *rest]))
    return _Cells(corners[0], corners[1], is_triangle, is_edge, np.concatenate(no_corners))


def _tags(cell_data: dict[str, Array], name: str, rows: Array) -> Array:
    """Take the integer array of that name; another kind of array is a field, the tags are 0."""
    values = cell_data.get(name)
    if values is None or values.ndim != 1 or values.dtype.kind not in "iu":
        return np.zeros(np.count_nonzero(rows), np.int32)
    del cell_data[name]
    return values[rows]


def is_ours(name: str) -> bool:
    """Whether the field of that name says what a number stands for."""
    return name.startswith(_OURS)


def take_names(content: Content, fields: Mapping[str, Array]) -> None:
    """Put names into the content, and leave the columns of its fields that it had."""
    for full, number in fields.items():
        prefix = next(p for p in _OURS if full.startswith(p))
        name = full.removeprefix(prefix)
        if prefix == _PERIODIC:
            names = read_json(_unescaped(name))
            rows = [[*names, number.ravel().tolist()]] if isinstance(names, list) else None
            content.periodic += checked_rows(rows)
            continue
        if prefix == _SHAPE and number.dtype.kind in "iu":
            for of in (content.point_fields, content.triangle_fields):
                if name in of:
                    of[name] = shaped(of[name], number.ravel().tolist())
            continue
        if number.shape != (1,) or number.dtype.kind not in "iu":
            raise FormatError(f"FieldData {prefix}{name!r} is not one integer")
        if prefix != _COLUMNS:
            names = content.names if prefix == _EDGE else content.region_names
            names[_unescaped(name)] = int(number[0])
            continue
        for of in (content.point_fields, content.triangle_fields):
            if name in of and of[name].ndim == 2:
                of[name] = of[name][:, :2]
