"""Thin sizes across a front: a shock, an interface, a flame."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import ArrayLike

from metrics.checks import evaluate, h_limit, positive
from metrics.control import ControlSpace, Metric, as_control_space
from metrics.errors import MetricError
from metrics.types import Floats

from .anisotropic_layer import layer_metric, size_along
from .geometry import as_curves
from .growth import slope_of

__all__ = ["Shock"]


class _Front(NamedTuple):
    """For n points: the distance to the front, the direction across it, where to ask for along."""

    distances: Floats
    normals: Floats
    places: Floats


class Shock(ControlSpace):
    """An anisotropic size at a front, thin across it and long along it.

    At the distance d from the front, ``across + growth * d`` across it and the larger of `along`
    and that along it; neither more than h_max.

    Parameters
    ----------
    front : Geometry, what it takes, or callable
        Curves as polylines or a shapely geometry; or a level set, a function of points (n, 2) that
        returns phi (n,), smooth and zero on the front. Then the distance is taken to first order,
        ``|phi| / |grad phi|``, which is exact on the front and for a signed distance, and the
        direction is that of the gradient.
    across : float
        The size across the front, on it.
    along : number, callable or ControlSpace
        The size along the front; it is asked for at the nearest point of a curve, or with a level
        set at the point itself.
    growth : float, optional
        Slope dh/dd, not negative.
    h_max : float, optional
        Neither size is larger. Needed where the gradient of a level set vanishes away from the
        front.
    gradient : callable, optional
        Of points (n, 2), returns the gradient (n, 2) of the level set.
    step : float, optional
        Without `gradient`, this is the step s of the central differences
        ``(phi(x + s) - phi(x - s)) / (2 s)``; a tenth of `across` if not given. The level set is
        asked for that far beyond the points.

    Raises
    ------
    MetricError
        Names the argument that is out of range; or, when evaluated, the point where the level set
        or its gradient is not finite, or where h_max is needed.
    """

    def __init__(
        self,
        front: Any,
        across: float,
        along: Metric,
        growth: float = 0.2,
        h_max: float = np.inf,
        *,
        gradient: Callable[[Floats], ArrayLike] | None = None,
        step: float | None = None,
    ) -> None:
        self.across = positive("across", across)
        self.along = as_control_space(along)
        self.slope = slope_of(growth, "linear")
        self.h_max = h_limit(h_max, "across", self.across)
        self.gradient = gradient
        self.step = positive("step", 0.1 * self.across if step is None else step)
        self.is_level_set = callable(front)
        if not self.is_level_set and (gradient is not None or step is not None):
            raise MetricError("gradient and step are for a level set, a front that is a function")
        self.front: Any = front if self.is_level_set else as_curves(front, "a front")

    def values(self, points: Floats) -> ArrayLike:
        front = self._of_level_set(points) if self.is_level_set else self._of_curves(points)
        flat = ~front.normals.any(axis=1)
        front.normals[flat] = (1, 0)
        along = size_along(self.along, front.places, front.normals)
        along[flat] = self.across  # no direction: both sizes are the smaller one
        return layer_metric(
            front.distances, front.normals, self.across, along, self.slope, self.h_max
        )

    def _of_curves(self, points: Floats) -> _Front:
        near = self.front.nearest(points)
        return _Front(near.distances, near.directions, near.points)

    def _of_level_set(self, points: Floats) -> _Front:
        phi = evaluate(self.front, points, (), "the level set")
        slopes = self._gradients(points)
        steepness = np.hypot(slopes[:, 0], slopes[:, 1])
        flat = steepness == 0
        lost = flat & (phi != 0)
        if self.h_max == np.inf and self.slope > 0 and lost.any():
            i = int(lost.argmax())
            x, y = points[i].tolist()
            raise MetricError(
                f"the gradient of the level set vanishes at point {i} ({x!r}, {y!r}), so that the "
                "distance is unknown: give h_max, the size there"
            )
        safe = np.where(flat, 1, steepness)
        normals = slopes / safe[:, None]
        far = self.h_max / self.slope if self.slope > 0 else 0.0  # where the size is h_max
        distances = np.where(lost, far, np.abs(phi) / safe)
        return _Front(distances, normals, points)

    def _gradients(self, points: Floats) -> Floats:
        if self.gradient is not None:
            return evaluate(self.gradient, points, (2,), "the gradient of the level set")
        shifts = self.step * np.array([[1.0, 0.0], [-1.0, 0.0], [0.0, 1.0], [0.0, -1.0]])
        around = (points + shifts[:, None]).reshape(-1, 2)
        right, left, up, down = evaluate(self.front, around, (), "the level set").reshape(4, -1)
        return np.stack([right - left, up - down], axis=1) / (2 * self.step)

    def __repr__(self) -> str:
        kind = "level set" if self.is_level_set else f"{len(self.front.segments)} segments"
        return (
            f"<Shock: {kind}, {self.across:g} + {self.slope:g} d across, {self.along!r} along, "
            f"at most {self.h_max:g}>"
        )
