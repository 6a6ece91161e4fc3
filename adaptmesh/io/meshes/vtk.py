"""Legacy VTK files, `.vtk`: unstructured grids and polygons, text or binary. ::

    # vtk DataFile Version 3.0
    title
    BINARY                                     or ASCII; in binary files numbers are big-endian
    DATASET UNSTRUCTURED_GRID                  or POLYDATA
    FIELD FieldData 1                          arrays of neither points nor cells
    POINTS 4 double
    CELLS 2 8                                  cells, numbers: 3 0 1 2  3 0 2 3
    CELL_TYPES 2
    CELL_DATA 2                                then arrays: FIELD, SCALARS, VECTORS, ...
    POINT_DATA 4

From version 5 on CELLS is followed by OFFSETS and CONNECTIVITY. POLYDATA has VERTICES, LINES,
POLYGONS and TRIANGLE_STRIPS instead of CELLS. In names, blanks and other characters are %20 and the
like. What is in which array is told by `adaptmesh.io.meshes.vtk_grid`.

Version 3.0 is written, which all programs read. VTK's own reader is not used: it takes counts at
their word, and crashes on files that are cut short. Source of the format: "VTK File Formats",
<https://docs.vtk.org/en/latest/vtk_file_formats/vtk_legacy_file_format.html>.
"""

from __future__ import annotations

from urllib.parse import quote, unquote_to_bytes

import numpy as np

from adaptmesh.errors import FormatError
from adaptmesh.files.located import located
from adaptmesh.files.whole import text_of
from adaptmesh.mesh.incoming import Content
from adaptmesh.types import Array

from .counts import check_stated, stated
from .vtk_grid import Grid, content_of, grid_of, is_ours, take_names
from .vtk_legacy import LegacyFile

_TITLE = "by adaptmesh, counts "
_LONGEST_NAME = 255  # bytes, in VTK's own reader
_PLAIN = "".join(chr(c) for c in range(33, 127) if chr(c) not in '"%')
_POLYGONS = {
    "VERTICES": {1: 1}, "LINES": {2: 3}, "POLYGONS": {3: 5, 4: 9}, "TRIANGLE_STRIPS": {},
}  # fmt: skip
"""Sections of POLYDATA in the order of cell data, with VTK's numbers of cells by vertices."""
_LONGER = {"VERTICES": 2, "LINES": 4, "POLYGONS": 7, "TRIANGLE_STRIPS": 6}
_OF_THREE = {"VECTORS": 3, "NORMALS": 3, "TENSORS": 9, "TENSORS6": 6}
_OF_ONE = ("GLOBAL_IDS", "PEDIGREE_IDS", "EDGE_FLAGS")
_TYPE_NAMES = {
    "i1": "char", "u1": "unsigned_char", "i2": "short", "u2": "unsigned_short", "i4": "int",
    "u4": "unsigned_int", "i8": "vtktypeint64", "u8": "vtktypeuint64", "f4": "float",
    "f8": "double",
}  # fmt: skip


# ---------------------------------------------------------------------------------------- writing


def encode(content: Content, *, binary: bool = True) -> bytes:
    """The bytes of a `.vtk` file."""
    grid = grid_of(content)
    cells = np.insert(grid.connectivity, grid.offsets[:-1], np.diff(grid.offsets))
    n, m = len(grid.points), len(grid.types)

    def numbers(values: Array) -> bytes:
        if binary:
            return values.astype(values.dtype.newbyteorder(">")).tobytes() + b"\n"
        rows = values.reshape(len(values), -1).tolist()
        return "".join(" ".join(map(repr, row)) + "\n" for row in rows).encode()

    def arrays(head: str, of: dict[str, Array]) -> list[bytes]:
        out = [f"{head}FIELD FieldData {len(of)}\n".encode()] if of else []
        for name, values in of.items():
            columns = values.shape[1] if values.ndim == 2 else 1
            kind = _TYPE_NAMES[values.dtype.str[1:]]
            out.append(f"{_quoted(name)} {columns} {len(values)} {kind}\n".encode())
            out.append(numbers(values))
        return out

    return b"".join(
        [
            f"# vtk DataFile Version 3.0\n{_TITLE}{stated(content)}\n".encode(),
            b"BINARY\n" if binary else b"ASCII\n",
            b"DATASET UNSTRUCTURED_GRID\n",
            *arrays("", grid.fields),
            f"POINTS {n} double\n".encode(),
            numbers(grid.points),
            f"CELLS {m} {len(cells)}\n".encode(),
            numbers(cells.astype(np.int32)),
            f"CELL_TYPES {m}\n".encode(),
            numbers(grid.types.astype(np.int32)),
            *arrays(f"CELL_DATA {m}\n", grid.cell_data),
            *arrays(f"POINT_DATA {n}\n", grid.point_data),
        ]
    )


def _quoted(name: str) -> str:
    out = quote(name, safe=_PLAIN)
    if len(out) > _LONGEST_NAME:
        raise FormatError(
            f"the name {name[:40]!r}... takes {len(out)} bytes; .vtk holds at most "
            f"{_LONGEST_NAME}: shorten it, or write .vtu"
        )
    return out


# ---------------------------------------------------------------------------------------- reading


def decode(data: bytes) -> Content:
    """What a `.vtk` file says."""
    file = LegacyFile(data)
    kind = file.dataset
    if kind not in ("UNSTRUCTURED_GRID", "POLYDATA"):
        raise FormatError(f"holds {kind}, neither UNSTRUCTURED_GRID nor POLYDATA; save it as one")
    grid = _Reader(file).grid()
    content = content_of(grid)
    take_names(content, {name: a for name, a in grid.fields.items() if is_ours(name)})
    if file.title.startswith(_TITLE):
        check_stated(file.title.removeprefix(_TITLE), content)
    return content


class _Reader:
    """Walks over the sections, and keeps what they say."""

    def __init__(self, file: LegacyFile) -> None:
        self._file = file
        self._points = np.empty((0, 3))
        self._cells: dict[str, tuple[Array, Array]] = {}  # vertices and offsets, by section
        self._types = np.empty(0, np.int64)
        self._arrays: dict[str, dict[str, Array]] = {"": {}, "POINT_DATA": {}, "CELL_DATA": {}}
        self._counts = {"POINT_DATA": 0, "CELL_DATA": 0}
        self._place = ""  # what the next arrays belong to

    def grid(self) -> Grid:
        while (words := self._file.line()) is not None:
            keyword = words[0].upper()
            with located(keyword):
                self._take(keyword, words)
        if self._place and not self._arrays[self._place]:
            raise FormatError(f"ends after {self._place} without an array: is it complete?")
        sections = [self._cells.get(s) for s in ("CELLS", *_POLYGONS)]
        cells = [c for c in sections if c is not None]
        ends = np.cumsum([0, *(len(vertices) for vertices, _ in cells)])
        offsets = [c[1][1:] + end for c, end in zip(cells, ends[:-1], strict=True)]
        grid = Grid(
            self._points,
            np.concatenate([np.empty(0, np.int64), *(vertices for vertices, _ in cells)]),
            np.concatenate([np.zeros(1, np.int64), *offsets]),
            self._types if "CELLS" in self._cells else self._polygon_types(),
            self._arrays["POINT_DATA"],
            self._arrays["CELL_DATA"],
            self._arrays[""],
        )
        for place, count in (("POINT_DATA", len(grid.points)), ("CELL_DATA", len(grid.types))):
            if self._arrays[place] and self._counts[place] != count:
                raise FormatError(f"{place} has {self._counts[place]} rows for {count} of them")
        return grid

    def _polygon_types(self) -> Array:
        out = [np.empty(0, np.int64)]
        for section, by_size in _POLYGONS.items():
            if section in self._cells:
                sizes = np.diff(self._cells[section][1]).tolist()
                out.append(np.array([by_size.get(s, _LONGER[section]) for s in sizes], np.int64))
        return np.concatenate(out)

    def _take(self, keyword: str, words: list[str]) -> None:
        file = self._file
        if keyword in self._counts:
            self._place, self._counts[keyword] = keyword, file.whole(words, 1)
        elif keyword == "POINTS":
            self._points = file.numbers(file.word(words, 2), file.whole(words, 1), 3)
        elif keyword == "CELLS" or keyword in _POLYGONS:
            self._cells[keyword] = self._read_cells(file.whole(words, 1), file.whole(words, 2))
        elif keyword == "CELL_TYPES":
            self._types = file.numbers("int", file.whole(words, 1))
        elif keyword == "METADATA":
            file.skip_block()
        elif keyword == "LOOKUP_TABLE":  # colours
            file.numbers("float" if file.is_text else "unsigned_char", file.whole(words, 2), 4)
        elif keyword == "FIELD":
            if self._cells and not self._place:
                raise FormatError("follows the cells: a line CELL_DATA or POINT_DATA is missing")
            for _ in range(file.whole(words, 2)):
                self._take_field()
        elif self._place:
            self._take_attribute(keyword, words)
        else:
            raise FormatError("is not known, or no keyword: a count may be wrong")

    def _read_cells(self, count: int, size: int) -> tuple[Array, Array]:
        """Vertices of cells one after the other, and where those of each begin."""
        file = self._file
        if file.has_next("OFFSETS"):  # version 5
            offsets = file.numbers(file.word(file.line(), 1), count)
            if not file.has_next("CONNECTIVITY"):
                raise FormatError("has OFFSETS without CONNECTIVITY")
            vertices = file.numbers(file.word(file.line(), 1), size)
            if not count:
                return vertices, np.zeros(1, np.int64)
            if offsets[0] != 0:
                raise FormatError(f"the first of OFFSETS is {offsets[0]}, not 0")
            return vertices, offsets
        numbers = file.numbers("int", size)
        heads, at, listed = [], 0, numbers.tolist()
        while at < size and listed[at] >= 0:
            heads.append(at)
            at += 1 + listed[at]
        if at != size or len(heads) != count:
            raise FormatError(f"{size} numbers are not those of {count} cells")
        sizes = numbers[heads]
        return np.delete(numbers, heads), np.concatenate([np.zeros(1, np.int64), np.cumsum(sizes)])

    def _take_field(self) -> None:
        file = self._file
        words = file.line()
        while words is not None and words[0].upper() == "METADATA":
            file.skip_block()
            words = file.line()
        columns, rows = file.whole(words, 1), file.whole(words, 2)
        kind = file.word(words, 3)
        if kind.lower() in ("string", "utf8_string"):
            file.skip_strings(columns * rows)
        else:
            self._keep(file.word(words, 0), file.numbers(kind, rows, columns))

    def _take_attribute(self, keyword: str, words: list[str]) -> None:
        file, rows = self._file, self._counts[self._place]
        name = file.word(words, 1)
        if keyword == "SCALARS":
            columns = file.whole(words, 3) if len(words) > 3 else 1
            if file.has_next("LOOKUP_TABLE"):
                file.line()
            self._keep(name, file.numbers(file.word(words, 2), rows, columns))
        elif keyword in _OF_THREE:
            self._keep(name, file.numbers(file.word(words, 2), rows, _OF_THREE[keyword]))
        elif keyword in _OF_ONE:
            self._keep(name, file.numbers(file.word(words, 2), rows))
        elif keyword == "TEXTURE_COORDINATES":
            self._keep(name, file.numbers(file.word(words, 3), rows, file.whole(words, 2)))
        elif keyword == "COLOR_SCALARS":
            kind = "float" if file.is_text else "unsigned_char"
            self._keep(name, file.numbers(kind, rows, file.whole(words, 2)))
        else:
            raise FormatError("is not known, or no keyword: a count may be wrong")

    def _keep(self, name: str, values: Array) -> None:
        full = text_of(unquote_to_bytes(name))
        self._arrays[self._place][full] = values
