"""Oracles of the geometric predicates: the textbook determinants, without rounding.

Written for integers and fractions alike, scalars or object arrays of them. They take the three by
three determinant where the core takes another form, so as to share nothing with it.
"""

from __future__ import annotations

from fractions import Fraction
from typing import Any

import numpy as np
from numpy.typing import NDArray


def orient2d(a: Any, b: Any, c: Any) -> Any:
    """The determinant whose sign is the orientation of abc; points are pairs (x, y)."""
    return (a[0] - c[0]) * (b[1] - c[1]) - (a[1] - c[1]) * (b[0] - c[0])


def incircle(a: Any, b: Any, c: Any, d: Any) -> Any:
    """The determinant that is positive if d is in the circle of the counter-clockwise abc."""
    (ax, ay), (bx, by), (cx, cy) = [(p[0] - d[0], p[1] - d[1]) for p in (a, b, c)]
    return (
        (ax * ax + ay * ay) * (bx * cy - by * cx)
        + (bx * bx + by * by) * (cx * ay - cy * ax)
        + (cx * cx + cy * cy) * (ax * by - ay * bx)
    )


def as_fractions(points: NDArray[np.float64]) -> NDArray[Any]:
    """The same array, of Fraction."""
    return np.vectorize(Fraction, otypes=[object])(points)


def as_integers(points: NDArray[np.float64]) -> NDArray[Any]:
    """The same array, of int, after multiplying each case by a power of two; much faster.

    ``points`` is (points of a case, coordinate, case); signs of determinants are kept.
    """
    mantissa, exponent = np.frexp(points)
    lowest = np.where(points == 0, np.iinfo(exponent.dtype).max, exponent).min(axis=(0, 1))
    integers = (mantissa * 2.0**53).astype(np.int64).astype(object)
    return integers << np.where(points == 0, 0, exponent - lowest).astype(object)


def sign(values: NDArray[Any]) -> NDArray[np.int8]:
    """-1, 0 or 1 for each."""
    return (values > 0).astype(np.int8) - (values < 0).astype(np.int8)
