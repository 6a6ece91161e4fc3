"""The sections of Gmsh's version 4.1 that hold the mesh, to be written; `gmsh4` reads them.

We write one curve entity for each edge tag, one surface entity for each region, and no bounding
entities: we do not know them.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from adaptmesh.files.records import table
from adaptmesh.mesh.incoming import Content
from adaptmesh.types import Array

from .gmsh_sections import section


class Entity(NamedTuple):
    """A curve or surface: its number (from 1), physical group (0: none), rows of its cells."""

    number: int
    group: int
    rows: Array


def body(content: Content, binary: bool) -> tuple[list[bytes], Array, Array]:
    """The three sections, and the orders in which they have the nodes and triangles."""
    curves, surfaces = _entities(content.edge_tags), _entities(content.regions)
    blocks = _node_blocks(content, curves, surfaces)
    sections = [
        section("Entities", _entity_rows(content, curves, surfaces, binary), binary),
        section("Nodes", _node_rows(content.points, blocks, binary), binary),
        section("Elements", _element_rows(content, curves, surfaces, binary), binary),
    ]
    nodes = np.concatenate([rows for *_, rows in blocks])
    return sections, nodes, np.concatenate([s.rows for s in surfaces])


def _entities(tags: Array) -> list[Entity]:
    return [
        Entity(number, int(tag), np.flatnonzero(tags == tag))
        for number, tag in enumerate(np.unique(tags), start=1)
    ]


def _entity_rows(
    content: Content, curves: list[Entity], surfaces: list[Entity], binary: bool
) -> bytes:
    parts = [table(binary, ("u8", [[0, len(curves), len(surfaces), 0]]))]
    for cells, entities in ((content.edges, curves), (content.triangles, surfaces)):
        for number, group, rows in entities:
            corners = content.points[cells[rows].ravel()]
            box = [*corners.min(axis=0), 0.0, *corners.max(axis=0), 0.0]
            groups = [group] if group else []
            parts.append(
                table(
                    binary,
                    ("i4", [number]),
                    ("f8", [box]),
                    ("u8", [len(groups)]),
                    ("i4", np.array([groups], dtype=np.int32)),
                    ("u8", [0]),
                )
            )
    return b"".join(parts)


def _node_blocks(
    content: Content, curves: list[Entity], surfaces: list[Entity]
) -> list[tuple[int, int, Array]]:
    """(dimension, entity, nodes): a node is on the first of its curves, else of its surfaces."""
    owner = np.full((len(content.points), 2), [2, 1])
    for dim, cells, entities in ((2, content.triangles, surfaces), (1, content.edges, curves)):
        for entity in reversed(entities):
            owner[cells[entity.rows].ravel()] = dim, entity.number
    kinds, block_of = np.unique(owner, axis=0, return_inverse=True)
    return [
        (dim, number, np.flatnonzero(block_of.ravel() == block))
        for block, (dim, number) in enumerate(kinds.tolist())
    ]


def _node_rows(points: Array, blocks: list[tuple[int, int, Array]], binary: bool) -> bytes:
    n = len(points)
    spatial = np.column_stack([points, np.zeros(n)])
    parts = [table(binary, ("u8", [[len(blocks), n, 1, n]]))]
    for dim, number, rows in blocks:
        parts.append(table(binary, ("i4", [[dim, number, 0]]), ("u8", [len(rows)])))
        parts.append(table(binary, ("u8", rows + 1)))
        parts.append(table(binary, ("f8", spatial[rows])))
    return b"".join(parts)


def _element_rows(
    content: Content, curves: list[Entity], surfaces: list[Entity], binary: bool
) -> bytes:
    """Triangles are elements 1 ... m, edges m + 1 ... m + k, in the order of the mesh."""
    m, k = len(content.triangles), len(content.edges)
    parts = [table(binary, ("u8", [[len(curves) + len(surfaces), m + k, 1, m + k]]))]
    for dim, cells, entities, first in (
        (1, content.edges, curves, m + 1),
        (2, content.triangles, surfaces, 1),
    ):
        for number, _, rows in entities:
            parts.append(table(binary, ("i4", [[dim, number, dim]]), ("u8", [len(rows)])))
            parts.append(table(binary, ("u8", first + rows), ("u8", cells[rows] + 1)))
    return b"".join(parts)
