"""The base class of curves: a function of t in [0, 1] with ends and kinks."""

from __future__ import annotations

from abc import ABC, abstractmethod
from functools import cached_property

import numpy as np
from numpy.typing import ArrayLike

from adaptmesh.errors import DomainError
from adaptmesh.types import Floats
from adaptmesh.value import Value


class Curve(Value, ABC):
    """A planar curve: a function of t in [0, 1], smooth between its `breaks`.

    A subclass defines `_point` and `_derivative` of t (n,); their results are checked here.
    """

    is_closed: bool = False
    """Whether the curve ends where it starts, and is smooth there."""

    is_straight: bool = False
    """Whether the curve is a straight line of constant speed between its breaks."""

    @property
    def breaks(self) -> Floats:
        """Parameters of its kinks, (k,), ascending, inside (0, 1)."""
        return np.empty(0)

    @property
    def knots(self) -> Floats:
        """Parameters between its analytic pieces, (k,), ascending, inside (0, 1)."""
        return self.breaks

    def point(self, t: ArrayLike) -> Floats:
        """Return the points (n, 2) at parameters t (n,).

        Raises
        ------
        DomainError
            If a point is not finite.
        """
        t = np.atleast_1d(np.asarray(t, np.float64))
        return self._checked(self._point(t), t, "point")

    def derivative(self, t: ArrayLike) -> Floats:
        """Return the derivatives (n, 2) by t at t (n,); at a break, the one from the right."""
        t = np.atleast_1d(np.asarray(t, np.float64))
        return self._checked(self._derivative(t), t, "derivative")

    @cached_property
    def start(self) -> Floats:
        """The point at t = 0, (2,)."""
        return self.point(0.0)[0]

    @cached_property
    def end(self) -> Floats:
        """The point at t = 1, (2,); that at t = 0 if the curve is closed."""
        return self.start if self.is_closed else self.point(1.0)[0]

    def reversed(self) -> Curve:
        """Return the same curve in the opposite direction."""
        return Part(self, 1.0, 0.0)

    def part(self, t0: float, t1: float) -> Curve:
        """Return the part from t0 to t1, in the opposite direction if t1 < t0.

        Use it to divide a curve at the end of another one.
        """
        return Part(self, t0, t1)

    @abstractmethod
    def _point(self, t: Floats) -> Floats: ...

    @abstractmethod
    def _derivative(self, t: Floats) -> Floats: ...

    def _checked(self, values: Floats, t: Floats, what: str) -> Floats:
        bad = np.flatnonzero(~np.isfinite(values).all(axis=1))
        if len(bad):
            x, y = values[bad[0]]
            raise DomainError(
                f"{self!r}: expected a finite {what} at t = {t[bad[0]]:.17g}, got ({x}, {y})"
            )
        return values

    def __repr__(self) -> str:
        return type(self).__name__


class Part(Curve):
    """A part of a curve in either direction; see `Curve.part`."""

    def __init__(self, whole: Curve, t0: float, t1: float) -> None:
        if not (0 <= t0 <= 1 and 0 <= t1 <= 1 and t0 != t1):
            raise DomainError(
                f"{whole!r}: expected two different parameters of a part, from 0 to 1, "
                f"got {t0} and {t1}"
            )
        self.whole, self.t0, self.t1 = whole, float(t0), float(t1)
        self.is_straight = whole.is_straight
        self.is_closed = whole.is_closed and abs(t1 - t0) == 1

    @property
    def breaks(self) -> Floats:
        """Parameters of the kinks of the whole curve inside the part."""
        return self._inside(self.whole.breaks)

    @property
    def knots(self) -> Floats:
        """Parameters of the knots of the whole curve inside the part."""
        return self._inside(self.whole.knots)

    def _inside(self, t_of_whole: Floats) -> Floats:
        t = (t_of_whole - self.t0) / (self.t1 - self.t0)
        return np.sort(t[(t > 0) & (t < 1)])

    def _point(self, t: Floats) -> Floats:
        return self.whole.point(self._of_whole(t))

    def _derivative(self, t: Floats) -> Floats:
        return (self.t1 - self.t0) * self.whole.derivative(self._of_whole(t))

    def _of_whole(self, t: Floats) -> Floats:
        # exact at both ends
        return np.where(t == 1, self.t1, self.t0 + t * (self.t1 - self.t0))

    def __repr__(self) -> str:
        return f"{self.whole!r} from t = {self.t0:g} to {self.t1:g}"
