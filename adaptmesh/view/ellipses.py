"""The metric as ellipses: the points at distance one, {v : vᵀ M v = 1}."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from adaptmesh.types import Floats, Index

from .frame import Frame
from .paint import View

SIDES = 64  # of the polygon that is drawn
TRIES = 30  # places looked at for each ellipse
GAP = 1.05  # between neighbours
SMALLEST = 10.0  # pixels; smaller ellipses are enlarged, all by the same factor


@dataclass(frozen=True)
class Ellipses:
    """Some ellipses of a metric, and how much larger than life they are."""

    centres: Floats
    tensors: Floats
    enlarged: float

    @property
    def outlines(self) -> Floats:
        """Their polygons, (n, SIDES, 2): v = L⁻ᵀ (cos, sin), with M = L Lᵀ."""
        angle = 2 * np.pi * np.arange(SIDES) / SIDES
        m11, m12, m22 = self.tensors.T
        l11 = np.sqrt(m11)
        l21 = m12 / l11
        l22 = np.sqrt(np.maximum(m22 - l21**2, 1e-14 * m22))
        y = np.sin(angle) / l22[:, None]
        x = (np.cos(angle) - l21[:, None] * y) / l11[:, None]
        return self.centres[:, None] + self.enlarged * np.stack([x, y], axis=2)


def choose(places: Floats, tensors: Floats, most: int, frame: Frame) -> Ellipses:
    """Ellipses that do not touch and stay in the view, taken from candidates in their order.

    Parameters
    ----------
    places : (n, 2) array of float
    tensors : (n, 3) array of float
    most : int
    frame : Frame
    """
    pixels = frame.factor * frame.pixel
    det = tensors[:, 0] * tensors[:, 2] - tensors[:, 1] ** 2
    enlarged = _nice(SMALLEST / (float(np.median(det**-0.25)) * float(pixels.min())))
    halves = enlarged * np.sqrt(tensors[:, [2, 0]] / det[:, None])  # of the boxes around them
    room = frame.spill / pixels
    low, high = np.array(frame.bounds[:2]) - room, np.array(frame.bounds[2:]) + room
    fits = ((places - halves >= low) & (places + halves <= high)).all(axis=1)
    kept: list[int] = []
    for i in np.flatnonzero(fits) if fits.any() else range(len(places)):
        step, here = places[kept] - places[i], tensors[i : i + 1]
        apart = np.maximum(
            _norm(here, step) - GAP * enlarged * (1 + _reach(tensors[kept], here)),
            _norm(tensors[kept], step) - GAP * enlarged * (1 + _reach(here, tensors[kept])),
        )
        if (apart > 0).all():
            kept.append(int(i))
        if len(kept) == most:
            break
    return Ellipses(places[kept], tensors[kept], enlarged)


def candidates(view: View, most: int) -> Index:
    """Points spread evenly over the view: corners of triangles that are drawn by their area."""
    random = np.random.default_rng(0)
    areas = np.abs(view.mesh.areas[view.numbers])
    chosen = random.choice(len(areas), TRIES * most, p=areas / areas.sum())
    vertices = view.triangles[chosen, random.integers(0, 3, len(chosen))]
    _, first = np.unique(vertices, return_index=True)
    return vertices[np.sort(first)]


def _norm(tensors: Floats, d: Floats) -> Floats:
    m11, m12, m22 = tensors.T
    x, y = d.T
    return np.sqrt(np.maximum(m11 * x * x + 2 * m12 * x * y + m22 * y * y, 1e-300))


def _reach(tensors: Floats, ruler: Floats) -> Floats:
    """The longest radius of ellipses in another metric: √ of the larger eigenvalue of M⁻¹ R."""
    a11, a12, a22 = tensors.T
    b11, b12, b22 = ruler.T
    det = a11 * a22 - a12 * a12
    half = (a22 * b11 - 2 * a12 * b12 + a11 * b22) / det / 2
    both = (b11 * b22 - b12 * b12) / det
    return np.sqrt(half + np.sqrt(np.maximum(half * half - both, 0)))


def _nice(factor: float) -> float:
    """1, 2, 5, 10, ... not less than a factor."""
    if factor <= 1:
        return 1.0
    power = 10.0 ** np.floor(np.log10(factor))
    return float(next(power * k for k in (1, 2, 5, 10) if power * k >= factor * 0.999))
