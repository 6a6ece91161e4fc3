"""From a solution, or its Hessians, to a metric in one call."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from numpy.typing import ArrayLike

from metrics import tensor
from metrics.background import Background
from metrics.checks import as_numbers, as_points, as_triangles
from metrics.errors import MetricError
from metrics.measure.nodal import nodal_complexity
from metrics.types import Floats, Ints

from .hessian_field import Curvature
from .limits import Limits
from .normalise import (
    Goal,
    check_norm,
    combined,
    count_goal,
    interpolation_error,
    lp_metric,
    scaled_to,
)

__all__ = ["metric_from_hessians", "metric_from_solution"]


def metric_from_solution(
    points: ArrayLike,
    triangles: ArrayLike,
    values: ArrayLike,
    *,
    target_vertices: float | None = None,
    complexity: float | None = None,
    error: ArrayLike | None = None,
    p: float = 2,
    h_min: float = 0.0,
    h_max: float = np.inf,
    max_anisotropy: float = np.inf,
    gradation: float | None = 2.0,
    law: str = "mixed",
    recovery: str = "least squares",
    combine: str = "intersection",
) -> Background:
    """The metric that minimises the error of linear interpolation, for a given target.

    The absolute Hessian of each field at the vertices, by `metrics.Curvature`, and then
    `metrics.metric_from_hessians`.

    Parameters
    ----------
    points : (n, 2) array_like
    triangles : (m, 3) array_like of int
    values : (n,) or (n, k) array_like
        One or more fields at the points.
    target_vertices : float, optional
        The number of vertices by `metrics.predicted_vertices`. Meshes come within about 5 % of it.
    complexity : float, optional
        Instead: the integral of sqrt(det M).
    error : float or (k,) array_like, optional
        Instead: the bound for each field on the L^p norm of its interpolation error, by
        `metrics.interpolation_error`.
    p : float, optional
        Of the norm, from 1 to inf. The smaller, the more small and weak features count.
    h_min, h_max, max_anisotropy : float, optional
        Bounds on the sizes and their ratio.
    gradation, law : optional
        Bound on growth and the law it follows, see `metrics.graded`; None for no bound.
    recovery : {"least squares", "projection", "green"}, optional
        How Hessians are found.
    combine : {"intersection", "average"}, optional
        How fields are combined.

    Returns
    -------
    Background
        The metric, carried by the mesh given.

    Raises
    ------
    MetricError
        If not exactly one target is given or the limits make it impossible; for a field that is
        constant; and as for `metrics.hessians`.

    References
    ----------
    Loseille, Alauzet: Continuous mesh framework parts I and II. SIAM Journal on Numerical Analysis
    49 (2011), 38-60 and 61-86.
    """
    check_norm(p)
    where = as_points(points)
    t = as_triangles(triangles, len(where))
    fields = _as_fields(values, len(where))
    if error is not None and not (target_vertices is None and complexity is None):
        raise MetricError("give one target: target_vertices, complexity or error")
    return metric_from_hessians(
        where,
        t,
        [Curvature.of(where, t, u, recovery).absolute for u in fields],
        target_vertices=target_vertices,
        complexity=complexity,
        error=error,
        p=p,
        limits=Limits(h_min, h_max, max_anisotropy, gradation, law),
        combine=combine,
    )


def metric_from_hessians(
    points: ArrayLike,
    triangles: ArrayLike,
    hessians: Sequence[ArrayLike],
    *,
    target_vertices: float | None = None,
    complexity: float | None = None,
    error: ArrayLike | None = None,
    p: float = 2,
    limits: Limits | None = None,
    combine: str = "intersection",
) -> Background:
    """The metric that minimises the error of linear interpolation, from absolute Hessians.

    In this order, always: the ratio of the sizes of each is bounded by `Limits.max_anisotropy`; its
    L^p metric (`metrics.lp_metric`); fields combined in the order given, after each is scaled to
    the same complexity, or to its own error; then one factor for all, so that after the limits, the
    gradation, and the limits again there is as much as was asked for.

    Parameters
    ----------
    points : (n, 2) array_like
    triangles : (m, 3) array_like of int
    hessians : sequence of (n, 3) or (n, 2, 2) array_like
        Positive definite, one for each field: see `metrics.Curvature.absolute`.
    target_vertices, complexity, error, p, combine : optional
        As for `metrics.metric_from_solution`. With an error as well as a number of vertices or a
        complexity, the errors say what a field counts for, and the other how fine the mesh is.
    limits : Limits, optional
        By default growth is bounded, and nothing else.

    Returns
    -------
    Background
        The metric, carried by the mesh given.

    Raises
    ------
    MetricError
        If no target is given or the limits make it impossible; and if a Hessian is not positive
        definite.
    """
    where = as_points(points)
    t = as_triangles(triangles, len(where))
    tensors = optimal_tensors(
        where,
        t,
        hessians,
        target_vertices=target_vertices,
        complexity=complexity,
        error=error,
        p=p,
        limits=limits,
        combine=combine,
    )
    return Background(where, t, tensors)


def optimal_tensors(
    points: Floats,
    triangles: Ints,
    hessians: Sequence[ArrayLike],
    *,
    target_vertices: float | None = None,
    complexity: float | None = None,
    error: ArrayLike | None = None,
    p: float = 2,
    limits: Limits | None = None,
    combine: str = "intersection",
) -> Floats:
    """What `metric_from_hessians` carries at the vertices, packed (n, 3)."""
    check_norm(p)
    limits = limits or Limits()
    if not len(hessians):
        raise MetricError("no Hessians: expected those of at least one field")
    curvatures = [
        tensor.limit(
            tensor.pack(h, points=points, what="the absolute Hessian"),
            max_anisotropy=limits.max_anisotropy,
        )
        for h in hessians
    ]
    shapes = [lp_metric(h, p) for h in curvatures]
    if error is None:
        goal = count_goal(points, triangles, target_vertices, complexity)
        amounts = [1 / nodal_complexity(points, triangles, m) for m in shapes]
    else:
        errors = _as_errors(error, len(curvatures))

        def shares(metrics: list[Floats]) -> list[float]:
            pairs = zip(metrics, curvatures, errors, strict=True)
            return [interpolation_error(points, triangles, m, h, p) / e for m, h, e in pairs]

        amounts = shares(shapes)
        if target_vertices is not None or complexity is not None:
            goal = count_goal(points, triangles, target_vertices, complexity)
        else:
            goal = Goal(
                lambda m: max(shares([m] * len(curvatures))), 1.0, "share of the error", False
            )
    together = combined([k * m for k, m in zip(amounts, shapes, strict=True)], combine)
    return scaled_to(goal, together, points, triangles, limits)


def _as_fields(values: ArrayLike, count: int) -> list[Floats]:
    array = np.asarray(as_numbers(values, "values"), np.float64)
    if array.ndim not in (1, 2) or len(array) != count or array.size == 0:
        raise MetricError(
            f"values must have the shape ({count},), or ({count}, k) for k fields, "
            f"not {array.shape}"
        )
    fields = list(np.atleast_2d(array.T))
    for k, u in enumerate(fields):
        if np.ptp(u) == 0:
            raise MetricError(f"field {k} is {u[0]:.6g} everywhere: it says nothing about sizes")
    return fields


def _as_errors(error: ArrayLike, count: int) -> Floats:
    out = np.asarray(as_numbers(error, "error"), np.float64)
    if out.shape not in ((), (count,)) or not (out > 0).all():
        raise MetricError(f"error must be positive, one number or {count}, not {error!r}")
    return np.broadcast_to(out, count)
