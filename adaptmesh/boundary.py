"""Cutting the segments of a domain into unit pieces."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from metrics import ControlSpace

from . import _core
from .domain import Domain
from .errors import BudgetError

Floats = NDArray[np.float64]
Ints = NDArray[np.int32]


# The metric is looked at this closely along segments, in metric length: a layer that meets the
# boundary between two looks would be missed there for good.
LONGEST_CHORD = 0.125

# More chords at once would be a boundary of millions of vertices (and a gigabyte of memory).
MOST_CHORDS = 8_000_000


@dataclass(frozen=True)
class Cuts:
    """The points of a domain with their metric, and the unit points between them.

    Attributes
    ----------
    tensors : (n, 3) array
        The metric at the points of the domain.
    ends : (p, 2) array of int32
        The pieces of the domain, each in the direction in which it is cut.
    points, point_tensors : (c, 2), (c, 3) arrays
        The cuts, and the metric at each.
    piece : (c,) array of int32
        The piece that each cut lies on; those of a piece are in order.
    """

    tensors: Floats
    ends: Ints
    points: Floats
    point_tensors: Floats
    piece: Ints


def measure_edges(
    sampler: _core.EdgeSampler, field: ControlSpace, most_points: float = np.inf
) -> Floats:
    """Metric lengths of the edges in a sampler, asking the field where it wants to know."""
    while len(wanted := sampler.wanted()):
        if len(wanted) > min(most_points * 2 / LONGEST_CHORD, MOST_CHORDS):
            x, y = wanted[len(wanted) // 2]
            raise BudgetError(
                f"the boundary alone needs more than {most_points:,} vertices, many of them near "
                f"({x:g}, {y:g}): ask for larger sizes, or allow more"
            )
        sampler.feed(field(wanted))
    lengths: Floats = sampler.lengths()
    return lengths


def cut_segments(domain: Domain, field: ControlSpace, most_points: int) -> Cuts:
    """Cut every segment of the domain into pieces of (nearly) unit metric length.

    A segment, or a part of one between points that lie on it, of length L becomes the n equal
    pieces for which sqrt((n - 1) n) < L <= sqrt(n (n + 1)): as near to unit as they can be. Each is
    cut once, from its lower point to its upper, so that both its sides and all meshes of the domain
    with this metric agree on it.
    """
    tensors = field(domain.points)
    ends = _canonical(domain)
    starts, stops = ends[:, 0], ends[:, 1]
    sampler = _core.edge_sampler(
        domain.points[starts], tensors[starts], domain.points[stops], tensors[stops], LONGEST_CHORD
    )
    total = measure_edges(sampler, field, most_points).sum()
    if len(domain.points) + total > most_points:
        raise BudgetError(
            f"the boundary alone would have about {total:.3g} vertices, but max_vertices is "
            f"{most_points:,}: ask for larger sizes, or allow more"
        )
    points, piece = sampler.cut()
    return Cuts(tensors, ends, points, field(points), piece)


def _canonical(domain: Domain) -> Ints:
    """The pieces of the domain, each from its lower left to its upper right end."""
    p, q = domain.points[domain.pieces[:, 0]], domain.points[domain.pieces[:, 1]]
    turned = (p[:, 0] > q[:, 0]) | ((p[:, 0] == q[:, 0]) & (p[:, 1] > q[:, 1]))
    out: Ints = np.where(turned[:, None], domain.pieces[:, ::-1], domain.pieces)
    return out
