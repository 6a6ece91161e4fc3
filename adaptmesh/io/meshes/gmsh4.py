"""The sections of Gmsh's versions 4.0 and 4.1 that hold the mesh: entities, nodes, elements.

An element is in the physical groups of its entity::

    $Entities            tag, box, physical groups, bounding entities
    $Nodes               blocks by entity:  dim entity parametric count, tags, coordinates
    $Elements            blocks by entity:  dim entity type count, (tag, vertices) by row

In 4.0 points have a box, too; a block gives its entity before its dimension, a node its tag beside
its coordinates; and tags have 32 bits. Source: Gmsh reference manuals, "MSH file format".
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from adaptmesh.errors import FormatError
from adaptmesh.files.records import Cursor, one

from .gmsh_sections import NODES_OF_TYPE, Elements, Sections, refuse_element_types

Reader = Callable[[Cursor, Sections], None]


@dataclass(frozen=True)
class Version:
    """What differs between the versions.

    Parameters
    ----------
    place : int
        Numbers that tell where a point entity is: its coordinates, or a box.
    head : int
        Numbers before the blocks; the first two are how many blocks and rows there are.
    tag : str
        Code of the tags of nodes and elements.
    dimension_first : bool
        Whether a block gives the dimension of its entity before its number.
    tags_apart : bool
        Whether the tags of the nodes of a block come before all their coordinates.
    """

    place: int
    head: int
    tag: str
    dimension_first: bool
    tags_apart: bool

    @property
    def readers(self) -> dict[str, Reader]:
        """The reader of each section."""
        return {
            "Entities": self._read_entities,
            "Nodes": self._read_nodes,
            "Elements": self._read_elements,
        }

    def _read_entities(self, cursor: Cursor, out: Sections) -> None:
        counts = cursor.rows(1, ("u8", 4))[0][0]
        for dim, count in enumerate(counts.tolist()):
            for _ in range(count):
                tag, _ = cursor.rows(1, ("i4", 1), ("f8", self.place if dim == 0 else 6))
                groups = cursor.rows(one(cursor, "u8"), ("i4", 1))[0]
                out.groups[dim, int(tag[0, 0])] = [abs(g) for g in groups[:, 0].tolist()]
                if dim > 0:
                    cursor.rows(one(cursor, "u8"), ("i4", 1))

    def _block(self, cursor: Cursor) -> tuple[int, int, int, int]:
        """Dimension and number of an entity, what its block holds, and how many."""
        first, second, what = cursor.rows(1, ("i4", 3))[0][0].tolist()
        dim, entity = (first, second) if self.dimension_first else (second, first)
        return dim, entity, what, one(cursor, "u8")

    def _read_nodes(self, cursor: Cursor, out: Sections) -> None:
        blocks, count, *_ = cursor.rows(1, ("u8", self.head))[0][0].tolist()
        tags, points = [out.node_tags], [out.points]
        for _ in range(blocks):
            dim, _, parametric, size = self._block(cursor)
            places = ("f8", 3 + (dim if parametric == 1 and 0 <= dim <= 3 else 0))
            if self.tags_apart:
                found, xyz = cursor.rows(size, (self.tag, 1))[0], cursor.rows(size, places)[0]
            else:
                found, xyz = cursor.rows(size, (self.tag, 1), places)
            tags.append(found[:, 0])
            points.append(xyz[:, :3])
        out.node_tags, out.points = np.concatenate(tags), np.concatenate(points)
        if len(out.points) != count:
            raise FormatError(f"expected {count} nodes, as announced, got {len(out.points)}")

    def _read_elements(self, cursor: Cursor, out: Sections) -> None:
        blocks, count, *_ = cursor.rows(1, ("u8", self.head))[0][0].tolist()
        found: dict[int, list[Elements]] = {}
        done = 0
        for _ in range(blocks):
            dim, entity, kind, size = self._block(cursor)
            refuse_element_types({kind: size})
            if not size:
                continue
            tags, nodes = cursor.rows(size, (self.tag, 1), (self.tag, NODES_OF_TYPE[kind]))
            group = np.full(size, out.group_of(dim, entity) if kind != 15 else 0)
            found.setdefault(kind, []).append(Elements(tags[:, 0], nodes, group))
            done += size
        if done != count:
            raise FormatError(f"expected {count} elements, as announced, got {done}")
        for kind, parts in found.items():
            out.add(kind, parts)


READERS_4_0 = Version(6, 2, "i4", dimension_first=False, tags_apart=False).readers
READERS_4_1 = Version(3, 4, "u8", dimension_first=True, tags_apart=True).readers
