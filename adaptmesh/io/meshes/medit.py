"""Medit meshes, `.mesh` (text) and `.meshb` (binary), also called Gamma Mesh Format.

The reference of a triangle is its region, that of an edge its tag, that of a vertex 0. Medit knows
no names, so they are put where its readers skip them:

    .mesh   comment lines        # adaptmesh counts {...}        see `adaptmesh.io.meshes.counts`
                                 # adaptmesh edge 3 "inlet"      (the name as a JSON string)
                                 # adaptmesh region 1 "steel"
                                 # adaptmesh periodic [["left", "right", [1, 0, 0, 1, 2, 0]]]
    .meshb  ReferenceStrings     libMeshb's keyword 199: keyword of the cells (5 edges,
                                 6 triangles), reference, name in 256 bytes of UTF-8

What every mesh has to keep is in RequiredVertices (which Corners are, too, when read) and
RequiredEdges; Ridges are edges that meet with an angle in space, and say nothing in the plane.
Fields are in files of their own, see `adaptmesh.io.meshes.sol`. Source of the formats: libMeshb 7,
<https://github.com/LoicMarechal/libMeshb>.

meshio (5.3.5) is not used here: it has no `.sol` files, knows neither names nor all keywords
(on an unknown one it gives up), and takes corrupt counts at their word.
"""

from __future__ import annotations

import json
import re
import warnings
from collections.abc import Mapping
from pathlib import Path

import numpy as np

from adaptmesh.errors import FormatError, FormatWarning
from adaptmesh.files.bounded import read_json
from adaptmesh.files.located import located
from adaptmesh.files.records import table
from adaptmesh.files.whole import read_bytes, text_of
from adaptmesh.mesh.incoming import Content, refuse_cells
from adaptmesh.mesh.periodic_sides import Rows, checked_rows
from adaptmesh.types import Array

from .counts import check_stated, stated
from .medit_keywords import (
    NUMBERS,
    OURS,
    Keyword,
    MeditFile,
    binary_file,
    count,
    dimension,
    opened,
    text_file,
)
from .sol import add_companions, encode_companions

# columns of integers, the last of which is the reference
_CELLS = {"Edges": 3, "Triangles": 4, "EdgesP2": 4, "TrianglesP2": 7}
_OTHER_CELLS = {
    "Quadrilaterals": 5, "Tetrahedra": 5, "Prisms": 7, "Pyramids": 6, "Hexahedra": 9,
    "Hexaedra": 9,
}  # fmt: skip
_REQUIRED = ("RequiredVertices", "RequiredEdges", "Corners")
_NAME_BYTES = 256
_PERIODIC = re.compile(r"^#[ \t]*adaptmesh periodic (\[.*\])[ \t]*$", re.MULTILINE)
_COUNTS = re.compile(r"^# adaptmesh counts (\{[^\n]{1,500}\})", re.MULTILINE)
_OURS = re.compile(r"#[ \t]*adaptmesh (edge|region)\b")
_COMMENT = re.compile(r'#[ \t]*adaptmesh (edge|region) (-?[0-9]{1,10}) (".*")[ \t]*')


def load(path: Path, fields: bool) -> Content:
    """What a mesh and, with `fields`, the solutions beside it say."""
    data = read_bytes(path)
    with located(path):
        content = decode(data, binary=path.suffix.lower() == ".meshb")
    if fields:
        add_companions(content, path)
    return content


def save(path: Path, content: Content) -> dict[Path, bytes]:
    """The bytes of a mesh and of its solutions."""
    binary = path.suffix.lower() == ".meshb"
    return {path: encode(content, binary=binary), **encode_companions(content, path)}


# ---------------------------------------------------------------------------------------- reading


def decode(data: bytes, *, binary: bool) -> Content:
    """What a `.mesh` or `.meshb` file says; its fields are in other files."""
    file = opened(data, binary=binary)
    names = {"edge": {}, "region": {}} if binary else _commented_names(text_of(data))
    dim, vertices, cells = 0, None, {}
    required = dict.fromkeys(_REQUIRED, np.empty(0, np.int64))
    while (keyword := file.next_keyword()) != "End":
        with located(keyword):
            if keyword == "Dimension":
                dim = dimension(file)
            elif keyword == "Vertices":
                if not dim:
                    raise FormatError("come before Dimension, the number of their coordinates")
                rows = file.cursor.rows(count(file), (file.real, dim), (file.integer, 1))
                vertices = rows[0]
            elif keyword in _CELLS or keyword in _OTHER_CELLS:
                width = _CELLS.get(keyword) or _OTHER_CELLS[keyword]
                cells[keyword] = file.cursor.rows(count(file), (file.integer, width))[0]
            elif keyword in _REQUIRED:
                required[keyword] = file.cursor.rows(count(file), (file.integer, 1))[0][:, 0] - 1
            elif keyword == "ReferenceStrings" and binary:
                _take_names(names, file)
            else:
                file.skip()
    if vertices is None:
        raise FormatError("has no Vertices")
    if file.lacks_end:
        _check_whole(cells)
    refuse_cells({name: len(cells[name]) for name in _OTHER_CELLS if name in cells})
    triangles, regions, inside = _of_any_order(cells, "Triangles", 3)
    edges, tags, on_edges = _of_any_order(cells, "Edges", 2)
    content = Content(
        vertices,
        triangles,
        regions,
        edges,
        tags,
        names=names["edge"],
        region_names=names["region"],
        required_points=np.union1d(required["RequiredVertices"], required["Corners"]),
        required_edges=required["RequiredEdges"],
        others=np.concatenate([inside, on_edges]),
        periodic=[] if binary else _commented_periodic(text_of(data)),
    )
    said = None if binary else _COUNTS.search(text_of(data))
    if said is not None:
        check_stated(said[1], content)
    return content


def _of_any_order(
    cells: Mapping[str, Array], kind: str, corners: int
) -> tuple[Array, Array, Array]:
    """Corners from 0 and references of cells, and all other nodes of those of second order."""
    linear = cells.get(kind, np.empty((0, _CELLS[kind]), np.int64))
    curved = cells.get(f"{kind}P2", np.empty((0, _CELLS[f"{kind}P2"]), np.int64))
    return (
        np.concatenate([linear[:, :corners], curved[:, :corners]]) - 1,
        np.concatenate([linear[:, -1], curved[:, -1]]),
        curved[:, corners:-1].ravel() - 1,
    )


def _commented_names(text: str) -> dict[str, dict[str, int]]:
    names: dict[str, dict[str, int]] = {"edge": {}, "region": {}}
    for line in text.split("\n") if "adaptmesh" in text else ():
        comment = line[line.find("#") :]
        if _OURS.match(comment):
            said = _COMMENT.fullmatch(comment)
            if said is None:
                raise FormatError(f"the name in the comment {comment[:80]!r} is damaged")
            names[said[1]][_unquoted(said[3])] = int(said[2])
    return names


def _check_whole(cells: Mapping[str, Array]) -> None:
    """A file without End is taken for whole if it has all that may be lost: edges and triangles."""
    if not any(k.startswith("Edges") for k in cells) or not any(
        k.startswith("Triangles") for k in cells
    ):
        raise FormatError(
            "has no End, and not both Edges and Triangles: it is cut short (if it is whole, add "
            "the line 'End')"
        )
    warnings.warn(
        "has no End; taken for whole, as it has Edges and Triangles", FormatWarning, stacklevel=7
    )


def _commented_periodic(text: str) -> Rows:
    found = _PERIODIC.search(text)
    return checked_rows(read_json(found[1])) if found else []


def _unquoted(quoted: str) -> str:
    try:
        return str(read_json(quoted))
    except FormatError:
        raise FormatError(f"the name {quoted[:80]!r} in a comment is damaged") from None


def _take_names(names: dict[str, dict[str, int]], file: MeditFile) -> None:
    kinds = {NUMBERS["Edges"]: "edge", NUMBERS["Triangles"]: "region"}
    rows = file.cursor.rows(count(file), (file.integer, 2), ("u1", _NAME_BYTES))
    for (keyword, tag), codes in zip(rows[0].tolist(), rows[1], strict=True):
        code = bytes(codes.astype(np.uint8)).partition(b"\0")[0]
        name = text_of(code)
        if keyword in kinds:
            names[kinds[keyword]][name] = tag


# ---------------------------------------------------------------------------------------- writing


def encode(content: Content, *, binary: bool) -> bytes:
    """The bytes of a `.mesh` or `.meshb` file, without the fields."""
    n = len(content.points)
    tables = [
        ("Vertices", [("f8", content.points), ("i4", np.zeros(n, np.int32))]),
        ("Edges", [("i4", content.edges + 1), ("i4", content.edge_tags)]),
        ("Triangles", [("i4", content.triangles + 1), ("i4", content.regions)]),
        ("RequiredVertices", [("i4", content.required_points[:, None] + 1)]),
        ("RequiredEdges", [("i4", content.required_edges[:, None] + 1)]),
    ]
    keywords: list[Keyword] = [
        (name, [len(columns[0][1])], table(binary, *columns))
        for name, columns in tables
        if len(columns[0][1])
    ]
    if binary:
        if content.names or content.region_names:
            keywords.insert(0, _reference_strings(content))
        return binary_file(keywords)
    return text_file(keywords, _comments(content))


def _comments(content: Content) -> str:
    rows = content.periodic
    periodic = f"# adaptmesh periodic {json.dumps(rows)}\n" if rows else ""
    return (
        OURS
        + f"# adaptmesh counts {stated(content, fields=False)}\n"
        + periodic
        + "".join(
            f"# adaptmesh {kind} {tag} {json.dumps(name, ensure_ascii=False)}\n"
            for kind, names in (("edge", content.names), ("region", content.region_names))
            for name, tag in names.items()
        )
    )


def _reference_strings(content: Content) -> Keyword:
    rows = []
    for keyword, names in (("Edges", content.names), ("Triangles", content.region_names)):
        for name, tag in names.items():
            code = name.encode()
            if len(code) >= _NAME_BYTES or b"\0" in code:
                raise FormatError(
                    f"the name {name[:40]!r}... has {len(code)} bytes; .meshb holds at most "
                    f"{_NAME_BYTES - 1}: shorten it, or write .mesh"
                )
            codes = np.frombuffer(code.ljust(_NAME_BYTES, b"\0"), np.uint8)
            rows.append(table(True, ("i4", [[NUMBERS[keyword], tag]]), ("u1", codes[None])))
    return "ReferenceStrings", [len(rows)], b"".join(rows)
