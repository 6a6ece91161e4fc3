"""Finite-element spaces on a mesh, and fields in them: which number belongs to which node.

space   nodes                                                        a field has the length
P0      the triangles                                                m
P1      the vertices                                                 n
P2      the vertices, then the midpoints of `mesh.unique_edges`      n + e
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import ArrayLike, NDArray

from adaptmesh.errors import TransferError
from adaptmesh.mesh.mesh import Mesh
from adaptmesh.types import Floats, Ints
from metrics import mesh_edges

DEGREES = {"P0": 0, "P1": 1, "P2": 2}


@dataclass(frozen=True, eq=False)
class Space:
    """Piecewise polynomials of one degree on a mesh: continuous for P1 and P2."""

    mesh: Mesh
    name: str

    @property
    def degree(self) -> int:
        return DEGREES[self.name]

    @cached_property
    def size(self) -> int:
        """How many nodes there are."""
        return sizes(self.mesh)[self.name]

    @cached_property
    def nodes(self) -> Floats:
        """Where the nodes are, (size, 2): for P0 the centroids."""
        points = self.mesh.points
        if self.name == "P0":
            return points[self.mesh.triangles].mean(axis=1)
        if self.name == "P1":
            return points
        return np.concatenate([points, points[self.mesh.unique_edges].mean(axis=1)])

    @cached_property
    def nodes_of_triangles(self) -> Ints:
        """The nodes of each triangle, (m, 1), (m, 3) or (m, 6).

        For P2 the three vertices, then the midpoint of the edge opposite each.
        """
        triangles = self.mesh.triangles
        if self.name == "P0":
            return np.arange(len(triangles), dtype=np.int32)[:, None]
        if self.name == "P1":
            return triangles
        sides = mesh_edges(triangles)[1]
        return np.concatenate([triangles, sides + np.int32(len(self.mesh.points))], axis=1)


def sizes(mesh: Mesh) -> dict[str, int]:
    """How many nodes each space has on a mesh."""
    n = len(mesh.points)
    return {"P0": len(mesh.triangles), "P1": n, "P2": n + len(mesh.unique_edges)}


def basis(degree: int, weights: Floats) -> Floats:
    """The basis functions of a triangle at barycentric coordinates (k, 3): (k, 1), (k, 3), (k, 6).

    With l the coordinates: 1; l_i; and l_i (2 l_i - 1), then 4 l_j l_k for the midpoint of the
    edge opposite vertex i.
    """
    if degree == 0:
        return np.ones((len(weights), 1))
    if degree == 1:
        return weights
    following, before = np.roll(weights, -1, axis=1), np.roll(weights, 1, axis=1)
    return np.concatenate([weights * (2 * weights - 1), 4 * following * before], axis=1)


@dataclass(frozen=True, eq=False)
class Field:
    """Values in a space, as real columns; `like` puts new columns into the shape they came in."""

    space: Space
    columns: Floats
    trailing: tuple[int, ...]
    is_complex: bool

    def like(self, columns: Floats) -> NDArray[np.generic]:
        out: NDArray[np.generic] = np.ascontiguousarray(columns)
        if self.is_complex:
            out = out.view(np.complex128)
        return out.reshape(len(columns), *self.trailing)


def as_field(values: ArrayLike, mesh: Mesh, space: str | None, label: str) -> Field:
    """A field on a mesh; its space is told from its length unless it is given.

    Raises
    ------
    TransferError
        For a wrong length, one that fits two spaces, or a value that is not a finite number.
    """
    if space is not None and space not in DEGREES:
        raise TransferError(f"space={space!r}: expected one of {', '.join(map(repr, DEGREES))}")
    try:
        raw = np.asarray(values)
    except ValueError as error:
        raise TransferError(f"{label} must be an array of numbers: {error}") from error
    if raw.dtype.kind not in "iufc":
        raise TransferError(f"{label} must be an array of numbers, not {raw.dtype}")
    if raw.ndim == 0:
        raise TransferError(f"{label} is a single number: one value for each node is needed")
    where = Space(mesh, _space_of(raw, mesh, space, label))
    is_complex = raw.dtype.kind == "c"
    flat = np.ascontiguousarray(raw.reshape(len(raw), -1), complex if is_complex else float)
    columns = flat.view(np.float64)
    bad = ~np.isfinite(columns).all(axis=1)
    if bad.any():
        i = int(bad.argmax())
        x, y = where.nodes[i].tolist()
        raise TransferError(f"{label}: value {i}, at ({x:g}, {y:g}), is {raw[i]}: not finite")
    return Field(where, columns, raw.shape[1:], is_complex)


def _space_of(raw: NDArray[np.generic], mesh: Mesh, space: str | None, label: str) -> str:
    lengths = sizes(mesh)
    if space is None:
        fits = [name for name, size in lengths.items() if size == len(raw)]
        if len(fits) == 1:
            return fits[0]
        if fits:
            names = " or ".join(fits)
            raise TransferError(
                f"{label} has {len(raw)} values, which fits {names}: say space={fits[0]!r} or "
                f"space={fits[1]!r}"
            )
        expected = ", ".join(f"{size} ({name})" for name, size in lengths.items())
        raise TransferError(f"{label} has {len(raw)} values: expected {expected} on the old mesh")
    if len(raw) != lengths[space]:
        raise TransferError(
            f"{label} has {len(raw)} values; {space} on the old mesh takes {lengths[space]}"
        )
    return space


def as_fields(
    values: Mapping[str, ArrayLike], mesh: Mesh, space: str | Mapping[str, str] | None
) -> dict[str, Field]:
    """Fields by name; `space` is that of all, or of each by name."""
    of_each: Mapping[str, str] = space if isinstance(space, Mapping) else {}
    of_all = space if isinstance(space, str) else None
    unknown = [name for name in of_each if name not in values]
    if unknown:
        raise TransferError(f"space is given for {unknown[0]!r}, but there is no such field")
    return {
        name: as_field(array, mesh, of_each.get(name, of_all), f"field {name!r}")
        for name, array in values.items()
    }
