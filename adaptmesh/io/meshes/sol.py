"""Medit solutions, `.sol` (text) and `.solb` (binary): one field of a mesh.

A file lists the types of its values, 1 scalar, 2 vector, 3 symmetric tensor, then the rows; a
tensor in the plane is m11 m12 m22, just our packed metric. ::

    Dimension 2
    SolAtVertices
    100             rows
    1 3             number of types, types
    1.0 0.0 4.0

Beside ``a.mesh`` the metric is ``a.sol``, where Mmg, BAMG and others look for it, and the field
``u`` is ``a.u.sol``; beside ``a.meshb`` they end in ``.solb``.
"""

from __future__ import annotations

from pathlib import Path
from typing import NamedTuple

import numpy as np

from adaptmesh.errors import FormatError
from adaptmesh.files.located import located
from adaptmesh.files.records import one, table
from adaptmesh.files.whole import read_bytes
from adaptmesh.mesh.incoming import Content
from adaptmesh.types import Array

from .medit_keywords import MeditFile, binary_file, count, dimension, opened, text_file
from .spatial import flat

SCALAR, VECTOR, TENSOR = 1, 2, 3
AT_VERTICES = "SolAtVertices"
_PLACES = (AT_VERTICES, "SolAtTriangles")
_MOST_TYPES = 100


class Solution(NamedTuple):
    """Values (n,) or (n, c), the types that they are of, and the keyword of their place."""

    values: Array
    types: list[int]
    place: str


def encode(values: Array, *, tensor: bool, place: str, binary: bool) -> bytes:
    """The bytes of a file with one field: (n,) scalars, (n, 2) vectors, (n, 3) tensors.

    Three columns that are no tensor are three scalars, and so are more.
    """
    values = flat(values)
    columns = 1 if values.ndim == 1 else values.shape[1]
    if columns > _MOST_TYPES:
        raise FormatError(f"a field of {columns} columns; .sol holds at most {_MOST_TYPES}")
    types = [TENSOR] if tensor else [VECTOR] if columns == 2 else [SCALAR] * columns
    keyword = (place, [len(values), len(types), *types], table(binary, ("f8", values)))
    return (binary_file if binary else text_file)([keyword])


def decode(data: bytes, *, binary: bool) -> Solution:
    """The first field at the vertices or triangles that a file holds."""
    file, dim, found = opened(data, binary=binary), 2, None
    while (keyword := file.next_keyword()) != "End":
        with located(keyword):
            if keyword == "Dimension":
                dim = dimension(file)
            elif keyword in _PLACES and found is None:
                found = _read(keyword, file, dim)
            else:
                file.skip()
    if file.lacks_end:
        raise FormatError("has no End: it is cut short (if it is whole, add the line 'End')")
    if found is None:
        raise FormatError(f"has neither {' nor '.join(_PLACES)}: there is no field to read")
    return found


def _read(place: str, file: MeditFile, dim: int) -> Solution:
    rows, number = count(file), one(file.cursor)
    if not 1 <= number <= _MOST_TYPES:
        raise FormatError(f"{number} solutions at each point")
    types = file.cursor.rows(number, ("i4", 1))[0][:, 0].tolist()
    widths = {SCALAR: 1, VECTOR: dim, TENSOR: dim * (dim + 1) // 2}
    for t in types:
        if t not in widths:
            raise FormatError(f"type {t} is neither 1 (scalar), 2 (vector) nor 3 (tensor)")
    columns = file.cursor.rows(rows, *((file.real, widths[t]) for t in types))
    if dim == 3:
        columns = [_planar(c, t) for c, t in zip(columns, types, strict=True)]
    values = np.concatenate(columns, axis=1)
    return Solution(values[:, 0] if values.shape[1] == 1 else values, types, place)


def _planar(values: Array, kind: int) -> Array:
    """Drop z: a vector is x y z, a tensor m11 m12 m22 m13 m23 m33."""
    keep, out = {SCALAR: (1, []), VECTOR: (2, [2]), TENSOR: (3, [3, 4])}[kind]
    bad = np.flatnonzero(values[:, out].any(axis=1))
    if len(bad):
        raise FormatError(f"row {bad[0]} is {values[bad[0]].tolist()}, not in the plane z = 0")
    return values[:, :keep]


# -------------------------------------------------------------------------------------- companions


def companion(mesh_path: Path, name: str | None) -> Path:
    """File of a field of that name, or of the metric, beside ``a.mesh`` or ``a.meshb``."""
    suffix = ".solb" if mesh_path.suffix.lower() == ".meshb" else ".sol"
    return mesh_path.with_name(f"{mesh_path.stem}{'' if name is None else '.' + name}{suffix}")


def companions(mesh_path: Path) -> dict[str | None, Path]:
    """Files of the fields beside a mesh, by name; None is the metric.

    A file that goes with another mesh (``a.b.sol`` if there is an ``a.b.mesh``) is left out.
    """
    suffix = companion(mesh_path, None).suffix
    found: dict[str | None, Path] = {}
    for path in sorted(mesh_path.parent.iterdir()):
        stem = path.name.removesuffix(suffix)
        if stem == path.name or path.with_name(stem + mesh_path.suffix) == mesh_path:
            continue
        if (
            stem.startswith(mesh_path.stem + ".")
            and not path.with_name(stem + mesh_path.suffix).exists()
        ):
            found[stem.removeprefix(mesh_path.stem + ".")] = path
    metric = companion(mesh_path, None)
    if metric.exists():
        found[None] = metric
    return found


def encode_companions(content: Content, mesh_path: Path) -> dict[Path, bytes]:
    """The files of the fields and of the metric, to be written beside a mesh."""
    binary = mesh_path.suffix.lower() == ".meshb"
    out = {}
    for place, fields in zip(_PLACES, (content.point_fields, content.triangle_fields), strict=True):
        for name, values in fields.items():
            if set(name) & set("/\\:*?|"):
                raise FormatError(
                    f"field {name!r} would be a file of its own; leave out / \\ : * ? | in its name"
                )
            data = encode(values, tensor=False, place=place, binary=binary)
            out[companion(mesh_path, name)] = data
    if content.metric is not None:
        data = encode(content.metric, tensor=True, place=AT_VERTICES, binary=binary)
        out[companion(mesh_path, None)] = data
    return out


def add_companions(content: Content, mesh_path: Path) -> None:
    """Read the files beside a mesh; ``a.sol`` is the metric if it is a tensor, else ``sol``."""
    for name, path in companions(mesh_path).items():
        data = read_bytes(path)
        with located(path):
            found = decode(data, binary=path.suffix == ".solb")
            at_points = found.place == AT_VERTICES
            rows = len(content.points if at_points else content.triangles)
            if len(found.values) != rows:
                raise FormatError(
                    f"has {len(found.values)} rows, the mesh {mesh_path.name} has {rows}: it "
                    "belongs to another mesh; delete or rename it"
                )
        if name is None and at_points and found.types == [TENSOR]:
            content.metric = found.values
        else:
            fields = content.point_fields if at_points else content.triangle_fields
            fields[name or "sol"] = found.values
