"""Coordinates in reports: as many digits as tell a place from what is near it."""

from __future__ import annotations

import math
from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

USUAL, ALL = 5, 17
"""Digits that a coordinate has if nothing asks for more, and that a double has."""


def place_text(point: Sequence[float] | NDArray[np.float64], length: float) -> str:
    """The coordinates of a point, to a thousandth of a length that is found there.

    Far from the origin, as in metres of UTM, five digits would not tell the ends of an edge apart.
    """
    x, y = float(point[0]), float(point[1])
    digits = USUAL
    if 0 < length < math.inf and (largest := max(abs(x), abs(y))) > 0:
        digits = math.floor(math.log10(largest)) - math.floor(math.log10(length)) + 4
    digits = min(max(digits, USUAL), ALL)
    return f"({x:.{digits}g}, {y:.{digits}g})"
