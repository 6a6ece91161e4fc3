"""The complexity of a field over a domain, by adaptive quadrature: how large a mesh will be."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numpy.typing import ArrayLike

from metrics.checks import as_points, as_triangles
from metrics.control import ControlSpace, Metric, as_control_space
from metrics.types import Floats, Index

from .quadrature import BLOCK, RADON_W, RADON_X, doubled_areas, root_dets

__all__ = ["Complexity", "complexity"]

# When sqrt(det M) varies by more than the exponential of this on a triangle, anything may be
# between samples.
_SMOOTH = 3.0
_DOUBT = 0.03  # how much an error that is only possible counts for, beside one that is seen
_GAP = 0.2  # from a point of a triangle to the nearest sample, relative to its width


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
    once = 3 * len(RADON_W) * len(corners)
    if once > max_evaluations:
        blocks = (corners[k : k + BLOCK] for k in range(0, len(corners), BLOCK))
        value, error = np.sum([_Leaves.of(space, block).totals() for block in blocks], axis=0)
        return Complexity(float(value), float(error), once)
    return _integrate(space, _cut_to_count(corners, 256), rtol, max_evaluations)


def _integrate(
    field: ControlSpace, triangles: Floats, rtol: float, max_evaluations: int
) -> Complexity:
    """The adaptive quadrature: the leaves whose errors do not fit the tolerance are cut, again."""
    leaves = _Leaves.of(field, triangles)
    evaluations = 3 * len(RADON_W) * len(triangles)
    cost = 4 * len(RADON_W)  # of cutting one leaf: two new leaves, each with its two parts
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
            samples = root_dets(field, triangles)
        whole = doubled_areas(triangles) * (samples @ RADON_W) / 2
        parts = _bisect(triangles, _edge_to_cut(samples))
        flat = parts.reshape(-1, 3, 2)
        inner = root_dets(field, flat)
        halves = (doubled_areas(flat) * (inner @ RADON_W) / 2).reshape(2, -1)
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
        areas = 0.5 * np.abs(doubled_areas(self.parts.reshape(-1, 3, 2)).reshape(2, -1).sum(axis=0))
        low, high = self.samples.min(axis=(0, 2)), self.samples.max(axis=(0, 2))
        smallest, largest = high**-0.5, low**-0.5
        variation = np.log(high / low)
        fall = largest - smallest
        valley = np.maximum(smallest - _GAP * fall, smallest.min())
        missed = 2 * areas * (1 / valley - 1 / smallest) / np.where(fall > 0, fall, np.inf)
        doubt = np.minimum(variation / _SMOOTH, 1) ** 3
        alone = 0.4 * np.clip((variation - 2.5) / 2, 0, 1)
        return np.maximum(3 * self.differences, alone * np.abs(self.sums)) + doubt * missed

    def cut(self, field: ControlSpace, chosen: Index) -> _Leaves:
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
    x = RADON_X
    corners = x * (2 * x - 1)
    midpoints = 4 * x[:, [1, 2, 0]] * x[:, [2, 0, 1]]
    return np.linalg.pinv(np.hstack([corners, midpoints]))


_QUADRATIC = _fit_quadratic()


def _edge_to_cut(samples: Floats) -> Index:
    """The edge, by the vertex opposite, along which the logarithm of the samples varies most."""
    fit = np.log(samples) @ _QUADRATIC.T
    corners, midpoints = fit[:, :3], fit[:, 3:]
    one, other = corners[:, [1, 2, 0]], corners[:, [2, 0, 1]]
    variation = np.abs(one - midpoints) + np.abs(other - midpoints)
    return np.asarray(variation.argmax(axis=1))


def _bisect(triangles: Floats, edge: Index) -> Floats:
    """Triangles (k, 3, 2) cut from the middle of an edge to the vertex opposite: (2, k, 3, 2)."""
    k = np.arange(len(triangles))
    apex, start, end = (triangles[k, (edge + i) % 3] for i in range(3))
    middle = 0.5 * (start + end)
    return np.stack([np.stack([apex, start, middle], 1), np.stack([apex, middle, end], 1)])


def _cut_to_count(triangles: Floats, count: int) -> Floats:
    """Triangles cut across their longest edges until there are `count`, the longest ones first."""
    while 0 < len(triangles) < count:
        edges = triangles[:, [2, 0, 1]] - triangles[:, [1, 2, 0]]
        lengths = np.hypot(edges[..., 0], edges[..., 1])
        longest = lengths.max(axis=1)
        cut = longest >= 0.7 * longest.max()
        parts = _bisect(triangles[cut], np.asarray(lengths[cut].argmax(axis=1)))
        triangles = np.concatenate([triangles[~cut], parts.reshape(-1, 3, 2)])
    return triangles
