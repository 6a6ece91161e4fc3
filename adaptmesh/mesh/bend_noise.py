"""How exact coordinates are, where digits no longer tell: rounded first, then turned or scaled.

A vertex is off the line through its neighbours along the border, to the left or to the right::

    ---o         o----          on a straight side that was rounded: of two neighbours, most often,
        `-. _,o-´               to opposite sides, as the error of one is seen from both
           o

       _.-o--o-._               on a curve: to the same side
     o´           `o
                                at a corner: alone
"""

from __future__ import annotations

import numpy as np

from adaptmesh.geometry.products import cross
from adaptmesh.types import Floats, Ints

LARGEST = 4e-6
"""Vertices farther off than this share of the extent are corners. Float32 is a tenth of that."""

OF_EDGE = 0.05
"""So are those farther off than this share of the shortest edge."""

FEWEST_PAIRS = 24
"""Fewer pairs of neighbours than these are no evidence."""

OPPOSITE = 0.6
"""Such a share of neighbours at least are off to opposite sides: 0.73 if errors are independent, up
to 1 if vertices are as regular as the places they are rounded to; 0 on a curve."""

USUAL = 0.95
"""Noise is what such a share of the neighbours are off by, as a few may be corners in pairs."""

DOUBTS = 8.0
"""The sides are straight to so many times the noise: if errors are those of rounding to a grid, it
is a third of the largest of them, a side is off by one error at its ends, a vertex by another, and
errors may be larger in one place than in another.
"""


def bend_noise(points: Floats, edges: Ints, smallest: float, shortest: float) -> float | None:
    """How far vertices are off the lines between their neighbours, if that is noise.

    The smaller one of two neighbours counts: a corner is off alone, what rounding moves takes both
    its neighbours along.

    Parameters
    ----------
    points : (n, 2) array
    edges : (k, 2) array of int
        Of the border and of inner lines.
    smallest : float
        Of what is off by less nothing is known.
    shortest : float
        Length of the shortest edge.
    """
    off = _pairs(points, edges)
    size = np.abs(off)
    largest = min(LARGEST * float(np.ptp(points, axis=0).max()), OF_EDGE * shortest)
    known = ((size > smallest) & (size <= largest)).all(axis=1)
    if known.sum() < FEWEST_PAIRS:
        return None
    opposite = (off[known] > 0).sum(axis=1) == 1
    if opposite.mean() < OPPOSITE:
        return None
    return float(np.quantile(size[known][opposite].min(axis=1), USUAL))


def _pairs(points: Floats, edges: Ints) -> Floats:
    """How far both ends of edges (p, 2) are to the left of the lines through their neighbours.

    Only of edges whose ends have one other edge each; along the edge, so that signs go together.
    """
    n = len(points)
    ends = edges.ravel()
    total = np.zeros(n, np.int64)  # the sum of the two neighbours of a vertex
    np.add.at(total, ends, edges[:, ::-1].ravel())
    passed = (np.bincount(ends, minlength=n) == 2)[edges].all(axis=1)
    a, b = edges[passed].T.astype(np.int64)
    before, after = total[a] - b, total[b] - a
    return np.stack(
        [
            _left_of(points[a], points[before], points[b]),
            _left_of(points[b], points[a], points[after]),
        ],
        axis=1,
    )


def _left_of(p: Floats, a: Floats, b: Floats) -> Floats:
    """How far points (n, 2) are to the left of the lines from a to b."""
    d, w = b - a, p - a
    length = np.hypot(*d.T)
    return np.divide(cross(d, w), length, out=np.full(len(p), np.inf), where=length > 0)
