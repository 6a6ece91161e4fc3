"""Where things go in the picture.

::

    +-----------------------------+----------+
    | title, what is drawn                   |  header
    +-----------------------------+----------+
    |                             | colour   |
    |          the view           | scale,   |
    |                             | legend   |
    +-----------------------------+----------+

Graphics cards have seven digits. So everything is drawn in coordinates of the frame: the view is
centred at 0 and its longer side runs from -1 to 1, whatever the coordinates of the mesh are.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from adaptmesh.types import Floats

Bounds = tuple[float, float, float, float]

MOST_ELONGATED = 12.0  # a longer view is stretched, so that there is something to see
LONG_SIDE = 1000  # pixels of the view in a picture whose size is not given
SHORT_SIDE = 240


@dataclass(frozen=True)
class Frame:
    """The layout of one picture.

    Attributes
    ----------
    bounds : (x0, y0, x1, y1)
        What is seen, in the coordinates of the mesh.
    window : (int, int)
        Size of the picture in pixels.
    margin, header, key : float
        Width of the empty border, height of the header, width of the column of the key, in pixels.
    """

    bounds: Bounds
    window: tuple[int, int]
    margin: float
    header: float
    key: float

    @classmethod
    def of(
        cls, bounds: Bounds, window: tuple[int, int] | None, has_title: bool, has_key: bool
    ) -> Frame:
        """The layout for a view; without a size given the window takes the shape of the view."""
        margin = 24.0
        header, key = 66.0 if has_title else 46.0, 190.0 if has_key else 0.0
        if window is None:
            width, height = _stretched(bounds)[1]
            longer = max(width, height)
            sides = [max(LONG_SIDE * side / longer, SHORT_SIDE) for side in (width, height)]
            if has_key:
                sides[1] = max(sides[1], 420)
            window = (round(sides[0] + 2 * margin + key), round(sides[1] + 1.5 * margin + header))
        else:  # small pictures have small margins
            unit = float(np.clip(min(window[0] / 1000, window[1] / 700), 0.6, 1.0))
            margin, header, key = margin * unit, header * unit, key * unit
        return cls(bounds, window, margin, header, key)

    @property
    def unit(self) -> float:
        """How much smaller than usual text and lines are."""
        return self.margin / 24.0

    @cached_property
    def stretch(self) -> Floats:
        """By how much x and y are stretched; (1, 1) unless the view is very elongated."""
        return _stretched(self.bounds)[0]

    @cached_property
    def factor(self) -> Floats:
        """Frame units for each unit of x and of y."""
        return 2 * self.stretch / _stretched(self.bounds)[1].max()

    @cached_property
    def size(self) -> Floats:
        """Width and height of the view in frame units."""
        x0, y0, x1, y1 = self.bounds
        return np.array([x1 - x0, y1 - y0]) * self.factor

    @cached_property
    def pixel(self) -> float:
        """Pixels for each frame unit."""
        room = np.array(self.window) - [2 * self.margin + self.key, 1.5 * self.margin + self.header]
        return float((np.maximum(room, 1) / self.size).min())

    @cached_property
    def centre(self) -> tuple[float, float]:
        """The point of the frame that is in the middle of the window."""
        up = (self.header - 0.5 * self.margin) / 2
        return self.key / 2 / self.pixel, up / self.pixel

    @cached_property
    def view(self) -> tuple[float, float, float, float]:
        """The view in pixels of the window, (x0, y0, x1, y1)."""
        half = self.size * self.pixel / 2
        middle = np.array(self.window) / 2 - np.array(self.centre) * self.pixel
        (x0, y0), (x1, y1) = (middle - half).tolist(), (middle + half).tolist()
        return x0, y0, x1, y1

    @property
    def spill(self) -> float:
        """Pixels by which things at the border may reach out of the view."""
        return 0.75 * self.margin

    def place(self, points: Floats, height: float = 0.0) -> NDArray[np.float32]:
        """Points (n, 2) of the mesh as points (n, 3) of the frame, at a height above it."""
        x0, y0, x1, y1 = self.bounds
        middle = np.array([x0 + (x1 - x0) / 2, y0 + (y1 - y0) / 2])
        out = np.empty((len(points), 3), np.float32)
        out[:, :2] = (points - middle) * self.factor
        out[:, 2] = height
        return out


def _stretched(bounds: Bounds) -> tuple[Floats, Floats]:
    """How much each axis is stretched, and the sides of the view after that."""
    sides = np.array([bounds[2] - bounds[0], bounds[3] - bounds[1]])
    stretch = np.maximum(sides.max() / MOST_ELONGATED / sides, 1.0)
    return stretch, sides * stretch


def bounds_of(points: Floats) -> Bounds:
    """The box around points, never flat."""
    low, high = points.min(axis=0), points.max(axis=0)
    longest = float((high - low).max()) or float(np.abs(points).max()) or 1.0
    flat = high - low < 1e-12 * longest
    low, high = low - 0.05 * longest * flat, high + 0.05 * longest * flat
    return float(low[0]), float(low[1]), float(high[0]), float(high[1])
