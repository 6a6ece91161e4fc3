"""How exact coordinates are: the digits they were written with, or the type they were stored as.

Vertices on a straight border are off it by what rounding has done to them::

    double precision                        4 units in the last place of the largest coordinate
    stored as float32                       half a unit in the last of 24 bits
    written with 12 digits ("%.12g")        half a unit in the twelfth digit
    rounded to millimetres, then shifted    half a millimetre

Digits count if they are used: the last one is not zero for most of the values, as after rounding,
and as it is not for numbers that someone chose, such as 0.25 or 1200. A grid whose edges are few
units of the last digit was chosen, too. Each axis is looked at on its own.
"""

from __future__ import annotations

import math
from collections.abc import Iterator
from typing import NamedTuple

import numpy as np

from adaptmesh.types import Floats

EPS = float(np.finfo(float).eps)

DOUBLE = 4 * EPS
"""Error of a coordinate that was computed in double precision, as a share of the largest."""

MOST_DIGITS = 15
"""Every double has about 16; with no more than these it was rounded."""

NEARLY_WHOLE = 0.01
"""Multiples of a unit, computed with since, are off by less than this share of it."""

USED = {2: 0.25, 10: 0.7}
"""The last digit, of this base, is used if for so large a share of the values it is not zero."""

FEWEST_VALUES = 8
"""Fewer different values than these are no evidence."""

UNITS_OF_EDGE, UNITS_OF_EXTENT = 20, 1e5
"""Rounding is told from choice if the shortest edge is that many units, or the extent is."""

UNITS_OF_EDGE_32 = 2
"""All 24 bits of a float32 are hardly used by choice: shorter edges will do."""

SMALLEST = 1e-280
"""Of smaller coordinates digits are not looked for: units of theirs would underflow."""


class Digits(NamedTuple):
    """How far points may be off, and why, in words."""

    error: float
    why: str


class Look(NamedTuple):
    """Values as whole multiples of a unit, which may differ from value to value."""

    units: Floats
    base: int
    why: str
    units_of_edge: int = UNITS_OF_EDGE


def digits_of(points: Floats, shortest_edge: float) -> Digits:
    """How exact points (n, 2) are, whose shortest distance that matters is given."""
    extent = float(np.ptp(points, axis=0).max())
    found = [_of_axis(np.unique(np.abs(values)), shortest_edge, extent) for values in points.T]
    error = math.hypot(*(axis.error for axis in found))
    return Digits(error, max(found, key=lambda axis: axis.error).why)


def _of_axis(values: Floats, shortest_edge: float, extent: float) -> Digits:
    """How exact the magnitudes of coordinates are, ascending."""
    double = DOUBLE * float(values[-1])
    out = Digits(double, "double precision")
    values = values[values > 0]
    if len(values) < FEWEST_VALUES or values[0] < SMALLEST:
        return out
    for look in _looks(values, double):
        used = np.rint(values / look.units) % look.base != 0
        unit = float(look.units[used].max(initial=0.0))
        largest = max(shortest_edge / look.units_of_edge, extent / UNITS_OF_EXTENT)
        is_rounding = used.mean() >= USED[look.base] and unit <= largest
        if is_rounding and double + unit / 2 > out.error:
            out = Digits(double + unit / 2, look.why)
    return out


def _looks(values: Floats, double: float) -> Iterator[Look]:
    """What units the values are multiples of; those below twice the double precision are none."""
    same = np.ones_like(values)
    if values[-1] < np.finfo(np.float32).max:
        single = values.astype(np.float32)
        if (single == values).all():
            yield Look(np.spacing(single).astype(float), 2, "float32", UNITS_OF_EDGE_32)
    step = _binary_step(values)
    if step > 2 * double:
        yield Look(step * same, 2, f"multiples of {step:.3g}")
    places = _decimal_places(values, 2 * double)
    if places is not None:
        yield Look(10.0**-places * same, 10, f"{places} decimal places")
    for digits in range(1, MOST_DIGITS + 1):
        units = 10.0 ** (np.floor(np.log10(values)) + 1 - digits)
        if (np.abs(np.rint(values / units) * units - values) <= 2 * EPS * values).all():
            yield Look(units, 10, f"{digits} significant digits")
            return


def _binary_step(values: Floats) -> float:
    """The largest power of two that all values are multiples of."""
    mantissa, exponent = np.frexp(values)
    whole = np.ldexp(mantissa, 53).astype(np.int64)
    lowest = np.log2((whole & -whole).astype(float)).astype(np.int64) + exponent - 53
    return float(np.ldexp(1.0, int(lowest.min())))


def _decimal_places(values: Floats, smallest_unit: float) -> int | None:
    """The fewest decimal places that all values have, about, if there are few enough."""
    extent = float(np.ptp(values))
    first = int(np.ceil(-np.log10(extent)))
    for places in range(first, first + MOST_DIGITS + 1):
        unit = 10.0**-places
        if unit <= smallest_unit:
            return None
        if (np.abs(values / unit - np.rint(values / unit)) <= NEARLY_WHOLE).all():
            return places
    return None
