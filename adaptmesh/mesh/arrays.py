"""The arrays that a mesh is given, checked, copied and made read-only."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from adaptmesh._core import triangle_areas as core_triangle_areas
from adaptmesh.domain.inputs import is_level
from adaptmesh.types import Floats, Ints


def plane_points(points: ArrayLike | None) -> NDArray[Any]:
    """Points (n, 2), also of (n, 3) that lie in a plane z = constant; or a `ValueError`."""
    out = np.asarray(() if points is None else points)
    if out.ndim != 2 or out.shape[1] != 3:
        return rows(out, "points", 2)
    z = out[:, 2]
    if len(z) and np.isfinite(out).all() and not is_level(z, out[:, :2]):
        i = int(np.argmax(np.abs(z - z[0])))
        raise ValueError(
            f"point {i} is at height {z[i]:g}, and point 0 at {z[0]:g}: a mesh is plane, give "
            "points[:, :2]"
        )
    return out[:, :2]


def rows(array: ArrayLike | None, what: str, columns: int) -> NDArray[Any]:
    """An (n, columns) array, or a `ValueError`."""
    out = np.asarray(() if array is None else array)
    if out.size == 0:
        return out.reshape(0, columns)
    if out.ndim != 2 or out.shape[1] != columns:
        raise ValueError(f"{what} must be an (n, {columns}) array, not one of shape {out.shape}")
    return out


def numbers(array: ArrayLike | None, what: str, count: int, items: str) -> NDArray[Any]:
    """A number for each of some items, 0 if none are given, or a `ValueError`."""
    out = np.asarray(() if array is None else array)
    if not out.size:
        out = np.zeros(count, np.int32)
    if out.shape != (count,):
        raise ValueError(
            f"{what} must be one number for each of {count} {items}, not of shape {out.shape}"
        )
    return out


def frozen_integers(array: NDArray[Any], what: str) -> Ints:
    """The array as integers of 32 bits, or a `ValueError` that names one that is none."""
    limits = np.iinfo(np.int32)
    if not np.issubdtype(array.dtype, np.integer):
        array = array.astype(np.float64)
    bad = np.argwhere(~((array >= limits.min) & (array <= limits.max) & (array == np.rint(array))))
    if len(bad):
        raise ValueError(
            f"{what} {int(bad[0, 0])} is {array[bad[0, 0]].tolist()}: whole numbers of 32 bits are "
            "wanted"
        )
    out = np.array(array, dtype=np.int32, order="C")
    out.flags.writeable = False
    return out


def frozen_reals(array: NDArray[Any]) -> Floats:
    """The array as real numbers."""
    out = np.array(array, np.float64, order="C")
    out.flags.writeable = False
    return out


def triangle_areas(corners: Floats) -> Floats:
    """Area of each triangle, (m,) of (m, 3, 2), negative if clockwise, infinite if it overflows."""
    with np.errstate(over="ignore", invalid="ignore"):  # products may be infinite, and areas not
        u, v = corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0]
        first, second = u[:, 0] * v[:, 1], u[:, 1] * v[:, 0]
        out: Floats = 0.5 * (first - second)
        # Where the products cancel, what is left is mostly their rounding.
        lost = np.abs(out) < np.abs(first) / 8 + np.abs(second) / 8
    lost |= ~np.isfinite(out) & np.isfinite(corners).all(axis=(1, 2))
    if lost.any():
        out[lost] = core_triangle_areas(corners[lost].reshape(-1, 6))
    return out
