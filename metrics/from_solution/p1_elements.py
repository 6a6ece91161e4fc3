"""Linear finite elements on a mesh: what estimates and recovery are computed with."""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike

import metrics._core as _core
from metrics.checks import as_numbers, as_points, as_triangles
from metrics.errors import MetricError
from metrics.types import Floats, Ints


def check_values(
    points: ArrayLike, triangles: ArrayLike, values: ArrayLike
) -> tuple[Floats, Ints, Floats]:
    """The arrays of a mesh and of values (n,) at its vertices, fit to be differentiated."""
    p, t = check_mesh(points, triangles)
    u = np.ascontiguousarray(as_numbers(values, "values"), np.float64)
    if u.shape != (len(p),):
        raise MetricError(f"values must have the shape ({len(p)},), one a point, not {u.shape}")
    if not np.isfinite(u).all():
        i = int(np.argmin(np.isfinite(u)))
        raise MetricError(f"the value at {place_of(p, i)} is not finite: {u[i]}")
    return p, t, u


def check_mesh(points: ArrayLike, triangles: ArrayLike) -> tuple[Floats, Ints]:
    """Points and counter-clockwise triangles; every point is in one."""
    p = as_points(points)
    t = as_triangles(triangles, len(p))
    i = _core.check_triangles(p, t)
    if i >= 0:
        raise MetricError(f"triangle {i} = {tuple(t[i].tolist())} is not counter-clockwise")
    alone = np.bincount(t.ravel(), minlength=len(p)) == 0
    if alone.any():
        raise MetricError(
            f"{place_of(p, int(alone.argmax()))} is in no triangle: leave it "
            "out, of a Mesh with mesh.cleaned()"
        )
    return p, t


def place_of(points: Floats, i: int) -> str:
    x, y = points[i].tolist()
    return f"point {i} ({x!r}, {y!r})"


class LinearElements:
    """The hat functions of a mesh.

    Attributes
    ----------
    triangles : (m, 3) array of int
    areas : (m,) array
    slopes : (m, 3, 2) array
        The gradients of the three hat functions on each triangle.
    mass : (n,) array
        The mass matrix, lumped: a third of the area of the triangles around each vertex.
    """

    def __init__(self, points: Floats, triangles: Ints) -> None:
        self.triangles = triangles
        corners = points[triangles]
        opposite = corners[:, [2, 0, 1]] - corners[:, [1, 2, 0]]
        u, v = corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0]
        doubled = u[:, 0] * v[:, 1] - u[:, 1] * v[:, 0]
        self.areas = doubled / 2
        self.slopes = np.stack([-opposite[..., 1], opposite[..., 0]], 2) / doubled[:, None, None]
        self.mass = self.gather(np.repeat(self.areas[:, None] / 3, 3, axis=1))

    def gradients(self, u: Floats) -> Floats:
        """Gradients on triangles, (m, 2), of the function with the values u (n,)."""
        return np.einsum("ti,tik->tk", u[self.triangles], self.slopes)

    def gather(self, parts: Floats) -> Floats:
        """Sums at vertices (n,) of parts at the corners of triangles (m, 3)."""
        return np.bincount(self.triangles.ravel(), parts.ravel()).astype(np.float64)
