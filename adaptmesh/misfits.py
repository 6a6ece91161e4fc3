"""Where a mesh does not fit its metric.

- An edge is not unit, or a triangle is bad.
- All edges are unit, but in one place most are long, or short: the mean length of the edges of a
  vertex, averaged over its neighbours, is off. In a fresh mesh it is within a tenth of 1.

Around constrained edges that the domain makes too short nothing fits, and never will: what is wrong
there is left alone.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

import metrics
from metrics import ControlSpace

from . import _core
from .stretches import UNIT

Floats = NDArray[np.float64]
Ints = NDArray[np.int32]
Bools = NDArray[np.bool_]

# The mesher knows lengths to about 1 %; this near to a bound they are measured as a report does.
DOUBT = 0.02


@dataclass(frozen=True)
class Fit:
    """What fits, and how much around a misfit is taken with it.

    Attributes
    ----------
    least_quality : float
        Triangles worse than this are misfits.
    mean_length : float
        Where mean lengths are beyond this or its inverse, the mesh is too coarse or too fine.
    rings : int
        Rings of neighbours taken with each misfit.
    spoilt_rings : int
        Rings around constrained edges that are too short in which a mesh may be too fine.
    """

    least_quality: float = 0.35
    mean_length: float = 1.15
    rings: int = 2
    spoilt_rings: int = 3


def around_misfits(mesher: _core.Mesher, field: ControlSpace, fit: Fit) -> Bools:
    """Which vertices are in or around a misfit, (n,)."""
    points = mesher.points()
    edges, lengths, is_constrained = mesher.edges()
    n = len(points)
    doubtful = np.zeros(len(edges), bool)
    for bound in UNIT:
        doubtful |= np.abs(lengths / bound - 1) < DOUBT
    lengths[doubtful] = metrics.edge_lengths(points, edges[doubtful], field)

    spoilt = _marked(edges[is_constrained & (lengths < UNIT[0])], n)
    misfit = _marked(edges[(lengths < UNIT[0]) | (lengths > UNIT[1])], n)
    misfit[mesher.corners_below(fit.least_quality)] = True
    mean = np.exp(_mean_around(_mean_of_edges(np.log(lengths), edges, n), edges))
    misfit |= mean > fit.mean_length
    misfit &= ~_grown(spoilt, edges, 1)
    misfit |= (mean < 1 / fit.mean_length) & ~_grown(spoilt, edges, fit.spoilt_rings)
    return _grown(misfit, edges, fit.rings)


def _marked(edges: Ints, n: int) -> Bools:
    out = np.zeros(n, bool)
    out[edges.ravel()] = True
    return out


def _grown(marks: Bools, edges: Ints, rings: int) -> Bools:
    """Marks with `rings` rings of neighbours."""
    out: Bools = marks.copy()
    for _ in range(rings):
        out[edges[out[edges].any(axis=1)]] = True
    return out


def _mean_of_edges(values: Floats, edges: Ints, n: int) -> Floats:
    """The mean of the values of the edges of each vertex."""
    ends = edges.ravel()
    out: Floats = np.bincount(ends, np.repeat(values, 2), n) / _degrees(edges, n)
    return out


def _mean_around(values: Floats, edges: Ints) -> Floats:
    """The mean of a vertex's value and those of its neighbours."""
    n = len(values)
    a, b = edges.T
    total = values + np.bincount(a, values[b], n) + np.bincount(b, values[a], n)
    out: Floats = total / (1 + _degrees(edges, n))
    return out


def _degrees(edges: Ints, n: int) -> Ints:
    return np.maximum(np.bincount(edges.ravel(), minlength=n), 1)
