"""Which vertices along a border are corners, and to what tolerance the rest of it is straight."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from adaptmesh.domain.data import CornersFound
from adaptmesh.errors import DomainError
from adaptmesh.types import Floats, Ints

from .bend_noise import DOUBTS, bend_noise
from .coordinate_digits import digits_of

EXACT = 1e-12
"""Vertices nearer than this share of the extent of a mesh to a straight line lie on it, anyway."""


@dataclass(frozen=True)
class Straightness:
    """How far off a straight line its vertices may be, and why."""

    tolerance: float
    why: str

    @classmethod
    def given(cls, tolerance: float) -> Straightness:
        """As the user says."""
        if not (isinstance(tolerance, (int, float, np.number)) and 0 <= tolerance < math.inf):
            raise DomainError(
                f"straight_tolerance: expected a distance, 0 or more, got {tolerance!r}"
            )
        return cls(float(tolerance), "straight_tolerance")

    @classmethod
    def exact(cls, points: Floats) -> Straightness:
        """Whatever the coordinates are."""
        return cls(EXACT * float(np.ptp(points, axis=0).max()), f"{EXACT:g} of the extent")

    @classmethod
    def of(cls, points: Floats, edges: Ints) -> Straightness:
        """By the digits of coordinates: a vertex is off by their error, and so is the line.

        Where vertices are off by more than digits explain, by how they are.
        """
        vector = np.diff(points[edges], axis=1)[:, 0]
        shortest = float(np.hypot(*vector.T).min())
        digits = digits_of(points, shortest)
        exact, found = cls.exact(points), cls(2 * digits.error, digits.why)
        noise = bend_noise(points, edges, exact.tolerance / 8, shortest)
        if noise is not None and noise > max(exact.tolerance / 4, 1.5 * digits.error):
            return cls(DOUBTS * noise, "neighbours off to either side, as rounding leaves them")
        return found if exact.tolerance < found.tolerance <= shortest else exact

    def found(self, corners: int, vertices: int) -> CornersFound:
        """What is told of the result."""
        return CornersFound(corners, vertices, self.tolerance, self.why)


def needed_corners(points: Floats, chain: list[int], is_ring: bool, tolerance: float) -> list[int]:
    """The vertices of a chain that a polyline within the tolerance needs (Douglas and Peucker).

    Its ends are among them, unless it is a ring that nothing else meets.
    """
    is_closed = chain[0] == chain[-1]
    if is_ring:  # open it at an extreme point, which is a corner
        chain = _opened(chain, min(chain[:-1], key=lambda v: tuple(points[v])))
    corners = _simplified(points, chain, tolerance)
    if is_ring and _is_straight(points, chain, corners, tolerance):
        # The end of a side that rounding has bent; it is no vertex between the ends that is
        # farthest from anywhere.
        middle = points[chain].mean(axis=0)
        far = max(chain[:-1], key=lambda v: math.dist(points[v], middle))
        corners = _simplified(points, _opened(chain, far), tolerance)
    if is_closed and len(corners) < 4:  # smaller than the tolerance
        return _simplified(points, chain, 0.0)
    return corners


def _opened(chain: list[int], start: int) -> list[int]:
    """A closed chain that begins and ends at one of its vertices."""
    ring = chain[:-1]
    k = ring.index(start)
    return [*ring[k:], *ring[: k + 1]]


def _is_straight(points: Floats, ring: list[int], corners: list[int], tolerance: float) -> bool:
    """Whether a ring is straight where it was opened, between the corners around that."""
    if len(corners) < 4:
        return False
    start, stop = corners[1], corners[-2]
    part = [*ring[ring.index(stop) : -1], *ring[: ring.index(start) + 1]]
    p = points[part]
    return bool((_distances(p[1:-1], p[0], p[-1]) <= tolerance).all())


def _simplified(points: Floats, chain: list[int], tolerance: float) -> list[int]:
    keep = {0, len(chain) - 1}
    p = points[chain]
    open_parts = [(0, len(chain) - 1)]
    while open_parts:
        i, j = open_parts.pop()
        if j - i < 2:
            continue
        distances = _distances(p[i + 1 : j], p[i], p[j])
        k = int(np.argmax(distances))
        if distances[k] > tolerance:
            keep.add(i + 1 + k)
            open_parts += [(i, i + 1 + k), (i + 1 + k, j)]
    return [chain[k] for k in sorted(keep)]


def _distances(p: Floats, a: Floats, b: Floats) -> Floats:
    """Distances of points from a segment, or from a point where it has no length."""
    d, w = b - a, p - a
    norm = float(np.hypot(*d))
    if norm == 0.0:
        return np.hypot(w[:, 0], w[:, 1])
    along = (w @ d) / norm
    beyond = np.maximum(np.maximum(-along, along - norm), 0.0)
    return np.hypot(np.abs(w[:, 0] * d[1] - w[:, 1] * d[0]) / norm, beyond)
