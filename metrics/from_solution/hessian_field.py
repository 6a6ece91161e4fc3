"""How a field bends at the vertices of a mesh, and the interpolation error that makes."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property, reduce

import numpy as np
from numpy.typing import ArrayLike

import metrics._core as _core
from metrics import tensor
from metrics.checks import as_numbers, as_points, as_triangles
from metrics.errors import MetricError
from metrics.types import Floats, Ints

from .normalise import check_norm
from .recovery import absolute, derivatives, largest_magnitude

__all__ = ["Curvature", "interpolation_errors"]

_FLATNESS = 1e-8  # curvature below this share of the largest is not told from none
_ROUNDING = 32 * 2.0**-52  # what rounding of the values does to second differences


@dataclass(frozen=True, eq=False)
class Curvature:
    """The derivatives of a field at the vertices of a mesh.

    Attributes
    ----------
    points : (n, 2) array of float
    triangles : (m, 3) array of int32
    gradients : list of (n, 2) array of float
    hessians : list of (n, 3) array of float
        Of each component of the field.
    largest : float
        The largest absolute value of the field; of one with components, their Euclidean norm.
    """

    points: Floats
    triangles: Ints
    gradients: list[Floats]
    hessians: list[Floats]
    largest: float

    @classmethod
    def of(
        cls,
        points: ArrayLike,
        triangles: ArrayLike,
        values: ArrayLike,
        recovery: str = "least squares",
    ) -> Curvature:
        """Recover the derivatives of a field from its values at the vertices.

        Parameters
        ----------
        points : (n, 2) array_like
        triangles : (m, 3) array_like of int
        values : (n,) or (n, k) array_like
            A scalar, or the components of one field, such as a velocity.
        recovery : {"least squares", "projection", "green"}, optional
            As `method` of `metrics.hessians`.

        Raises
        ------
        MetricError
            For values of another shape; and as for `metrics.hessians`.
        """
        where = as_points(points)
        t = as_triangles(triangles, len(where))
        array = np.asarray(as_numbers(values, "values"), np.float64)
        if array.ndim not in (1, 2) or len(array) != len(where) or array.size == 0:
            raise MetricError(
                f"values must have the shape ({len(where)},), or ({len(where)}, k) with k "
                f"components, not {array.shape}"
            )
        both = [derivatives(where, t, u, recovery) for u in np.atleast_2d(array.T)]
        largest = float(np.hypot.reduce(np.abs(array.reshape(len(array), -1)), axis=1).max())
        return cls(where, t, [g for g, _ in both], [h for _, h in both], largest)

    @cached_property
    def absolute(self) -> Floats:
        """The absolute Hessian at the vertices, packed (n, 3) and positive definite.

        Of a field with components, the root of the sum of the squares of their Hessians
        (`metrics.tensor.hypot`): whatever axes a vector is given along, it is the same, and a small
        component counts for little. Eigenvalues are raised to 1e-8 of the largest one, and to what
        rounding of the values can make of a function without curvature: a linear function gives
        back the sizes of the mesh it is on.
        """
        together = reduce(tensor.hypot, self.hessians)
        noise = _ROUNDING * self.largest / _core.shortest_squares(self.points, self.triangles)
        return absolute(together, np.maximum(noise, _FLATNESS * largest_magnitude(together)))

    @cached_property
    def is_flat(self) -> bool:
        """Whether rounding of the values can make all that tells the field from a linear one."""
        return bool(self.interpolation_errors(np.inf).max() <= _ROUNDING * self.largest)

    def interpolation_errors(self, p: float = 2) -> Floats:
        """The L^p norm on each triangle, (m,), of the error of linear interpolation on this mesh.

        As `metrics.interpolation_errors`; of a field with components, that of the Euclidean norm of
        the error. For ``p=inf`` it may then be more than the true one, by a third at most.
        """
        return _norms(self.points, self.triangles, self.gradients, p)


def interpolation_errors(
    points: ArrayLike, triangles: ArrayLike, gradients: ArrayLike, p: float = 2
) -> Floats:
    """The L^p norm of the error of linear interpolation on each triangle, (m,).

    On a triangle with barycentric coordinates b_i, the linear interpolant minus a quadratic is
    1/2 sum over i < j of b_i b_j d_ij, where d_ij = e_ij' H e_ij, for the edge e_ij, is also the
    difference of the gradients at its ends, along it: (g_j - g_i) . e_ij. The second form is used.
    It measures each edge by itself, and a gradient is recovered more accurately than a Hessian.

    The norm is in closed form for p = 2, for ``p=inf`` the maximum of the quadratic, and for others
    by 75 Gauss points, exact for p = 4.

    Parameters
    ----------
    points : (n, 2) array_like
    triangles : (m, 3) array_like of int
    gradients : (n, 2) array_like
        At the points, see `metrics.gradients`.
    p : float, optional
        From 1 to inf. The norm on the mesh is ``np.sum(errors**p) ** (1 / p)``, or the maximum.
    """
    check_norm(p)
    where = as_points(points)
    t = as_triangles(triangles, len(where))
    g = np.asarray(as_numbers(gradients, "gradients"), np.float64)
    if g.shape != where.shape:
        raise MetricError(f"gradients must have the shape {where.shape}, not {g.shape}")
    return _norms(where, t, [g], p)


def _norms(points: Floats, triangles: Ints, gradients: list[Floats], p: float) -> Floats:
    """The L^p norms (m,) of the Euclidean norm of the errors of all components."""
    check_norm(p)
    d = np.stack([_core.bends(points, triangles, np.ascontiguousarray(g)).T for g in gradients])
    if p == np.inf:
        return _maxima(*(d[0] if len(d) == 1 else np.linalg.norm(d, axis=0)))
    corners = points[triangles]
    u, v = corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0]
    areas = np.abs(u[:, 0] * v[:, 1] - u[:, 1] * v[:, 0]) / 2
    scale = np.maximum(np.abs(d).max(axis=(0, 1)), np.finfo(float).tiny)
    mean = _mean_square(d / scale) if p == 2 else _mean_power(d / scale, p)
    return 0.5 * scale * (areas * mean) ** (1 / p)


def _mean_square(d: Floats) -> Floats:
    """Of b1 b2 d0 + b2 b0 d1 + b0 b1 d2: the mean of (b1 b2)² is 1/90, of b0 b1 b2² 1/180.

    d (k, 3, m) are those of k components, whose squares are added.
    """
    d0, d1, d2 = d.transpose(1, 0, 2)
    return (d0 * (d0 + d1) + d1 * (d1 + d2) + d2 * (d2 + d0)).sum(axis=0) / 90


def _mean_power(d: Floats, p: float) -> Floats:
    """Of the norm of b1 b2 d0 + b2 b0 d1 + b0 b1 d2 over k components, by Gauss points."""
    mean = np.zeros(d.shape[2])
    for b, weight in zip(*_triangle_rule(), strict=True):
        error = b[1] * b[2] * d[:, 0] + b[2] * b[0] * d[:, 1] + b[0] * b[1] * d[:, 2]
        size = np.abs(error[0]) if len(d) == 1 else np.linalg.norm(error, axis=0)
        mean += weight * size**p
    return mean


def _maxima(d0: Floats, d1: Floats, d2: Floats) -> Floats:
    """The largest absolute value of (b1 b2 d0 + b2 b0 d1 + b0 b1 d2) / 2 on each triangle.

    On an edge it is d / 8, in the middle. Inside it is stationary where b is in proportion to
    w0 = d0 (d1 + d2 - d0), and so on; the value is then d0 d1 d2 / (2 (w0 + w1 + w2)).
    """
    w = np.stack([d0 * (d1 + d2 - d0), d1 * (d2 + d0 - d1), d2 * (d0 + d1 - d2)])
    total = w.sum(axis=0)
    inside = (w > 0).all(axis=0) | (w < 0).all(axis=0)
    middle = np.where(inside, d0 * d1 * d2 / np.where(inside, 2 * total, 1), 0)
    return np.max(np.abs([d0 / 8, d1 / 8, d2 / 8, middle]), axis=0)


def _triangle_rule() -> tuple[Floats, Floats]:
    """Barycentric coordinates (75, 3) and weights that sum to 1, of Gauss points.

    On the three triangles from the centroid to the sides, so that no corner is preferred.
    """
    x, w = np.polynomial.legendre.leggauss(5)
    along, s = (a.ravel() for a in np.meshgrid(0.5 * (x + 1), 0.5 * (x + 1), indexing="ij"))
    weights = np.outer(w, w).ravel() / 2 * (1 - s)
    # s from a side to the centroid, on one of the three triangles
    inner = np.stack([s / 3, s / 3 + (1 - s) * along, s / 3 + (1 - s) * (1 - along)], axis=1)
    return np.concatenate([np.roll(inner, k, axis=1) for k in range(3)]), np.tile(weights / 3, 3)
