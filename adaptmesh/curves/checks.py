"""Checks of the points that define curves."""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike

from adaptmesh import checks
from adaptmesh.errors import DomainError
from adaptmesh.types import Floats


def checked_points(points: ArrayLike, what: str, min_count: int) -> Floats:
    """Return the points of a curve as an (n, 2) array; raise `DomainError` with its name."""
    try:
        out = checks.checked_points(points, "point", least=0)
    except DomainError as error:
        raise DomainError(f"{what}: {error}") from None
    if len(out) < min_count:
        raise DomainError(f"{what}: expected at least {min_count} points, got {len(out)}")
    return out


def checked_point(point: ArrayLike, what: str) -> Floats:
    out = np.array(point, dtype=np.float64)
    if out.shape != (2,) or not np.isfinite(out).all():
        raise DomainError(f"{what}: expected two finite numbers, got {point!r}")
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
