"""Metric lengths of edges, alone and of a mesh at work, the metric being asked for in rounds.

`core/edge_sampler.hpp` explains how.
"""

from __future__ import annotations

import numpy as np

from adaptmesh._core import EdgeSampler, EdgesToMeasure, Mesher, edge_sampler
from adaptmesh.errors import BudgetError
from adaptmesh.types import Floats, Index
from metrics import ControlSpace

# The metric is looked at this closely along segments, in metric length: a layer that meets the
# boundary between two looks would be missed there for good.
LONGEST_CHORD = 0.125

# More chords at once would be a boundary of millions of vertices (and a gigabyte of memory).
MOST_CHORDS = 8_000_000


def sampler_of(points: Floats, tensors: Floats, edges: Index) -> EdgeSampler:
    """What measures, and cuts, edges (k, 2) between points (n, 2) with metrics (n, 3)."""
    a, b = edges.T
    return edge_sampler(points[a], tensors[a], points[b], tensors[b], LONGEST_CHORD)


def measure_edges(sampler: EdgeSampler, field: ControlSpace, most_points: float = np.inf) -> Floats:
    """Metric lengths of the edges in a sampler, asking the field where it wants to know."""
    while len(wanted := sampler.wanted()):
        if len(wanted) > min(most_points * 2 / LONGEST_CHORD, MOST_CHORDS):
            x, y = wanted[len(wanted) // 2]
            raise BudgetError(
                f"the boundary alone needs more than {most_points:,} vertices, many of them near "
                f"({x:g}, {y:g}): ask for larger sizes, or allow more"
            )
        sampler.feed(field(wanted))
    return sampler.lengths()


def straight_lengths(
    points: Floats, edges: Index, field: ControlSpace, most_points: float = np.inf
) -> Floats:
    """Metric lengths of straight edges (k, 2) between points (n, 2)."""
    return measure_edges(sampler_of(points, field(points), edges), field, most_points)


def refresh(mesher: Mesher, field: ControlSpace) -> None:
    """Evaluate the metric where vertices are new or have moved."""
    mesher.set_stale_metrics(field(mesher.stale_points()))


def measure_fresh_edges(mesher: Mesher, field: ControlSpace, uncut_below: float) -> EdgesToMeasure:
    """Measure the edges that have changed, and let the mesher know where its lengths are off."""
    edges = mesher.fresh_edges(uncut_below)
    measure_edges(edges.sampler, field)
    mesher.correct_lengths(edges)
    return edges
