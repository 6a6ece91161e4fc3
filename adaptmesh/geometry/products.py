"""Products of vectors of the plane."""

from __future__ import annotations

import numpy as np

from adaptmesh.types import Floats


def cross(u: Floats, v: Floats) -> Floats:
    """Areas of the parallelograms of vectors (..., 2), positive where v is on the left of u."""
    return u[..., 0] * v[..., 1] - u[..., 1] * v[..., 0]


def angles_between(u: Floats, v: Floats) -> Floats:
    """Angles between vectors (..., 2), from 0 to pi."""
    return np.abs(np.arctan2(cross(u, v), (u * v).sum(axis=-1)))
