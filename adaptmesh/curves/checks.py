"""What is asked of the points that curves are made of."""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike, NDArray

from ..errors import DomainError

Floats = NDArray[np.float64]


def checked_points(points: ArrayLike, what: str, least: int) -> Floats:
    try:
        out = np.array(points, dtype=np.float64, order="C")
    except (TypeError, ValueError) as error:
        raise DomainError(f"{what}: points must be an (n, 2) array of numbers: {error}") from None
    if out.ndim != 2 or out.shape[1] != 2:
        raise DomainError(f"{what}: points must be an (n, 2) array, not one of shape {out.shape}")
    if len(out) < least:
        raise DomainError(f"{what}: {len(out)} points; at least {least} are needed")
    bad = np.flatnonzero(~np.isfinite(out).all(axis=1))
    if len(bad):
        x, y = out[bad[0]]
        raise DomainError(f"{what}: point {bad[0]} is ({x}, {y}): coordinates must be finite")
    out.flags.writeable = False
    return out


def checked_point(point: ArrayLike, what: str) -> Floats:
    out = np.array(point, dtype=np.float64)
    if out.shape != (2,) or not np.isfinite(out).all():
        raise DomainError(f"{what}: {point!r} is no pair of finite numbers")
    return out


def check_distinct(points: Floats, what: str) -> None:
    same = np.flatnonzero((points[1:] == points[:-1]).all(axis=1))
    if len(same):
        i = same[0]
        x, y = points[i]
        raise DomainError(f"{what}: points {i} and {i + 1} are the same, ({x:g}, {y:g})")
