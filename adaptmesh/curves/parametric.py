"""Any function as a curve."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
from numpy.typing import ArrayLike

from adaptmesh.errors import DomainError
from adaptmesh.types import Floats

from .curve import Curve

CLOSED = 1e-9
"""The ends of a closed `Parametric` curve may be apart by this share of its size."""

LOOKS = 65
"""A function is looked at in so many places before it is taken for a curve."""

DIFFERENCE = 1e-6
"""Step of the differences that stand for a derivative not given."""


class Parametric(Curve):
    """Any function as a curve.

    Parameters
    ----------
    function : callable
        Of t (n,) in [0, 1], returning points (n, 2).
    derivative : callable, optional
        Its derivative, (n,) -> (n, 2). If not given, taken by differences.
    closed : bool
        Whether it ends where it begins, smoothly. A curve that comes back with a corner is open.
    breaks : (k,) array_like
        Where it has kinks, inside (0, 1); each becomes a vertex.
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
            raise DomainError(f"{self!r}: breaks must lie inside (0, 1)")
        t = np.linspace(0, 1, LOOKS)
        seen = self.point(t)
        size = float(np.ptp(seen, axis=0).max())
        if size == 0:
            raise DomainError(f"{self!r} has no length: it stays at ({seen[0, 0]}, {seen[0, 1]})")
        gap = float(np.hypot(*(seen[-1] - seen[0])))
        if closed and gap > CLOSED * size:
            raise DomainError(
                f"{self!r} is said to be closed, but ends {gap:g} from where it begins, "
                f"({seen[0, 0]:g}, {seen[0, 1]:g})"
            )
        self.derivative(t)

    @property
    def breaks(self) -> Floats:
        """As given."""
        return self._breaks

    def _point(self, t: Floats) -> Floats:
        return self._returned(self.function(t), len(t), "function")

    def _derivative(self, t: Floats) -> Floats:
        if self._given_derivative is not None:
            return self._returned(self._given_derivative(t), len(t), "derivative")
        low, high = np.maximum(t - DIFFERENCE, 0), np.minimum(t + DIFFERENCE, 1)
        low = np.where(np.isin(t, self._breaks), t, low)  # no differences across a kink
        return (self._point(high) - self._point(low)) / (high - low)[:, None]

    def _returned(self, values: ArrayLike, n: int, what: str) -> Floats:
        out = np.asarray(values, np.float64)
        if out.shape != (n, 2):
            raise DomainError(
                f"{self!r}: its {what} returned an array of shape {out.shape} for {n} parameters; "
                f"({n}, 2) is wanted"
            )
        return out

    def __repr__(self) -> str:
        return f"Parametric {getattr(self.function, '__name__', 'curve')}"
