"""VTK XML unstructured grids, `.vtu`: what ParaView and pyvista open.

One grid holds the triangles (VTK type 5) and after them the constrained edges (type 3)::

    PointData   u, v, ...     nodal fields; one with 2 columns is written with a third of zeros,
                              so that ParaView takes it for a vector
                metric        9 columns, the symmetric tensor m11 m12 0  m12 m22 0  0 0 0 of each
                              point, as ParaView's tensor glyphs want it
    CellData    regions       region of each triangle, 0 on edges
                edge_tags     tag of each edge, 0 on triangles
                q, ...        fields of the triangles, NaN (or 0 for integers) on edges
    FieldData   edge_tags: inlet    tag of the edges that bear a name
                regions: steel      number of a named region
                columns: u          2 for a field that had 2 columns

Names are in the names of arrays because meshio, through which many read `.vtu`, stops at arrays of
strings. There ``% " & < >`` and control characters are %25, %22, ..., since VTK does not escape
them when it saves a file again. meshio (5.3.5) is not used here: it writes no FieldData, and of a
file with several pieces it reads only the cells of the last.
"""

from __future__ import annotations

import base64
import re
import zlib
from collections.abc import Mapping
from typing import TYPE_CHECKING
from xml.sax.saxutils import quoteattr

import numpy as np

from ..errors import FormatError
from .content import Array, Content, check_vertices, refuse_cells
from .spatial import plane_fields, spatial, spatial_tensor, take_metric
from .vtu_arrays import TYPES, VtuArrays

if TYPE_CHECKING:
    from xml.etree.ElementTree import Element

_VERTICES, _LINE, _TRIANGLE = (1, 2), 3, 5
_KINDS = {
    4: "polylines", 6: "triangle strips", 7: "polygons", 8: "pixels", 9: "quadrilaterals",
    10: "tetrahedra", 11: "voxels", 12: "hexahedra", 13: "wedges", 14: "pyramids",
    21: "quadratic edges", 22: "quadratic triangles", 23: "quadratic quadrilaterals",
    42: "polyhedra",
}  # fmt: skip
_EDGE, _REGION, _COLUMNS = "edge_tags: ", "regions: ", "columns: "
_TYPE_NAMES = {dtype: name for name, dtype in TYPES.items()}


# ---------------------------------------------------------------------------------------- writing


def encode(content: Content) -> bytes:
    """The bytes of a `.vtu` file."""
    m, k = len(content.triangles), len(content.edges)
    point_data = {name: spatial(a) for name, a in content.point_fields.items()}
    if content.metric is not None:
        point_data["metric"] = spatial_tensor(content.metric)
    cell_data = {
        "regions": np.concatenate([content.regions, np.zeros(k, np.int32)]),
        "edge_tags": np.concatenate([np.zeros(m, np.int32), content.edge_tags]),
    }
    for name, values in content.triangle_fields.items():
        cell_data[name] = _padded(spatial(values), k)
    cells = {
        "connectivity": np.concatenate([content.triangles.ravel(), content.edges.ravel()]),
        "offsets": np.concatenate([3 * np.arange(1, m + 1), 3 * m + 2 * np.arange(1, k + 1)]),
        "types": np.repeat(np.array([_TRIANGLE, _LINE], np.uint8), [m, k]),
    }
    points = np.column_stack([content.points, np.zeros(len(content.points))])
    lines = [
        '<?xml version="1.0" encoding="utf-8"?>',
        '<VTKFile type="UnstructuredGrid" version="1.0" byte_order="LittleEndian" '
        'header_type="UInt64" compressor="vtkZLibDataCompressor">',
        "<UnstructuredGrid>",
        "<FieldData>",
        *_field_data(content),
        "</FieldData>",
        f'<Piece NumberOfPoints="{len(points)}" NumberOfCells="{m + k}">',
        *_section("PointData", point_data),
        *_section("CellData", cell_data),
        *_section("Points", {"Points": points}),
        *_section("Cells", cells),
        "</Piece>",
        "</UnstructuredGrid>",
        "</VTKFile>",
        "",
    ]
    return "\n".join(lines).encode()


def _padded(values: Array, count: int) -> Array:
    nothing = np.nan if values.dtype.kind == "f" else 0
    return np.concatenate([values, np.full((count, *values.shape[1:]), nothing, values.dtype)])


def _field_data(content: Content) -> list[str]:
    numbers = {
        **{f"{_EDGE}{_escaped(name)}": tag for name, tag in content.names.items()},
        **{f"{_REGION}{_escaped(name)}": tag for name, tag in content.region_names.items()},
        **{f"{_COLUMNS}{name}": 2 for name in plane_fields(content)},
    }
    return [
        _data_array(name, np.array([number], np.int32), 'NumberOfTuples="1" ')
        for name, number in numbers.items()
    ]


def _escaped(name: str) -> str:
    return re.sub(r"[%\"&<>\x00-\x1f\x7f]", lambda match: f"%{ord(match[0]):02X}", name)


def _unescaped(name: str) -> str:
    return re.sub(r"%([0-9A-F]{2})", lambda match: chr(int(match[1], 16)), name)


def _section(tag: str, arrays: Mapping[str, Array]) -> list[str]:
    return [f"<{tag}>", *(_data_array(name, a) for name, a in arrays.items()), f"</{tag}>"]


def _data_array(name: str, values: Array, extra: str = "") -> str:
    columns = values.shape[1] if values.ndim == 2 else 1
    return (
        f'<DataArray type="{_TYPE_NAMES[values.dtype.newbyteorder("=")]}" Name={quoteattr(name)} '
        f'NumberOfComponents="{columns}" {extra}format="binary">{_compressed(values)}</DataArray>'
    )


def _compressed(values: Array, block: int = 1 << 20) -> str:
    """Base64 of a header (blocks, size of a block, of the last, compressed sizes) and blocks."""
    data = values.astype(values.dtype.newbyteorder("<")).tobytes()
    parts = [zlib.compress(data[i : i + block], 1) for i in range(0, len(data), block)]
    header = np.array([len(parts), block, len(data) % block, *map(len, parts)], "<u8").tobytes()
    return (base64.b64encode(header) + base64.b64encode(b"".join(parts))).decode()


# ---------------------------------------------------------------------------------------- reading


def decode(data: bytes) -> Content:
    """What a `.vtu` file says."""
    root, arrays = _opened(data)
    grid = root.find("UnstructuredGrid")
    if grid is None:
        raise FormatError("has no <UnstructuredGrid>: the file is damaged or not a .vtu file")
    pieces = [_piece(piece, arrays) for piece in grid.findall("Piece")]
    if not pieces:
        raise FormatError("has no <Piece>: there is nothing to read")
    content = _joined(pieces)
    _take_names(content, grid, arrays)
    return content


def _opened(data: bytes) -> tuple[Element, VtuArrays]:
    """Root of the XML, and the reader of its arrays.

    Raw appended data makes the file invalid as XML, so it is cut out before parsing.
    """
    from xml.etree import ElementTree

    appended, encoding = b"", "base64"
    opening = re.search(rb"<AppendedData[^>]*>", data)
    if opening:
        start, stop = data.find(b"_", opening.end()), data.rfind(b"</AppendedData")
        if start < 0 or stop < start:
            raise FormatError("<AppendedData> is not closed: the file is cut short")
        appended = data[start + 1 : stop]
        encoding = "raw" if b"raw" in opening.group() else "base64"
        data = data[: opening.end()] + data[stop:]
    try:
        root = ElementTree.fromstring(data)
    except (ElementTree.ParseError, ValueError, LookupError) as error:
        raise FormatError(f"is cut short or not XML: {error}") from None
    if root.tag != "VTKFile" or root.get("type") != "UnstructuredGrid":
        what = root.get("type", f"<{root.tag}>")
        raise FormatError(f"holds {what}, not a VTK UnstructuredGrid; save it as one")
    return root, VtuArrays(root.attrib, appended, encoding)


def _piece(piece: Element, arrays: VtuArrays) -> Content:
    def section(tag: str) -> dict[str, Array]:
        found = piece.iterfind(f"{tag}/DataArray")
        return {a.get("Name", tag): arrays.read(a) for a in found}

    points = next(iter(section("Points").values()), np.empty((0, 3)))
    if points.ndim != 2 or points.shape[1] != 3:
        raise FormatError(f"<Points> has shape {points.shape}; three coordinates were expected")
    triangles, edges, is_triangle, is_edge = _cells(section("Cells"))
    _same_length("<Points>", len(points), "NumberOfPoints", piece)
    _same_length("<Cells>", len(is_edge), "NumberOfCells", piece)

    point_data, cell_data = section("PointData"), section("CellData")
    for name, values in point_data.items():
        _same_length(f"point array {name!r}", len(values), "NumberOfPoints", piece)
    for name, values in cell_data.items():
        _same_length(f"cell array {name!r}", len(values), "NumberOfCells", piece)
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
    )


def _same_length(what: str, length: int, attribute: str, piece: Element) -> None:
    if piece.get(attribute, "").strip() != str(length):
        raise FormatError(
            f"{what} has {length} entries, but the piece says {attribute}="
            f"{piece.get(attribute)!r}: the file is damaged"
        )


def _cells(cells: Mapping[str, Array]) -> tuple[Array, Array, Array, Array]:
    """Triangles, edges, and which cells are the ones and the others."""
    missing = [name for name in ("connectivity", "offsets", "types") if name not in cells]
    if missing:
        raise FormatError(f"<Cells> has no {missing[0]!r} array: the file is damaged")
    vertices, types = cells["connectivity"].ravel(), cells["types"].ravel()
    offsets = cells["offsets"].ravel().astype(np.int64)
    starts = np.concatenate([np.zeros(min(1, len(offsets)), np.int64), offsets[:-1]])
    sizes = offsets - starts
    if len(types) != len(offsets) or (sizes < 0).any() or sizes.sum() != len(vertices):
        raise FormatError("<Cells>: connectivity, offsets and types do not fit together")
    known = np.isin(types, [0, *_VERTICES, _LINE, _TRIANGLE])
    others, counts = np.unique(types[~known], return_counts=True)
    found = zip(others.tolist(), counts.tolist(), strict=True)
    refuse_cells({_KINDS.get(t, f"cells of VTK type {t}"): count for t, count in found})
    is_triangle, is_edge = types == _TRIANGLE, types == _LINE
    if (sizes[is_triangle] != 3).any() or (sizes[is_edge] != 2).any():
        raise FormatError("<Cells>: a triangle without 3 or a line without 2 vertices")
    vertices = vertices.astype(np.int64)
    triangles = vertices[starts[is_triangle, None] + np.arange(3)]
    edges = vertices[starts[is_edge, None] + np.arange(2)]
    return triangles, edges, is_triangle, is_edge


def _tags(cell_data: dict[str, Array], name: str, rows: Array) -> Array:
    """Take the integer array of that name; another kind of array is a field, the tags are 0."""
    values = cell_data.get(name)
    if values is None or values.ndim != 1 or values.dtype.kind not in "iu":
        return np.zeros(np.count_nonzero(rows), np.int32)
    del cell_data[name]
    return values[rows]


def _joined(pieces: list[Content]) -> Content:
    """One content of several pieces: vertices of later ones count on."""
    first = pieces[0]
    if len(pieces) == 1:
        return first
    for p in pieces:
        check_vertices("triangle", p.triangles, len(p.points))
        check_vertices("edge", p.edges, len(p.points))
    shifts = np.cumsum([0, *(len(p.points) for p in pieces[:-1])])
    metrics = [p.metric for p in pieces if p.metric is not None]
    if len(metrics) not in (0, len(pieces)):
        raise FormatError("array 'metric' is not alike in all pieces of the file")
    return Content(
        np.concatenate([p.points for p in pieces]),
        np.concatenate([p.triangles + s for p, s in zip(pieces, shifts, strict=True)]),
        np.concatenate([p.regions for p in pieces]),
        np.concatenate([p.edges + s for p, s in zip(pieces, shifts, strict=True)]),
        np.concatenate([p.edge_tags for p in pieces]),
        point_fields=_joined_fields([p.point_fields for p in pieces]),
        triangle_fields=_joined_fields([p.triangle_fields for p in pieces]),
        metric=np.concatenate(metrics) if metrics else None,
    )


def _joined_fields(pieces: list[dict[str, Array]]) -> dict[str, Array]:
    shapes = [{name: values.shape[1:] for name, values in piece.items()} for piece in pieces]
    for shape in shapes[1:]:
        differing = dict(set(shape.items()) ^ set(shapes[0].items()))
        if differing:
            raise FormatError(f"array {min(differing)!r} is not alike in all pieces of the file")
    return {name: np.concatenate([piece[name] for piece in pieces]) for name in pieces[0]}


def _take_names(content: Content, grid: Element, arrays: VtuArrays) -> None:
    two_columns = []
    for element in grid.iterfind("FieldData/DataArray"):
        name = element.get("Name", "")
        prefix = next((p for p in (_EDGE, _REGION, _COLUMNS) if name.startswith(p)), None)
        if prefix is None:
            continue
        number, name = arrays.read(element), name.removeprefix(prefix)
        if number.shape != (1,) or number.dtype.kind not in "iu":
            raise FormatError(f"FieldData {prefix}{name!r} is not one integer")
        if prefix == _COLUMNS:
            two_columns.append(name)
        else:
            names = content.names if prefix == _EDGE else content.region_names
            names[_unescaped(name)] = int(number[0])
    for fields in (content.point_fields, content.triangle_fields):
        for name in two_columns:
            if name in fields and fields[name].ndim == 2:
                fields[name] = fields[name][:, :2]
