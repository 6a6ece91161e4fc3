"""Unit ellipses of a metric: the points at distance one, {v : vᵀ M v = 1}."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from adaptmesh.types import Floats, Index

from .frame import Frame
from .paint import View

SIDES = 64
"""Number of sides of the polygon drawn for an ellipse."""

TRIES = 30
"""Number of candidate points per ellipse."""

GAP = 1.05
"""Minimum distance of neighbouring ellipses, as a factor on the distance at which they touch."""

MIN_RADIUS = 10.0
"""Median radius in pixels below which all ellipses are enlarged by one factor."""


@dataclass(frozen=True)
class Ellipses:
    """Unit ellipses of a metric, and the factor by which they are enlarged."""

    centres: Floats
    tensors: Floats
    enlargement: float

    @property
    def outlines(self) -> Floats:
        """Polygons (n, SIDES, 2) of the ellipses: v = L⁻ᵀ (cos, sin), with M = L Lᵀ."""
        angle = 2 * np.pi * np.arange(SIDES) / SIDES
        m11, m12, m22 = self.tensors.T
        l11 = np.sqrt(m11)
        l21 = m12 / l11
        l22 = np.sqrt(np.maximum(m22 - l21**2, 1e-14 * m22))
        y = np.sin(angle) / l22[:, None]
        x = (np.cos(angle) - l21[:, None] * y) / l11[:, None]
        return self.centres[:, None] + self.enlargement * np.stack([x, y], axis=2)


def choose_ellipses(points: Floats, tensors: Floats, max_count: int, frame: Frame) -> Ellipses:
    """Choose ellipses that do not touch and lie in the view, in the order of the points.

    Parameters
    ----------
    points : (n, 2) array of float
        Candidates for centres.
    tensors : (n, 3) array of float
        The metric there.
    max_count : int
    frame : Frame
    """
    pixels = frame.factor * frame.pixel
    det = tensors[:, 0] * tensors[:, 2] - tensors[:, 1] ** 2
    enlargement = _round_up(MIN_RADIUS / (float(np.median(det**-0.25)) * float(pixels.min())))
    halves = enlargement * np.sqrt(tensors[:, [2, 0]] / det[:, None])  # of the bounding boxes
    room = frame.overhang / pixels
    low, high = np.array(frame.bounds[:2]) - room, np.array(frame.bounds[2:]) + room
    fits = ((points - halves >= low) & (points + halves <= high)).all(axis=1)
    kept: list[int] = []
    for i in np.flatnonzero(fits) if fits.any() else range(len(points)):
        step, here = points[kept] - points[i], tensors[i : i + 1]
        apart = np.maximum(
            _norm(here, step) - GAP * enlargement * (1 + _max_radius(tensors[kept], here)),
            _norm(tensors[kept], step) - GAP * enlargement * (1 + _max_radius(here, tensors[kept])),
        )
        if (apart > 0).all():
            kept.append(int(i))
        if len(kept) == max_count:
            break
    return Ellipses(points[kept], tensors[kept], enlargement)


def sample_vertices(view: View, max_count: int) -> Index:
    """Sample vertices evenly over the view, as corners of triangles drawn with weight area."""
    random = np.random.default_rng(0)
    areas = np.abs(view.mesh.areas[view.numbers])
    chosen = random.choice(len(areas), TRIES * max_count, p=areas / areas.sum())
    vertices = view.triangles[chosen, random.integers(0, 3, len(chosen))]
    _, first = np.unique(vertices, return_index=True)
    return vertices[np.sort(first)]


def _norm(tensors: Floats, d: Floats) -> Floats:
    m11, m12, m22 = tensors.T
    x, y = d.T
    return np.sqrt(np.maximum(m11 * x * x + 2 * m12 * x * y + m22 * y * y, 1e-300))


def _max_radius(tensors: Floats, ruler: Floats) -> Floats:
    """Return the largest radius of ellipses in a metric R: √ of the larger eigenvalue of M⁻¹ R."""
    a11, a12, a22 = tensors.T
    b11, b12, b22 = ruler.T
    det = a11 * a22 - a12 * a12
    half = (a22 * b11 - 2 * a12 * b12 + a11 * b22) / det / 2
    both = (b11 * b22 - b12 * b12) / det
    return np.sqrt(half + np.sqrt(np.maximum(half * half - both, 0)))


def _round_up(factor: float) -> float:
    """Round a factor up to 1, 2, 5, 10, 20, ..."""
    if factor <= 1:
        return 1.0
    power = 10.0 ** np.floor(np.log10(factor))
    return float(next(power * k for k in (1, 2, 5, 10) if power * k >= factor * 0.999))
