"""The arrays that come in: converted once, checked once, never changed."""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike, NDArray

from .errors import MetricError
from .types import Floats, Ints

__all__ = ["Floats", "Ints", "as_points", "as_triangles"]


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
