"""Quadrature rules on segments and triangles, and sqrt(det M) at their points."""

from __future__ import annotations

import numpy as np

import metrics._core as _core
from metrics.control import ControlSpace
from metrics.types import Floats

BLOCK = 1 << 15  # segments or triangles measured at a time: tens of megabytes

# Gauss-Legendre, 5 points, on [0, 1].
_x, _w = np.polynomial.legendre.leggauss(5)
GAUSS_X, GAUSS_W = 0.5 * (_x + 1), 0.5 * _w

# Radon's rule of degree 5 with 7 points: the centroid, and two orbits of three. Dunavant, High
# degree efficient symmetrical Gaussian quadrature rules for the triangle, IJNME 21 (1985).
_R = np.sqrt(15.0)
RADON_X = np.array(
    [[1 / 3, 1 / 3, 1 / 3]]
    + [np.roll([1 - 2 * s, s, s], k) for s in ((6 + _R) / 21, (6 - _R) / 21) for k in range(3)]
)
RADON_W = np.repeat([9 / 40, (155 + _R) / 1200, (155 - _R) / 1200], [1, 3, 3])


def root_dets(field: ControlSpace, triangles: Floats) -> Floats:
    """The square root of det M at the 7 points of each triangle (k, 3, 2): (k, 7)."""
    where = np.einsum("qi,kid->kqd", RADON_X, triangles)
    return np.sqrt(_core.det(field(where.reshape(-1, 2)))).reshape(-1, len(RADON_X))


def doubled_areas(triangles: Floats) -> Floats:
    u, v = triangles[:, 1] - triangles[:, 0], triangles[:, 2] - triangles[:, 0]
    return u[:, 0] * v[:, 1] - u[:, 1] * v[:, 0]
