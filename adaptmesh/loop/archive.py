"""A mesh with arrays and notes in one file, bit for bit: what histories are kept in."""

from __future__ import annotations

import io
import json
from collections.abc import Iterator, Mapping
from contextlib import contextmanager
from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from adaptmesh.errors import AdaptmeshError, FormatError
from adaptmesh.files.bounded import read_json
from adaptmesh.files.notes import Notes
from adaptmesh.files.npz import read_npz
from adaptmesh.files.whole import read_bytes
from adaptmesh.mesh.incoming import Content, mesh_of
from adaptmesh.mesh.mesh import Mesh
from adaptmesh.transfer.spaces import sizes

if TYPE_CHECKING:
    from adaptmesh.domain.domain import Domain

MESH_ARRAYS = ("points", "triangles", "regions", "edges", "edge_tags")
_COLUMNS = {"points": 2, "triangles": 3, "edges": 2}


class Stored(NamedTuple):
    """What a file holds; the arrays are read-only."""

    mesh: Mesh
    arrays: dict[str, NDArray[Any]]
    notes: Notes


def encoded(mesh: Mesh, arrays: Mapping[str, NDArray[Any]], notes: Mapping[str, Any]) -> bytes:
    """The content of a file. Notes are what JSON can hold."""
    content = {name: getattr(mesh, name) for name in MESH_ARRAYS} | dict(arrays)
    notes = {"names": dict(mesh.names), "region_names": dict(mesh.region_names), **notes}
    out = io.BytesIO()
    np.savez(out, notes=np.array(json.dumps(notes)), **content)
    return out.getvalue()


def decoded(path: Path, domain: Domain | None) -> Stored:
    """Read a file; its mesh gets this domain."""
    data = read_bytes(path)
    with damage_named(path):
        arrays = read_npz(data)
        for array in arrays.values():
            array.flags.writeable = False
        notes = Notes(read_json(str(take(arrays, "notes"))))
        mesh = replace(_mesh(arrays, notes), domain=domain)
    return Stored(mesh, arrays, notes)


def take(arrays: dict[str, NDArray[Any]], name: str) -> NDArray[Any]:
    """Take the array of that name out."""
    if name not in arrays:
        raise FormatError(f"the array {name!r} is missing")
    return arrays.pop(name)


def refuse_left_over(arrays: Mapping[str, NDArray[Any]]) -> None:
    """Raise for arrays that nothing in the file has asked for: what did is lost."""
    if arrays:
        raise FormatError(f"nothing in the notes says what the array {next(iter(arrays))!r} is")


def _mesh(arrays: dict[str, NDArray[Any]], notes: Notes) -> Mesh:
    points, triangles, regions, edges, tags = (
        _of_mesh(name, take(arrays, name)) for name in MESH_ARRAYS
    )
    if len(regions) != len(triangles) or len(tags) != len(edges):
        raise FormatError("the numbers of triangles and regions, or of edges and tags, differ")
    names, region_names = notes.numbers("names"), notes.numbers("region_names")
    return mesh_of(Content(points, triangles, regions, edges, tags, names, region_names))


def _of_mesh(name: str, values: NDArray[Any]) -> NDArray[Any]:
    kinds, columns = "f" if name == "points" else "iu", _COLUMNS.get(name)
    shape = values.shape[:1] if columns is None else (*values.shape[:1], columns)
    if values.dtype.kind not in kinds or values.shape != shape:
        raise FormatError(f"the array {name} is {values.dtype} of shape {values.shape}")
    return values


def check_fields(values: Mapping[str, NDArray[Any]], mesh: Mesh) -> None:
    """Raise for a field that cannot be one on the mesh."""
    lengths = sizes(mesh).values()
    for name, array in values.items():
        if array.dtype.kind not in "iufc" or not array.ndim or len(array) not in lengths:
            raise FormatError(f"field {name!r} is {array.dtype} of shape {array.shape}")
        if not np.isfinite(array).all():
            raise FormatError(f"field {name!r} has values that are not finite")


@contextmanager
def damage_named(path: Path) -> Iterator[None]:
    """Errors of what a file holds, with its name."""
    try:
        yield
    except Warning:
        raise
    except AdaptmeshError as error:
        raise FormatError(f"{path}: is damaged: {error}") from None
    except Exception as error:  # unforeseen
        raise FormatError(f"{path}: is damaged: {type(error).__name__} {error}") from error
