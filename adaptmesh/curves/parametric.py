"""Any function as a curve."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
from numpy.typing import ArrayLike

from adaptmesh.errors import DomainError
from adaptmesh.types import Floats

from .curve import Curve

CLOSED = 1e-9
"""Largest gap between the ends of a closed `Parametric` curve, relative to its size."""

N_SAMPLES = 65
"""Number of parameters at which the function and its derivative are checked at first."""

DIFFERENCE = 1e-6
"""Step of the finite differences that replace a missing derivative."""


class Parametric(Curve):
    """Any function as a curve.

    Parameters
    ----------
    function : callable
        Maps t (n,) in [0, 1] to points (n, 2).
    derivative : callable, optional
        Its derivative, (n,) -> (n, 2); by finite differences if not given.
    closed : bool
        Whether the curve ends where it starts and is smooth there. A curve with a corner there is
        not closed.
    breaks : (k,) array_like
        Parameters of its kinks, inside (0, 1); each becomes a vertex.
    """

    def __init__(
        self,
        function: Callable[[Floats], ArrayLike],
        derivative: Callable[[Floats], ArrayLike] | None = None,
        closed: bool = False,
        breaks: ArrayLike = (),
    ) -> None:
        self.function, self._given_derivative, self.is_closed = function, derivative, closed
        self._breaks = np.unique(np.asarray(breaks, np.float64))
        if not ((self._breaks > 0) & (self._breaks < 1)).all():
            raise DomainError(f"{self!r}: expected breaks inside (0, 1), got {self._breaks}")
        t = np.linspace(0, 1, N_SAMPLES)
        points = self.point(t)
        size = float(np.ptp(points, axis=0).max())
        if size == 0:
            raise DomainError(
                f"{self!r} has no length: all points are ({points[0, 0]}, {points[0, 1]})"
            )
        gap = float(np.hypot(*(points[-1] - points[0])))
        if closed and gap > CLOSED * size:
            raise DomainError(
                f"{self!r}: closed=True, but its end is {gap:g} away from its start, "
                f"({points[0, 0]:g}, {points[0, 1]:g})"
            )
        self.derivative(t)

    @property
    def breaks(self) -> Floats:
        """Parameters of its kinks, as given."""
        return self._breaks

    def _point(self, t: Floats) -> Floats:
        return self._checked_result(self.function(t), len(t), "function")

    def _derivative(self, t: Floats) -> Floats:
        if self._given_derivative is not None:
            return self._checked_result(self._given_derivative(t), len(t), "derivative")
        low, high = np.maximum(t - DIFFERENCE, 0), np.minimum(t + DIFFERENCE, 1)
        low = np.where(np.isin(t, self._breaks), t, low)  # one-sided at a kink
        return (self._point(high) - self._point(low)) / (high - low)[:, None]

    def _checked_result(self, values: ArrayLike, n: int, what: str) -> Floats:
        out = np.asarray(values, np.float64)
        if out.shape != (n, 2):
            raise DomainError(
                f"{self!r}: expected its {what} to return an array of shape ({n}, 2) for {n} "
                f"parameters, got {out.shape}"
            )
        return out

    def __repr__(self) -> str:
        return f"Parametric {getattr(self.function, '__name__', 'curve')}"
