"""What the sections of Gmsh's `.msh` files say, of whatever version: elements, nodes, groups."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass, field
from typing import Any

import numpy as np

from adaptmesh.files.bounded import Allowance
from adaptmesh.mesh.incoming import refuse_cells
from adaptmesh.types import Array

NODES_OF_TYPE = {
    15: 1, 1: 2, 8: 3, 26: 4, 27: 5, 28: 6,
    2: 3, 9: 6, 20: 9, 21: 10, 22: 12, 23: 15, 24: 15, 25: 21,
}  # fmt: skip
"""Nodes of the element types that are read: lone vertices, edges and triangles of any order."""
DIMENSION_OF_TYPE = {
    kind: 0 if kind == 15 else 1 if kind in (1, 8, 26, 27, 28) else 2 for kind in NODES_OF_TYPE
}
_KINDS = {
    3: "quadrilaterals", 4: "tetrahedra", 5: "hexahedra", 6: "prisms", 7: "pyramids",
    10: "quadrilaterals with 9 nodes",
    11: "tetrahedra of second order", 16: "quadrilaterals with 8 nodes",
}  # fmt: skip


@dataclass
class Elements:
    """Elements of one type: tag, vertices by node tag, and physical group of each.

    Below 0 stand several groups, see `Sections.shared`.
    """

    tags: Array
    nodes: Array
    physical: Array


@dataclass
class Sections:
    """What the sections of a `.msh` file say, before they are brought together."""

    allowance: Allowance
    node_tags: Array = field(default_factory=lambda: np.empty(0, np.int64))
    points: Array = field(default_factory=lambda: np.empty((0, 3)))
    elements: dict[int, Elements] = field(default_factory=dict)
    names: dict[int, dict[str, int]] = field(default_factory=dict)
    groups: dict[tuple[int, int], list[int]] = field(default_factory=dict)
    node_data: dict[str, tuple[Array, Array]] = field(default_factory=dict)
    element_data: dict[str, tuple[Array, Array]] = field(default_factory=dict)
    ours: dict[str, Any] = field(default_factory=dict)
    several: dict[tuple[int, tuple[int, ...]], int] = field(default_factory=dict)

    def group_of(self, dim: int, entity: int) -> int:
        """The physical group of an entity, see `shared`."""
        return self.shared(dim, self.groups.get((dim, entity), []))

    def shared(self, dim: int, groups: Iterable[int]) -> int:
        """One number for groups: 0 for none, that of a single one, else one below 0."""
        key = tuple(sorted(set(groups)))
        if len(key) < 2:
            return key[0] if key else 0
        return self.several.setdefault((dim, key), -1 - len(self.several))

    def add(self, kind: int, parts: list[Elements]) -> None:
        """Bring the blocks of one type of element together."""
        self.elements[kind] = Elements(
            np.concatenate([p.tags for p in parts]),
            np.concatenate([p.nodes for p in parts]),
            np.concatenate([p.physical for p in parts]),
        )


def refuse_element_types(counts: dict[int, int]) -> None:
    """Raise for element types that are not read; `counts` by Gmsh's number of the type."""
    refuse_cells(
        {
            _KINDS.get(t, f"elements of Gmsh type {t}"): n
            for t, n in counts.items()
            if t not in NODES_OF_TYPE
        }
    )


def section(name: str, body: bytes, binary: bool = False) -> bytes:
    """A section with its first and last line; after bytes a line break comes before ``$End``."""
    newline = b"\n" if binary else b""
    return b"$%b\n%b%b$End%b\n" % (name.encode(), body, newline, name.encode())
