"""Rows of different lengths, one after the other in one array."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from .types import Array, Floats, Index


def offsets(counts: Index) -> NDArray[np.intp]:
    """Where each of n rows begins, and where the last one ends, (n + 1,)."""
    return np.concatenate([[0], np.cumsum(counts)]).astype(np.intp)


def owners(counts: Index) -> NDArray[np.intp]:
    """The row of each item."""
    return np.repeat(np.arange(len(counts)), counts)


def ranges(starts: Index, counts: Index) -> NDArray[np.intp]:
    """The numbers from each start on, so many each: [3, 4, 5, 9] for starts 3, 9, counts 3, 1."""
    first = offsets(counts)
    return np.arange(first[-1]) + np.repeat(starts - first[:-1], counts)


def split(items: Array, counts: Index) -> list[Array]:
    """The rows as arrays of their own."""
    return np.split(items, offsets(counts)[1:-1]) if len(counts) else []


def starts_of_pairs(owner: Index) -> NDArray[np.intp]:
    """The items, (k,), that the next item follows in the same row; owners are ascending."""
    return np.flatnonzero(owner[1:] == owner[:-1])


def equal_parts(intervals: Floats, parts: Index) -> Floats:
    """Intervals (k, 2) divided into equal parts, so many each; ends that meet are one number."""
    k, n = ranges(np.zeros(len(parts), np.intp), parts), np.repeat(parts, parts)
    low, high = (np.repeat(intervals[:, i], parts) for i in (0, 1))
    begin = low + k / n * (high - low)
    end = np.where(k + 1 == n, high, low + (k + 1) / n * (high - low))
    return np.stack([begin, end], axis=1)
