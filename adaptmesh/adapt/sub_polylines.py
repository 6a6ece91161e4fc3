"""Which parts of boundary polylines are to be cut again: around edges that are not unit."""

from __future__ import annotations

import numpy as np

from adaptmesh.types import Bools, Floats, Index

UNIT = (float(np.sqrt(0.5)) * (1 - 1e-9), float(np.sqrt(2)) * (1 + 1e-9))

# What cannot be cut into parts this near to unit takes in a neighbouring edge, so many times.
GOOD = (0.8, 1.25)
MAX_NEIGHBOURS = 4

BETTER = 0.9
"""With as many edges that are not unit, squares of logarithms of lengths are to fall below this."""


def ranges_to_cut(side: Index, lengths: Floats, is_frozen: Bools) -> Index:
    """Ranges of edges, (r, 2): from the first on, the second not included.

    Parameters
    ----------
    side : (e,) array of int
        The side of each edge, ascending; those of one side are in order along it.
    lengths : (e,) array
    is_frozen : (s,) array of bool
        Sides that are left alone.
    """
    out, done = [], 0
    for edge in np.flatnonzero(is_off(lengths) & ~is_frozen[side]).tolist():
        if edge < done:
            continue
        low, high = np.searchsorted(side, [side[edge], side[edge] + 1]).tolist()
        a, done = _range_around(edge, max(low, done), high, lengths)
        out.append((a, done))
    return np.array(out, np.intp).reshape(-1, 2)


def _range_around(edge: int, low: int, high: int, lengths: Floats) -> tuple[int, int]:
    """Edges [a, b) within [low, high) around one that is not unit, that cut into good parts."""

    def badness(a: int, b: int) -> float:
        _, part = unit_parts(lengths[a:b].sum())
        return float(abs(np.log(part)))

    a, b = edge, edge + 1
    for _ in range(MAX_NEIGHBOURS):
        while b < high and is_off(lengths[b]):
            b += 1
        if GOOD[0] <= unit_parts(lengths[a:b].sum())[1] <= GOOD[1]:
            break
        wider = [(a - 1, b)] * (a > low) + [(a, b + 1)] * (b < high)
        if not wider:
            break
        a, b = min(wider, key=lambda w: badness(*w))
    return a, b


def unit_parts(length: float) -> tuple[int, float]:
    """How many parts bring a length nearest to unit, and how long they are then."""
    parts = max(1, int(0.5 * (1 + np.sqrt(1 + 4 * (length * (1 - 1e-9)) ** 2))))
    return parts, length / parts


def is_off(length: Floats) -> Bools:
    """Whether edges are not unit."""
    return (length < UNIT[0]) | (length > UNIT[1])


def is_better(new: Floats, old: Floats) -> bool:
    """Whether edges of the new lengths are nearer to unit than those of the old ones.

    Fewer of them are off; or as many, and the lengths are nearer to 1 by more than a little.
    """
    off, was_off = np.count_nonzero(is_off(new)), np.count_nonzero(is_off(old))
    if off != was_off:
        return bool(off < was_off)
    return bool(np.sum(np.log(new) ** 2) < BETTER * np.sum(np.log(old) ** 2))
