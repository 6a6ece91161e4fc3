"""Where rows of edges are to be cut anew: around edges that are not unit."""

from __future__ import annotations

import numpy as np

from adaptmesh.types import Bools, Floats, Index

UNIT = (float(np.sqrt(0.5)) * (1 - 1e-9), float(np.sqrt(2)) * (1 + 1e-9))

# A stretch that cannot be cut into parts this near to unit takes in a neighbour, so many times.
GOOD = (0.8, 1.25)
MOST_NEIGHBOURS = 4

BETTER = 0.9
"""With as many edges that are not unit, squares of logarithms of lengths are to fall below this."""


def stretches_of(line: Index, lengths: Floats, is_frozen: Bools) -> Index:
    """Stretches as ranges of edges, (s, 2): from the first on, the second not included.

    Parameters
    ----------
    line : (e,) array of int
        The line of each edge, ascending; those of one line are in order along it.
    lengths : (e,) array
    is_frozen : (l,) array of bool
        Lines that are left alone.
    """
    out, done = [], 0
    for edge in np.flatnonzero(is_off(lengths) & ~is_frozen[line]).tolist():
        if edge < done:
            continue
        least, most = np.searchsorted(line, [line[edge], line[edge] + 1]).tolist()
        a, done = _stretch_around(edge, max(least, done), most, lengths)
        out.append((a, done))
    return np.array(out, np.intp).reshape(-1, 2)


def _stretch_around(edge: int, least: int, most: int, lengths: Floats) -> tuple[int, int]:
    """Edges [a, b) within [least, most) around one that is not unit, that cut into good parts."""

    def badness(a: int, b: int) -> float:
        _, part = unit_parts(lengths[a:b].sum())
        return float(abs(np.log(part)))

    a, b = edge, edge + 1
    for _ in range(MOST_NEIGHBOURS):
        while b < most and is_off(lengths[b]):
            b += 1
        if GOOD[0] <= unit_parts(lengths[a:b].sum())[1] <= GOOD[1]:
            break
        wider = [(a - 1, b)] * (a > least) + [(a, b + 1)] * (b < most)
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
