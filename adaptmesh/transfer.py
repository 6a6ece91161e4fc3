"""Fields from mesh to mesh."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any, overload

import numpy as np
from numpy.typing import ArrayLike, NDArray

from . import _core
from .errors import TransferError
from .mesh import Mesh
from .spaces import Field, Floats, Ints, Space, as_field, as_fields, basis

METHODS = ("interpolation",)

OUTSIDE = 0.25
"""How far outside of the old mesh a node may be, relative to the longest edge beside it.

The chords of a circle, cut into edges of a right angle each, are off by a fifth of their length.
"""


@overload
def transfer(
    values: Mapping[str, ArrayLike],
    old_mesh: Mesh,
    new_mesh: Mesh,
    *,
    method: str = ...,
    space: str | Mapping[str, str] | None = ...,
    outside: float = ...,
) -> dict[str, NDArray[Any]]: ...
@overload
def transfer(
    values: ArrayLike,
    old_mesh: Mesh,
    new_mesh: Mesh,
    *,
    method: str = ...,
    space: str | None = ...,
    outside: float = ...,
) -> NDArray[Any]: ...
def transfer(
    values: Any,
    old_mesh: Mesh,
    new_mesh: Mesh,
    *,
    method: str = "interpolation",
    space: Any = None,
    outside: float = OUTSIDE,
) -> Any:
    """Carry fields from one mesh to another of the same domain.

    Parameters
    ----------
    values : array_like, or mapping of str to array_like
        A field, or any number of them by name: (N,) for a scalar, (N, ...) for vectors and tensors,
        real or complex. N tells the space: P0 has a value for each triangle, P1 for each vertex, P2
        for each vertex and then for the midpoint of each of `Mesh.unique_edges`.
    old_mesh, new_mesh : Mesh
        What they cover should be the same, up to the chords of curved boundaries.
    method : {"interpolation"}, optional
        ``"interpolation"``: the value of the old field at each node of the new mesh, for P0 at the
        centroid.
    space : {"P0", "P1", "P2"}, or mapping of str to these, optional
        Needed only where the length fits two spaces.
    outside : float, optional
        A node of the new mesh outside of the old takes the value at the nearest point of its
        border, if it is no farther than this times the longest edge of the old triangle there or of
        the new triangles at the node.

    Returns
    -------
    array, or dict of str to array
        In the same spaces on the new mesh, of the same trailing shape.

    Raises
    ------
    TransferError
        A field is of the wrong length, or not finite; a node is too far outside; a mesh is broken.
    """
    if method not in METHODS:
        raise TransferError(f"method={method!r} is none of {', '.join(map(repr, METHODS))}")
    if not outside >= 0:
        raise TransferError(f"outside={outside!r}: a share of an edge is wanted, 0 or more")
    if isinstance(values, Mapping):
        fields = as_fields(values, old_mesh, space)
    else:
        fields = {"": as_field(values, old_mesh, space, "the field")}
    new = interpolated(fields, old_mesh, new_mesh, outside)
    return new if isinstance(values, Mapping) else new[""]


def interpolated(
    fields: Mapping[str, Field], old: Mesh, new: Mesh, outside: float
) -> dict[str, NDArray[Any]]:
    """The old fields at the nodes of the new mesh."""
    if is_same_mesh(old, new):
        return {name: field.like(field.columns.copy()) for name, field in fields.items()}
    locator = located(old)
    places: dict[str, tuple[Ints, Floats]] = {}
    out = {}
    for name, field in fields.items():
        kind = field.space.name
        if kind not in places:
            places[kind] = _places(locator, old, Space(new, kind), outside)
        triangles, weights = places[kind]
        shape = basis(field.space.degree, weights)
        values = field.columns[field.space.nodes_of_triangles[triangles]]
        out[name] = field.like(np.einsum("ij,ijk->ik", shape, values))
    return out


def is_same_mesh(old: Mesh, new: Mesh) -> bool:
    """Whether two meshes have the same points and triangles, in the same order."""
    return np.array_equal(old.points, new.points) and np.array_equal(old.triangles, new.triangles)


def located(mesh: Mesh) -> _core.Locator:
    """What finds points in the triangles of a mesh."""
    flat = np.flatnonzero(~(mesh.areas > 0))
    if len(flat):
        t = int(flat[0])
        raise TransferError(
            f"triangle {t} = {tuple(mesh.triangles[t].tolist())} has the area {mesh.areas[t]:g}: "
            "triangles must be counter-clockwise"
        )
    try:
        return _core.Locator(mesh.points, mesh.triangles)
    except ValueError as error:
        raise TransferError(f"the triangles are not a mesh: {error}") from error


def _places(locator: _core.Locator, old: Mesh, space: Space, outside: float) -> tuple[Ints, Floats]:
    """The old triangle of each new node, and its barycentric coordinates there."""
    triangles, weights, distances = locator.locate(space.nodes)
    off = np.flatnonzero(distances > 0)
    if len(off):
        near = np.maximum(longest_edges(old)[triangles[off]], _longest_edges_at_nodes(space)[off])
        far = off[distances[off] > outside * near]
        if len(far):
            worst = int(far[np.argmax(distances[far])])
            x, y = space.nodes[worst].tolist()
            raise TransferError(
                f"{len(far)} nodes of the new mesh lie far outside of the old; {space.name} node "
                f"{worst} at ({x:g}, {y:g}) by {distances[worst]:g}: the meshes must cover the "
                "same domain (outside=inf takes the nearest value of the border all the same)"
            )
    return triangles, weights


def longest_edges(mesh: Mesh) -> Floats:
    """Length of the longest edge of each triangle, (m,)."""
    p = mesh.points[mesh.triangles]
    out: Floats = np.linalg.norm(p - np.roll(p, 1, axis=1), axis=2).max(axis=1)
    return out


def _longest_edges_at_nodes(space: Space) -> Floats:
    out = np.zeros(space.size)
    nodes = space.nodes_of_triangles
    longest = np.repeat(longest_edges(space.mesh)[:, None], nodes.shape[1], axis=1)
    np.maximum.at(out, nodes, longest)
    return out
