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


@dataclass(frozen=True)
class Outline:
    """The points and pieces of all segments: what the triangulation starts from.

    Attributes
    ----------
    points, tensors : (n, 2), (n, 3) arrays
        The points of the domain, then the cuts; the metric at each.
    held_by : (n,) array of int32
        ``FIXED`` for the points of the domain, the segment it lies on for a cut.
    pieces : (q, 2) array of int32
        Point numbers of each piece, in the direction of its segment.
    segment : (q,) array of int32
        The segment that each piece is part of.
    """

    points: Floats
    tensors: Floats
    held_by: Ints
    pieces: Ints
    segment: Ints


def measure_edges(sampler: _core.EdgeSampler, field: ControlSpace) -> Floats:
    """Metric lengths of the edges in a sampler, asking the field where it wants to know."""
    while len(wanted := sampler.wanted()):
        sampler.feed(field(wanted))
    lengths: Floats = sampler.lengths()
    return lengths


def cut_segments(domain: Domain, field: ControlSpace, most_points: int) -> Outline:
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
    total = measure_edges(sampler, field).sum()
    if len(domain.points) + total > most_points:
        raise BudgetError(
            f"the boundary alone would have about {total:.3g} vertices, but max_vertices is "
            f"{most_points:,}: ask for larger sizes, or allow more"
        )
    cuts, piece, parts = sampler.cut()
    return _join(domain, tensors, ends, parts, cuts, piece, field(cuts))


def _canonical(domain: Domain) -> Ints:
    """The pieces of the domain, each from its lower left to its upper right end."""
    p, q = domain.points[domain.pieces[:, 0]], domain.points[domain.pieces[:, 1]]
    turned = (p[:, 0] > q[:, 0]) | ((p[:, 0] == q[:, 0]) & (p[:, 1] > q[:, 1]))
    out: Ints = np.where(turned[:, None], domain.pieces[:, ::-1], domain.pieces)
    return out


def _join(
    domain: Domain,
    tensors: Floats,
    ends: Ints,
    parts: Ints,
    cuts: Floats,
    piece: Ints,
    cut_tensors: Floats,
) -> Outline:
    """Number the cuts after the points of the domain, and chain them along their pieces."""
    n, k = len(domain.points), len(ends)
    # The chain of a piece: its start, its cuts, its end; all chains one behind the other.
    chain_start = np.concatenate([[0], np.cumsum(parts + 1)])
    chains = np.empty(chain_start[-1], np.int32)
    chains[chain_start[:-1]] = ends[:, 0]
    chains[chain_start[1:] - 1] = ends[:, 1]
    is_cut = np.ones(len(chains), bool)
    is_cut[chain_start[:-1]] = is_cut[chain_start[1:] - 1] = False
    chains[is_cut] = n + np.arange(len(cuts))

    owner = np.repeat(np.arange(k, dtype=np.int32), parts + 1)
    inside = owner[:-1] == owner[1:]
    return Outline(
        points=np.concatenate([domain.points, cuts]),
        tensors=np.concatenate([tensors, cut_tensors]),
        held_by=np.concatenate([np.full(n, _core.FIXED, np.int32), domain.piece_segments[piece]]),
        pieces=np.stack([chains[:-1], chains[1:]], axis=1)[inside],
        segment=domain.piece_segments[owner[:-1][inside]],
    )
