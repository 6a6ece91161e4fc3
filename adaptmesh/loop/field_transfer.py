"""Transfer of the fields of a solution to the next mesh."""

from __future__ import annotations

from collections.abc import Mapping

from adaptmesh.mesh.mesh import Mesh
from adaptmesh.transfer.transfer import METHODS, transfer
from adaptmesh.types import Array

from .solution import space_of


def check_transfer(method: str) -> None:
    """Raise for a way to transfer fields that there is not."""
    if method not in METHODS:
        raise ValueError(f"transfer={method!r}: expected one of {', '.join(map(repr, METHODS))}")


def transfer_fields(
    fields: Mapping[str, Array], old: Mesh, new: Mesh, method: str, keep_bounds: bool = False
) -> dict[str, Array]:
    """Fields, each in the space that its length tells, on another mesh."""
    spaces = {name: space_of(values, old) for name, values in fields.items()}
    return transfer(fields, old, new, method=method, space=spaces, keep_bounds=keep_bounds)
