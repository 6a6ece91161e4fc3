"""Areas of triangles, accurate however thin these are."""

from __future__ import annotations

import numpy as np

from adaptmesh._core import triangle_areas as core_triangle_areas
from adaptmesh.types import Floats


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
