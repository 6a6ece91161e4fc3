"""Arcs of circles and ellipses."""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike

from adaptmesh.errors import DomainError
from adaptmesh.types import Floats

from .checks import checked_point
from .curve import Curve

FULL_TURN = 2 * np.pi


class EllipticArc(Curve):
    """An arc of an ellipse.

    Parameters
    ----------
    centre : (x, y)
    semi_axes : (a, b)
        Half the lengths of the axes, positive.
    rotation : float
        Angle of the first axis with the x axis, in radians.
    start_angle, end_angle : float
        Eccentric angles from the first axis, in radians; the point at angle s is centre +
        a cos s (first axis) + b sin s (second axis). Anticlockwise if the end is larger. A full
        turn makes a closed curve.
    """

    def __init__(
        self,
        centre: ArrayLike,
        semi_axes: ArrayLike,
        rotation: float = 0.0,
        start_angle: float = 0.0,
        end_angle: float = FULL_TURN,
    ) -> None:
        what = type(self).__name__
        self.centre = checked_point(centre, what)
        self.semi_axes = checked_point(semi_axes, what)
        self.rotation, self.start_angle = float(rotation), float(start_angle)
        self.turn = float(end_angle) - self.start_angle
        if not (self.semi_axes > 0).all():
            raise DomainError(f"{what}: expected positive radii, got {self.semi_axes.min():g}")
        if not np.isfinite([self.rotation, self.start_angle, self.turn]).all():
            raise DomainError(f"{what}: angles must be finite")
        if self.turn == 0 or abs(self.turn) > FULL_TURN * (1 + 1e-12):
            raise DomainError(
                f"{what}: expected a turn between 0 and 2 pi radians in either direction, "
                f"got {self.turn:g}"
            )
        self.is_closed = abs(self.turn) > FULL_TURN * (1 - 1e-12)
        c, s = np.cos(self.rotation), np.sin(self.rotation)
        self._axes = np.array([[c, s], [-s, c]]) * self.semi_axes[:, None]

    def _point(self, t: Floats) -> Floats:
        phi = self.start_angle + t * self.turn
        return self.centre + np.stack([np.cos(phi), np.sin(phi)], axis=1) @ self._axes

    def _derivative(self, t: Floats) -> Floats:
        phi = self.start_angle + t * self.turn
        return self.turn * np.stack([-np.sin(phi), np.cos(phi)], axis=1) @ self._axes

    def __repr__(self) -> str:
        x, y = self.centre.tolist()
        return f"{type(self).__name__} around ({x:g}, {y:g})"


class Arc(EllipticArc):
    """An arc of a circle, from one angle (in radians, from the x axis) to another.

    Anticlockwise if the end angle is larger.
    """

    def __init__(
        self, centre: ArrayLike, radius: float, start_angle: float, end_angle: float
    ) -> None:
        super().__init__(centre, (radius, radius), 0.0, start_angle, end_angle)
        self.radius = float(radius)

    @classmethod
    def through(cls, a: ArrayLike, b: ArrayLike, c: ArrayLike) -> Arc:
        """Make the arc from a to c through b."""
        p = [checked_point(q, "Arc") for q in (a, b, c)]
        u, v = p[1] - p[0], p[2] - p[0]
        cross = u[0] * v[1] - u[1] * v[0]
        if abs(cross) <= 1e-14 * np.hypot(*u) * np.hypot(*v):
            raise DomainError(
                f"Arc: ({p[0][0]:g}, {p[0][1]:g}), ({p[1][0]:g}, {p[1][1]:g}) and "
                f"({p[2][0]:g}, {p[2][1]:g}) lie on a line; use a Line"
            )
        w = np.array([v[1] * (u @ u) - u[1] * (v @ v), u[0] * (v @ v) - v[0] * (u @ u)])
        centre = p[0] + w / (2 * cross)
        first, last = (np.arctan2(*(q - centre)[::-1]) for q in (p[0], p[2]))
        turn = (last - first) % FULL_TURN
        if cross < 0:
            turn -= FULL_TURN
        return cls(centre, float(np.hypot(*(p[0] - centre))), float(first), float(first + turn))


class Circle(Arc):
    """A circle, anticlockwise from its point at angle 0, which is a vertex of every mesh."""

    def __init__(self, centre: ArrayLike, radius: float) -> None:
        super().__init__(centre, radius, 0.0, FULL_TURN)
