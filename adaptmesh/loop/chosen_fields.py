"""Which fields of a solution the mesh is adapted to."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

import numpy as np

from adaptmesh.errors import MetricError
from adaptmesh.mesh.mesh import Mesh
from adaptmesh.types import Array

from .solution import space_of

SCALES = (1e-100, 1e100)  # of fields; squares of their derivatives are to be numbers


def check_names(names: Sequence[str] | None) -> None:
    """Raise for a name in the place of a list of names, and for an empty list."""
    if isinstance(names, str):
        raise TypeError(f"fields={names!r}: give a list of names, [{names!r}]")
    if names is not None and not names:
        raise ValueError(
            "fields=[]: give the names of those that the mesh is adapted to, or leave it out"
        )


def choose_fields(
    names: Sequence[str] | None, fields: Mapping[str, Array], mesh: Mesh
) -> dict[str, Array]:
    """The fields of these names, or else all that a mesh can be adapted to."""
    known = ", ".join(map(repr, fields)) or "none"
    if names is None:
        chosen = {name: values for name, values in fields.items() if is_usable(values, mesh)}
        if not chosen:
            raise MetricError(
                "no field that the mesh can be adapted to: expected real values at the vertices; "
                f"there {'are' if fields else 'is'} {known}"
            )
        return chosen
    for name in names:
        if name not in fields:
            raise MetricError(
                f"there is no field {name!r} to adapt the mesh to; solve gave {known}"
            )
        if not is_usable(fields[name], mesh):
            raise MetricError(
                f"the mesh cannot be adapted to field {name!r}: expected real values at the "
                f"vertices, got {fields[name].dtype} of shape {fields[name].shape}"
            )
    return {name: fields[name] for name in names}


def is_usable(values: Array, mesh: Mesh) -> bool:
    """Whether a field has Hessians: whether it is real, and at the vertices."""
    return values.dtype.kind != "c" and space_of(values, mesh) == "P1"


def is_constant(values: Array) -> bool:
    """Whether a field, and each of its components, is the same everywhere."""
    return not np.ptp(values.reshape(len(values), -1), axis=0).any()


def check_scale(name: str, values: Array) -> None:
    """Raise for a field of which the squares of derivatives overflow or vanish."""
    largest = float(np.abs(values).max())
    if not SCALES[0] <= largest <= SCALES[1]:
        raise MetricError(
            f"field {name!r} has values up to {largest:.3g}: choose a unit in which they are "
            f"between {SCALES[0]:g} and {SCALES[1]:g}"
        )
