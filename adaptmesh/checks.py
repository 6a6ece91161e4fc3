"""What users give, checked: points, integers, numbers, functions; errors name what is wrong."""

from __future__ import annotations

import math
from collections.abc import Mapping
from numbers import Real
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from .errors import DomainError
from .types import Array, Floats, Ints

LARGEST = 1e75  # coordinate: its fourth power is still a double
FLAT = 1e-9
"""Heights that differ by at most this share of the extent are rounding: the points are plane."""


def read_only(array: Array) -> Array:
    array.flags.writeable = False
    return array


def checked_points(points: ArrayLike, what: str, least: int = 3) -> Floats:
    """Coordinates (n, 2) that areas can be computed of, or a `DomainError`."""
    try:
        if np.iscomplexobj(points):
            raise TypeError("they are complex")
        out = np.array(points, dtype=np.float64, order="C")
    except (TypeError, ValueError) as error:
        raise DomainError(f"{what}s must be an (n, 2) array of numbers: {error}") from None
    if out.size == 0:
        out = out.reshape(0, 2)
    if out.ndim == 2 and out.shape[1] == 3:
        out = _without_heights(out, what)
    if out.ndim != 2 or out.shape[1] != 2:
        raise DomainError(f"{what}s must be an (n, 2) array, not one of shape {out.shape}")
    if len(out) < least:
        raise DomainError(f"{len(out)} {what}s: at least {least} are needed")
    check_range(out, what)
    return read_only(out)


def check_range(out: Floats, what: str) -> None:
    """Refuse coordinates of which no exact signs and no areas can be computed."""
    bad = np.flatnonzero(~np.isfinite(out).all(axis=1))
    if len(bad):
        x, y = out[bad[0]]
        raise DomainError(f"{what} {bad[0]} is ({x}, {y}): coordinates must be finite")
    bad = np.flatnonzero((np.abs(out) > LARGEST).any(axis=1))
    if len(bad):
        x, y = out[bad[0]]
        raise DomainError(
            f"{what} {bad[0]} is ({x:g}, {y:g}): areas and squares of coordinates beyond "
            f"{LARGEST:g} overflow; choose another unit of length"
        )


def _without_heights(points: Floats, what: str) -> Floats:
    """Points (n, 3) that lie in a plane z = constant without z, or a `DomainError`."""
    z = points[:, 2]
    if np.isfinite(points).all() and not is_level(z, points[:, :2]):
        i = int(np.argmax(np.abs(z - z[0])))
        raise DomainError(
            f"{what} {i} is at height {z[i]:g}, and {what} 0 at {z[0]:g}: a domain is plane, give "
            "[:, :2] of the points"
        )
    return np.ascontiguousarray(points[:, :2])


def is_level(heights: Floats, xy: Floats) -> bool:
    """Whether points lie in one plane z = constant, to `FLAT` of their extent."""
    half_width = heights.max() / 2 - heights.min() / 2  # halves, as differences may overflow
    half_extent = (xy.max(axis=0) / 2 - xy.min(axis=0) / 2).max()
    return bool(half_width <= FLAT * half_extent)


def plane_points(points: ArrayLike | None) -> Array:
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


def rows(array: ArrayLike | None, what: str, columns: int) -> Array:
    """An (n, columns) array, or a `ValueError`."""
    out = np.asarray(() if array is None else array)
    if out.size == 0:
        return out.reshape(0, columns)
    if out.ndim != 2 or out.shape[1] != columns:
        raise ValueError(f"{what} must be an (n, {columns}) array, not one of shape {out.shape}")
    return out


def numbers(array: ArrayLike | None, what: str, count: int, items: str) -> Array:
    """A number for each of some items, 0 if none are given, or a `ValueError`."""
    out = np.asarray(() if array is None else array)
    if not out.size:
        out = np.zeros(count, np.int32)
    if out.shape != (count,):
        raise ValueError(
            f"{what} must be one number for each of {count} {items}, not of shape {out.shape}"
        )
    return out


def frozen_integers(array: Array, what: str) -> Ints:
    """The array as integers of 32 bits, or a `ValueError` that names one that is none."""
    limits = np.iinfo(np.int32)
    if not np.issubdtype(array.dtype, np.integer):
        array = array.astype(np.float64)
    bad = np.argwhere(~((array >= limits.min) & (array <= limits.max) & (array == np.rint(array))))
    if len(bad):
        raise ValueError(
            f"{what} {int(bad[0, 0])} is {array[bad[0, 0]].tolist()}: expected whole numbers of 32 "
            "bits"
        )
    out = np.array(array, dtype=np.int32, order="C")
    out.flags.writeable = False
    return out


def frozen_reals(array: Array) -> Floats:
    """The array as real numbers."""
    out = np.array(array, np.float64, order="C")
    out.flags.writeable = False
    return out


def checked_number(value: object, what: str) -> float:
    """A finite real number, or a `DomainError`."""
    try:
        number = float(value)  # type: ignore[arg-type]
    except (TypeError, ValueError, OverflowError):
        number = math.nan
    if not math.isfinite(number) or isinstance(value, str):
        raise DomainError(f"{what}={value!r}: expected a finite number")
    return number


def checked_pairs(segments: ArrayLike, n_points: int) -> Ints:
    """Pairs of point numbers, (k, 2), or a `DomainError`."""
    raw = np.asarray(segments)
    if raw.size == 0:
        raise DomainError("no segments: say which points the boundary joins, e.g. Domain.polygon")
    if raw.ndim != 2 or raw.shape[1] != 2:
        raise DomainError(f"segments must be a (k, 2) array, not one of shape {raw.shape}")
    if not np.issubdtype(raw.dtype, np.integer):
        raise DomainError(f"segments must be integers, pairs of point numbers, not {raw.dtype}")
    bad = np.flatnonzero(((raw < 0) | (raw >= n_points)).any(axis=1))
    if len(bad):
        i = bad[0]
        raise DomainError(
            f"segment {i} joins points {raw[i, 0]} and {raw[i, 1]}, but the points are numbered "
            f"0 to {n_points - 1}"
        )
    return read_only(np.array(raw, dtype=np.int32, order="C"))


def check_is_mapping(labels: object, what: str) -> None:
    """Refuse what gives nothing for each name."""
    if not isinstance(labels, Mapping):
        raise DomainError(f"{what} must be a mapping of names, not {type(labels).__name__}")


def expect_number(name: str, value: Any) -> None:
    """A `TypeError` for what is no real number."""
    if not isinstance(value, Real) or isinstance(value, bool):
        raise TypeError(f"{name}={value!r}: expected a number")


def expect_whole(name: str, value: Any, least: int) -> None:
    """Also a `ValueError` for what is not whole, or less than the least."""
    expect_number(name, value)
    if not value >= least or value != int(value):
        raise ValueError(f"{name}={value!r}: expected a whole number, at least {least}")


def expect_function(name: str, value: Any) -> None:
    """A `TypeError` for what cannot be called; None stands for one that need not be given."""
    if value is not None and not callable(value):
        raise TypeError(f"{name} must be a function, not {type(value).__name__}")
