"""Curves joined smoothly, end to end: one line with one parameter."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from functools import cached_property

import numpy as np

from adaptmesh.curves import Curve
from adaptmesh.domain.inputs import rows_of_each
from adaptmesh.types import Floats, Index
from adaptmesh.value import Value

SAMPLES = 64
"""On each part of a path, among which the place nearest to a point is looked for."""

NEWTON_STEPS = 8


@dataclass(frozen=True, eq=False)
class Path(Value):
    """Curves from corner to corner, with no corner between.

    Attributes
    ----------
    parts : tuple of Curve
        End to end; the path has the parameter u = k + t on part k.
    curves : tuple of int
        The curve, of those that the domain was given, that each part belongs to.
    ends : (int, int)
        The corners where it begins and ends.
    start, end : (2,) arrays
        Their places: the ends of curves that are joined may differ by rounding.
    """

    parts: tuple[Curve, ...]
    curves: tuple[int, ...]
    ends: tuple[int, int]
    start: Floats
    end: Floats

    @property
    def length(self) -> float:
        """The parameter of its end."""
        return float(len(self.parts))

    @cached_property
    def knots(self) -> Floats:
        """The parameters between which it is analytic, ascending, without those of its ends."""
        joints = np.arange(1.0, self.length)
        return np.sort(np.concatenate([joints, *(k + p.knots for k, p in enumerate(self.parts))]))

    def curve_at(self, u: float) -> int:
        """The curve that the path follows at u."""
        return self.curves[min(int(u), len(self.parts) - 1)]

    def point(self, u: Floats) -> Floats:
        """Points (n, 2) at u (n,)."""
        out = self.point_of_part(self._parts_at(u), u)
        out[u == 0] = self.start
        out[u == self.length] = self.end
        return out

    def derivative(self, u: Floats) -> Floats:
        """Derivatives by u (n, 2) at u (n,)."""
        return self._of_parts(Curve.derivative, self._parts_at(u), u)

    def point_of_part(self, part: Index, u: Floats) -> Floats:
        """Points (n, 2) at u (n,) of the curves as they are, which joining may have left apart."""
        return self._of_parts(Curve.point, part, u)

    def derivative_of_part(self, part: Index, u: Floats) -> Floats:
        """Derivatives by u (n, 2) at u (n,) of these parts, up to and including their ends."""
        return self._of_parts(Curve.derivative, part, u)

    def nearest(self, points: Floats) -> Floats:
        """The parameters (n,) nearest to points (n, 2) that lie on the path but for rounding.

        The nearest of many samples, then Newton's steps for (p(u) - x) . p'(u) = 0, without the
        second derivative, as the distance is nearly zero.
        """
        samples = np.linspace(0, self.length, int(SAMPLES * self.length) + 1)
        at = self.point(samples)
        u = samples[((points[:, None] - at) ** 2).sum(axis=2).argmin(axis=1)]
        for _ in range(NEWTON_STEPS):
            off, d = points - self.point(u), self.derivative(u)
            u = np.clip(u + (off * d).sum(axis=1) / (d * d).sum(axis=1), 0, self.length)
        return u

    def _parts_at(self, u: Floats) -> Index:
        return np.clip(u.astype(np.intp), 0, len(self.parts) - 1)

    def _of_parts(
        self, values: Callable[[Curve, Floats], Floats], part: Index, u: Floats
    ) -> Floats:
        out = np.empty((len(u), 2))
        for k, here in rows_of_each(part).items():
            out[here] = values(self.parts[k], u[here] - k)
        return out


def points_on(paths: Sequence[Path], path: Index, u: Floats) -> Floats:
    """Points (k, 2) at the parameters u (k,) of these paths (k,)."""
    return _each(Path.point, paths, path, u)


def derivatives_on(paths: Sequence[Path], path: Index, u: Floats) -> Floats:
    """Derivatives (k, 2) at the parameters u (k,) of these paths (k,)."""
    return _each(Path.derivative, paths, path, u)


def derivatives_of_parts(paths: Sequence[Path], path: Index, part: Index, u: Floats) -> Floats:
    """Derivatives (k, 2) of these parts of paths (k,) at u (k,)."""
    out = np.empty((len(u), 2))
    for p, mine in rows_of_each(path).items():
        out[mine] = paths[p].derivative_of_part(part[mine], u[mine])
    return out


def _each(
    values: Callable[[Path, Floats], Floats], paths: Sequence[Path], path: Index, u: Floats
) -> Floats:
    out = np.empty((len(u), 2))
    for p, mine in rows_of_each(path).items():
        out[mine] = values(paths[p], u[mine])
    return out
