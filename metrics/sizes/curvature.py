"""Sizes that follow the curvature of a boundary."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

import metrics._core as _core
from metrics.checks import as_points, h_limit, number, positive
from metrics.control import ControlSpace
from metrics.errors import MetricError
from metrics.types import Floats, Ints

from .geometry import Geometry, as_curves
from .growth import slope_of

__all__ = ["BoundaryCurvature", "sample"]


class BoundaryCurvature(ControlSpace):
    """Small where a curve is sharply bent, growing with the distance from there.

    With the curvature k at a vertex of the curve, the size there is ``sqrt(8 chord_error / k)``,
    the chord that is that far from its arc in the middle, or ``2 pi / (elements_per_circle k)``,
    or the smaller one; within [h_min, h_max], and linear between vertices. Anywhere it is the
    minimum of ``h(p) + growth |x - p|`` over all points p of the curve: continuous, and nowhere
    steeper than growth.

    Parameters
    ----------
    curve : Geometry, what it takes, or callable
        Curves as polylines, polygons, a shapely geometry, or an `adaptmesh.Domain`; or a function
        of parameters t (n,) that returns points (n, 2) and is sampled.
    chord_error : float, optional
        The largest distance between a chord and its arc, in the units of the coordinates.
    elements_per_circle : float, optional
        How many edges a full circle of the same radius would get.
    h_min, h_max : float, optional
        Bounds of the size. h_max is needed where all is straight.
    growth : float, optional
        Slope dh/dd, positive.
    corner_angle : float, optional
        In degrees: a vertex where the curve turns by more is a corner, and not curvature.
    interval : (float, float), optional
        For a function: the first and the last parameter.
    samples : int, optional
        For a function: how many points it is sampled at, evenly in t.

    Raises
    ------
    MetricError
        Names the argument that is missing or out of range, or what is wrong with the curve.

    Notes
    -----
    The curvature at a vertex is 1/R of the circle through it and its two neighbours (Menger
    curvature), exact for points on a circle however they are spaced. At ends, at corners and where
    more than two segments meet, each segment has the size of its other end.

    The chord formula is the limit for a chord_error well below the radius; where there may be
    smaller circles than that, give elements_per_circle too.

    Examples
    --------
    >>> import numpy as np
    >>> from metrics import BoundaryCurvature, tensor
    >>> t = np.linspace(0, 2 * np.pi, 201)
    >>> circle = np.stack([2 * np.cos(t), 2 * np.sin(t)], axis=1)
    >>> field = BoundaryCurvature(circle, elements_per_circle=40)
    >>> np.round(tensor.sizes(field([[2.0, 0.0]])), 6)
    array([[0.314159, 0.314159]])
    """

    def __init__(
        self,
        curve: Any,
        chord_error: float | None = None,
        elements_per_circle: float | None = None,
        h_min: float = 0.0,
        h_max: float = np.inf,
        growth: float = 0.2,
        *,
        corner_angle: float = 40.0,
        interval: tuple[float, float] = (0.0, 1.0),
        samples: int = 1000,
    ) -> None:
        if chord_error is None and elements_per_circle is None:
            raise MetricError("give chord_error, elements_per_circle, or both")
        self.chord_error = None if chord_error is None else positive("chord_error", chord_error)
        self.elements_per_circle = (
            None
            if elements_per_circle is None
            else number("elements_per_circle", elements_per_circle, minimum=3)
        )
        self.h_min = number("h_min", h_min, minimum=0)
        self.h_max = h_limit(h_max, "h_min", self.h_min)
        self.growth = positive("growth", slope_of(growth, "linear"))
        self.corner_angle = number("corner_angle", corner_angle, minimum=0)
        given = sample(curve, interval, samples) if callable(curve) else curve
        self.curve = as_curves(given, "a curve")
        self.sizes = self._sizes()
        self._build()

    def _sizes(self) -> Floats:
        """Finite sizes at both ends of each segment, (k, 2)."""
        _, numbers = self.curve.vertices()
        curvatures = _curvatures(self.curve, np.cos(np.radians(self.corner_angle)))
        unknown = np.isnan(curvatures[numbers])
        sizes = self._size_of(curvatures)[numbers]
        sizes = np.where(unknown & ~unknown[:, ::-1], sizes[:, ::-1], sizes)
        sizes[unknown.all(axis=1)] = np.inf
        sizes = np.clip(sizes, self.h_min, self.h_max)
        smallest = sizes.min()
        if smallest == np.inf:
            raise MetricError("the curve is straight, its curvature asks for no size: give h_max")
        if smallest == 0:
            raise MetricError("the curve is bent infinitely sharply: give h_min")
        # What the smallest size allows at the other end of the curve; no size above it matters.
        extent = np.ptp(self.curve.segments.reshape(-1, 2), axis=0)
        capped: Floats = np.minimum(sizes, smallest + self.growth * np.hypot(*extent))
        return np.ascontiguousarray(capped)

    def _size_of(self, curvatures: Floats) -> Floats:
        sizes = np.full(len(curvatures), np.inf)
        with np.errstate(divide="ignore"):
            if self.chord_error is not None:
                sizes = np.sqrt(8 * self.chord_error / curvatures)
            if self.elements_per_circle is not None:
                each = 2 * np.pi / (self.elements_per_circle * curvatures)
                sizes = np.minimum(sizes, each)
        return sizes

    def _build(self) -> None:
        segments = _core.Segments(self.curve.segments.reshape(-1, 4))
        self._spreading = _core.Spreading(segments, self.sizes, self.growth)

    def __getstate__(self) -> dict[str, Any]:
        return {name: value for name, value in vars(self).items() if name != "_spreading"}

    def __setstate__(self, state: dict[str, Any]) -> None:
        vars(self).update(state)
        self._build()

    def values(self, points: Floats) -> ArrayLike:
        return np.minimum(self._spreading.at(points), self.h_max)

    def __repr__(self) -> str:
        return (
            f"<BoundaryCurvature: h = {self.sizes.min():.3g} ... {self.sizes.max():.3g} on the "
            f"curve, growing by {self.growth:g}>"
        )


def sample(
    curve: Callable[[Floats], ArrayLike], interval: tuple[float, float], samples: int
) -> Floats:
    """Points (samples, 2) of a parametric curve, evenly spaced in the parameter."""
    count = int(number("samples", samples, minimum=3))
    first, last = (number("interval", end) for end in interval)
    points = as_points(curve(np.linspace(first, last, count)))
    if len(points) != count:
        raise MetricError(
            f"the curve must return a point for each parameter: {count} are asked for, "
            f"{len(points)} came"
        )
    return points


def _curvatures(curve: Geometry, min_cosine: float) -> Floats:
    """Curvatures (v,) at the vertices of a curve; NaN at ends, branches and corners.

    With the neighbours a and b of a vertex v, 1/R = 2 |(v - a) x (b - v)| / (|va| |vb| |ab|).
    """
    vertices, numbers = curve.vertices()
    before, after, smooth = _neighbours(numbers, len(vertices))
    u = vertices[smooth] - vertices[before[smooth]]
    w = vertices[after[smooth]] - vertices[smooth]
    cross = u[:, 0] * w[:, 1] - u[:, 1] * w[:, 0]
    lengths = np.hypot(*u.T) * np.hypot(*w.T)
    chord = np.hypot(*(u + w).T)
    is_corner = (u * w).sum(axis=1) < min_cosine * lengths
    out = np.full(len(vertices), np.nan)
    safe = np.where(is_corner, 1, lengths * chord)
    out[smooth] = np.where(is_corner, np.nan, 2 * np.abs(cross) / safe)
    return out


def _neighbours(numbers: Ints, count: int) -> tuple[Ints, Ints, Ints]:
    """For each of the vertices that two segments meet at: the other ends of these.

    Returns the two neighbours of all vertices (v,), and the numbers of the vertices for which
    they mean something.
    """
    edges = np.unique(np.sort(numbers, axis=1), axis=0)  # a border that two polygons share: once
    start = np.concatenate([edges[:, 0], edges[:, 1]])
    end = np.concatenate([edges[:, 1], edges[:, 0]])
    order = np.argsort(start, kind="stable")
    first = np.searchsorted(start[order], np.arange(count))
    last = np.searchsorted(start[order], np.arange(count), side="right")
    partners = end[order]
    two = np.flatnonzero(last - first == 2)
    return partners[first], partners[last - 1], two.astype(np.int32)
