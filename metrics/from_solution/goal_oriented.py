"""The metric for a goal, one number of a solution, weighted by an adjoint."""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike

from metrics.background import Background
from metrics.checks import as_numbers
from metrics.errors import MetricError
from metrics.types import Floats

from .limits import Limits
from .optimal_metric import metric_from_hessians
from .p1_elements import check_mesh, place_of
from .recovery import absolute, gradients, hessians, largest_magnitude

__all__ = ["metric_from_adjoint"]

_FLATNESS = 1e-8  # of the largest eigenvalue


def metric_from_adjoint(
    points: ArrayLike,
    triangles: ArrayLike,
    fluxes: ArrayLike,
    adjoint: ArrayLike,
    *,
    target_vertices: float | None = None,
    complexity: float | None = None,
    h_min: float = 0.0,
    h_max: float = np.inf,
    max_anisotropy: float = np.inf,
    gradation: float | None = 2.0,
    law: str = "mixed",
    recovery: str = "least squares",
) -> Background:
    """The metric that minimises the error in a goal J(u), for a number of vertices or a complexity.

    For a conservation law div F(u) = f and the adjoint z of the goal, the error of J comes from the
    interpolation error of the fluxes, along the gradient of the adjoint: it is bounded by the
    integral of abs(grad z . (F - its interpolant)).

    Around a point, grad z . F has the Hessian G = sum over i of dz/dx_i H(F_i), whatever axes the
    plane is given; and abs(G) takes the place of the Hessian of the solution, in the L^1 norm. Of
    several equations the absolute values are added.

    Parameters
    ----------
    points : (n, 2) array_like
    triangles : (m, 3) array_like of int
        Counter-clockwise.
    fluxes : (n, 2), (n, k, 2) or (n, k, c, 2) array_like
        At the points, the flux of each of k equations in x and y: for convection and diffusion,
        ``-div(a grad u) + b . grad u``, it is ``b u - a grad u``. Gradients in it are recovered,
        e.g. by `metrics.gradients`. Parts whose errors must not be reckoned to cancel, such as
        these two, are given as two equations with the same adjoint. An equation of c components,
        such as the two of momentum, is one, so that it does not matter along which axes they are.
    adjoint : (n,), (n, k) or (n, k, c) array_like
        The adjoint solution z of each equation at the points; its scale does not matter.
    target_vertices, complexity, h_min, h_max, max_anisotropy, gradation, law, recovery
        As for `metric_from_solution`.

    Returns
    -------
    Background
        The metric, carried by the mesh given.

    Raises
    ------
    MetricError
        For arrays that do not fit or are not finite; if the adjoint is constant, or no flux has
        curvature where it changes, so that the goal asks for nothing; and as for
        `metric_from_solution`.

    Notes
    -----
    The paper adds abs(dz/dx_i) abs(H(F_i)) over both axes, which depends on them. Along the
    gradient of the adjoint and across it there is one term only, and that is abs(G).

    Where the goal does not depend on the mesh, the weighted Hessian is nearly zero and sizes are
    bounded by `h_max` and `gradation` only: a finite `h_max` is advised.

    References
    ----------
    Loseille, Dervieux, Alauzet: Fully anisotropic goal-oriented mesh adaptation for 3D steady Euler
    equations. Journal of Computational Physics 229 (2010), 2866-2897.
    """
    p, t = check_mesh(points, triangles)
    f, z = _checked_pair(p, fluxes, adjoint)
    weighted = np.zeros((len(p), 3))
    for k in range(z.shape[1]):
        along = np.zeros_like(weighted)
        for c in range(z.shape[2]):
            slopes = gradients(p, t, z[:, k, c], _gradient_method(recovery))
            for i in range(2):
                along += slopes[:, [i]] * hessians(p, t, f[:, k, c, i], recovery)
        weighted += absolute(along)
    largest = largest_magnitude(weighted)
    if not largest > 0:
        raise MetricError(
            "the goal does not ask for any size: the adjoint is constant, or the fluxes are linear "
            "wherever it changes"
        )
    curvature = absolute(weighted, _FLATNESS * largest)
    return metric_from_hessians(
        p,
        t,
        [curvature],
        target_vertices=target_vertices,
        complexity=complexity,
        p=1,
        limits=Limits(h_min, h_max, max_anisotropy, gradation, law),
    )


def _gradient_method(recovery: str) -> str:
    return "least squares" if recovery == "least squares" else "projection"


def _checked_pair(points: Floats, fluxes: ArrayLike, adjoint: ArrayLike) -> tuple[Floats, Floats]:
    """Fluxes (n, k, c, 2) and adjoints (n, k, c) that belong together."""
    n = len(points)
    f = np.asarray(as_numbers(fluxes, "fluxes"), np.float64)
    z = np.asarray(as_numbers(adjoint, "the adjoint"), np.float64)
    if f.ndim not in (2, 3, 4) or f.shape[0] != n or f.shape[-1] != 2 or f.size == 0:
        raise MetricError(
            f"fluxes must have the shape ({n}, 2), ({n}, k, 2) or ({n}, k, c, 2), not "
            f"{np.shape(fluxes)}"
        )
    if z.shape != f.shape[:-1] and not (f.ndim == 2 and z.shape == (n, 1)):
        raise MetricError(
            f"the adjoint must have the shape {f.shape[:-1]}, one for each flux, not "
            f"{np.shape(adjoint)}"
        )
    for array, what in ((f.reshape(n, -1), "flux"), (z.reshape(n, -1), "adjoint")):
        bad = ~np.isfinite(array).all(axis=1)
        if bad.any():
            i = int(bad.argmax())
            raise MetricError(f"the {what} at {place_of(points, i)} is not finite")
    k, c = (*f.shape[1:-1], 1, 1)[:2]
    return f.reshape(n, k, c, 2), z.reshape(n, k, c)
