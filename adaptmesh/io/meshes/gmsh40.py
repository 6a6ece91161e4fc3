"""The sections of Gmsh's version 4.0 that hold the mesh; read, not written.

As 4.1, but for the order of a few numbers::

    $Entities    points have a box, too
    $Nodes       blocks by entity:  entity dim parametric count, then tag and coordinates by row
    $Elements    blocks by entity:  entity dim type count, (tag, vertices) by row

Tags are of 32 bits. Source: Gmsh reference manual of version 4.0, "MSH file format".
"""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

from adaptmesh.errors import FormatError
from adaptmesh.files.records import Cursor, one

from .gmsh_sections import NODES_OF_TYPE, Elements, Sections, refuse_element_types


def _read_entities(cursor: Cursor, out: Sections) -> None:
    counts = cursor.rows(1, ("u8", 4))[0][0]
    for dim, count in enumerate(counts.tolist()):
        for _ in range(count):
            tag, _ = cursor.rows(1, ("i4", 1), ("f8", 6))
            groups = cursor.rows(one(cursor, "u8"), ("i4", 1))[0]
            out.groups[dim, int(tag[0, 0])] = [abs(g) for g in groups[:, 0].tolist()]
            if dim > 0:
                cursor.rows(one(cursor, "u8"), ("i4", 1))


def _read_nodes(cursor: Cursor, out: Sections) -> None:
    blocks, count = cursor.rows(1, ("u8", 2))[0][0].tolist()
    tags, points = [out.node_tags], [out.points]
    for _ in range(blocks):
        _, dim, parametric = cursor.rows(1, ("i4", 3))[0][0].tolist()
        extra = dim if parametric == 1 and 0 <= dim <= 3 else 0
        found, xyz = cursor.rows(one(cursor, "u8"), ("i4", 1), ("f8", 3 + extra))
        tags.append(found[:, 0])
        points.append(xyz[:, :3])
    out.node_tags, out.points = np.concatenate(tags), np.concatenate(points)
    if len(out.points) != count:
        raise FormatError(f"{count} nodes are announced, {len(out.points)} are there")


def _read_elements(cursor: Cursor, out: Sections) -> None:
    blocks, count = cursor.rows(1, ("u8", 2))[0][0].tolist()
    found: dict[int, list[Elements]] = {}
    done = 0
    for _ in range(blocks):
        entity, dim, kind = cursor.rows(1, ("i4", 3))[0][0].tolist()
        size = one(cursor, "u8")
        refuse_element_types({kind: size})
        if not size:
            continue
        rows = cursor.rows(size, ("i4", 1 + NODES_OF_TYPE[kind]))[0]
        group = np.full(size, out.group_of(dim, entity) if kind != 15 else 0)
        found.setdefault(kind, []).append(Elements(rows[:, 0], rows[:, 1:], group))
        done += size
    if done != count:
        raise FormatError(f"{count} elements are announced, {done} are there")
    for kind, parts in found.items():
        out.add(kind, parts)


READERS: dict[str, Callable[[Cursor, Sections], None]] = {
    "Entities": _read_entities,
    "Nodes": _read_nodes,
    "Elements": _read_elements,
}
