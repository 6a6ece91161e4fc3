"""The sections of Gmsh's versions 1 and 3, in text; read, not written. ::

    version 1   $NOD         count, then  tag x y z  by row
                $ELM         count, then  tag type group entity nodes vertices  by row

    version 3   $Entities    by dimension:  tag [bounds tag ...] groups group ...
                $Nodes       count, then  tag x y z entity [dim u v]  by row
                $Elements    count, then  tag type entity nodes vertices  by row

In version 3, an entity of a node other than 0 tells that its parameters follow.
"""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

from adaptmesh.errors import FormatError
from adaptmesh.files.records import BinaryCursor, Cursor, TextCursor, one
from adaptmesh.types import Array

from .gmsh_sections import (
    DIMENSION_OF_TYPE,
    NODES_OF_TYPE,
    Elements,
    Sections,
    refuse_element_types,
)


def _text(cursor: Cursor) -> TextCursor:
    if isinstance(cursor, BinaryCursor):
        raise FormatError("binary files of this version cannot be read; convert it with Gmsh")
    assert isinstance(cursor, TextCursor)
    return cursor


def _read_old_nodes(cursor: Cursor, out: Sections) -> None:
    tags, out.points = cursor.rows(one(cursor), ("i4", 1), ("f8", 3))
    out.node_tags = tags[:, 0]


def _read_old_elements(cursor: Cursor, out: Sections) -> None:
    def group_of(row: Array) -> int:
        return abs(int(row[2]))

    _read_rows(_text(cursor), out, 4, group_of)


def _read_entities(cursor: Cursor, out: Sections) -> None:
    counts = _text(cursor).rows(1, ("i8", 4))[0][0]
    for dim, count in enumerate(counts.tolist()):
        for _ in range(count):
            tag = one(cursor)
            if dim > 0:
                cursor.rows(one(cursor), ("i4", 1))
            groups = cursor.rows(one(cursor), ("i4", 1))[0]
            out.groups[dim, tag] = [abs(g) for g in groups[:, 0].tolist()]


def _read_nodes(cursor: Cursor, out: Sections) -> None:
    text = _text(cursor)
    tags, points = [], []
    for _ in range(one(text)):
        tag, xyz, entity = text.rows(1, ("i4", 1), ("f8", 3), ("i4", 1))
        if entity[0, 0]:
            dim = one(text)
            if not 0 <= dim <= 3:
                raise FormatError(f"node {tag[0, 0]} is on an entity of dimension {dim}")
            text.rows(1, ("f8", dim))
        tags.append(int(tag[0, 0]))
        points.append(xyz[0])
    out.node_tags = np.array(tags, np.int64)
    out.points = np.array(points, np.float64).reshape(-1, 3)


def _read_elements(cursor: Cursor, out: Sections) -> None:
    def group_of(row: Array) -> int:
        return out.group_of(DIMENSION_OF_TYPE[int(row[1])], int(row[2]))

    _read_rows(_text(cursor), out, 3, group_of)


def _read_rows(
    cursor: TextCursor, out: Sections, head: int, group_of: Callable[[Array], int]
) -> None:
    """Rows of tag, type, numbers up to `head`, the number of nodes, and the nodes."""
    found: dict[int, list[tuple[int, int, Array]]] = {}
    for _ in range(one(cursor)):
        row = cursor.rows(1, ("i8", head + 1))[0][0]
        kind, nodes = int(row[1]), int(row[head])
        refuse_element_types({kind: 1})
        if nodes != NODES_OF_TYPE[kind]:
            raise FormatError(f"element {row[0]} of type {kind} has {nodes} nodes: it is damaged")
        vertices = cursor.rows(1, ("i8", nodes))[0][0]
        group = 0 if kind == 15 else group_of(row)
        found.setdefault(kind, []).append((int(row[0]), group, vertices))
    for kind, rows in found.items():
        tags, groups, cells = zip(*rows, strict=True)
        out.add(kind, [Elements(np.array(tags), np.stack(cells), np.array(groups))])


READERS_1: dict[str, Callable[[Cursor, Sections], None]] = {
    "NOD": _read_old_nodes,
    "ELM": _read_old_elements,
}
READERS_3: dict[str, Callable[[Cursor, Sections], None]] = {
    "Entities": _read_entities,
    "Nodes": _read_nodes,
    "Elements": _read_elements,
}
