"""Curves defined by control points or interpolated points, evaluated by scipy."""

from __future__ import annotations

from functools import cached_property
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import ArrayLike, NDArray

from adaptmesh.errors import DomainError
from adaptmesh.types import Floats

from .checks import check_distinct, checked_points
from .curve import Curve

if TYPE_CHECKING:
    from scipy.interpolate import BSpline as ScipyBSpline
    from scipy.interpolate import CubicSpline


class Bezier(Curve):
    """The Bézier curve of degree n with control points (n + 1, 2)."""

    def __init__(self, control_points: ArrayLike) -> None:
        self.control_points = checked_points(control_points, "Bezier", 2)
        if (self.control_points == self.control_points[0]).all():
            raise DomainError("Bezier: its control points are all the same")

    def _point(self, t: Floats) -> Floats:
        return _de_casteljau(self.control_points, t)

    def _derivative(self, t: Floats) -> Floats:
        sides = np.diff(self.control_points, axis=0)
        return _de_casteljau(len(sides) * sides, t)


class Spline(Curve):
    """The interpolating cubic spline through points, by `scipy.interpolate.CubicSpline`.

    Parameters
    ----------
    points : (n, 2) array_like
    closed : bool
        Whether the spline is periodic: smooth at the first point, to which it returns. For a
        corner there (the trailing edge of an aerofoil), repeat the first point instead.

    Notes
    -----
    Parametrised by chord length, with not-a-knot conditions at open ends.
    """

    def __init__(self, points: ArrayLike, closed: bool = False) -> None:
        p = checked_points(points, "Spline", 3 if closed else 2)
        if closed and (p[0] != p[-1]).any():
            p = np.concatenate([p, p[:1]])
        check_distinct(p, "Spline")
        self.points, self.is_closed = p, closed
        along = np.concatenate([[0.0], np.cumsum(np.hypot(*np.diff(p, axis=0).T))])
        self._t = along / along[-1]

    @cached_property
    def _spline(self) -> CubicSpline:
        from scipy.interpolate import CubicSpline

        ends = "periodic" if self.is_closed else "not-a-knot"
        return CubicSpline(self._t, self.points, bc_type=ends)

    @property
    def knots(self) -> Floats:
        """The parameters of the points between its ends."""
        return self._t[1:-1]

    def _point(self, t: Floats) -> Floats:
        return np.asarray(self._spline(t), np.float64)

    def _derivative(self, t: Floats) -> Floats:
        return np.asarray(self._spline(t, 1), np.float64)


class BSpline(Curve):
    """A B-spline, rational (NURBS) if it has weights, by `scipy.interpolate.BSpline`.

    Parameters
    ----------
    control_points : (n, 2) array_like
    degree : int
    knots : (n + degree + 1,) array_like, optional
        Ascending; the curve goes from knots[degree] to knots[n]. By default equidistant and
        clamped: the curve starts and ends at its first and last control points.
    weights : (n,) array_like, optional
        Positive; all 1 by default.
    closed : bool
        Whether the control points are periodic, so that the curve is closed and smooth. Not
        together with `knots`.
    """

    def __init__(
        self,
        control_points: ArrayLike,
        degree: int = 3,
        knots: ArrayLike | None = None,
        weights: ArrayLike | None = None,
        closed: bool = False,
    ) -> None:
        p = checked_points(control_points, "BSpline", 2)
        if degree != int(degree) or degree < 1 or len(p) < degree + 1 - (1 if closed else 0):
            raise DomainError(
                f"BSpline: expected a degree of at least 1 and more control points than that, "
                f"got degree {degree} and {len(p)} points"
            )
        w = np.ones(len(p)) if weights is None else np.array(weights, np.float64)
        if w.shape != (len(p),) or not (np.isfinite(w) & (w > 0)).all():
            raise DomainError(f"BSpline: expected {len(p)} positive weights, got {weights!r}")
        if (p == p[0]).all():
            raise DomainError("BSpline: its control points are all the same")
        self.degree, self.is_closed = int(degree), closed
        if closed:
            if knots is not None:
                raise DomainError(
                    "BSpline: a closed curve has equidistant knots; leave `knots` out"
                )
            p, w = (np.concatenate([a, a[:degree]]) for a in (p, w))
        self.control_points, self.weights = p, w
        self._u = self._checked_knots(knots)

    @cached_property
    def _spline(self) -> ScipyBSpline:
        w = self.weights[:, None]
        return self._with_coefficients(np.column_stack([self.control_points * w, w]))

    @cached_property
    def _slope(self) -> ScipyBSpline:
        return self._spline.derivative()

    @property
    def breaks(self) -> Floats:
        """Parameters of the knots of full multiplicity, where the curve is only continuous."""
        knots, times = self._inner_knots
        return knots[times >= self.degree]

    @property
    def knots(self) -> Floats:
        """Parameters of the knots inside (0, 1)."""
        return self._inner_knots[0]

    @property
    def _inner_knots(self) -> tuple[Floats, NDArray[np.intp]]:
        """Distinct knots inside (0, 1), and the multiplicity of each."""
        inner = self._u[(self._u > 0) & (self._u < 1)]
        return np.unique(inner, return_counts=True)

    def _checked_knots(self, knots: ArrayLike | None) -> Floats:
        n, k = len(self.control_points), self.degree
        if knots is None:
            if self.is_closed:
                return (np.arange(n + k + 1) - k) / (n - k)
            inner = np.arange(1, n - k) / (n - k)
            return np.concatenate([np.zeros(k + 1), inner, np.ones(k + 1)])
        u = np.array(knots, np.float64)
        if u.shape != (n + k + 1,):
            raise DomainError(
                f"BSpline: expected {n + k + 1} knots for degree {k} and {n} points, got {u.size}"
            )
        bad = np.flatnonzero(~(np.diff(u) >= 0))
        if len(bad) or not np.isfinite(u).all() or not u[k] < u[n]:
            where = f" after knot {bad[0]}" if len(bad) else ""
            raise DomainError(f"BSpline: knots must be finite and ascending{where}")
        return (u - u[k]) / (u[n] - u[k])

    def _with_coefficients(self, coefficients: Floats) -> ScipyBSpline:
        from scipy.interpolate import BSpline as ScipyBSpline

        return ScipyBSpline(self._u, coefficients, self.degree)

    def _point(self, t: Floats) -> Floats:
        values = self._spline(t)
        return values[:, :2] / values[:, 2:]

    def _derivative(self, t: Floats) -> Floats:
        values, slopes = self._spline(t), self._slope(t)
        p = values[:, :2] / values[:, 2:]
        return (slopes[:, :2] - p * slopes[:, 2:]) / values[:, 2:]


def _de_casteljau(control: Floats, t: Floats) -> Floats:
    """Evaluate the Bézier curve of control points (n, 2) at t (m,); stable at any degree."""
    s = t[:, None, None]
    p = np.broadcast_to(control, (len(t), *control.shape))
    while p.shape[1] > 1:
        p = (1 - s) * p[:, :-1] + s * p[:, 1:]
    return p[:, 0].copy()
