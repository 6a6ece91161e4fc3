"""The metric that a mesh is unit for."""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike

import metrics._core as _core
from metrics import tensor
from metrics.checks import as_points, as_triangles
from metrics.errors import MetricError
from metrics.types import Floats

__all__ = ["implied_metric", "triangle_metrics"]


def triangle_metrics(points: ArrayLike, triangles: ArrayLike) -> Floats:
    """The metric, packed (m, 3), in which all three edges of each triangle have length 1.

    The three equations e' M e = 1 have the solution M = adj(S) / (8 area²), where S is the sum of
    e e' over the edges: for the unit equilateral triangle S = 3/2 I, and both sides change alike
    when the triangle is mapped linearly.

    Raises
    ------
    MetricError
        For a triangle that is not counter-clockwise, or too flat for a metric.
    """
    p = as_points(points)
    t = as_triangles(triangles, len(p))
    i = _core.check_triangles(p, t)
    if i >= 0:
        raise MetricError(f"triangle {i} = {tuple(t[i].tolist())} is not counter-clockwise")
    corners = p[t]
    edges = np.roll(corners, -1, axis=1) - corners
    x, y = edges[..., 0], edges[..., 1]
    doubled = x[:, 0] * y[:, 1] - y[:, 0] * x[:, 1]
    out = np.stack([(y * y).sum(1), -(x * y).sum(1), (x * x).sum(1)], axis=1)
    return tensor.pack(out / (2 * doubled**2)[:, None], what="the metric of a triangle")


def implied_metric(points: ArrayLike, triangles: ArrayLike) -> Floats:
    """The metric at the vertices, packed (n, 3), for which a mesh is as nearly unit as it can be.

    At each vertex the log-Euclidean mean of `triangle_metrics` around it, all with the same weight:
    each has the same area in its own metric. So the complexity is that of the mesh, and meshing for
    it again gives about as many triangles; for four times it, four times as many. (Weighted by area
    in the plane, as some do, the large triangles beside small ones would make it too coarse.)

    Raises
    ------
    MetricError
        As for `triangle_metrics`, and for a vertex without triangle.
    """
    p = as_points(points)
    t = as_triangles(triangles, len(p))
    logs = tensor.log(triangle_metrics(p, t))
    owners = t.ravel()
    count = np.bincount(owners, minlength=len(p))
    if (count == 0).any():
        i = int(np.argmin(count))
        x, y = p[i].tolist()
        raise MetricError(
            f"point {i} ({x!r}, {y!r}) is in no triangle: leave it "
            "out, of a Mesh with mesh.cleaned()"
        )
    sums = [np.bincount(owners, np.repeat(logs[:, k], 3), len(p)) for k in range(3)]
    return tensor.exp(np.stack(sums, axis=1) / count[:, None])
