"""Where a mesh does not fit its metric.

- An edge is not unit, or a triangle is bad.
- All edges are unit, but in one place most are long, or short: the mean length of the edges of a
  vertex, averaged over its neighbours, is off. In a fresh mesh it is within a tenth of 1.

Around constrained edges that the domain makes too short nothing fits, and never will: bad triangles
and places that are too fine are left alone there. Not so short edges with a vertex that is on no
constrained edge: a new mesh has none of them.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

import metrics
from adaptmesh._core import MetricMesh
from adaptmesh.types import Bools, Floats, Ints
from metrics import ControlSpace

from .sub_polylines import UNIT

# The mesher knows lengths to about 1 %; this near to a bound they are measured as a report does.
DOUBT = 0.02


# Triangles worse than this do not fit.
LEAST_QUALITY = 0.35

# Where mean lengths are beyond this or its inverse, the mesh is too coarse or too fine.
MEAN_LENGTH = 1.15

# Rings of neighbours taken with what does not fit, and rings around constrained edges that are too
# short in which a mesh may be too fine.
RINGS = 2
SPOILT_RINGS = 3


class Misfits(NamedTuple):
    """What does not fit.

    Attributes
    ----------
    zone : (n,) array of bool
        Which vertices are in or around a misfit: those that are free are to be removed.
    has_long_edges : bool
        Whether points are missing, be there a vertex to remove or not.
    share : float
        The share of edges that are not unit, those that are constrained aside.
    """

    zone: Bools
    has_long_edges: bool
    share: float


def find_misfits(core: MetricMesh, field: ControlSpace) -> Misfits:
    """Measure the edges of a mesh, and find where it does not fit."""
    points = core.points()
    edges, lengths, is_constrained = core.edges()
    n = len(points)
    doubtful = np.zeros(len(edges), bool)
    for bound in UNIT:
        doubtful |= np.abs(lengths / bound - 1) < DOUBT
    lengths[doubtful] = metrics.edge_lengths(points, edges[doubtful], field)

    is_short, is_long = lengths < UNIT[0], lengths > UNIT[1]
    is_free = ~_marked(edges[is_constrained], n)
    spoilt = _marked(edges[is_constrained & is_short], n)
    misfit = _marked(edges[is_short | is_long], n)
    misfit[core.corners_below(LEAST_QUALITY)] = True
    mean = np.exp(_mean_around(_mean_of_edges(np.log(lengths), edges, n), edges))
    misfit |= mean > MEAN_LENGTH
    misfit &= ~_grown(spoilt, edges, 1)
    misfit |= (mean < 1 / MEAN_LENGTH) & ~_grown(spoilt, edges, SPOILT_RINGS)
    misfit |= _marked(edges[is_short & is_free[edges].any(axis=1)], n)
    share = float(np.mean((is_short | is_long) & ~is_constrained))
    return Misfits(_grown(misfit, edges, RINGS), bool(is_long.any()), share)


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
    return np.bincount(ends, np.repeat(values, 2), n) / _degrees(edges, n)


def _mean_around(values: Floats, edges: Ints) -> Floats:
    """The mean of a vertex's value and those of its neighbours."""
    n = len(values)
    a, b = edges.T
    total = values + np.bincount(a, values[b], n) + np.bincount(b, values[a], n)
    return total / (1 + _degrees(edges, n))


def _degrees(edges: Ints, n: int) -> Ints:
    return np.maximum(np.bincount(edges.ravel(), minlength=n), 1)
