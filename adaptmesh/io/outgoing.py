"""What is about to be written, checked before a file is touched."""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np
from numpy.typing import ArrayLike

from metrics.errors import MetricError

from ..errors import FormatError
from ..mesh import Mesh
from .content import Array, Content, check_finite, check_vertices

_RESERVED = ("metric", "regions", "edge_tags")


def outgoing(
    mesh: Mesh,
    metric: ArrayLike | None,
    fields: Mapping[str, ArrayLike],
    triangle_fields: Mapping[str, ArrayLike],
) -> Content:
    """The content of a file of that mesh and those fields."""
    n, m = len(mesh.points), len(mesh.triangles)
    if not m:
        raise FormatError("the mesh has no triangles; there is nothing to write")
    check_finite(mesh.points)
    check_vertices("triangle", mesh.triangles, n)
    check_vertices("edge", mesh.edges, n)
    content = Content(
        mesh.points,
        mesh.triangles,
        mesh.regions,
        mesh.edges,
        mesh.edge_tags,
        names=dict(mesh.names),
        region_names=dict(mesh.region_names),
        metric=None if metric is None else packed_metric(metric, n),
    )
    for name in [*mesh.names, *mesh.region_names]:
        if not isinstance(name, str) or not name:
            raise FormatError(f"the name {name!r} is not a text; rename it")
    for name, values in fields.items():
        array = _field(name, values)
        if len(array) not in (n, m):
            raise FormatError(
                f"field {name!r} has {len(array)} rows; the mesh has {n} points and {m} triangles"
            )
        (content.point_fields if len(array) == n else content.triangle_fields)[name] = array
    for name, values in triangle_fields.items():
        array = _field(name, values)
        if name in fields:
            raise FormatError(f"two fields are called {name!r}; rename one")
        if len(array) != m:
            raise FormatError(
                f"field {name!r} of the triangles has {len(array)} rows; the mesh has {m} triangles"
            )
        content.triangle_fields[name] = array
    return content


def packed_metric(metric: ArrayLike, count: int) -> Array:
    """Packed (n, 3) of packed metrics, tensors (n, 2, 2) or sizes (n,); positive definite."""
    array = _reals("metric", metric)
    shapes = {(count,), (count, 3), (count, 2, 2)}
    if array.shape not in shapes:
        raise MetricError(
            f"metric has shape {array.shape}; for {count} points it is ({count},) sizes, "
            f"({count}, 3) packed or ({count}, 2, 2)"
        )
    with np.errstate(divide="ignore", over="ignore", invalid="ignore"):
        if array.ndim == 1:
            packed = np.stack([array**-2.0, np.zeros(count), array**-2.0], axis=1)
            good = array > 0
        else:
            packed = array if array.ndim == 2 else _upper("metric", array)
            m11, m12, m22 = packed.T
            # the determinant by scaled entries: no overflow
            good = (m11 > 0) & (m22 > 0) & (np.abs(m12) < np.sqrt(m11) * np.sqrt(m22))
    bad = np.flatnonzero(~(good & np.isfinite(packed).all(axis=1)))
    if len(bad):
        raise MetricError(
            f"metric {bad[0]} is {array[bad[0]].tolist()}: a size must be positive, a tensor "
            "symmetric positive definite, and both finite"
        )
    return packed


def solution_values(values: ArrayLike) -> Array:
    """Values of a Medit solution, tensors packed."""
    array = _reals("the solution", values)
    if array.shape[1:] == (2, 2):
        return _upper("the solution", array)
    if array.ndim not in (1, 2) or (array.ndim == 2 and array.shape[1] not in (2, 3)):
        raise FormatError(
            f"the solution has shape {array.shape}; it must be (n,), (n, 2), (n, 3) or (n, 2, 2)"
        )
    return array


def _upper(what: str, tensors: Array) -> Array:
    bad = np.flatnonzero(tensors[:, 0, 1] != tensors[:, 1, 0])
    if len(bad):
        raise MetricError(f"{what} {bad[0]} is {tensors[bad[0]].tolist()}, not symmetric")
    return np.stack([tensors[:, 0, 0], tensors[:, 0, 1], tensors[:, 1, 1]], axis=1)


def _reals(what: str, values: ArrayLike) -> Array:
    try:
        array = np.asarray(values)
    except ValueError as error:
        raise FormatError(f"{what} is not an array: {error}") from None
    if array.dtype.kind not in "fiub":
        raise FormatError(f"{what} has values of type {array.dtype}; real numbers can be written")
    return array.astype(np.float64)


def _field(name: str, values: ArrayLike) -> Array:
    """A field as float64 or as integers of at most 64 bits, (n,), (n, 2) or (n, 3)."""
    if name in _RESERVED:
        raise FormatError(f"{name!r} is the name of what the file holds anyway; rename the field")
    if not name or not name.isprintable() or set(name) & set('"$&<>') or name != name.strip():
        raise FormatError(
            f'{name!r} cannot be the name of a field; leave out " $ & < > and blanks at its ends'
        )
    try:
        array = np.asarray(values)
    except ValueError as error:
        raise FormatError(f"field {name!r} is not an array: {error}") from None
    if array.dtype.kind not in "fiub":
        raise FormatError(
            f"field {name!r} has values of type {array.dtype}; only real numbers can be written"
        )
    if array.ndim == 2 and array.shape[1] == 1:
        array = array[:, 0]
    if array.ndim not in (1, 2) or (array.ndim == 2 and array.shape[1] not in (2, 3)):
        raise FormatError(
            f"field {name!r} has shape {array.shape}; it must be (n,), (n, 2) or (n, 3)"
        )
    if array.dtype.kind == "b":
        return array.astype(np.uint8)
    return array if array.dtype.kind in "iu" else array.astype(np.float64)
