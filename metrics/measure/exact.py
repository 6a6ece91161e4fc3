"""Exact measures of meshes in a control space: lengths, areas, qualities, complexity.

Exact means by quadrature of the field itself, refined where it varies, and never of a field
interpolated from the vertices of the mesh that is judged.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import NamedTuple

import numpy as np
from numpy.typing import ArrayLike, NDArray

from metrics import _core
from metrics.checks import as_indices, as_points, as_triangles
from metrics.control import ControlSpace, Metric, as_control_space
from metrics.errors import MetricError
from metrics.types import Floats, Ints

__all__ = ["Complexity", "complexity", "edge_lengths", "mesh_edges", "metric_areas", "qualities"]

Numbers = NDArray[np.intp]

_SPARSE = 16  # with so many times more numbers than corners, most have no triangle

# When sqrt(det M) varies by more than the exponential of this on a triangle, anything may be
# between samples.
_SMOOTH = 3.0
_DOUBT = 0.03  # how much an error that is only possible counts for, beside one that is seen
_GAP = 0.2  # from a point of a triangle to the nearest sample, relative to its width

_BLOCK = 1 << 15  # segments or triangles measured at a time: tens of megabytes

# Gauss-Legendre, 5 points, on [0, 1].
_x, _w = np.polynomial.legendre.leggauss(5)
_GAUSS_X, _GAUSS_W = 0.5 * (_x + 1), 0.5 * _w

# Radon's rule of degree 5 with 7 points: the centroid, and two orbits of three. Dunavant, High
# degree efficient symmetrical Gaussian quadrature rules for the triangle, IJNME 21 (1985).
_R = np.sqrt(15.0)
_RADON_X = np.array(
    [[1 / 3, 1 / 3, 1 / 3]]
    + [np.roll([1 - 2 * s, s, s], k) for s in ((6 + _R) / 21, (6 - _R) / 21) for k in range(3)]
)
_RADON_W = np.repeat([9 / 40, (155 + _R) / 1200, (155 - _R) / 1200], [1, 3, 3])


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
        The largest change by one more halving that is let be, relative to the edge. Where the
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
    return _integrals(_lengths, _halved, as_control_space(field), ends, rtol, max_depth)


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
    return _integrals(_areas, _quartered, as_control_space(field), corners, rtol, max_depth)


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


def mesh_edges(triangles: ArrayLike) -> tuple[Ints, Ints]:
    """The edges of triangles, each once, and which of them each triangle has.

    Returns
    -------
    edges : (e, 2) array of int32
        Smaller vertex number first, sorted.
    sides : (m, 3) array of int32
        ``sides[t, i]`` is the number of the edge opposite vertex i of triangle t.
    """
    t = as_triangles(triangles, np.iinfo(np.int32).max)
    count = int(t.max(initial=-1)) + 1
    if count <= _SPARSE * t.size:
        return _core.mesh_edges(t, count)
    used, dense = np.unique(t, return_inverse=True)
    edges, sides = _core.mesh_edges(dense.reshape(-1, 3).astype(np.int32), len(used))
    return used[edges], sides


class Complexity(NamedTuple):
    """The integral of sqrt(det M), how wrong it may be, and what it took."""

    value: float
    error: float
    evaluations: int


def complexity(
    points: ArrayLike,
    triangles: ArrayLike,
    field: Metric,
    *,
    rtol: float = 1e-2,
    max_evaluations: int = 100_000,
) -> Complexity:
    """The complexity C of a field: the integral of sqrt(det M) over a domain.

    A unit mesh has about ``2 / sqrt(3) * C`` vertices and ``4 / sqrt(3) * C`` triangles, so this
    predicts the size of a mesh before it is made, from any triangulation of the domain, however
    coarse and thin: where the integral is least certain, triangles are cut in two across the edge
    along which log sqrt(det M) varies most, so that a layer is cut along itself.

    A feature that is not graded into its surroundings and is smaller than a few percent of the
    domain may lie between all the points: then neither the value nor its error know of it.

    Parameters
    ----------
    points : (n, 2) array_like
    triangles : (m, 3) array_like of int
        Clockwise ones count negative.
    field : number, callable or ControlSpace
    rtol : float, optional
        When to stop: the sum of all estimated errors relative to the integral.
    max_evaluations : int, optional
        When to stop at the latest: how often the field may be evaluated (but once over the
        triangulation given, at 21 points a triangle, in any case).

    Returns
    -------
    Complexity
        Named tuple of `value`, `error` and `evaluations`. The error is a bound, at any angle, where
        sizes are graded: a layer is reckoned with as soon as the sizes beside it fall towards it,
        and usually the value is right to a tenth of it. When `max_evaluations` stopped it, `error`
        is more than `rtol` of `value`, and an estimate.
    """
    p = as_points(points)
    corners = p[as_triangles(triangles, len(p))]
    space = as_control_space(field)
    once = 3 * len(_RADON_W) * len(corners)
    if once > max_evaluations:
        blocks = (corners[k : k + _BLOCK] for k in range(0, len(corners), _BLOCK))
        value, error = np.sum([_Leaves.of(space, block).totals() for block in blocks], axis=0)
        return Complexity(float(value), float(error), once)
    return _adapted(space, _at_least(corners, 256), rtol, max_evaluations)


def _adapted(
    field: ControlSpace, triangles: Floats, rtol: float, max_evaluations: int
) -> Complexity:
    """The adaptive quadrature: the leaves whose errors do not fit the tolerance are cut, again."""
    leaves = _Leaves.of(field, triangles)
    evaluations = 3 * len(_RADON_W) * len(triangles)
    cost = 4 * len(_RADON_W)  # of cutting one leaf: two new leaves, each with its two parts
    while True:
        value, error = leaves.totals()
        affordable = (max_evaluations - evaluations) // cost
        if error <= rtol * abs(value) or affordable <= 0:
            return Complexity(value, error, evaluations)
        errors = leaves.errors()
        # What is known to be wrong goes first, what may be later, and the worst before what is less
        # wrong by far: so a budget that is too small for the bound serves the value.
        urgency = leaves.differences + _DOUBT * (errors - leaves.differences)
        worst = np.argsort(-urgency, kind="stable")
        rest = error - np.cumsum(errors[worst])
        needed = int(np.count_nonzero(rest > 0.5 * rtol * abs(value))) + 1
        urgent = int(np.count_nonzero(urgency >= _DOUBT * urgency[worst[0]]))
        chosen = worst[: min(needed, urgent, affordable)]
        leaves = leaves.cut(field, chosen)
        evaluations += cost * len(chosen)


class _Leaves(NamedTuple):
    """Triangles of an adaptive quadrature, each known as the sum of its two parts.

    `parts` (2, k, 3, 2) are the corners of the parts, `samples` (2, k, 7) the values of
    sqrt(det M) in them, `sums` (k,) the integrals, and `differences` (k,) how far a sum is from the
    integral over the undivided triangle.
    """

    parts: Floats
    samples: Floats
    sums: Floats
    differences: Floats

    @classmethod
    def of(cls, field: ControlSpace, triangles: Floats, samples: Floats | None = None) -> _Leaves:
        if samples is None:
            samples = _root_dets(field, triangles)
        whole = _doubled_areas(triangles) * (samples @ _RADON_W) / 2
        parts = _bisected(triangles, _edge_to_cut(samples))
        flat = parts.reshape(-1, 3, 2)
        inner = _root_dets(field, flat)
        halves = (_doubled_areas(flat) * (inner @ _RADON_W) / 2).reshape(2, -1)
        sums = halves.sum(axis=0)
        return cls(parts, inner.reshape(2, -1, 7), sums, np.abs(sums - whole))

    def totals(self) -> tuple[float, float]:
        """The integral and its error."""
        return float(self.sums.sum()), float(self.errors().sum())

    def errors(self) -> Floats:
        """How wrong each sum may be, (k,).

        Three times the difference, as where a layer is in line with the triangles all of them are
        wrong alike. But that says little where samples vary much: where a layer crosses a triangle
        between them both sums are wrong, and alike. So, the more as values vary from `_SMOOTH` on,
        the size h = det^(-1/4) is taken to fall on as steeply as it does between samples, over the
        gap to the next one, but not below the smallest size of all; what such a valley, of the
        shape h + slope |x|, adds to the integral of 1 / h² is the error. And where samples vary so
        much that few of them make up the sum, as across a jump, it is 0.4 of the sum.
        """
        if not len(self.sums):
            return self.differences
        areas = 0.5 * np.abs(
            _doubled_areas(self.parts.reshape(-1, 3, 2)).reshape(2, -1).sum(axis=0)
        )
        low, high = self.samples.min(axis=(0, 2)), self.samples.max(axis=(0, 2))
        smallest, largest = high**-0.5, low**-0.5
        variation = np.log(high / low)
        fall = largest - smallest
        valley = np.maximum(smallest - _GAP * fall, smallest.min())
        missed = 2 * areas * (1 / valley - 1 / smallest) / np.where(fall > 0, fall, np.inf)
        doubt = np.minimum(variation / _SMOOTH, 1) ** 3
        alone = 0.4 * np.clip((variation - 2.5) / 2, 0, 1)
        return np.maximum(3 * self.differences, alone * np.abs(self.sums)) + doubt * missed

    def cut(self, field: ControlSpace, chosen: Numbers) -> _Leaves:
        """The same with the chosen leaves replaced by their two parts."""
        new = _Leaves.of(
            field,
            self.parts[:, chosen].reshape(-1, 3, 2),
            self.samples[:, chosen].reshape(-1, 7),
        )
        kept = np.ones(len(self.sums), bool)
        kept[chosen] = False
        return _Leaves(
            np.concatenate([self.parts[:, kept], new.parts], axis=1),
            np.concatenate([self.samples[:, kept], new.samples], axis=1),
            np.concatenate([self.sums[kept], new.sums]),
            np.concatenate([self.differences[kept], new.differences]),
        )


def _fit_quadratic() -> Floats:
    """From values at the 7 points of Radon's rule, the values at the corners and midpoints (6, 7).

    Least squares by quadratics, in Lagrange form: corners 0, 1, 2, then the midpoint of the edge
    opposite each.
    """
    x = _RADON_X
    corners = x * (2 * x - 1)
    midpoints = 4 * x[:, [1, 2, 0]] * x[:, [2, 0, 1]]
    return np.linalg.pinv(np.hstack([corners, midpoints]))


_QUADRATIC = _fit_quadratic()


def _edge_to_cut(samples: Floats) -> Numbers:
    """The edge, by the vertex opposite, along which the logarithm of the samples varies most."""
    fit = np.log(samples) @ _QUADRATIC.T
    corners, midpoints = fit[:, :3], fit[:, 3:]
    one, other = corners[:, [1, 2, 0]], corners[:, [2, 0, 1]]
    variation = np.abs(one - midpoints) + np.abs(other - midpoints)
    return np.asarray(variation.argmax(axis=1))


def _bisected(triangles: Floats, edge: Numbers) -> Floats:
    """Triangles (k, 3, 2) cut from the middle of an edge to the vertex opposite: (2, k, 3, 2)."""
    k = np.arange(len(triangles))
    apex, start, end = (triangles[k, (edge + i) % 3] for i in range(3))
    middle = 0.5 * (start + end)
    return np.stack([np.stack([apex, start, middle], 1), np.stack([apex, middle, end], 1)])


def _at_least(triangles: Floats, count: int) -> Floats:
    """Triangles cut across their longest edges until there are `count`, the longest ones first."""
    while 0 < len(triangles) < count:
        edges = triangles[:, [2, 0, 1]] - triangles[:, [1, 2, 0]]
        lengths = np.hypot(edges[..., 0], edges[..., 1])
        longest = lengths.max(axis=1)
        cut = longest >= 0.7 * longest.max()
        parts = _bisected(triangles[cut], np.asarray(lengths[cut].argmax(axis=1)))
        triangles = np.concatenate([triangles[~cut], parts.reshape(-1, 3, 2)])
    return triangles


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
    for start in range(0, len(simplices), _BLOCK):
        block = slice(start, start + _BLOCK)
        out[block] = _refined(rule, split, field, simplices[block], rtol, max_depth)
    return out


def _refined(
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
    where = start[:, None] + _GAUSS_X[:, None] * step[:, None]
    speeds = _core.lengths_in(field(where.reshape(-1, 2)), np.repeat(step, len(_GAUSS_X), axis=0))
    return speeds.reshape(-1, len(_GAUSS_X)) @ _GAUSS_W


def _halved(segments: Floats) -> Floats:
    start, end = segments[:, 0], segments[:, 1]
    middle = 0.5 * (start + end)
    return np.concatenate([np.stack([start, middle], 1), np.stack([middle, end], 1)])


def _areas(field: ControlSpace, triangles: Floats) -> Floats:
    return 0.5 * _doubled_areas(triangles) * (_root_dets(field, triangles) @ _RADON_W)


def _quartered(triangles: Floats) -> Floats:
    a, b, c = (triangles[:, i] for i in range(3))
    ab, bc, ca = 0.5 * (a + b), 0.5 * (b + c), 0.5 * (c + a)
    return np.concatenate(
        [np.stack(t, 1) for t in ((a, ab, ca), (ab, b, bc), (ca, bc, c), (ab, bc, ca))]
    )


def _root_dets(field: ControlSpace, triangles: Floats) -> Floats:
    """The square root of det M at the 7 points of each triangle (k, 3, 2): (k, 7)."""
    where = np.einsum("qi,kid->kqd", _RADON_X, triangles)
    return np.sqrt(_core.det(field(where.reshape(-1, 2)))).reshape(-1, len(_RADON_X))


def _doubled_areas(triangles: Floats) -> Floats:
    u, v = triangles[:, 1] - triangles[:, 0], triangles[:, 2] - triangles[:, 0]
    return u[:, 0] * v[:, 1] - u[:, 1] * v[:, 0]
