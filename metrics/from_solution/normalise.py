"""The metric of minimal interpolation error, and the one factor with which it meets a target."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike

from metrics import tensor
from metrics.checks import as_points, as_triangles
from metrics.errors import MetricError
from metrics.measure.nodal import nodal_complexity, nodal_lengths, vertices_of
from metrics.topology import border_edges
from metrics.types import Floats, Ints

from .limits import Limits

__all__ = [
    "combined",
    "interpolation_error",
    "lp_metric",
    "normalised",
]

_PRECISION = 5e-4  # of the logarithm of the amount
_NARROW = 1e-9  # an interval for the logarithm of the factor in which there is no more to find
_MIN_SLOPE = 0.1  # of the excess over the logarithm, for a secant to be trusted
_FAR = 200.0  # logarithm of a factor beyond any use


def lp_metric(absolute_hessians: ArrayLike, p: float = 2) -> Floats:
    """det(abs(H))^(-1 / (2 p + 2)) abs(H), packed (n, 3).

    Of all metrics of the same complexity, that in proportion to this one has the minimal error in
    the L^p norm when a function with the Hessian H is interpolated linearly, in two dimensions.
    For ``p=inf`` abs(H) itself; the smaller p, the more the fine features count.

    Parameters
    ----------
    absolute_hessians : (n, 3) or (n, 2, 2) array_like
        Positive definite, see `metrics.recovery.absolute`.
    p : float, optional
        From 1 to inf.

    References
    ----------
    Loseille, Alauzet: Continuous mesh framework part I: well-posed continuous interpolation error.
    SIAM Journal on Numerical Analysis 49 (2011), 38-60.
    """
    check_norm(p)
    h = tensor.pack(absolute_hessians, what="the absolute Hessian")
    return tensor.det(h)[:, None] ** (-1 / (2 * p + 2)) * h


def interpolation_error(
    points: ArrayLike,
    triangles: ArrayLike,
    metric: ArrayLike,
    absolute_hessians: ArrayLike,
    p: float = 2,
) -> float:
    """The L^p norm of the error of linear interpolation on a mesh that is unit in the metric.

    c_p / 2 times the L^p norm of trace(M^-1 abs(H)), where c_p is the L^p mean, over the unit
    equilateral triangle, of the error (1/3 - r²) / 2 of the function r² / 2: c_1 = 1/8,
    c_inf = 1/6. Exact in the limit of many triangles if M is in proportion to abs(H) and H is
    definite; where H has eigenvalues of both signs, an upper bound. The integral is by the values
    at the vertices.

    Notes
    -----
    For p = 1, trace / 16. The continuous error of Loseille and Alauzet, trace / 8, is by its
    definition twice the mean error on a triangle.
    """
    check_norm(p)
    where = as_points(points)
    m = tensor.pack(metric, points=where)
    h = tensor.pack(absolute_hessians, points=where, what="the absolute Hessian")
    adjugate = m[:, 0] * h[:, 2] + m[:, 2] * h[:, 0] - 2 * m[:, 1] * h[:, 1]
    local = 0.5 * _mean_error(p) * adjugate / tensor.det(m)
    largest = float(local.max())
    if p == np.inf:
        return largest
    weights = _vertex_areas(where, as_triangles(triangles, len(where)))
    return float(largest * (weights @ (local / largest) ** p) ** (1 / p))


def combined(metrics: Sequence[ArrayLike], how: str = "intersection") -> Floats:
    """Several metrics at the same points as one, packed (n, 3).

    Parameters
    ----------
    metrics : sequence of array_like
        What `metrics.tensor.pack` takes, at least one.
    how : {"intersection", "average"}, optional
        ``"intersection"``: of the first and second, of that and the third, and so on: the order
        matters a little. ``"average"``: the log-Euclidean mean.
    """
    packed = [tensor.pack(m) for m in metrics]
    if not packed:
        raise MetricError("at least one metric is needed")
    check_combination(how)
    if how == "intersection":
        out = packed[0]
        for other in packed[1:]:
            out = tensor.intersect(out, other)
        return out
    return tensor.exp(np.mean([tensor.log(m) for m in packed], axis=0))


def normalised(
    metric: ArrayLike,
    points: ArrayLike,
    triangles: ArrayLike,
    *,
    target_vertices: float | None = None,
    complexity: float | None = None,
    limits: Limits | None = None,
) -> Floats:
    """The metric times the one factor with which it meets a target, packed (n, 3).

    Parameters
    ----------
    metric : (n,), (n, 3) or (n, 2, 2) array_like
        Sizes, packed tensors or matrices at the points, to a factor.
    points : (n, 2) array_like
    triangles : (m, 3) array_like of int
    target_vertices : float, optional
        The number of vertices by `predicted_vertices`. Meshes come within about 5 % of it.
    complexity : float, optional
        The integral of sqrt(det M), instead.
    limits : Limits, optional
        Applied after scaling; the target is met including limits, to 0.1 %.

    Raises
    ------
    MetricError
        If not exactly one target is given; and if the limits make it impossible, with what they
        allow.
    """
    where = as_points(points)
    t = as_triangles(triangles, len(where))
    m = tensor.pack(metric, points=where)
    goal = count_goal(where, t, target_vertices, complexity)
    return scaled_to(goal, m, where, t, limits or Limits(gradation=None))


@dataclass(frozen=True)
class Goal:
    """A target for a metric.

    Attributes
    ----------
    amount : callable
        Of a metric (n, 3), the quantity.
    value : float
        What it should be.
    name : str
        Of the quantity, for messages.
    grows : bool
        Whether it grows as the metric gets finer. One that falls, an error, may also be below
        the value, if it is so even for the coarsest metric allowed.
    """

    amount: Callable[[Floats], float]
    value: float
    name: str
    grows: bool = True

    def excess(self, metric: Floats) -> float:
        """How much finer the metric is than it has to be, as a logarithm."""
        ratio = float(np.log(self.amount(metric) / self.value))
        return ratio if self.grows else -ratio


def count_goal(
    points: Floats, triangles: Ints, target_vertices: float | None, complexity: float | None
) -> Goal:
    """A number of vertices, or a complexity: the one of the two that is given."""
    if (target_vertices is None) == (complexity is None):
        raise MetricError("give one target: target_vertices or complexity")
    if target_vertices is not None:
        if not 3 <= target_vertices < np.inf:
            raise MetricError(f"target_vertices must be at least 3, not {target_vertices!r}")
        border = border_edges(triangles)

        def vertices(m: Floats) -> float:
            length = nodal_lengths(points, border, m).sum()
            return vertices_of(nodal_complexity(points, triangles, m), length)

        return Goal(vertices, target_vertices, "vertices")
    assert complexity is not None
    if not 0 < complexity < np.inf:
        raise MetricError(f"the complexity must be positive, not {complexity!r}")
    return Goal(lambda m: nodal_complexity(points, triangles, m), complexity, "complexity")


def scaled_to(
    goal: Goal, metric: Floats, points: Floats, triangles: Ints, limits: Limits
) -> Floats:
    """The metric times the factor with which, after the limits, it meets the goal.

    The root of the excess over the logarithm of the factor, which is continuous and grows, nearly
    as the logarithm itself: from the factor that does without limits, by secants in growing steps
    until the excess changes its sign, then by the rule of false position (Illinois).
    """
    coarsest, finest = _useful_factors(metric, limits)
    x = float(np.clip(_unlimited_factor(goal, metric), coarsest, finest))
    ends: dict[bool, tuple[float, float]] = {}  # where it is too fine, and where too coarse
    last: bool | None = None
    scale = 1.0
    while True:
        met = limits.applied(np.exp(x) * metric, points, triangles)
        here = goal.excess(met)
        if abs(here) <= _PRECISION:
            return met
        side = here > 0
        before = ends.get(side)
        if len(ends) == 2 and side == last:
            far, excess = ends[not side]
            ends[not side] = far, excess / 2
        ends[side], last = (x, here), side
        if len(ends) == 2:
            (a, above), (b, below) = ends[True], ends[False]
            if abs(a - b) <= _NARROW:
                return met
            x = (a * below - b * above) / (below - above)
            continue
        slope = 1.0
        if before is not None:
            slope = float(np.clip((here - before[1]) / (x - before[0]), _MIN_SLOPE, 1))
        further = float(np.clip(x - scale * here / slope, coarsest, finest))
        if further == x:
            if side and not goal.grows:
                return met
            raise MetricError(_impossible(goal, goal.amount(met), side, limits))
        x, scale = further, scale if before is None else 2 * scale


def _unlimited_factor(goal: Goal, metric: Floats) -> float:
    """The logarithm of the factor with which the goal is nearly met without limits.

    An amount is a sum of powers of the factor, of which the first step finds the order of magnitude
    and the second corrects it where another power leads there.
    """
    first = -goal.excess(metric)
    return first - goal.excess(np.exp(first) * metric)


def _useful_factors(metric: Floats, limits: Limits) -> tuple[float, float]:
    """Logarithms of the factors with which all sizes are h_max, and with which all are h_min."""
    sizes = tensor.sizes(metric)
    coarsest = 2 * np.log(sizes.min() / limits.h_max) if limits.h_max < np.inf else -_FAR
    finest = 2 * np.log(sizes.max() / limits.h_min) if limits.h_min > 0 else _FAR
    return float(coarsest), float(max(coarsest, finest))


def _impossible(goal: Goal, amount: float, too_fine: bool, limits: Limits) -> str:
    asked = f"{goal.value:.6g} {goal.name} cannot be reached"
    if too_fine:
        return (
            f"{asked}: the coarsest metric allowed, h_max = {limits.h_max:.6g} everywhere, has "
            f"{amount:.6g}; raise h_max, or ask for more"
        )
    remedy = "ask for less" if goal.grows else "allow more"
    return (
        f"{asked}: the finest metric allowed, h_min = {limits.h_min:.6g} everywhere, has "
        f"{amount:.6g}; lower h_min, or {remedy}"
    )


def check_combination(how: str) -> None:
    """Raise for an unknown way to combine metrics."""
    if how not in ("intersection", "average"):
        raise MetricError(f'metrics are combined by "intersection" or "average", not {how!r}')


def check_norm(p: float) -> None:
    if not p >= 1:
        raise MetricError(f"p is that of an L^p norm, from 1 to inf, not {p!r}")


def _mean_error(p: float) -> float:
    """The L^p mean of (1/3 - r²) / 2 over the unit equilateral triangle, r from its centre.

    Six sectors of 60 degrees from the centre to a side at the distance d = 1 / (2 sqrt 3); along
    the radius the integral is closed, and over the angle it is done by Gauss points.
    """
    if p == np.inf:
        return 1 / 6
    x, w = np.polynomial.legendre.leggauss(40)
    angle = np.pi / 6 * (x + 1)
    to_side = 1 / (12 * np.cos(angle) ** 2)  # squared
    along = (1 - (1 - 3 * to_side) ** (p + 1)) / (6 * (p + 1))  # of (1 - 3 r²)^p r dr
    mean = 6 * np.pi / 6 * (w @ along) / (np.sqrt(3) / 4)
    return float(mean ** (1 / p) / 6)


def _vertex_areas(points: Floats, triangles: Ints) -> Floats:
    """A third of the area of the triangles around each vertex, (n,)."""
    corners = points[triangles]
    u, v = corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0]
    thirds = (u[:, 0] * v[:, 1] - u[:, 1] * v[:, 0]) / 6
    return np.bincount(triangles.ravel(), np.repeat(thirds, 3), len(points)).astype(np.float64)
