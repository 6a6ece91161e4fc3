"""Measures of a mesh in a metric known at its own vertices.

Between the vertices the logarithm of the metric is linear, as `Background` has it. So these are
cheap, and judge a metric as it is carried; `measure` judges a mesh by the metric as it was asked.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

import metrics._core as _core
from metrics import tensor
from metrics.checks import as_indices, as_points, as_triangles
from metrics.errors import MetricError
from metrics.topology import border_edges, mesh_edges
from metrics.types import Floats

__all__ = [
    "LENGTH_RULES",
    "efficiency_index",
    "h_shocks",
    "nodal_areas",
    "nodal_complexity",
    "nodal_lengths",
    "nodal_qualities",
    "predicted_vertices",
]


def nodal_lengths(
    points: ArrayLike, edges: ArrayLike, metric: Any, rule: str = "quadrature"
) -> Floats:
    """Metric lengths of edges, (k,), from the metric at the vertices.

    Parameters
    ----------
    points : (n, 2) array_like
    edges : (k, 2) array_like of int
        Vertex numbers of the ends.
    metric : (n,), (n, 3) or (n, 2, 2) array_like, or callable
        Sizes, packed tensors or matrices at the points; a function or control space is evaluated
        there and nowhere else.
    rule : {"quadrature", "simpson", "logarithmic"}, optional
        With a and b the lengths of the edge in the metrics of its two ends:
        ``"quadrature"``: the integral of sqrt(e' M e) by 8 Gauss points, with log M linear between.
        ``"simpson"``: (a + 4 m + b) / 6, with m in the geometric mean of the two metrics; what the
        mesher uses, see `metrics.tensor.lengths`.
        ``"logarithmic"``: (a - b) / ln(a / b), for sizes that change geometrically along the edge.
        They agree where the two ends differ little; name the rule beside a number.
    """
    if rule not in LENGTH_RULES:
        raise MetricError(f"rule must be one of {', '.join(map(repr, LENGTH_RULES))}, not {rule!r}")
    p = as_points(points)
    ends = as_indices(edges, 2, len(p), "edge")
    m = at_vertices(p, metric)
    return LENGTH_RULES[rule](m[ends[:, 0]], m[ends[:, 1]], p[ends[:, 1]] - p[ends[:, 0]])


def h_shocks(points: ArrayLike, edges: ArrayLike, metric: Any) -> Floats:
    """How fast sizes change along edges, (k,): max(h_q / h_p, h_p / h_q)^(1 / l), at least 1.

    h is the size along the edge at either end, and l its length by the rule ``"logarithmic"`` of
    `nodal_lengths`. From one unit edge to the next, the H-shock 1.2 is a growth by 20 %.
    Parameters are as for `nodal_lengths`.

    References
    ----------
    Borouchaki, Hecht, Frey: Mesh gradation control. International Journal for Numerical Methods in
    Engineering 43 (1998), 1143-1165.
    """
    p = as_points(points)
    ends = as_indices(edges, 2, len(p), "edge")
    m = at_vertices(p, metric)
    vectors = p[ends[:, 1]] - p[ends[:, 0]]
    if not vectors.any(axis=1).all():
        i = int(np.argmin(vectors.any(axis=1)))
        raise MetricError(f"edge {i} = {tuple(ends[i].tolist())} has no length")
    a, b = _core.lengths_in(m[ends[:, 0]], vectors), _core.lengths_in(m[ends[:, 1]], vectors)
    return np.exp(np.abs(np.log(a / b)) / _logarithmic_mean(a, b))


def nodal_areas(points: ArrayLike, triangles: ArrayLike, metric: Any) -> Floats:
    """Metric areas of triangles, (m,): the integral of sqrt(det M), negative for clockwise ones.

    Exact, in closed form: the logarithm of sqrt(det M) is linear on a triangle. Parameters are as
    for `nodal_lengths`.
    """
    p = as_points(points)
    t = as_triangles(triangles, len(p))
    return _core.areas(p, t, at_vertices(p, metric))


def nodal_qualities(points: ArrayLike, triangles: ArrayLike, metric: Any) -> Floats:
    """Metric qualities of triangles, (m,): Q = 4 sqrt(3) area / (sum of squared lengths).

    1 for the unit equilateral triangle, 0 for a flat one, negative for a clockwise one. Areas are
    exact, and lengths by quadrature. Parameters are as for `nodal_lengths`.
    """
    edges, sides = mesh_edges(triangles)
    squares = nodal_lengths(points, edges, metric)[sides] ** 2
    areas = nodal_areas(points, triangles, metric)
    return 4 * np.sqrt(3) * areas / squares.sum(axis=1)


def nodal_complexity(points: ArrayLike, triangles: ArrayLike, metric: Any) -> float:
    """The integral of sqrt(det M) over the mesh: the sum of `nodal_areas`."""
    return float(nodal_areas(points, triangles, metric).sum())


def predicted_vertices(points: ArrayLike, triangles: ArrayLike, metric: Any) -> float:
    """How many vertices a mesh will have that is unit in the metric: (2 / sqrt 3) C + B / 2 + 1.

    As in a hexagonal lattice of unit edges: C is `nodal_complexity`, and B the metric length of
    the border of the mesh. To about 5 %, except for meshes of a few triangles. Parameters are as
    for `nodal_lengths`.
    """
    p = as_points(points)
    m = at_vertices(p, metric)
    border = border_edges(triangles)
    return vertices_of(nodal_complexity(p, triangles, m), nodal_lengths(p, border, m).sum())


def vertices_of(complexity: float, border: float) -> float:
    """How many vertices a unit mesh has, with a border of that metric length."""
    return float(2 / np.sqrt(3) * complexity + border / 2 + 1)


def efficiency_index(lengths: ArrayLike, definition: str = "mean square") -> float:
    """One number for the lengths of all edges of a mesh: 1 if each is 1, and less otherwise.

    Parameters
    ----------
    lengths : (k,) array_like
        Metric lengths by any rule.
    definition : {"mean square", "frey-george"}, optional
        With q = min(l, 1 / l): ``"mean square"``: 1 - mean (1 - q)²; ``"frey-george"``:
        exp(mean(q - 1)), by Frey and George, Mesh Generation, 2nd edition, ISTE and Wiley (2008).
        Near 1 the second is the smaller of the two: never compare one with the other.
    """
    given = np.asarray(lengths, np.float64)
    if given.ndim != 1 or given.size == 0 or not (given > 0).all():
        raise MetricError("lengths must be positive numbers in one dimension, at least one")
    shortfall = 1 - np.minimum(given, 1 / given)
    if definition == "mean square":
        return float(1 - np.mean(shortfall**2))
    if definition == "frey-george":
        return float(np.exp(-shortfall.mean()))
    raise MetricError(f'definition must be "mean square" or "frey-george", not {definition!r}')


def at_vertices(points: Floats, metric: Any) -> Floats:
    """Packed tensors (n, 3) from values at the points, or from what can be evaluated there."""
    values = metric(points) if callable(metric) else metric
    return tensor.pack(values, points=points)


def _by_quadrature(start: Floats, end: Floats, vectors: Floats) -> Floats:
    return _core.lengths_by_quadrature(_core.log(start), _core.log(end), vectors)


def _by_logarithmic_mean(start: Floats, end: Floats, vectors: Floats) -> Floats:
    return _logarithmic_mean(_core.lengths_in(start, vectors), _core.lengths_in(end, vectors))


LENGTH_RULES: dict[str, Callable[[Floats, Floats, Floats], Floats]] = {
    "quadrature": _by_quadrature,
    "simpson": _core.lengths,
    "logarithmic": _by_logarithmic_mean,
}


def _logarithmic_mean(a: Floats, b: Floats) -> Floats:
    """(a - b) / ln(a / b), and a where they are equal: b (e^x - 1) / x with x = ln(a / b)."""
    x = np.log(np.divide(a, b, out=np.ones_like(a), where=b > 0))
    near = np.abs(x) < 1e-8
    return b * np.where(near, 1 + x / 2, np.expm1(x) / np.where(near, 1, x))
