"""What is about to be written, checked before a file is touched."""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np
from numpy.typing import ArrayLike

from adaptmesh.errors import FormatError
from adaptmesh.mesh.incoming import Content, check_coordinates, check_vertices
from adaptmesh.mesh.mesh import Mesh
from adaptmesh.mesh.periodic_sides import periodic_rows
from adaptmesh.types import Array
from metrics import tensor
from metrics.control import ControlSpace, Metric, as_control_space

_RESERVED = ("metric", "regions", "edge_tags")


def all_fields(
    fields: Mapping[str, ArrayLike] | None,
    named: Mapping[str, ArrayLike],
    metric: Metric | ArrayLike | None,
) -> tuple[dict[str, ArrayLike], Metric | ArrayLike | None]:
    """Fields from a mapping and from keywords, and the metric, which may be in the mapping, too.

    Nothing may be given twice.
    """
    if fields is None:
        return dict(named), metric
    if not isinstance(fields, Mapping):
        raise FormatError(
            f"fields: expected a mapping of names to arrays, got {type(fields).__name__}; a field "
            "of that name is fields={'fields': ...}"
        )
    keywords = named if metric is None else {**named, "metric": metric}
    twice = [name for name in fields if name in keywords]
    if twice:
        raise FormatError(f"{twice[0]!r} is given twice: in fields and as a keyword")
    out = {**fields, **named}
    return out, out.pop("metric", metric)


def outgoing(
    mesh: Mesh,
    metric: Metric | ArrayLike | None,
    fields: Mapping[str, ArrayLike],
    triangle_fields: Mapping[str, ArrayLike],
) -> Content:
    """The content of a file of that mesh and those fields."""
    if not isinstance(mesh, Mesh):
        raise TypeError(f"expected a Mesh, got {type(mesh).__name__}")
    n, m = len(mesh.points), len(mesh.triangles)
    if not m:
        raise FormatError("the mesh has no triangles; there is nothing to write")
    check_coordinates(mesh.points)
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
        metric=None if metric is None else _packed(metric, mesh.points),
        periodic=periodic_rows(mesh),
    )
    for name in [*mesh.names, *mesh.region_names]:
        if not isinstance(name, str) or not name or not _is_unicode(name):
            raise FormatError(f"the name {name!r} is not a text of Unicode; rename it")
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


def _is_unicode(name: str) -> bool:
    """False with half a surrogate pair, which no file can hold."""
    return not any("\ud800" <= c <= "\udfff" for c in name)


def _packed(metric: Metric | ArrayLike, points: Array) -> Array:
    """Packed (n, 3) of arrays at the points, or of anything that has a value everywhere."""
    everywhere = callable(metric) or isinstance(metric, (ControlSpace, int, float))
    values = as_control_space(metric)(points) if everywhere else metric  # type: ignore[arg-type]
    return tensor.pack(values, points=points)  # type: ignore[arg-type]


def solution_values(values: ArrayLike) -> Array:
    """Values of a Medit solution, tensors packed; they need not be positive definite."""
    array = _real("the solution", values).astype(np.float64)
    if array.ndim == 3 and array.shape[1:] == (2, 2):
        skew = np.flatnonzero(array[:, 0, 1] != array[:, 1, 0])
        if len(skew):
            raise FormatError(
                f"tensor {skew[0]} is {array[skew[0]].tolist()}, not symmetric; only symmetric "
                "tensors can be written"
            )
        return array.reshape(-1, 4)[:, [0, 1, 3]]
    return _of_few_columns("the solution", array)


def _field(name: str, values: ArrayLike) -> Array:
    """A field as float64 or as integers of at most 64 bits, (n,) or (n, ...)."""
    if name in _RESERVED:
        raise FormatError(f"{name!r} is the name of what the file holds anyway; rename the field")
    if not isinstance(name, str):
        raise FormatError(f"{name!r} cannot be the name of a field: expected a text")
    if not name or not name.isprintable() or set(name) & set('"$&<>') or name != name.strip():
        raise FormatError(
            f'{name!r} cannot be the name of a field; leave out " $ & < > and blanks at its ends'
        )
    array = _real(f"field {name!r}", values)
    if array.ndim == 0 or 0 in array.shape[1:]:
        raise FormatError(f"field {name!r}: expected shape (n,) or (n, ...), got {array.shape}")
    if array.ndim == 2 and array.shape[1] == 1:
        array = array[:, 0]
    if array.dtype.kind == "b":
        return array.astype(np.uint8)
    return array if array.dtype.kind in "iu" else array.astype(np.float64)


def _real(what: str, values: ArrayLike) -> Array:
    try:
        array = np.asarray(values)
    except ValueError as error:
        raise FormatError(f"{what} is not an array: {error}") from None
    if array.dtype.kind not in "fiub":
        raise FormatError(
            f"{what} has values of type {array.dtype}; only real numbers can be written"
        )
    return array


def _of_few_columns(what: str, array: Array) -> Array:
    if array.ndim == 2 and array.shape[1] == 1:
        return array[:, 0]
    if array.ndim == 1 or (array.ndim == 2 and array.shape[1] in (2, 3)):
        return array
    raise FormatError(f"{what}: expected shape (n,), (n, 2) or (n, 3), got {array.shape}")
