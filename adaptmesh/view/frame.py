"""The layout of a picture, and its coordinates.

::

    +-----------------------------+----------+
    | title, caption                         |  header
    +-----------------------------+----------+
    |                             | colour   |
    |          the view           | scale,   |
    |                             | legend   |
    +-----------------------------+----------+

Graphics cards compute with seven digits. So everything is drawn in frame coordinates: the view is
centred at 0 and its longer side is [-1, 1], whatever the coordinates of the mesh are.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from adaptmesh.types import Floats

Bounds = tuple[float, float, float, float]

MAX_ASPECT = 12.0  # aspect ratio beyond which the shorter side of the view is scaled up
LONG_SIDE = 1000  # pixels of the longer side of the view if no picture size is given
SHORT_SIDE = 240  # and the minimum for the shorter side


@dataclass(frozen=True)
class Frame:
    """The layout of one picture.

    Attributes
    ----------
    bounds : (x0, y0, x1, y1)
        The visible box, in the coordinates of the mesh.
    window : (int, int)
        Size of the picture in pixels.
    margin, header, legend : float
        Width of the empty border, height of the header, width of the legend column, in pixels.
    """

    bounds: Bounds
    window: tuple[int, int]
    margin: float
    header: float
    legend: float

    @classmethod
    def of(
        cls, bounds: Bounds, window: tuple[int, int] | None, has_title: bool, has_legend: bool
    ) -> Frame:
        """Make the layout of a view; by default the window takes the shape of the view."""
        margin = 24.0
        header, legend = 66.0 if has_title else 46.0, 190.0 if has_legend else 0.0
        if window is None:
            width, height = _scale_axes(bounds)[1]
            longer = max(width, height)
            sides = [max(LONG_SIDE * side / longer, SHORT_SIDE) for side in (width, height)]
            if has_legend:
                sides[1] = max(sides[1], 420)
            window = (
                round(sides[0] + 2 * margin + legend),
                round(sides[1] + 1.5 * margin + header),
            )
        else:  # small pictures have small margins
            unit = float(np.clip(min(window[0] / 1000, window[1] / 700), 0.6, 1.0))
            margin, header, legend = margin * unit, header * unit, legend * unit
        return cls(bounds, window, margin, header, legend)

    @property
    def unit(self) -> float:
        """Scale of text and lines: 1, less in small pictures."""
        return self.margin / 24.0

    @cached_property
    def axis_scale(self) -> Floats:
        """Scale factors of x and y: (1, 1) unless the view is very elongated."""
        return _scale_axes(self.bounds)[0]

    @cached_property
    def factor(self) -> Floats:
        """Frame units per unit of x and of y."""
        return 2 * self.axis_scale / _scale_axes(self.bounds)[1].max()

    @cached_property
    def size(self) -> Floats:
        """Width and height of the view in frame units."""
        x0, y0, x1, y1 = self.bounds
        return np.array([x1 - x0, y1 - y0]) * self.factor

    @cached_property
    def pixel(self) -> float:
        """Pixels per frame unit."""
        width = 2 * self.margin + self.legend
        height = 1.5 * self.margin + self.header
        room = np.array(self.window) - [width, height]
        return float((np.maximum(room, 1) / self.size).min())

    @cached_property
    def centre(self) -> tuple[float, float]:
        """The point of the frame at the centre of the window."""
        up = (self.header - 0.5 * self.margin) / 2
        return self.legend / 2 / self.pixel, up / self.pixel

    @cached_property
    def view(self) -> tuple[float, float, float, float]:
        """The view in pixels of the window, (x0, y0, x1, y1)."""
        half = self.size * self.pixel / 2
        middle = np.array(self.window) / 2 - np.array(self.centre) * self.pixel
        (x0, y0), (x1, y1) = (middle - half).tolist(), (middle + half).tolist()
        return x0, y0, x1, y1

    @property
    def overhang(self) -> float:
        """Pixels by which items at the border may extend beyond the view."""
        return 0.75 * self.margin

    def place(self, points: Floats, height: float = 0.0) -> NDArray[np.float32]:
        """Map points (n, 2) of the mesh to frame coordinates (n, 3) at a given height."""
        x0, y0, x1, y1 = self.bounds
        middle = np.array([x0 + (x1 - x0) / 2, y0 + (y1 - y0) / 2])
        out = np.empty((len(points), 3), np.float32)
        out[:, :2] = (points - middle) * self.factor
        out[:, 2] = height
        return out


def _scale_axes(bounds: Bounds) -> tuple[Floats, Floats]:
    """Return the scale factor of each axis, and the sides of the view after scaling."""
    sides = np.array([bounds[2] - bounds[0], bounds[3] - bounds[1]])
    scale = np.maximum(sides.max() / MAX_ASPECT / sides, 1.0)
    return scale, sides * scale


def bounding_box(points: Floats) -> Bounds:
    """Return the bounding box of points, enlarged if it has no width or height."""
    low, high = points.min(axis=0), points.max(axis=0)
    longest = float((high - low).max()) or float(np.abs(points).max()) or 1.0
    flat = high - low < 1e-12 * longest
    low, high = low - 0.05 * longest * flat, high + 0.05 * longest * flat
    return float(low[0]), float(low[1]), float(high[0]), float(high[1])
