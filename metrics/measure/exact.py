"""Exact measures of meshes in a control space: lengths, areas and qualities.

Exact means by quadrature of the field itself, refined where it varies, and never of a field
interpolated from the vertices of the mesh that is judged.
"""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
from numpy.typing import ArrayLike

import metrics._core as _core
from metrics.checks import as_indices, as_points, as_triangles
from metrics.control import ControlSpace, Metric, as_control_space
from metrics.errors import MetricError
from metrics.topology import mesh_edges
from metrics.types import Floats

from .quadrature import BLOCK, GAUSS_W, GAUSS_X, RADON_W, doubled_areas, root_dets

__all__ = ["edge_lengths", "metric_areas", "qualities"]


def edge_lengths(
    points: ArrayLike, edges: ArrayLike, field: Metric, *, rtol: float = 1e-3, max_depth: int = 8
) -> Floats:
    """Metric lengths of edges: the integral of sqrt(e' M e) along each.

    Gauss-Legendre with 5 points on the two halves of each edge; a half is halved again, up to
    `max_depth` times, where that changes the length by more than `rtol`. A layer much thinner than
    a twentieth of the edge may lie between all the points.

    Parameters
    ----------
    points : (n, 2) array_like
    edges : (k, 2) array_like of int
        Vertex numbers of the ends.
    field : number, callable or ControlSpace
    rtol : float, optional
        The largest change by one more halving that is accepted, relative to the edge. Where the
        metric has kinks, the error left may be a few times that.
    max_depth : int, optional
        How often an edge is halved at most.

    Returns
    -------
    (k,) array of float

    Raises
    ------
    MetricError
        For edges out of range, or where the field is not a metric.
    """
    p = as_points(points)
    ends = p[as_indices(edges, 2, len(p), "edge")]
    return _integrals(_lengths, _halve, as_control_space(field), ends, rtol, max_depth)


def metric_areas(
    points: ArrayLike,
    triangles: ArrayLike,
    field: Metric,
    *,
    rtol: float = 1e-2,
    max_depth: int = 4,
) -> Floats:
    """Metric areas of triangles, (m,): the integral of sqrt(det M), negative for clockwise ones.

    A rule of degree 5 with 7 points on the four quarters of each triangle; a quarter is quartered
    again, up to `max_depth` times, where that changes the area by more than `rtol`.

    Parameters and errors are as for `edge_lengths`.
    """
    p = as_points(points)
    corners = p[as_triangles(triangles, len(p))]
    return _integrals(_areas, _quarter, as_control_space(field), corners, rtol, max_depth)


def qualities(
    points: ArrayLike, triangles: ArrayLike, field: Metric, *, lengths: ArrayLike | None = None
) -> Floats:
    """Metric qualities of triangles, (m,): Q = 4 sqrt(3) area / (sum of squared lengths).

    1 for the unit equilateral triangle, 0 for a flat one, negative for a clockwise one. Where the
    metric varies much within a triangle it may exceed 1 a little.

    Parameters
    ----------
    points : (n, 2) array_like
    triangles : (m, 3) array_like of int
    field : number, callable or ControlSpace
    lengths : (e,) array_like, optional
        The lengths of the edges in the order of `mesh_edges`, where they are known already.
    """
    edges, sides = mesh_edges(triangles)
    if lengths is None:
        lengths = edge_lengths(points, edges, field)
    squares = np.square(np.asarray(lengths, np.float64))
    if squares.shape != (len(edges),):
        raise MetricError(f"lengths must have the shape ({len(edges)},), not {squares.shape}")
    areas = metric_areas(points, triangles, field)
    return 4 * np.sqrt(3) * areas / squares[sides].sum(axis=1)


def _integrals(
    rule: Callable[[ControlSpace, Floats], Floats],
    split: Callable[[Floats], Floats],
    field: ControlSpace,
    simplices: Floats,
    rtol: float,
    max_depth: int,
) -> Floats:
    """Integrals over many simplices (n, corners, 2), block by block."""
    out = np.empty(len(simplices))
    for start in range(0, len(simplices), BLOCK):
        block = slice(start, start + BLOCK)
        out[block] = _refine(rule, split, field, simplices[block], rtol, max_depth)
    return out


def _refine(
    rule: Callable[[ControlSpace, Floats], Floats],
    split: Callable[[Floats], Floats],
    field: ControlSpace,
    simplices: Floats,
    rtol: float,
    max_depth: int,
) -> Floats:
    """Integrals over simplices, of which those are split again that splitting has changed.

    `split` lays the first parts of all simplices before the second parts of all, and so on.
    """
    out = np.zeros(len(simplices))
    owners, values, pieces = np.arange(len(simplices)), rule(field, simplices), simplices
    tolerance = None
    for _ in range(max_depth):
        parts = split(pieces)
        part_values = rule(field, parts)
        count = len(parts) // len(pieces)
        sums = part_values.reshape(count, -1).sum(axis=0)
        if tolerance is None:
            tolerance = rtol * np.abs(sums)
        changed = np.abs(sums - values) > tolerance[owners]
        out += np.bincount(owners[~changed], sums[~changed], len(out))
        if not changed.any():
            return out
        again = np.tile(changed, count)
        owners, values, pieces = np.tile(owners, count)[again], part_values[again], parts[again]
    out += np.bincount(owners, values, len(out))
    return out


def _lengths(field: ControlSpace, segments: Floats) -> Floats:
    start, step = segments[:, 0], segments[:, 1] - segments[:, 0]
    where = start[:, None] + GAUSS_X[:, None] * step[:, None]
    speeds = _core.lengths_in(field(where.reshape(-1, 2)), np.repeat(step, len(GAUSS_X), axis=0))
    return speeds.reshape(-1, len(GAUSS_X)) @ GAUSS_W


def _halve(segments: Floats) -> Floats:
    start, end = segments[:, 0], segments[:, 1]
    middle = 0.5 * (start + end)
    return np.concatenate([np.stack([start, middle], 1), np.stack([middle, end], 1)])


def _areas(field: ControlSpace, triangles: Floats) -> Floats:
    return 0.5 * doubled_areas(triangles) * (root_dets(field, triangles) @ RADON_W)


def _quarter(triangles: Floats) -> Floats:
    a, b, c = (triangles[:, i] for i in range(3))
    ab, bc, ca = 0.5 * (a + b), 0.5 * (b + c), 0.5 * (c + a)
    return np.concatenate(
        [np.stack(t, 1) for t in ((a, ab, ca), (ab, b, bc), (ca, bc, c), (ab, bc, ca))]
    )
