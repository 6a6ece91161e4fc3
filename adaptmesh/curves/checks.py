"""What is asked of the points that curves are made of."""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike

from adaptmesh import checks
from adaptmesh.errors import DomainError
from adaptmesh.types import Floats


def checked_points(points: ArrayLike, what: str, least: int) -> Floats:
    """The points of a curve, (n, 2), or a `DomainError` that names it."""
    try:
        out = checks.checked_points(points, "point", least=0)
    except DomainError as error:
        raise DomainError(f"{what}: {error}") from None
    if len(out) < least:
        raise DomainError(f"{what}: {len(out)} points; at least {least} are needed")
    return out


def checked_point(point: ArrayLike, what: str) -> Floats:
    out = np.array(point, dtype=np.float64)
    if out.shape != (2,) or not np.isfinite(out).all():
        raise DomainError(f"{what}: {point!r} is no pair of finite numbers")
    if np.abs(out).max() > checks.LARGEST:
        raise DomainError(
            f"{what}: {point!r} is beyond {checks.LARGEST:g}, where areas overflow; choose "
            "another unit of length"
        )
    return out


def check_distinct(points: Floats, what: str) -> None:
    same = np.flatnonzero((points[1:] == points[:-1]).all(axis=1))
    if len(same):
        i = same[0]
        x, y = points[i]
        raise DomainError(f"{what}: points {i} and {i + 1} are the same, ({x:g}, {y:g})")
