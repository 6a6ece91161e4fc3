"""What the meshers are compared on: domains with metrics known by formula.

A case gives a metric for one level of detail; a problem is a case at the level that asks for a
given number of triangles, by multiplying the metric by one factor. Curved boundaries are polygons,
with sides about two units long at that level, so that everybody meshes the same domain.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from functools import cached_property, lru_cache

import numpy as np

import adaptmesh as am
import metrics

COMPLEXITY_ACCURACY = 1e-3


def isotropic(size):
    """Sizes (n,) as packed metrics (n, 3)."""
    density = size**-2.0
    return np.stack([density, np.zeros_like(density), density], axis=1)


def stretched(nx, ny, across, along):
    """Packed metrics with the size `across` in the unit direction (nx, ny), `along` sideways."""
    a, b = across**-2.0, along**-2.0
    return np.stack([a * nx**2 + b * ny**2, (a - b) * nx * ny, a * ny**2 + b * nx**2], axis=1)


def polygon_of_units(curve, metric, least):
    """Points on a closed curve [0, 1) -> plane, two metric units apart, or `least` of them."""
    t = np.linspace(0, 1, 20_001)
    fine = curve(t)
    step = np.diff(fine, axis=0)
    m = metric(0.5 * (fine[1:] + fine[:-1]))
    dx, dy = step.T
    length = np.sqrt(m[:, 0] * dx**2 + 2 * m[:, 1] * dx * dy + m[:, 2] * dy**2)
    count = int(np.ceil(length.sum() / 2))
    if count < least:
        count, length = least, np.hypot(dx, dy)
    along = np.concatenate([[0], np.cumsum(length)])
    return curve(np.interp(np.arange(count) / count * along[-1], along, t))


def circle(x, y, radius):
    def curve(t):
        angle = 2 * np.pi * t
        return np.stack([x + radius * np.cos(angle), y + radius * np.sin(angle)], axis=1)

    return curve


@dataclass(frozen=True)
class Case:
    """A metric, and the domain it asks for; for functions, the function whose error counts.

    Attributes
    ----------
    name, about : str
    metric : callable
        Points (n, 2) to packed metrics (n, 3), at the level of factor one.
    domain : callable
        From the metric, which says how fine curves are to be, to a Domain.
    is_isotropic : bool
        Whether meshers that know only sizes can take part.
    function : callable, optional
        Points (n, 2) to values (n,).
    """

    name: str
    about: str
    metric: Callable
    domain: Callable
    is_isotropic: bool = False
    function: Callable | None = None


@dataclass(frozen=True)
class Problem:
    """A case at the level that asks for `target` triangles."""

    case: Case
    target: int

    @cached_property
    def factor(self):
        return self.target * np.sqrt(3) / 4 / complexity(self.case.name)

    def metric(self, points):
        return self.factor * self.case.metric(points)

    def sizes(self, points):
        """One size for each point, that of the same density."""
        m = self.metric(points)
        return (m[:, 0] * m[:, 2] - m[:, 1] ** 2) ** -0.25

    @cached_property
    def domain(self):
        return self.case.domain(self.metric)

    @property
    def diameter(self):
        return float(np.ptp(self.domain.points, axis=0).max())


@lru_cache
def complexity(name):
    """The complexity of a case at factor one; (4 / sqrt 3) times it is its number of triangles."""
    case = CASES[name]
    domain = case.domain(case.metric)
    result = metrics.complexity(
        domain.points,
        domain.triangles,
        case.metric,
        rtol=COMPLEXITY_ACCURACY,
        max_evaluations=3_000_000,
    )
    return result.value


def _rectangle(*corners):
    return lambda metric: am.Domain.rectangle(*corners)


def _radius(x):
    return np.hypot(x[:, 0], x[:, 1])


# ------------------------------------------------------------------ sizes


def _uniform(x):
    return isotropic(np.full(len(x), 0.05))


def _radial(x):
    return isotropic(0.002 + 0.1 * _radius(x))


def _jump(x):
    inside = np.hypot(x[:, 0] - 0.45, x[:, 1] - 0.55) < 0.2
    return isotropic(np.where(inside, 0.002, 0.1))


def _aerofoil_contour(t):
    """NACA 0012 with a sharp trailing edge, from there over the upper side and back below."""
    x = 0.5 * (1 + np.cos(2 * np.pi * t))
    root = np.sqrt(x)
    half = 0.6 * (0.2969 * root + x * (-0.1260 + x * (-0.3516 + x * (0.2843 - 0.1036 * x))))
    return np.stack([x, np.where(t <= 0.5, half, -half)], axis=1)


def _aerofoil(x):
    to_nose, to_tail = _radius(x), np.hypot(x[:, 0] - 1, x[:, 1])
    to_chord = np.hypot(x[:, 0] - np.clip(x[:, 0], 0, 1), x[:, 1])
    near = np.minimum(5e-4 + 0.2 * to_nose, 5e-4 + 0.2 * to_tail)
    return isotropic(np.minimum(np.minimum(near, 0.01 + 0.2 * to_chord), 5.0))


def _aerofoil_domain(metric):
    far = polygon_of_units(circle(0.5, 0, 30.0), metric, least=32)
    upper = polygon_of_units(lambda t: _aerofoil_contour(0.5 * t), metric, least=32)
    lower = upper[:0:-1] * [1, -1]  # mirrored, without the tail
    nose = np.zeros((1, 2))
    return am.Domain.polygon(far, [np.concatenate([upper, nose, lower])])


# ------------------------------------------------------------------ tensors


def _wall(x):
    across = np.minimum(1e-4 + 0.15 * np.maximum(x[:, 1], 0), 0.1)
    return stretched(np.zeros(len(x)), np.ones(len(x)), across, np.full(len(x), 0.1))


def _wave(x):
    """Height above the wave y = 1/2 + sin(2 pi x)/5, and its gradient."""
    k = 2 * np.pi
    height = x[:, 1] - 0.5 - 0.2 * np.sin(k * x[:, 0])
    return height, -0.2 * k * np.cos(k * x[:, 0]), np.ones(len(x))


def _shock(x):
    height, gx, gy = _wave(x)
    slope = np.hypot(gx, gy)
    across = np.minimum(0.002 + 0.4 * np.abs(height) / slope, 0.08)
    return stretched(gx / slope, gy / slope, across, np.full(len(x), 0.08))


def _outwards(x):
    """Distance from the origin, and the direction away from it; any direction at the origin."""
    r = _radius(x)
    at_origin = r < 1e-12
    safe = np.where(at_origin, 1.0, r)
    return r, np.where(at_origin, 1.0, x[:, 0] / safe), np.where(at_origin, 0.0, x[:, 1] / safe)


def _ring(x):
    """polar-1 of the Unstructured Grid Adaptation Working Group."""
    r, nx, ny = _outwards(x)
    return stretched(nx, ny, 1e-3 + 0.198 * np.abs(r - 0.5), np.full(len(x), 0.1))


HOLES = ((0.8, 1.3, 0.30), (2.0, 0.6, 0.25), (3.2, 1.4, 0.35))


def _plate(x):
    """Layers around the holes, each ruled by the nearest."""
    layers = [(_outwards(x - [cx, cy]), radius) for cx, cy, radius in HOLES]
    distance = np.stack([np.abs(r - radius) for (r, _, _), radius in layers])
    nearest = distance.argmin(axis=0)
    each = np.arange(len(x))
    nx = np.stack([out[1] for out, _ in layers])[nearest, each]
    ny = np.stack([out[2] for out, _ in layers])[nearest, each]
    d = distance[nearest, each]
    return stretched(nx, ny, np.minimum(0.006 + 0.3 * d, 0.15), np.minimum(0.06 + 0.2 * d, 0.15))


def _interface(t):
    return np.stack([1.35 + 0.12 * np.sin(2 * np.pi * t), 2 * t], axis=1)


def _plate_domain(metric):
    """A plate with three holes, and a wavy line from side to side between two materials."""
    outer = [(0, 0), (1.35, 0), (4, 0), (4, 2), (1.35, 2), (0, 2)]
    wave = polygon_of_units(_interface, metric, least=16)[1:]
    rings = [polygon_of_units(circle(*hole), metric, least=32) for hole in HOLES]
    chain = [1, *range(6, 6 + len(wave)), 4]
    points, segments = [np.array(outer), wave], [np.stack([range(6), np.roll(range(6), -1)], 1)]
    segments.append(np.stack([chain[:-1], chain[1:]], axis=1))
    n = 6 + len(wave)
    for ring in rings:
        number = n + np.arange(len(ring))
        points.append(ring)
        segments.append(np.stack([number, np.roll(number, -1)], axis=1))
        n += len(ring)
    return am.Domain(
        np.concatenate(points),
        np.concatenate(segments),
        holes=[hole[:2] for hole in HOLES],
        regions={"left": (0.1, 0.1), "right": (3.9, 0.1)},
    )


# ------------------------------------------------------------------ functions


def _least_error(hessian, floor):
    """The metric of least L2 error of linear interpolation, det |H|^(-1/6) |H|, up to a factor.

    Loseille and Alauzet: Continuous mesh framework, part I. SIAM J. Numer. Anal. 49 (2011).
    """
    a, b, c = hessian.T
    mean, spread = 0.5 * (a + c), np.hypot(0.5 * (a - c), b)
    angle = 0.5 * np.arctan2(2 * b, a - c)  # of the axis of the larger eigenvalue
    larger = np.maximum(np.abs(mean + spread), floor)
    smaller = np.maximum(np.abs(mean - spread), floor)
    size = (larger * smaller) ** (1 / 12)
    return stretched(np.cos(angle), np.sin(angle), size * larger**-0.5, size * smaller**-0.5)


def _hessian_of_tanh(steepness, phi, gx, gy, second):
    """Second derivatives of tanh(steepness phi), by the chain rule."""
    t = np.tanh(steepness * phi)
    p = steepness * (1 - t * t)
    q = -2 * steepness * t * p
    return np.stack(
        [p * second[0] + q * gx * gx, p * second[1] + q * gx * gy, p * second[2] + q * gy * gy], 1
    )


def _front(x):
    return np.tanh(60 * _wave(x)[0])


def _front_metric(x):
    second = 0.2 * (2 * np.pi) ** 2 * np.sin(2 * np.pi * x[:, 0]), 0.0, 0.0
    return _least_error(_hessian_of_tanh(60, *_wave(x), second), floor=0.3)


def _rim(x):
    return np.tanh(100 * (_radius(x) - 0.6))


def _rim_metric(x):
    r, nx, ny = _outwards(x)
    r = np.maximum(r, 1e-12)
    second = ny * ny / r, -nx * ny / r, nx * nx / r
    return _least_error(_hessian_of_tanh(100, r - 0.6, nx, ny, second), floor=0.3)


_UNIT_SQUARE = _rectangle(0, 0, 1, 1)

CASES = {
    case.name: case
    for case in (
        Case("uniform", "one size", _uniform, _UNIT_SQUARE, True),
        Case("radial", "sizes 1 : 70, from a point", _radial, _rectangle(-1, -1, 1, 1), True),
        Case("jump", "sizes 1 : 50 across a circle", _jump, _UNIT_SQUARE, True),
        Case("aerofoil", "far field, sizes 1 : 10 000", _aerofoil, _aerofoil_domain, True),
        Case("wall", "layer on a wall, 1000 : 1", _wall, _rectangle(0, 0, 2, 1)),
        Case("shock", "sinusoidal, 40 : 1", _shock, _UNIT_SQUARE),
        Case("ring", "circular, 100 : 1 (polar-1)", _ring, _UNIT_SQUARE),
        Case("plate", "holes, layers, an interface", _plate, _plate_domain),
        Case("front", "tanh 60 (y - wave(x))", _front_metric, _UNIT_SQUARE, False, _front),
        Case("rim", "tanh 100 (r - 0.6)", _rim_metric, _UNIT_SQUARE, False, _rim),
    )
}
