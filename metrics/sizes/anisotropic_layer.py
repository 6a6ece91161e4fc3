"""Thin sizes across a curve and long ones along it, which become one size away from it.

::

    h |                        ______ h_max
      |                     _/
      |  along  _________ _/           along stays as it is until across has come up to it,
      |                 _/             then both are the same: isotropic
      |     across   _/
      |____________/____________ d
"""

from __future__ import annotations

import numpy as np

from metrics.control import ControlSpace
from metrics.types import Floats

from .growth import grown

__all__ = ["layer_metric", "size_along"]


def layer_metric(
    distances: Floats,
    normals: Floats,
    across: float,
    along: Floats,
    slope: float,
    h_max: float,
) -> Floats:
    """Packed tensors (n, 3) with one size along unit normals (n, 2), the other at right angles.

    Across, ``across + slope * d``; along, ``max(along, min(along, across) + slope * d)``: as given
    until the other size has come up to it, or growing at once where it is the smaller one. Neither
    is more than `h_max`.
    """
    high = grown(across, slope, distances, h_max) ** -2
    start = np.minimum(along, across)
    low = np.maximum(np.minimum(along, h_max), grown(start, slope, distances, h_max)) ** -2
    x, y = normals.T
    return np.stack(
        [high * x * x + low * y * y, (high - low) * x * y, high * y * y + low * x * x], axis=1
    )


def size_along(field: ControlSpace, points: Floats, normals: Floats) -> Floats:
    """The sizes (n,) of a field at points, at right angles to normals: 1 / sqrt(t' M t)."""
    m = field(points)
    x, y = normals.T
    squares = m[:, 0] * y * y - 2 * m[:, 1] * x * y + m[:, 2] * x * x
    return 1 / np.sqrt(squares)
