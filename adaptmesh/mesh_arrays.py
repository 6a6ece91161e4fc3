"""The arrays that a mesh is given, checked, copied and made read-only."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

Floats = NDArray[np.float64]
Ints = NDArray[np.int32]


def rows(array: ArrayLike, what: str, columns: int) -> NDArray[Any]:
    """An (n, columns) array, or a `ValueError`."""
    out = np.asarray(array)
    if out.size == 0:
        return out.reshape(0, columns)
    if out.ndim != 2 or out.shape[1] != columns:
        raise ValueError(f"{what} must be an (n, {columns}) array, not one of shape {out.shape}")
    return out


def numbers(array: ArrayLike, what: str, count: int, items: str) -> NDArray[Any]:
    """A number for each of some items, 0 if none are given, or a `ValueError`."""
    out = np.asarray(array) if np.size(array) else np.zeros(count, np.int32)
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
