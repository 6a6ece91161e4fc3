"""What a user's solve returns, checked and brought into one form."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Any

import numpy as np

from adaptmesh.errors import MetricError
from adaptmesh.mesh.mesh import Mesh
from adaptmesh.transfer.spaces import as_field, sizes
from adaptmesh.types import Array, Floats
from adaptmesh.value import FrozenMapping, Value
from metrics import ControlSpace, tensor

UNNAMED = "solution"  # the name of a field that is returned as a bare array
UNNAMED_ERROR = "error"  # the name of an error that is returned as a bare number


@dataclass(frozen=True, eq=False)
class Solution(Value):
    """Result of a solve that returns more than fields.

    Parameters
    ----------
    fields : mapping of str to array_like, or array_like
        Values at the vertices (n,), or (n, k) for k components; fields in P0 or P2 are transferred
        to the next mesh, but it is not adapted to them.
    metric : control space, (n, 3) or (n, 2, 2) array_like, optional
        Where this is given, the mesh is adapted to it, and to no field. It is evaluated at the
        vertices. The errors of the fields are estimated all the same, to tell when nothing changes
        any more.
    errors : mapping of str to float, or float, optional
        The solver's own estimates, in the place of that of the interpolation error.

    Notes
    -----
    Those of histories are checked: `fields` is a mapping of str to read-only arrays, `metric` is
    packed (n, 3) or None, and `errors` is a mapping, empty where the solver gave none.
    """

    fields: Any = field(default_factory=dict)
    metric: Any = None
    errors: Any = None
    is_bare: bool = field(default=False, repr=False)  # whether `fields` was an array without a name

    def as_returned(self, fields: Mapping[str, Array]) -> Any:
        """Fields on another mesh in the form in which the user returned these."""
        if not fields:
            return None
        return fields[UNNAMED] if self.is_bare else dict(fields)


def check_solution(answer: Any, mesh: Mesh, function: str = "solve") -> Solution:
    """What solve, or another function of the user's, returned: checked, in one form.

    Raises
    ------
    TypeError, ValueError
        For what is neither fields nor a metric; for fields of another length, or with a value that
        is not finite; for a metric that is not one.
    """
    given = answer if isinstance(answer, Solution) else _as_solution(answer, mesh, function)
    is_bare = given.is_bare or not isinstance(given.fields, Mapping)
    named = given.fields if isinstance(given.fields, Mapping) else {UNNAMED: given.fields}
    fields = {str(name): _check_field(values, name, mesh) for name, values in named.items()}
    metric = None if given.metric is None else _check_metric(given.metric, mesh)
    if not fields and metric is None:
        raise TypeError(f"{function} returned neither fields nor a metric")
    return Solution(FrozenMapping(fields), metric, _check_errors(given.errors), is_bare)


def _as_solution(answer: Any, mesh: Mesh, function: str) -> Solution:
    """Mappings and (n,) are fields; control spaces, (n, 3) and (n, 2, 2) are metrics."""
    if isinstance(answer, Mapping):
        return Solution(answer)
    if isinstance(answer, ControlSpace):
        return Solution(metric=answer)
    if answer is None:
        raise TypeError(f"{function} returned None; is a return statement missing?")
    array = _as_array(answer, f"what {function} returned")
    if array.ndim == 1:
        return Solution(array)
    n = len(mesh.points)
    if array.shape in ((n, 3), (n, 2, 2)):
        return Solution(metric=array)
    raise ValueError(
        f"{function} returned an array of the shape {array.shape}: expected values at the {n} "
        f"vertices ({n},) or a metric ({n}, 3); fields with components go into a dict, by name"
    )


def _as_array(values: Any, what: str) -> Array:
    try:
        array = np.asarray(values)
    except ValueError as error:
        raise TypeError(f"{what} is not an array of numbers: {error}") from error
    if np.ma.is_masked(values):
        raise TypeError(f"{what} has masked values: fill them, np.ma.filled(values, ...)")
    if array.dtype.kind not in "iufc" or array.ndim == 0:
        kind = type(values).__name__ if array.ndim == 0 else f"an array of {array.dtype}"
        raise TypeError(f"{what}: expected an array of numbers, got {kind}")
    return array


def _check_field(values: Any, name: object, mesh: Mesh) -> Array:
    if not isinstance(name, str):
        raise TypeError(f"the names of fields are strings, got {name!r}")
    label = "the solution" if name == UNNAMED else f"field {name!r}"
    array = _as_array(values, label)
    lengths = sizes(mesh)
    if len(array) not in lengths.values():
        raise ValueError(
            f"{label}: expected {lengths['P1']} values at the vertices (or {lengths['P0']} of the "
            f"triangles, or {lengths['P2']} in P2), got {len(array)}"
        )
    as_field(array, mesh, space_of(array, mesh), label)
    return _read_only_copy(array)


def space_of(values: Array, mesh: Mesh) -> str:
    """The space of a field by its length; P1 where it could be another as well."""
    fits = [name for name, size in sizes(mesh).items() if size == len(values)]
    return "P1" if "P1" in fits else fits[0]


def _check_metric(metric: Any, mesh: Mesh) -> Floats:
    if callable(metric):
        return _read_only_copy(tensor.pack(metric(mesh.points), points=mesh.points))
    array = _as_array(metric, "the metric")
    n = len(mesh.points)
    if array.shape not in ((n,), (n, 3), (n, 2, 2)):
        raise MetricError(
            f"the metric: expected sizes ({n},), packed tensors ({n}, 3) or matrices ({n}, 2, 2) "
            f"at the vertices, got an array of the shape {array.shape}"
        )
    return _read_only_copy(tensor.pack(array, points=mesh.points))


def _check_errors(errors: Any) -> Mapping[str, float]:
    if errors is None:
        return FrozenMapping({})
    named = errors if isinstance(errors, Mapping) else {UNNAMED_ERROR: errors}
    out = {str(name): float(value) for name, value in named.items()}
    for name, value in out.items():
        if not 0 <= value < np.inf:
            raise ValueError(f"the estimate {name!r} must be finite and not negative, got {value}")
    return FrozenMapping(out)


def _read_only_copy(array: Array) -> Array:
    out = np.array(array, order="C")
    out.flags.writeable = False
    return out
