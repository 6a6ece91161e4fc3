"""A mesh with arrays and notes in one file, bit for bit: what histories are kept in."""

from __future__ import annotations

import io
import json
import zipfile
from collections.abc import Iterator, Mapping
from contextlib import contextmanager
from pathlib import Path
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from .errors import FormatError
from .io.files import read_bytes
from .mesh import Mesh

if TYPE_CHECKING:
    from .domain import Domain

MESH_ARRAYS = ("points", "triangles", "regions", "edges", "edge_tags")


class Stored(NamedTuple):
    """What a file holds; the arrays are read-only."""

    mesh: Mesh
    arrays: dict[str, NDArray[Any]]
    notes: dict[str, Any]


def encoded(mesh: Mesh, arrays: Mapping[str, NDArray[Any]], notes: Mapping[str, Any]) -> bytes:
    """The content of a file. Notes are what JSON can hold."""
    content = {name: getattr(mesh, name) for name in MESH_ARRAYS} | dict(arrays)
    notes = {"names": dict(mesh.names), "region_names": dict(mesh.region_names), **notes}
    out = io.BytesIO()
    np.savez(out, notes=np.array(json.dumps(notes)), **content)
    return out.getvalue()


def decoded(path: Path, domain: Domain | None) -> Stored:
    """Read a file; its mesh gets this domain."""
    data = io.BytesIO(read_bytes(path))
    with damage_named(path), np.load(data, allow_pickle=False) as content:
        notes = json.loads(str(content["notes"]))
        mesh = Mesh(
            **{name: content[name] for name in MESH_ARRAYS},
            names=notes["names"],
            region_names=notes["region_names"],
            domain=domain,
        )
        arrays = {n: content[n] for n in content.files if n not in ("notes", *MESH_ARRAYS)}
    for array in arrays.values():
        array.flags.writeable = False
    return Stored(mesh, arrays, notes)


@contextmanager
def damage_named(path: Path) -> Iterator[None]:
    """Errors of what a file holds, with its name."""
    try:
        yield
    except (ValueError, KeyError, TypeError, AttributeError, zipfile.BadZipFile, EOFError) as error:
        raise FormatError(f"{path}: is damaged: {type(error).__name__} {error}") from error
