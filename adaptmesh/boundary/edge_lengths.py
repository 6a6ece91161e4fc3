"""Metric lengths of straight edges, measured by the core with the exact metric.

`core/mesher/edge_sampler.hpp` explains how.
"""

from __future__ import annotations

import numpy as np

from adaptmesh._core import MAX_VERTICES, MeasuredEdges, TooManyVertices
from adaptmesh.errors import BudgetError
from adaptmesh.types import Floats, Index
from metrics import ControlSpace


def measured_edges(
    points: Floats,
    tensors: Floats,
    edges: Index,
    field: ControlSpace,
    max_vertices: int = MAX_VERTICES,
) -> MeasuredEdges:
    """Measure edges (k, 2) between points (n, 2) with metrics (n, 3), so that they can be cut."""
    try:
        return MeasuredEdges(points, tensors, np.asarray(edges, np.int32), field, max_vertices)
    except TooManyVertices as error:
        x, y = error.args
        raise BudgetError(
            f"the boundary alone needs more than {max_vertices:,} vertices, many of them near "
            f"({x:g}, {y:g}): ask for larger sizes, or allow more"
        ) from None


def straight_lengths(
    points: Floats,
    edges: Index,
    field: ControlSpace,
    max_vertices: int = MAX_VERTICES,
) -> Floats:
    """Metric lengths of straight edges (k, 2) between points (n, 2)."""
    return measured_edges(points, field(points), edges, field, max_vertices).lengths()
