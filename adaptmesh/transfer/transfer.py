"""Fields from mesh to mesh."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any, overload

import numpy as np
from numpy.typing import ArrayLike

from adaptmesh.errors import TransferError
from adaptmesh.mesh.mesh import Mesh
from adaptmesh.types import Array, Floats, Ints

from .location import (
    OUTSIDE,
    MeshLocator,
    check_distances,
    check_mesh,
    check_outside,
    longest_edges,
    make_locator,
)
from .spaces import Field, Space, as_field, as_fields, basis
from .supermesh import Overlay

METHODS = ("interpolation", "conservative")


@overload
def transfer(
    values: Mapping[str, ArrayLike],
    old_mesh: Mesh,
    new_mesh: Mesh,
    *,
    method: str = ...,
    space: str | Mapping[str, str] | None = ...,
    keep_bounds: bool = ...,
    outside: float = ...,
) -> dict[str, Array]: ...
@overload
def transfer(
    values: ArrayLike,
    old_mesh: Mesh,
    new_mesh: Mesh,
    *,
    method: str = ...,
    space: str | None = ...,
    keep_bounds: bool = ...,
    outside: float = ...,
) -> Array: ...
def transfer(
    values: Any,
    old_mesh: Mesh,
    new_mesh: Mesh,
    *,
    method: str = "interpolation",
    space: Any = None,
    keep_bounds: bool = False,
    outside: float = OUTSIDE,
) -> Any:
    """Transfer fields from one mesh to another of the same domain.

    Parameters
    ----------
    values : array_like, or mapping of str to array_like
        A field, or any number of them by name: (N,) for a scalar, (N, ...) for vectors and tensors,
        real or complex. N tells the space: P0 has a value for each triangle, P1 for each vertex, P2
        for each vertex and then for the midpoint of each of `Mesh.unique_edges`.
    old_mesh, new_mesh : Mesh
        What they cover should be the same, up to the chords of curved boundaries.
    method : {"interpolation", "conservative"}, optional
        ``"interpolation"``: the value of the old field at each node of the new mesh, for P0 at the
        centroid. Cheap, and exact where a node is a vertex of both meshes.
        ``"conservative"``: the L² projection; among the fields of the new space the one nearest to
        the old field. Its integral is that of the old field, and polynomials of the degree of the
        space come back, to rounding.
    space : {"P0", "P1", "P2"}, or mapping of str to these, optional
        Needed only where the length fits two spaces.
    keep_bounds : bool, optional
        For the conservative method: no value beyond those that the old field has on the triangles
        around, and still the same integral. Without, a steep field overshoots. Interpolated nodal
        values are values of the old field anyway.
    outside : float, optional
        A node of the new mesh outside of the old takes the value at the nearest point of its
        border, if it is no farther than this times the longest edge of the old triangle there or of
        the new triangles at the node. For the conservative method, the centroid of a triangle that
        overlaps none of the other mesh may be this far outside.

    Returns
    -------
    array, or dict of str to array
        In the same spaces on the new mesh, of the same trailing shape. For a mesh with the same
        points and triangles, the same values.

    Raises
    ------
    TransferError
        A field is of the wrong length, or not finite; a node or triangle is too far outside; the
        meshes do not overlap; a mesh is broken.

    Notes
    -----
    Where the domains differ, by the chords of a curved boundary, the conservative method extends
    the old field by polynomials of its degree, on the uncovered part of a new triangle by the L²
    projection of its covered part. The integral of the new field is then that of the old over the
    common part, plus that of the extension; `Overlay` tells how large these parts are. Polynomials
    of the degree of the space stay what they are. Formulas and sources: :doc:`/transfer`.

    Examples
    --------
    >>> import numpy as np
    >>> import adaptmesh as am
    >>> square = am.Domain.rectangle(0, 0, 1, 1)
    >>> old, new = am.generate(square, 0.3), am.generate(square, 0.2)
    >>> u = am.transfer(old.points[:, 0], old, new, method="conservative")
    >>> bool(np.abs(u - new.points[:, 0]).max() < 1e-14)
    True
    """
    if method not in METHODS:
        raise TransferError(f"method={method!r}: expected one of {', '.join(map(repr, METHODS))}")
    check_mesh(old_mesh, "old")
    check_mesh(new_mesh, "new")
    check_outside(outside)
    if is_same_mesh(old_mesh, new_mesh):
        method = "interpolation"
    if method == "conservative":
        overlay = Overlay(old_mesh, new_mesh, outside=outside)
        return overlay.project(values, space=space, keep_bounds=keep_bounds)
    if isinstance(values, Mapping):
        return interpolate(as_fields(values, old_mesh, space), old_mesh, new_mesh, outside)
    field = as_field(values, old_mesh, space, "the field")
    return interpolate({"": field}, old_mesh, new_mesh, outside)[""]


def interpolate(
    fields: Mapping[str, Field], old: Mesh, new: Mesh, outside: float
) -> dict[str, Array]:
    """The old fields at the nodes of the new mesh."""
    if is_same_mesh(old, new):
        return {name: field.like(field.columns.copy()) for name, field in fields.items()}
    where = make_locator(old, "old")
    places: dict[str, tuple[Ints, Floats]] = {}
    out = {}
    for name, field in fields.items():
        kind = field.space.name
        if kind not in places:
            places[kind] = _places(where, Space(new, kind), outside)
        triangles, weights = places[kind]
        shape = basis(field.space.degree, weights)
        values = field.columns[field.space.nodes_of_triangles[triangles]]
        out[name] = field.like(np.einsum("ij,ijk->ik", shape, values))
    return out


def is_same_mesh(old: Mesh, new: Mesh) -> bool:
    """Whether two meshes have the same points and triangles, in the same order."""
    return np.array_equal(old.points, new.points) and np.array_equal(old.triangles, new.triangles)


def _places(old: MeshLocator, space: Space, outside: float) -> tuple[Ints, Floats]:
    """The old triangle of each new node, and its barycentric coordinates there."""
    triangles, weights, distances = old.locator.locate(space.nodes)
    off = np.flatnonzero(distances > 0)
    edges = np.maximum(longest_edges(old.mesh)[triangles[off]], _longest_edges_at_nodes(space)[off])
    check_distances(space.nodes[off], distances[off], edges, outside, f"{space.name} nodes", "old")
    return triangles, weights


def _longest_edges_at_nodes(space: Space) -> Floats:
    out = np.zeros(space.size)
    nodes = space.nodes_of_triangles
    longest = np.repeat(longest_edges(space.mesh)[:, None], nodes.shape[1], axis=1)
    np.maximum.at(out, nodes, longest)
    return out
