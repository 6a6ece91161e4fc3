"""Gmsh meshes, `.msh`: what its versions share, and which version it is; 2.2 and 4.1 are written.

Names are physical groups: edge tags physical curves, regions physical surfaces; tag 0 is in no
group. A field is a `$NodeData` or `$ElementData` view; one with 2 columns is written with a third
of zeros, the metric as the 9-component tensor view ``metric``. Nodes and elements come out in the
order of their tags, so a mesh written and read keeps its numbering.

What Gmsh cannot say goes into a section of our own, which Gmsh skips::

    $Adaptmesh
    {"edges": {"say \\"hi\\"": 3}, "regions": {}, "plane_fields": ["u"]}
    $EndAdaptmesh

`edges` and `regions` are there only if `$PhysicalNames` cannot hold the names as they are (with a
quote, a $ or a line break, longer than 127 bytes, two for one tag, or for tag 0), and then stand in
its place; Gmsh shows them with ' for a quote and blanks.

When Gmsh saves a mesh again, it leaves out what is in no group as soon as there is any group; give
every region a tag, or set its option `Mesh.SaveAll`.

meshio (5.3.5) is not used here: for 4.1 it writes only physical groups of entities that own a
node, and groups the nodes by entity without putting them back into order when it reads; it reads
binary data only for all nodes in a row; and it takes corrupt counts at their word.
"""

from __future__ import annotations

import json
import re
import warnings
from collections.abc import Callable, Iterator, Mapping

import numpy as np

from adaptmesh.errors import FormatError, FormatWarning
from adaptmesh.files.bounded import Allowance, read_json, whole_number
from adaptmesh.files.located import located
from adaptmesh.files.records import BinaryCursor, Cursor, TextCursor, table
from adaptmesh.files.whole import text_of
from adaptmesh.mesh.incoming import Content
from adaptmesh.mesh.periodic_sides import checked_rows
from adaptmesh.types import Array

from . import gmsh22, gmsh41, gmsh_old
from .gmsh4 import READERS_4_0, READERS_4_1
from .gmsh_groups import in_several, name_several
from .gmsh_sections import DIMENSION_OF_TYPE, Elements, Sections, section
from .spatial import plane_fields, shaped, shapes, spatial, spatial_tensor, take_metric

_VERSIONS_4_0 = ("4", "4.0")
_VERSIONS = ("2", "2.0", "2.1", "2.2", "3", "3.0", "3.1", *_VERSIONS_4_0, "4.1")
_LONGEST_NAME = 127


# ---------------------------------------------------------------------------------------- reading


def decode(data: bytes) -> Content:
    """What a `.msh` file of Gmsh says, of any version, text or binary."""
    sections = list(_sections(data))
    version, order = "1", None
    if sections and sections[0][0] == "MeshFormat":
        version, order = _version(sections.pop(0)[1])
    elif not sections or sections[0][0] != "NOD":
        raise FormatError("does not start with $MeshFormat: it is damaged or not a Gmsh file")
    readers = _readers(version)
    out = Sections(Allowance(len(data)))
    for name, body in sections:
        with located(f"${name}"):
            if name in readers:
                cursor = _cursor(body, order)
                readers[name](cursor, out)
                if cursor.left_over():
                    raise FormatError("holds more than its counts say: the file is damaged")
            elif name in _TEXT_READERS:
                _TEXT_READERS[name](body, out)
            elif name in ("NodeData", "ElementData"):
                _read_view(body, order, out.node_data if name == "NodeData" else out.element_data)
            elif name == "PartitionedEntities":
                raise FormatError("the mesh is partitioned; save it whole")
            elif name == "Periodic":
                warnings.warn(
                    "periodic boundaries of Gmsh are passed over; declare them on the domain, "
                    "mesh.to_domain().with_periodic(first, second)",
                    FormatWarning,
                    stacklevel=5,
                )
    return _together(out)


def _sections(data: bytes) -> Iterator[tuple[str, bytes]]:
    """Name and body of each ``$Name ... $EndName``; between them only blanks."""
    at, end_of_file = 0, len(data.rstrip())
    while at < end_of_file:
        opening = re.compile(rb"\s*\$(\w+)[ \t\r]*\n").match(data, at)
        if not opening:
            raise FormatError(f"expected a section $Name, got {data[at : at + 24]!r}")
        name = opening.group(1)
        closing = (b"$END" if name in (b"NOD", b"ELM") else b"$End") + name
        end = data.find(closing, opening.end())
        if end < 0:
            raise FormatError(f"${name.decode()} has no {closing.decode()}: the file is cut short")
        yield name.decode(), data[opening.end() : end]
        at = end + len(closing)


def _readers(version: str) -> Mapping[str, Callable[[Cursor, Sections], None]]:
    """The readers of the sections of a version, by name."""
    by_version = {"1": gmsh_old.READERS_1, "3": gmsh_old.READERS_3, "4": READERS_4_1}
    return READERS_4_0 if version in _VERSIONS_4_0 else by_version.get(version[0], gmsh22.READERS)


def _cursor(body: bytes, order: str | None) -> TextCursor | BinaryCursor:
    return TextCursor(body) if order is None else BinaryCursor(body, order)


def _version(body: bytes) -> tuple[str, str | None]:
    """Version, and byte order of a binary file."""
    line, _, rest = body.partition(b"\n")
    words = line.decode("ascii", "replace").split()
    if len(words) != 3 or words[1] not in ("0", "1"):
        raise FormatError(f"$MeshFormat: {line!r} is not a version, a type and a size")
    if words[0] not in _VERSIONS:
        raise FormatError(
            f"is of Gmsh version {words[0]}; 1, 2 to 2.2, 3, 4.0 and 4.1 can be read: "
            "`gmsh in.msh -save -format msh41 -o out.msh` converts it"
        )
    if words[2] != "8":
        raise FormatError(f"$MeshFormat: numbers of {words[2]} bytes; only 8 can be read")
    if words[1] == "0":
        return words[0], None
    orders = {b"\x01\0\0\0": "<", b"\0\0\0\x01": ">"}
    if rest[:4] not in orders:
        raise FormatError("$MeshFormat: the binary 1 that tells the byte order is damaged")
    return words[0], orders[rest[:4]]


def _read_names(body: bytes, out: Sections) -> None:
    lines = [line for line in text_of(body).splitlines() if line.strip()]
    pattern = re.compile(r'\s*(?:([0-9]{1,9})\s+)?(-?[0-9]{1,18})\s+"(.*)"\s*$')
    rows = [pattern.match(line) for line in lines[1:]]
    if not lines or lines[0].strip() != str(len(rows)):
        raise FormatError(f"its first line is not the number of names that follow, {len(rows)}")
    for row, line in zip(rows, lines[1:], strict=True):
        if row is None:
            raise FormatError(f'{line!r} is not: dimension, tag, "name"')
        for dim in (1, 2) if row[1] is None else (int(row[1]),):  # version 2.0 does not say it
            out.names.setdefault(dim, {})[row[3]] = int(row[2])


def _read_ours(body: bytes, out: Sections) -> None:
    ours = read_json(text_of(body))
    names = [ours.get("edges", {}), ours.get("regions", {})] if isinstance(ours, dict) else [None]
    for group in names:
        if not isinstance(group, dict) or not all(type(tag) is int for tag in group.values()):
            raise FormatError("is not what adaptmesh writes: the file is damaged")
    out.ours = ours


_TEXT_READERS = {"PhysicalNames": _read_names, "Adaptmesh": _read_ours}


def _read_view(body: bytes, order: str | None, views: dict[str, tuple[Array, Array]]) -> None:
    """One view: its header of strings, reals and integers in lines, then tag and values by row.

    Of several time steps of one name the last in the file is kept.
    """
    at = 0

    def line() -> bytes:
        nonlocal at
        start, stop = at, body.find(b"\n", at)
        if stop < 0:
            raise FormatError("cut short within its header")
        at = stop + 1
        return body[start:stop]

    strings, _, integers = [[line() for _ in range(whole_number(line()))] for _ in range(3)]
    if not strings or len(integers) < 3:
        raise FormatError("its header lacks the name, the components or the count of values")
    columns, count = whole_number(integers[1]), whole_number(integers[2])
    if columns < 1:
        raise FormatError("a view with no components")
    cursor = _cursor(body[at:], order)
    tags_of_rows, values = cursor.rows(count, ("i4", 1), ("f8", columns))
    if cursor.left_over():
        raise FormatError("holds more than its counts say: the file is damaged")
    views[text_of(strings[0]).strip().strip('"')] = tags_of_rows[:, 0], values


def _together(file: Sections) -> Content:
    order = np.argsort(file.node_tags, kind="stable")
    node_tags = file.node_tags[order]
    _refuse_twice("node", node_tags)
    (triangles, inside), (edges, on_edges) = (_cells(file, dim, node_tags) for dim in (2, 1))
    plane = file.ours.get("plane_fields", [])
    of_shape = file.ours.get("shapes", {})

    def field_of(name: str, view: tuple[Array, Array], tags: Array) -> Array:
        # A view may have one row of many columns, and the field has a row for each node.
        file.allowance.take(len(tags) * view[1].shape[1], 8)
        values = _field(name, view, tags, plane)
        return shaped(values, of_shape.get(name)) if isinstance(of_shape, dict) else values

    point_fields = {name: field_of(name, view, node_tags) for name, view in file.node_data.items()}
    content = Content(
        file.points[order],
        triangles.nodes,
        triangles.physical,
        edges.nodes,
        edges.physical,
        names=file.ours.get("edges", file.names.get(1, {})),
        region_names=file.ours.get("regions", file.names.get(2, {})),
        metric=take_metric(point_fields),
        point_fields=point_fields,
        triangle_fields={
            name: field_of(name, view, triangles.tags)
            for name, view in file.element_data.items()
            if np.isin(view[0], triangles.tags).any()
        },
    )
    content.periodic = checked_rows(file.ours.get("periodic", []))
    name_several(file, 1, content.edge_tags, content.names)
    name_several(file, 2, content.regions, content.region_names)
    content.others = np.concatenate([inside, on_edges])
    return content


def _cells(file: Sections, dim: int, node_tags: Array) -> tuple[Elements, Array]:
    """Edges or triangles in the order of their tags, and nodes of them that are no corners."""
    parts = [e for kind, e in file.elements.items() if DIMENSION_OF_TYPE[kind] == dim]
    nothing = np.empty(0, np.int64)
    tags = np.concatenate([nothing, *(e.tags for e in parts)])
    corners = np.concatenate(
        [np.empty((0, dim + 1), np.int64), *(e.nodes[:, : dim + 1] for e in parts)]
    )
    physical = np.concatenate([nothing, *(e.physical for e in parts)])
    others = [
        _numbers(e.nodes[:, dim + 1 :], node_tags, e.tags).ravel()
        for e in parts
        if e.nodes.shape[1] > dim + 1
    ]
    by_tag = np.argsort(tags, kind="stable")
    nodes = _numbers(corners[by_tag], node_tags, tags[by_tag])
    cells = in_several(file, dim, Elements(tags[by_tag], nodes, physical[by_tag]))
    return cells, np.concatenate([nothing, *others])


def _refuse_twice(kind: str, sorted_tags: Array) -> None:
    again = np.flatnonzero(sorted_tags[1:] == sorted_tags[:-1])
    if len(again):
        raise FormatError(f"{kind} {sorted_tags[again[0]]} is there twice")


def _numbers(nodes: Array, node_tags: Array, element_tags: Array) -> Array:
    """Row of each node tag in the sorted tags."""
    rows = np.searchsorted(node_tags, nodes)
    known = rows < len(node_tags)
    known[known] = node_tags[rows[known]] == nodes[known]
    missing = np.argwhere(~known)
    if len(missing):
        i, j = missing[0]
        raise FormatError(
            f"element {element_tags[i]} has the node {nodes[i, j]}, which is not in $Nodes"
        )
    return rows


def _field(name: str, view: tuple[Array, Array], tags: Array, plane: object) -> Array:
    """Values in the order of the sorted `tags`; NaN where the view has none."""
    rows = np.searchsorted(tags, view[0])
    known = rows < len(tags)
    known[known] = tags[rows[known]] == view[0][known]
    out = np.full((len(tags), view[1].shape[1]), np.nan)
    out[rows[known]] = view[1][known]
    if isinstance(plane, list) and name in plane:
        out = out[:, :2]
    return out[:, 0] if out.shape[1] == 1 else out


# ---------------------------------------------------------------------------------------- writing


def encode(content: Content, *, version: str = "4.1", binary: bool = True) -> bytes:
    """The bytes of a `.msh` file."""
    writers = {"4.1": gmsh41.body, "2.2": gmsh22.body}
    if version not in writers:
        raise FormatError(f"there is no version {version!r} to write; choose '4.1' or '2.2'")
    for kind, tags in (("edge tag", content.edge_tags), ("region", content.regions)):
        if len(tags) and tags.min() < 0:
            raise FormatError(
                f"{kind} {tags.min()} is negative, but physical groups of Gmsh are numbered from 1 "
                "(0: in none); renumber it"
            )
    parts = [section("MeshFormat", f"{version} {int(binary)} 8\n".encode() + _one(binary))]
    parts += _names_sections(content)
    sections, nodes, triangles = writers[version](content, binary)
    parts += sections
    for name, values in content.point_fields.items():
        parts.append(section("NodeData", _view(name, values, nodes, binary), binary))
    if content.metric is not None:
        tensor = spatial_tensor(content.metric)
        parts.append(section("NodeData", _view("metric", tensor, nodes, binary), binary))
    for name, values in content.triangle_fields.items():
        parts.append(section("ElementData", _view(name, values, triangles, binary), binary))
    return b"".join(parts)


def _one(binary: bool) -> bytes:
    return b"\x01\0\0\0\n" if binary else b""


def _names_sections(content: Content) -> list[bytes]:
    lines: list[str] = []
    ours: dict[str, object] = {}
    for dim, key, names in ((1, "edges", content.names), (2, "regions", content.region_names)):
        shown = {tag: _shown(name) for name, tag in reversed(names.items()) if tag > 0}
        lines += [f'{dim} {tag} "{name}"\n' for tag, name in sorted(shown.items())]
        if {name: tag for tag, name in shown.items()} != names:
            ours[key] = dict(names)
    plane, of_shape = plane_fields(content), shapes(content)
    if plane:
        ours["plane_fields"] = plane
    if of_shape:
        ours["shapes"] = of_shape
    if content.periodic:
        ours["periodic"] = content.periodic
    parts = []
    if lines:
        parts.append(section("PhysicalNames", f"{len(lines)}\n{''.join(lines)}".encode()))
    if ours:
        parts.append(section("Adaptmesh", _json(ours)))
    return parts


def _shown(name: str) -> str:
    """The name as far as `$PhysicalNames` can hold it."""
    plain = "".join(c if c.isprintable() else " " for c in name.replace('"', "'"))
    return plain.replace("$", " ").encode()[:_LONGEST_NAME].decode(errors="ignore").strip()


def _json(ours: Mapping[str, object]) -> bytes:
    return (json.dumps(ours).replace("$", "\\u0024") + "\n").encode()


def _view(name: str, values: Array, order: Array, binary: bool) -> bytes:
    """A view, row by row in the order in which the file has the nodes or elements.

    Each row has its tag, so Gmsh takes any order; but meshio does not look at the tags.
    """
    rows = _of_gmsh(name, spatial(values.reshape(len(values), -1)[order]))
    header = f'1\n"{name}"\n1\n0\n3\n0\n{rows.shape[1]}\n{len(rows)}\n'.encode()
    return header + table(binary, ("i4", order + 1), ("f8", rows))


def _of_gmsh(name: str, rows: Array) -> Array:
    """Rows of 1, 3 or 9 columns, which Gmsh reads, with zeros behind others."""
    width = next((w for w in (1, 3, 9) if w >= rows.shape[1]), None)
    if width is None:
        raise FormatError(
            f"field {name!r} has {rows.shape[1]} values at each place; .msh holds at most 9: split "
            "it, or write .vtu"
        )
    return np.pad(rows, [(0, 0), (0, width - rows.shape[1])])
