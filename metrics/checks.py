"""Checks of arguments: arrays, converted once and never changed; numbers and functions."""

from __future__ import annotations

from collections.abc import Callable
from numbers import Real
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from .errors import AdaptmeshError, MetricError
from .types import Floats, Ints


def as_points(points: ArrayLike) -> Floats:
    """Points as a contiguous (n, 2) array of finite floats.

    Parameters
    ----------
    points : (n, 2) array_like
        Coordinates; n may be 0.

    Returns
    -------
    (n, 2) array of float
        The very same array if it is already as it should be.

    Raises
    ------
    MetricError
        For another shape, complex or non-numeric entries, or a coordinate that is not finite.
    """
    raw = as_numbers(points, "points")
    if raw.shape == (0,):
        raw = raw.reshape(0, 2)
    if raw.ndim != 2 or raw.shape[1] != 2:
        remedy = "; for a single point write [[x, y]]" if raw.shape == (2,) else ""
        raise MetricError(f"points must have the shape (n, 2), not {raw.shape}{remedy}")
    out = np.ascontiguousarray(raw, np.float64)
    if not np.isfinite(out).all():
        i = int(np.argmin(np.isfinite(out).all(axis=1)))
        raise MetricError(f"point {i} is not finite: ({out[i, 0]}, {out[i, 1]})")
    return out


def as_triangles(triangles: ArrayLike, count: int) -> Ints:
    """Triangles as a contiguous (m, 3) array of int32, whose numbers are below `count`.

    Parameters
    ----------
    triangles : (m, 3) array_like of int
        Vertex numbers from 0.
    count : int
        How many vertices there are.

    Raises
    ------
    MetricError
        For another shape, for numbers that are not integers, or that are out of range.
    """
    return as_indices(triangles, 3, count, "triangle")


def as_indices(items: ArrayLike, columns: int, count: int, kind: str) -> Ints:
    """Rows of vertex numbers in [0, count), as contiguous int32; `kind` names a row in errors."""
    raw = as_numbers(items, f"{kind}s")
    if raw.shape == (0,):
        raw = raw.reshape(0, columns)
    if raw.ndim != 2 or raw.shape[1] != columns:
        raise MetricError(f"{kind}s must have the shape (m, {columns}), not {raw.shape}")
    if raw.size and raw.dtype.kind not in "iu":
        raise MetricError(f"{kind}s must be integers, not {raw.dtype}")
    if raw.size and not (int(raw.min()) >= 0 and int(raw.max()) < count):
        numbers = raw.astype(np.int64, copy=False)
        i = int(((numbers < 0) | (numbers >= count)).any(axis=1).argmax())
        raise MetricError(
            f"{kind} {i} = {tuple(raw[i].tolist())} is out of range: there are {count} points, "
            "numbered from 0"
        )
    return np.ascontiguousarray(raw, np.int32)


def as_numbers(values: object, what: str) -> NDArray[np.generic]:
    """An array of real numbers, of any shape; `what` names it in errors."""
    try:
        raw = np.asarray(values)
    except ValueError as error:
        raise MetricError(f"{what} must be an array of numbers: {error}") from error
    if raw.dtype.kind not in "iuf":
        raise MetricError(f"{what} must be real numbers, not {raw.dtype}")
    return raw


def number(name: str, value: Any, *, minimum: float = -np.inf) -> float:
    """A finite real number, not below `minimum`."""
    if not isinstance(value, Real) or isinstance(value, (bool, np.bool_)):
        raise MetricError(f"{name} must be a number, not {value!r}")
    out = float(value)
    if not np.isfinite(out) or out < minimum:
        bound = "" if minimum == -np.inf else f" and not below {minimum:g}"
        raise MetricError(f"{name} must be finite{bound}, not {value!r}")
    return out


def positive(name: str, value: Any) -> float:
    """A finite number above 0."""
    if number(name, value) <= 0:
        raise MetricError(f"{name} must be positive, not {value!r}")
    return float(value)


def h_limit(h_max: Any, name: str, smallest: float) -> float:
    """The largest size, which may be infinite; not below the one called `name`."""
    if h_max == np.inf:
        return np.inf
    if positive("h_max", h_max) < smallest:
        raise MetricError(f"h_max = {h_max!r} is smaller than {name} = {smallest!r}")
    return float(h_max)


def one_of(name: str, value: Any, choices: tuple[str, ...]) -> Any:
    """One of some words."""
    if not isinstance(value, str) or value not in choices:
        raise MetricError(f"{name} must be one of {', '.join(map(repr, choices))}, not {value!r}")
    return value


def evaluate(
    function: Callable[[Floats], ArrayLike], points: Floats, columns: tuple[int, ...], what: str
) -> Floats:
    """A user's function of points (n, 2): finite numbers (n, *columns), or an error with `what`."""
    try:
        result = function(points.copy())
    except AdaptmeshError:
        raise
    except Exception as error:
        raise MetricError(
            f"{what} raised {type(error).__name__} when called with points of shape "
            f"{points.shape}: {error}"
        ) from error
    out = np.ascontiguousarray(as_numbers(result, what), np.float64)
    expected = (len(points), *columns)
    if out.shape != expected:
        raise MetricError(f"{what}: expected an array of shape {expected}, got {out.shape}")
    finite = np.isfinite(out).all(axis=tuple(range(1, out.ndim)))
    if not finite.all():
        i = int(np.argmin(finite))
        x, y = points[i].tolist()
        raise MetricError(f"{what} at point {i} ({x!r}, {y!r}) is not finite: {out[i].tolist()}")
    return out
