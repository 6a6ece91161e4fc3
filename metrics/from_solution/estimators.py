"""Where the error of a linear finite-element solution is, and the sizes that spread it evenly.

Indicators are one number a triangle, the error on it in the energy norm; together they are their
square root of the sum of squares. They know no directions: what follows from them is isotropic.
For thin layers the metric from second derivatives, `metric_from_solution`, needs far fewer
vertices; indicators serve singularities, rough data, and solutions without second derivatives.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike

from metrics.background import Background
from metrics.checks import as_numbers
from metrics.errors import MetricError
from metrics.topology import mesh_edges
from metrics.types import Bools, Floats, Ints

from .limits import Limits
from .normalise import count_goal, scaled_to
from .p1_elements import LinearElements, check_mesh, check_values
from .recovery import gradients

__all__ = [
    "doerfler_marking",
    "metric_from_indicators",
    "residual_indicators",
    "zz_indicators",
]

_UNIT_AREA = np.sqrt(3) / 4  # of the equilateral triangle with sides of 1


def zz_indicators(
    points: ArrayLike, triangles: ArrayLike, values: ArrayLike, method: str = "projection"
) -> Floats:
    """The error of each triangle by recovered gradients (Zienkiewicz and Zhu), (m,).

    The L2 norm over the triangle of the difference between the gradient of the linear
    interpolant, constant there, and gradients recovered at the vertices, linear between them.

    Parameters
    ----------
    points : (n, 2) array_like
    triangles : (m, 3) array_like of int
        Counter-clockwise.
    values : (n,) or (n, k) array_like
        The solution at the points, or several; their squared errors are added.
    method : {"projection", "least squares"}, optional
        Of recovery, see `metrics.gradients`.

    Raises
    ------
    MetricError
        As for `metrics.gradients`.

    References
    ----------
    Zienkiewicz, Zhu: A simple error estimator and adaptive procedure for practical engineering
    analysis. International Journal for Numerical Methods in Engineering 24 (1987), 337-357.
    """
    fields = np.asarray(as_numbers(values, "values"), np.float64)
    columns = fields.T if fields.ndim == 2 else [fields]
    squares = [_zz_squares(points, triangles, u, method) for u in columns]
    if not squares:
        raise MetricError(f"values must have the shape (n,) or (n, k), not {fields.shape}")
    return np.sqrt(np.sum(squares, axis=0))


def _zz_squares(points: ArrayLike, triangles: ArrayLike, values: ArrayLike, method: str) -> Floats:
    p, t, u = check_values(points, triangles, values)
    elements = LinearElements(p, t)
    off = gradients(p, t, u, method)[t] - elements.gradients(u)[:, None, :]
    # Of a linear function with the values d_i at the corners:  A/12 ((sum d_i)^2 + sum d_i^2).
    squares = (off.sum(axis=1) ** 2).sum(axis=1) + (off**2).sum(axis=(1, 2))
    return elements.areas / 12 * squares


def residual_indicators(
    points: ArrayLike,
    triangles: ArrayLike,
    values: ArrayLike,
    *,
    source: ArrayLike = 0.0,
    diffusion: ArrayLike = 1.0,
) -> Floats:
    """The error of each triangle by the residual of -div(k grad u) = f, (m,).

    The sum of eta² = h² times the integral of f² / k over the triangle, h its longest side, and of
    half of the length of each side inside the domain times the integral over it of j² / k, j being
    the jump of the flux k du/dn and k the larger of the two. Up to a constant an upper bound of the
    error in the energy norm. Sides on the boundary count nothing.

    Parameters
    ----------
    points : (n, 2) array_like
    triangles : (m, 3) array_like of int
        Counter-clockwise.
    values : (n,) array_like
        The linear finite-element solution at the points.
    source : float, (m,) or (n,) array_like, optional
        f: on triangles, or at points and linear between them. With as many points as triangles,
        on triangles.
    diffusion : float or (m,) array_like, optional
        k > 0, on triangles.

    Raises
    ------
    MetricError
        For arrays that do not fit, values that are not finite, a diffusion that is not positive.

    References
    ----------
    Verfürth: A Posteriori Error Estimation Techniques for Finite Element Methods, Oxford University
    Press 2013, chapter 1. Bernardi, Verfürth: Adaptive finite element methods for elliptic
    equations with non-smooth coefficients. Numerische Mathematik 85 (2000), 579-608: the weights.
    """
    p, t, u = check_values(points, triangles, values)
    elements = LinearElements(p, t)
    k = _on_triangles(diffusion, len(t), "the diffusion")
    if not (k > 0).all():
        i = int(np.argmin(k > 0))
        raise MetricError(f"the diffusion on triangle {i} is {k[i]}: it must be positive")
    sides = np.linalg.norm(p[t[:, [2, 0, 1]]] - p[t[:, [1, 2, 0]]], axis=2)
    inside = sides.max(axis=1) ** 2 / k * _squared_norm(source, elements, len(p))
    return np.sqrt(inside + _flux_jumps(p, t, k[:, None] * elements.gradients(u), k))


def _squared_norm(source: ArrayLike, elements: LinearElements, n_points: int) -> Floats:
    """The integral of f² over each triangle."""
    f = np.asarray(as_numbers(source, "the source"), np.float64)
    if f.ndim == 1 and len(f) == n_points != len(elements.areas):
        _check_finite(f, "the source", "point")
        corners = f[elements.triangles]
        total = corners.sum(axis=1) ** 2 + (corners**2).sum(axis=1)
        return np.asarray(elements.areas / 12 * total)
    return np.asarray(elements.areas * _on_triangles(f, len(elements.areas), "the source") ** 2)


def _flux_jumps(p: Floats, t: Ints, flux: Floats, k: Floats) -> Floats:
    """For each triangle half the sum of h_e² [flux . n]² / k over its inner sides."""
    edges, of_side = mesh_edges(t)
    # The side opposite vertex i runs from `start` to `stop`, the triangle on its left. What flows
    # out of the two triangles over their common side, added up, is the jump times its length.
    start, stop = t[:, [1, 2, 0]], t[:, [2, 0, 1]]
    d = p[stop] - p[start]
    outward = flux[:, None, 0] * d[..., 1] - flux[:, None, 1] * d[..., 0]
    jump = np.bincount(of_side.ravel(), outward.ravel(), len(edges))
    inner = np.bincount(of_side.ravel(), minlength=len(edges)) == 2
    larger = np.zeros(len(edges))
    np.maximum.at(larger, of_side, np.repeat(k[:, None], 3, axis=1))
    squares = np.where(inner, jump**2 / larger, 0.0)
    return 0.5 * squares[of_side].sum(axis=1)


def _on_triangles(values: ArrayLike, count: int, what: str) -> Floats:
    given = np.asarray(as_numbers(values, what), np.float64)
    if given.shape not in ((), (count,)):
        raise MetricError(
            f"{what} must be one number or have the shape ({count},), one a triangle, "
            f"not {given.shape}"
        )
    _check_finite(np.atleast_1d(given), what, "triangle")
    return np.broadcast_to(given, count)


def _check_finite(values: Floats, what: str, item: str) -> None:
    if not np.isfinite(values).all():
        i = int(np.argmin(np.isfinite(values)))
        raise MetricError(f"{what} at {item} {i} is not finite: {values[i]}")


def doerfler_marking(indicators: ArrayLike, fraction: float = 0.5) -> Bools:
    """The smallest set of triangles with this share of the squared error, as a mask (m,).

    Parameters
    ----------
    indicators : (m,) array_like
        Not negative.
    fraction : float, optional
        From 0 to 1.

    References
    ----------
    Dörfler: A convergent adaptive algorithm for Poisson's equation. SIAM Journal on Numerical
    Analysis 33 (1996), 1106-1124.
    """
    if not 0 < fraction <= 1:
        raise MetricError(f"the fraction must be above 0 and at most 1, not {fraction!r}")
    squares = _check_indicators(indicators) ** 2
    order = np.argsort(-squares, kind="stable")
    reached = np.cumsum(squares[order])
    count = int(np.searchsorted(reached, fraction * reached[-1] * (1 - 1e-12))) + 1
    out = np.zeros(len(squares), bool)
    out[order[:count]] = True
    return out & (squares > 0)


def metric_from_indicators(
    points: ArrayLike,
    triangles: ArrayLike,
    indicators: ArrayLike,
    *,
    target_vertices: float | None = None,
    error: float | None = None,
    order: float = 1.0,
    fraction: float = 1.0,
    max_change: float = 4.0,
    h_min: float = 0.0,
    h_max: float = np.inf,
    gradation: float | None = 1.5,
    law: str = "mixed",
) -> Background:
    """Sizes that spread the error evenly over the triangles of the next mesh.

    Where x triangles take the place of one with the indicator eta, its squared error eta² becomes
    eta² / x^order. Of all x with the same sum those in proportion to eta^(2 / (order + 1)) minimise
    the error: then all new triangles have the same.

    Parameters
    ----------
    points : (n, 2) array_like
    triangles : (m, 3) array_like of int
        Counter-clockwise.
    indicators : (m,) array_like
        The error on each triangle, e.g. by `zz_indicators` or `residual_indicators`.
    target_vertices : float, optional
        The number of vertices by `metrics.predicted_vertices`, after all bounds.
    error : float, optional
        Instead: the square root of the sum of the squared indicators to come to.
    order : float, optional
        With which power of the size the error falls: 1 for gradients of linear elements, less
        beside singularities that the mesh does not yet resolve.
    fraction : float, optional
        Below 1, with `error`: only the triangles that have this share of the squared error get new
        sizes (Dörfler's marking); the others keep theirs.
    max_change : float, optional
        By how much a size may become smaller or larger at once, apart from the one factor that
        meets `target_vertices`: where indicators are zero, sizes would be infinite.
    h_min, h_max, gradation, law : optional
        As for `metric_from_solution`.

    Returns
    -------
    Background
        Isotropic, carried by the mesh given.

    Raises
    ------
    MetricError
        If not exactly one target is given, for indicators that are negative, not finite, or all
        zero, and for arrays that do not fit.
    """
    p, t = check_mesh(points, triangles)
    eta = _check_indicators(indicators)
    if eta.shape != (len(t),):
        raise MetricError(f"indicators must have the shape ({len(t)},), not {eta.shape}")
    if (target_vertices is None) == (error is None):
        raise MetricError("give one target: target_vertices or error")
    if fraction < 1 and error is None:
        raise MetricError(
            "a fraction of the triangles cannot be given new sizes and a number of "
            "vertices be met: give `error`, or leave `fraction` out"
        )
    if not (order > 0 and max_change > 1):
        raise MetricError(f"order={order!r} must be positive and max_change={max_change!r} above 1")
    shares = eta ** (2 / (order + 1))
    marked = doerfler_marking(eta, fraction) if fraction < 1 else np.ones(len(t), bool)
    if error is not None:
        factor = _factor_for(error, eta, shares, marked, order)
    elif target_vertices is not None:
        factor = target_vertices / len(p) * len(t) / shares.sum()
    bounded = np.clip(factor * shares, max_change**-2.0, max_change**2.0)
    metric = _metric_at_vertices(np.where(marked, bounded, 1.0), LinearElements(p, t))
    limits = Limits(h_min, h_max, gradation=gradation, law=law)
    if error is not None:
        return Background(p, t, limits.applied(metric, p, t))
    return Background(
        p, t, scaled_to(count_goal(p, t, target_vertices, None), metric, p, t, limits)
    )


def _factor_for(error: float, eta: Floats, shares: Floats, marked: Bools, order: float) -> float:
    """With x = factor * shares on the marked triangles, what is left of all squares is error²."""
    if not 0 < error < np.inf:
        raise MetricError(f"the error must be positive, not {error!r}")
    elsewhere = float((eta[~marked] ** 2).sum())
    if elsewhere >= error**2:
        raise MetricError(
            f"the triangles that keep their sizes have an error of {np.sqrt(elsewhere):.6g}, more "
            f"than the {error:.6g} asked for: raise the fraction"
        )
    return float((shares[marked].sum() / (error**2 - elsewhere)) ** (1 / order))


def _metric_at_vertices(children: Floats, elements: LinearElements) -> Floats:
    """The isotropic metric (n, 3) in which each triangle is worth a number of unit triangles.

    Its density sqrt(det M) = 1/h² is averaged around each vertex, weighted by area, so that the
    complexity is that of all triangles.
    """
    worth = _UNIT_AREA / 3 * np.repeat(children[:, None], 3, axis=1)
    density = elements.gather(worth) / elements.mass
    return np.stack([density, np.zeros_like(density), density], axis=1)


def _check_indicators(indicators: ArrayLike) -> Floats:
    eta = np.asarray(as_numbers(indicators, "indicators"), np.float64)
    if eta.ndim != 1 or len(eta) == 0:
        raise MetricError(f"indicators must have the shape (m,), one a triangle, not {eta.shape}")
    bad = ~(np.isfinite(eta) & (eta >= 0))
    if bad.any():
        i = int(bad.argmax())
        raise MetricError(f"the indicator of triangle {i} is {eta[i]}: none may be negative")
    if not eta.any():
        raise MetricError("all indicators are zero: they say nothing about sizes")
    return eta
