"""Gradients and Hessians at the vertices of a mesh, recovered from values there."""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike

import metrics._core as _core
from metrics.checks import as_numbers
from metrics.errors import MetricError
from metrics.types import Floats, Ints

from .p1_elements import check_values, place_of

__all__ = ["METHODS", "absolute", "gradients", "hessians"]

METHODS = ("least squares", "projection", "green")


def gradients(
    points: ArrayLike, triangles: ArrayLike, values: ArrayLike, method: str = "least squares"
) -> Floats:
    """Gradients at the vertices, (n, 2), from values there.

    Parameters
    ----------
    points : (n, 2) array_like
    triangles : (m, 3) array_like of int
        Counter-clockwise.
    values : (n,) array_like
    method : {"least squares", "projection"}, optional
        ``"least squares"``: of the quadratic fitted around each vertex, as in `hessians`. Of second
        order on any mesh, at the border too. ``"projection"``: the L2 projection, with the mass
        lumped, of the gradients on triangles: their mean around the vertex, weighted by area. Of
        first order, of second where the triangles lie symmetrically.

    Raises
    ------
    MetricError
        As for `hessians`.
    """
    check_method(method)
    p, t, u = check_values(points, triangles, values)
    if method == "least squares":
        return _fit(p, t, u)[0]
    if method == "green":
        raise MetricError("Green's formula gives Hessians; for gradients use the projection")
    return _project(p, t, u)


def hessians(
    points: ArrayLike, triangles: ArrayLike, values: ArrayLike, method: str = "least squares"
) -> Floats:
    """Second derivatives at the vertices, packed (n, 3), from values there.

    Parameters
    ----------
    points : (n, 2) array_like
    triangles : (m, 3) array_like of int
        Counter-clockwise.
    values : (n,) array_like
    method : {"least squares", "projection", "green"}, optional
        ``"least squares"``: of the quadratic that fits best, with equal weights, the values at
        the vertex and at two rings of neighbours; more rings where these do not determine it well,
        as at corners. Where 60 neighbours do not, as the mesh is one triangle thick there, the
        flattest of those that fit best to two rings. Exact for quadratics. Of first order on
        any mesh, of second where the neighbours lie symmetrically.
        ``"projection"``: the gradients by the lumped L2 projection, projected again, and made
        symmetric. ``"green"``: tested with the hat function of the vertex,
        H_ij = -(integral of d_i u d_j hat) / (integral of hat), which is defined inside only; at
        the border by least squares.
        The last two do not converge on irregular meshes, but cost less; and on meshes that are
        adapted again and again Green's formula, which sees one ring only, gave better meshes than
        the fit to two: see :doc:`/theory`.

    Returns
    -------
    (n, 3) array of float
        (d²u/dx², d²u/dxdy, d²u/dy²).

    Raises
    ------
    MetricError
        For arrays that do not fit, values that are not finite, a triangle that is not
        counter-clockwise, a vertex without triangle; and where the values of the whole mesh do
        not determine a quadratic (it has few points, all on two lines or another conic).

    References
    ----------
    Zhang, Naga: A new finite element gradient recovery method: superconvergence property. SIAM
    Journal on Scientific Computing 26 (2005), 1192-1213: the quadratic fit.

    Kamenski, Huang: How a nonconvergent recovered Hessian works in mesh adaptation. SIAM Journal
    on Numerical Analysis 52 (2014), 1692-1708: why Hessians that do not converge still serve.
    """
    return derivatives(points, triangles, values, method)[1]


def derivatives(
    points: ArrayLike, triangles: ArrayLike, values: ArrayLike, method: str = "least squares"
) -> tuple[Floats, Floats]:
    """First and second derivatives at once, as `gradients` and `hessians` give them.

    With Green's formula the first are by the projection.
    """
    check_method(method)
    p, t, u = check_values(points, triangles, values)
    if method == "least squares":
        return _fit(p, t, u)
    first = _project(p, t, u)
    return first, _green(p, t, u) if method == "green" else _projected_twice(p, t, first)


def absolute(hessians: ArrayLike, floor: ArrayLike = 0.0) -> Floats:
    """The absolute values of symmetric tensors, packed (n, 3): the same axes, eigenvalues > 0.

    Parameters
    ----------
    hessians : (n, 3) or (n, 2, 2) array_like
        Symmetric, of any signs.
    floor : float or (n,) array_like, optional
        Eigenvalues are raised to it.
    """
    raw = np.asarray(as_numbers(hessians, "Hessians"), np.float64)
    if raw.ndim == 3 and raw.shape[1:] == (2, 2):
        raw = np.stack([raw[:, 0, 0], 0.5 * (raw[:, 0, 1] + raw[:, 1, 0]), raw[:, 1, 1]], axis=1)
    if raw.ndim != 2 or raw.shape[1] != 3:
        raise MetricError(f"Hessians must have the shape (n, 3) or (n, 2, 2), not {raw.shape}")
    tensors = np.ascontiguousarray(raw)
    if not np.isfinite(tensors).all():
        i = int(np.argmin(np.isfinite(tensors).all(axis=1)))
        raise MetricError(f"the Hessian at item {i} is not finite: {tensors[i].tolist()}")
    floors = np.ascontiguousarray(np.broadcast_to(floor, len(tensors)), np.float64)
    if not (floors >= 0).all():
        raise MetricError("the floor of eigenvalues must not be negative")
    return _core.absolute(tensors, floors)


def largest_magnitude(hessians: Floats) -> float:
    """The largest magnitude of an eigenvalue of packed symmetric tensors (n, 3) of any signs."""
    m11, m12, m22 = hessians.T
    out = np.abs(0.5 * (m11 + m22)) + np.hypot(0.5 * (m11 - m22), m12)
    return float(out.max(initial=0.0))


def check_method(method: str) -> None:
    """Refuse a method of recovery that there is not."""
    if method not in METHODS:
        raise MetricError(f"method must be one of {', '.join(map(repr, METHODS))}, not {method!r}")


def _fit(p: Floats, t: Ints, u: Floats) -> tuple[Floats, Floats]:
    first, second, undetermined = _core.quadratic_fit(p, t, u)
    _raise_undetermined(p, undetermined)
    return first, second


def _raise_undetermined(p: Floats, i: int) -> None:
    if i >= 0:
        raise MetricError(
            f"the values around {place_of(p, i)} do not determine a quadratic: the "
            "points there lie on two lines, or another conic; refine the mesh across, or use "
            'the method "projection"'
        )


def _project(p: Floats, t: Ints, u: Floats) -> Floats:
    return _core.projected_gradients(p, t, np.ascontiguousarray(u))


def _projected_twice(p: Floats, t: Ints, first: Floats) -> Floats:
    """The projection of the derivatives of a gradient (n, 2), made symmetric."""
    of_x, of_y = (_project(p, t, component) for component in first.T)
    return np.stack([of_x[:, 0], 0.5 * (of_x[:, 1] + of_y[:, 0]), of_y[:, 1]], axis=1)


def _green(p: Floats, t: Ints, u: Floats) -> Floats:
    second, undetermined = _core.green_hessians(p, t, u)
    _raise_undetermined(p, undetermined)
    return second
