"""The sections of Gmsh's version 2.2 that hold the mesh: nodes and elements.

    $Nodes       count, then tag x y z by row
    $Elements    count, then in text      tag type tags [physical entity ...] vertices  by row,
                             in binary    type count tags, then  tag [physical ...] vertices

Source: Gmsh reference manual, "MSH file format version 2 (Legacy)".
"""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

from adaptmesh.errors import FormatError
from adaptmesh.files.bounded import whole_number
from adaptmesh.files.records import BinaryCursor, Cursor, TextCursor, one, table
from adaptmesh.mesh.incoming import Content
from adaptmesh.types import Array

from .gmsh_sections import NODES_OF_TYPE, Elements, Sections, refuse_element_types, section

_MOST_TAGS = 1000


# ---------------------------------------------------------------------------------------- reading


def _read_nodes(cursor: Cursor, out: Sections) -> None:
    tags, out.points = cursor.rows(_count(cursor), ("i4", 1), ("f8", 3))
    out.node_tags = tags[:, 0]


def _read_elements(cursor: Cursor, out: Sections) -> None:
    count = _count(cursor)
    blocks = _text_blocks(cursor, count) if isinstance(cursor, TextCursor) else None
    found: dict[int, list[Elements]] = {}
    for kind, tag_count, rows in blocks or _binary_blocks(cursor, count):
        physical = np.abs(rows[:, 1]) if tag_count else np.zeros(len(rows), np.int64)
        found.setdefault(kind, []).append(Elements(rows[:, 0], rows[:, 1 + tag_count :], physical))
    for kind, parts in found.items():
        out.add(kind, parts)


def _count(cursor: Cursor) -> int:
    """The count is a line of text in binary files too."""
    if isinstance(cursor, BinaryCursor):
        line, _, _ = cursor.data[cursor.at : cursor.at + 32].partition(b"\n")
        cursor.at += len(line) + 1
        return whole_number(line)
    return one(cursor)


def _text_blocks(cursor: TextCursor, count: int) -> list[tuple[int, int, Array]]:
    """Rows (tag, tags, vertices) by type and number of tags; rows of a text differ in length."""
    words = cursor.rest("i4")
    starts: dict[tuple[int, int], list[int]] = {}
    at, end = 0, len(words)
    numbers = words.tolist()
    for _ in range(count):
        if at + 3 > end:
            raise FormatError(f"cut short: {count} elements are announced")
        kind, tag_count = numbers[at + 1], numbers[at + 2]
        if kind not in NODES_OF_TYPE:
            refuse_element_types({kind: 1})
        if not 0 <= tag_count <= _MOST_TAGS:
            raise FormatError(f"element {numbers[at]} with {tag_count} tags: the file is damaged")
        starts.setdefault((kind, tag_count), []).append(at)
        at += 3 + tag_count + NODES_OF_TYPE[kind]
    if at != end:
        raise FormatError(f"{count} elements of {at} numbers are announced, there are {end}")
    out = []
    for (kind, tag_count), rows in starts.items():
        columns = [0, *range(3, 3 + tag_count + NODES_OF_TYPE[kind])]
        out.append((kind, tag_count, words[np.add.outer(rows, columns)]))
    return out


def _binary_blocks(cursor: Cursor, count: int) -> list[tuple[int, int, Array]]:
    out, done = [], 0
    while done < count:
        kind, size, tag_count = cursor.rows(1, ("i4", 3))[0][0].tolist()
        refuse_element_types({kind: size})
        if size < 1 or not 0 <= tag_count <= _MOST_TAGS:
            raise FormatError(f"a block of {size} elements with {tag_count} tags: it is damaged")
        rows = cursor.rows(size, ("i4", 1 + tag_count + NODES_OF_TYPE[kind]))[0]
        out.append((kind, tag_count, rows))
        done += size
    if done != count:
        raise FormatError(f"{count} elements are announced, {done} are there")
    return out


READERS: dict[str, Callable[[Cursor, Sections], None]] = {
    "Nodes": _read_nodes,
    "Elements": _read_elements,
}


# ---------------------------------------------------------------------------------------- writing


def body(content: Content, binary: bool) -> tuple[list[bytes], Array, Array]:
    """The sections `$Nodes` and `$Elements`, and the orders of nodes and triangles in them.

    The entity of an element is its tag plus one.
    """
    n, m, k = len(content.points), len(content.triangles), len(content.edges)
    points = np.column_stack([content.points, np.zeros(n)])
    nodes = b"%d\n" % n + table(binary, ("i4", np.arange(1, n + 1)), ("f8", points))
    elements = b"%d\n" % (m + k)
    for kind, cells, physical, first in (
        (2, content.triangles, content.regions, 1),
        (1, content.edges, content.edge_tags, m + 1),
    ):
        tags = np.arange(first, first + len(cells))
        groups = np.column_stack([physical, physical.astype(np.int64) + 1])
        if binary and len(cells):
            elements += table(binary, ("i4", [[kind, len(cells), 2]]))
            elements += table(binary, ("i4", tags), ("i4", groups), ("i4", cells + 1))
        elif len(cells):
            types = np.broadcast_to([kind, 2], (len(cells), 2))
            columns = (tags, types, groups, cells + 1)
            elements += table(binary, *(("i4", column) for column in columns))
    sections = [section("Nodes", nodes, binary), section("Elements", elements, binary)]
    return sections, np.arange(n), np.arange(m)
