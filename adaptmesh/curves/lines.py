"""Straight lines."""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike, NDArray

from adaptmesh.types import Floats

from .checks import check_distinct, checked_point, checked_points
from .curve import Curve


class Polyline(Curve):
    """Straight lines through points, each of which is a vertex of every mesh.

    Parameters
    ----------
    points : (n, 2) array_like
    closed : bool
        Whether a last line returns to the first point.
    """

    is_straight = True

    def __init__(self, points: ArrayLike, closed: bool = False) -> None:
        p = checked_points(points, type(self).__name__, 3 if closed else 2)
        if closed and (p[0] != p[-1]).any():
            p = np.concatenate([p, p[:1]])
        check_distinct(p, type(self).__name__)
        self.points = p
        # the first point is a corner, too: a polyline divided there keeps it as a vertex
        self.is_closed = closed

    @property
    def breaks(self) -> Floats:
        """Parameters of all points but the ends; each line has an equal part of [0, 1]."""
        return np.arange(1, len(self.points) - 1) / (len(self.points) - 1)

    def _point(self, t: Floats) -> Floats:
        k, s = self._line(t)
        a, b = self.points[k], self.points[k + 1]
        return np.where((s == 1)[:, None], b, a + s[:, None] * (b - a))

    def _derivative(self, t: Floats) -> Floats:
        k, _ = self._line(t)
        return (len(self.points) - 1) * (self.points[k + 1] - self.points[k])

    def _line(self, t: Floats) -> tuple[NDArray[np.intp], Floats]:
        lines = len(self.points) - 1
        along = t * lines
        whole = np.rint(along)  # k / n * n need not be k
        along = np.where(np.abs(along - whole) <= 4e-16 * lines, whole, along)
        k = np.minimum(along.astype(np.intp), lines - 1)
        return k, along - k


class Line(Polyline):
    """A straight line from a to b."""

    def __init__(self, a: ArrayLike, b: ArrayLike) -> None:
        super().__init__(np.stack([checked_point(a, "Line"), checked_point(b, "Line")]))

    def __repr__(self) -> str:
        (x0, y0), (x1, y1) = self.points.tolist()
        return f"Line from ({x0:g}, {y0:g}) to ({x1:g}, {y1:g})"
