"""Small triangulations to compute on, without a mesher."""

import numpy as np
from scipy.spatial import Delaunay


def irregular_square(n, jitter=0.22, seed=0):
    """The unit square with n x n vertices, those inside moved by up to `jitter` of their distance.

    The diagonals of the cells go either way at random.
    """
    rng = np.random.default_rng(seed)
    points, cells = _cells(n)
    inside = ~on_border(points)
    points[inside] += jitter / (n - 1) * rng.uniform(-1, 1, (inside.sum(), 2))
    one = rng.random(cells.shape[1])[:, None] < 0.5
    a, b, c, d = cells
    first = np.where(one, np.stack([a, b, c], 1), np.stack([a, b, d], 1))
    second = np.where(one, np.stack([a, c, d], 1), np.stack([b, c, d], 1))
    return points, np.concatenate([first, second]).astype(np.int32)


def regular_square(n):
    """The unit square with n x n vertices and all diagonals parallel."""
    points, (a, b, c, d) = _cells(n)
    return points, np.concatenate([np.stack([a, b, c], 1), np.stack([a, c, d], 1)])


def _cells(n):
    x, y = np.meshgrid(np.linspace(0, 1, n), np.linspace(0, 1, n))
    k = np.arange(n * n, dtype=np.int32).reshape(n, n)
    corners = (k[:-1, :-1], k[:-1, 1:], k[1:, 1:], k[1:, :-1])
    return np.stack([x.ravel(), y.ravel()], axis=1), np.stack([part.ravel() for part in corners])


def delaunay(points):
    """Counter-clockwise Delaunay triangles of points in general position."""
    t = Delaunay(points).simplices
    u, v = points[t[:, 1]] - points[t[:, 0]], points[t[:, 2]] - points[t[:, 0]]
    clockwise = u[:, 0] * v[:, 1] < u[:, 1] * v[:, 0]
    return np.where(clockwise[:, None], t[:, ::-1], t).astype(np.int32)


def on_border(points):
    """Which points of the unit square lie on its border."""
    return ((points < 1e-9) | (points > 1 - 1e-9)).any(axis=1)


def from_axes(h1, h2, angle):
    """Packed tensors with the size h1 along the angle and h2 across."""
    h1, h2, angle = np.broadcast_arrays(h1, h2, angle)
    l1, l2, c, s = h1**-2.0, h2**-2.0, np.cos(angle), np.sin(angle)
    return np.stack([l1 * c * c + l2 * s * s, (l1 - l2) * c * s, l1 * s * s + l2 * c * c], -1)
