"""Colours and colour scales, distinguishable for the colour-blind."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from adaptmesh.types import Floats

Bytes = NDArray[np.uint8]

INK = "#22303c"  # text, unnamed boundaries
FADED = "#6b7885"  # secondary text
PAPER = "#ffffff"
FACE = "#e9eef2"  # triangles that show no value
EDGE = "#4a5a68"  # edges that show no value
ELLIPSE = "#7a3b8f"

# Edge lengths: short edges are blue, unit edges grey, long edges red.
SHORT = ("#0b2a5b", "#1f5fae", "#6aa5dc")
UNIT = ("#a9b8ae", "#94aa9b", "#a9b8ae")
LONG = ("#f0995b", "#d1492e", "#7a1010")

# Qualities from 0 (red) to 1 (grey blue).
QUALITY = ("#6d0f1a", "#b5352f", "#e27d4e", "#f3c27f", "#e8e6c8", "#bcd5d3", "#86b3c4")
SIZES = ("#123a5e", "#1f6b8a", "#4ba3a3", "#a5cfa4", "#eceac2")
FIELD = "viridis"
NO_VALUE = "#b3b3b3"  # NaN; not on any scale

REGIONS = (
    "#cfe0ee", "#f6dcc0", "#d4e8cf", "#e9d3e6", "#f5edbb", "#cfe8e6",
    "#f3cfd0", "#dcd6ee", "#e3dccb", "#c7d3da",
)  # fmt: skip
NAMES = (
    "#0072b2", "#d55e00", "#009e73", "#b8428f", "#c99a00", "#3f9fd8",
    "#8c2d19", "#5b4ba0", "#5c7f1f", "#7f6a55",
)  # fmt: skip


def rgb(colour: str) -> Bytes:
    """Return the bytes of ``#rrggbb``."""
    return np.frombuffer(bytes.fromhex(colour[1:]), np.uint8)


def make_ramp(colours: Sequence[str], steps: int = 256) -> Bytes:
    """Interpolate between equally spaced colours: a table (steps, 3)."""
    anchors = np.array([rgb(colour) for colour in colours], float)
    at = np.linspace(0, len(anchors) - 1, steps)
    channels = [np.interp(at, np.arange(len(anchors)), anchors[:, k]) for k in range(3)]
    return np.stack(channels, axis=1).round().astype(np.uint8)


@dataclass(frozen=True)
class Scale:
    """A map of numbers to colours; values outside [low, high] get the colours of the ends.

    NaN gets the colour `NO_VALUE`.

    Attributes
    ----------
    label : str
        Name of the quantity.
    table : (k, 3) array of uint8
    low, high : float
    logarithmic : bool
    ticks : tuple of float
    band : (float, float, str), optional
        A range to be marked beside the scale, and its name.
    """

    label: str
    table: Bytes
    low: float
    high: float
    logarithmic: bool = False
    ticks: tuple[float, ...] = ()
    band: tuple[float, float, str] | None = None

    def share(self, values: NDArray[np.floating] | float) -> Floats:
        """Return the positions of values on the scale, from 0 to 1."""
        v = np.asarray(values, float)
        low, high = self.low, self.high
        if self.logarithmic:
            v, low, high = np.log(np.maximum(v, 1e-300)), np.log(low), np.log(high)
        return np.clip(np.nan_to_num((v - low) / (high - low)), 0, 1)

    def __call__(self, values: Floats) -> Bytes:
        """Return the colours of values, (n, 3)."""
        steps = len(self.table)
        out: Bytes = self.table[np.minimum(self.share(values) * steps, steps - 1).astype(int)]
        out[np.isnan(values)] = rgb(NO_VALUE)
        return out


def make_length_scale(cmap: str | None) -> Scale:
    """Make the logarithmic scale of metric lengths from 1/4 to 4, unit edges in the middle."""
    table = np.concatenate([make_ramp(SHORT, 96), make_ramp(UNIT, 64), make_ramp(LONG, 96)])
    return Scale(
        "metric edge length",
        table if cmap is None else load_colour_map(cmap),
        0.25,
        4.0,
        logarithmic=True,
        ticks=(0.25, 0.5, 2**-0.5, 1, 2**0.5, 2, 4),
        band=(2**-0.5, 2**0.5, "unit"),
    )


def make_quality_scale(label: str, cmap: str | None) -> Scale:
    """Make the scale of qualities from 0 to 1."""
    table = make_ramp(QUALITY) if cmap is None else load_colour_map(cmap)
    return Scale(label, table, 0.0, 1.0, ticks=(0, 0.2, 0.4, 0.6, 0.8, 1))


def make_size_scale(sizes: Floats, cmap: str | None) -> Scale:
    """Make a logarithmic scale from the smallest to the largest size."""
    low, high = float(sizes.min()), float(sizes.max())
    table = make_ramp(SIZES) if cmap is None else load_colour_map(cmap)
    if high < 1.05 * low:
        low, high = low / 1.05, high * 1.05
    return Scale("size", table, low, high, True, tuple(np.geomspace(low, high, 5).tolist()))


def make_field_scale(values: Floats, cmap: str | None) -> Scale:
    """Make a linear scale from the smallest to the largest value."""
    finite = values[np.isfinite(values)]
    low, high = (float(finite.min()), float(finite.max())) if len(finite) else (0.0, 1.0)
    if not low < high:
        low, high = low - 0.5, high + 0.5
    ticks = tuple(np.linspace(low, high, 6).tolist())
    return Scale("value", load_colour_map(cmap or FIELD), low, high, ticks=ticks)


def load_colour_map(cmap: str) -> Bytes:
    """Return the table of a colour map of pyvista."""
    import pyvista as pv

    return np.asarray(pv.LookupTable(cmap, n_values=256).values)[:, :3]
