"""VTK XML unstructured grids, `.vtu`: what ParaView and pyvista open.

What is in which array is told by `vtk_grid.py`. meshio (5.3.5) is not used: it writes no
FieldData, and of a file with several pieces it reads only the cells of the last. Nor is the reader
of VTK (9.7): of 150 damaged copies of a file, 4 to 6 crashed the process or kept it busy for 8 to
20 s and up to 0.7 GB, whether arrays were text, base64 or compressed.
"""

from __future__ import annotations

import base64
import re
import warnings
import zlib
from collections.abc import Mapping
from typing import TYPE_CHECKING
from xml.sax.saxutils import quoteattr

import numpy as np

from adaptmesh.errors import FormatError, FormatWarning
from adaptmesh.files.bounded import Allowance, read_xml
from adaptmesh.mesh.incoming import Content, check_vertices
from adaptmesh.types import Array

from .counts import check_stated, stated
from .vtk_grid import Grid, content_of, grid_of, is_ours, take_names
from .vtu_arrays import TYPES, VtuArrays

if TYPE_CHECKING:
    from xml.etree.ElementTree import Element

_COUNTS = re.compile(rb"<!-- adaptmesh counts (\{[ -;=?-~]{1,500}\}) -->")
_HEAD = 1000  # bytes in which the counts are
_TYPE_NAMES = {dtype: name for name, dtype in TYPES.items()}


# ---------------------------------------------------------------------------------------- writing


def encode(content: Content) -> bytes:
    """The bytes of a `.vtu` file."""
    grid = grid_of(content)
    field_data = [
        _data_array(name, values, f'NumberOfTuples="{len(values)}" ')
        for name, values in grid.fields.items()
    ]
    cells = {
        "connectivity": grid.connectivity,
        "offsets": grid.offsets[1:],
        "types": grid.types,
    }
    lines = [
        '<?xml version="1.0" encoding="utf-8"?>',
        f"<!-- adaptmesh counts {stated(content)} -->",
        '<VTKFile type="UnstructuredGrid" version="1.0" byte_order="LittleEndian" '
        'header_type="UInt64" compressor="vtkZLibDataCompressor">',
        "<UnstructuredGrid>",
        "<FieldData>",
        *field_data,
        "</FieldData>",
        f'<Piece NumberOfPoints="{len(grid.points)}" NumberOfCells="{len(grid.types)}">',
        *_section("PointData", grid.point_data),
        *_section("CellData", grid.cell_data),
        *_section("Points", {"Points": grid.points}),
        *_section("Cells", cells),
        "</Piece>",
        "</UnstructuredGrid>",
        "</VTKFile>",
        "",
    ]
    return "\n".join(lines).encode()


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
    fields = {
        name: arrays.read(array)
        for array in grid.iterfind("FieldData/DataArray")
        if is_ours(name := array.get("Name", ""))
    }
    take_names(content, fields)
    said = _COUNTS.search(data, 0, _HEAD)
    if said is not None:
        check_stated(said[1].decode(), content)
    return content


def _opened(data: bytes) -> tuple[Element, VtuArrays]:
    """Root of the XML, and the reader of its arrays.

    Raw appended data makes the file invalid as XML, so it is cut out before parsing.
    """
    size = len(data)
    appended, encoding = b"", "base64"
    begin = data.find(b"<AppendedData")
    if begin >= 0:
        end = data.find(b">", begin) + 1
        start, stop = data.find(b"_", end), data.rfind(b"</AppendedData")
        if not end or start < 0 or stop < start:
            raise FormatError("<AppendedData> is not closed: the file is cut short")
        appended = data[start + 1 : stop]
        encoding = "raw" if b"raw" in data[begin:end] else "base64"
        data = data[:end] + data[stop:]
    root = read_xml(data)
    if root.tag != "VTKFile" or root.get("type") != "UnstructuredGrid":
        what = root.get("type", f"<{root.tag}>")
        raise FormatError(f"holds {what}, not a VTK UnstructuredGrid; save it as one")
    return root, VtuArrays(root.attrib, appended, encoding, Allowance(size))


def _piece(piece: Element, arrays: VtuArrays) -> Content:
    def section(tag: str) -> dict[str, Array]:
        found = piece.iterfind(f"{tag}/DataArray")
        return {a.get("Name", tag): arrays.read(a) for a in found if _has_numbers(a)}

    points = next(iter(section("Points").values()), np.empty((0, 3)))
    cells, point_data, cell_data = section("Cells"), section("PointData"), section("CellData")
    missing = [name for name in ("connectivity", "offsets", "types") if name not in cells]
    if missing:
        raise FormatError(f"<Cells> has no {missing[0]!r} array: the file is damaged")
    types = cells["types"].ravel()
    _same_length("<Points>", len(points), "NumberOfPoints", piece)
    _same_length("<Cells>", len(types), "NumberOfCells", piece)
    point_data = {name: _in_rows(values, len(points)) for name, values in point_data.items()}
    cell_data = {name: _in_rows(values, len(types)) for name, values in cell_data.items()}
    for name, values in point_data.items():
        _same_length(f"point array {name!r}", len(values), "NumberOfPoints", piece)
    for name, values in cell_data.items():
        _same_length(f"cell array {name!r}", len(values), "NumberOfCells", piece)
    ends = cells["offsets"].ravel().astype(np.int64)
    offsets = np.concatenate([[0], ends])
    return content_of(
        Grid(points, cells["connectivity"].ravel(), offsets, types, point_data, cell_data)
    )


def _in_rows(values: Array, count: int) -> Array:
    """A tensor field of meshio, which does not say how many components it has, in as many rows."""
    several = values.ndim == 1 and count > 0 and len(values) > count and len(values) % count == 0
    return values.reshape(count, -1) if several else values


def _has_numbers(array: Element) -> bool:
    """Whether an array holds numbers, not texts; a `FormatWarning` names one that does not."""
    kind = array.get("type", "")
    if kind in ("String", "Variant"):
        warnings.warn(
            f"array {array.get('Name')!r} is passed over: it holds values of type {kind}",
            FormatWarning,
            stacklevel=9,
        )
    return kind not in ("String", "Variant")


def _same_length(what: str, length: int, attribute: str, piece: Element) -> None:
    if piece.get(attribute, "").strip() != str(length):
        raise FormatError(
            f"{what} has {length} entries, but the piece says {attribute}="
            f"{piece.get(attribute)!r}: the file is damaged"
        )


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
        others=np.concatenate([p.others + s for p, s in zip(pieces, shifts, strict=True)]),
    )


def _joined_fields(pieces: list[dict[str, Array]]) -> dict[str, Array]:
    shapes = [{name: values.shape[1:] for name, values in piece.items()} for piece in pieces]
    for shape in shapes[1:]:
        differing = dict(set(shape.items()) ^ set(shapes[0].items()))
        if differing:
            raise FormatError(f"array {min(differing)!r} is not alike in all pieces of the file")
    return {name: np.concatenate([piece[name] for piece in pieces]) for name in pieces[0]}
