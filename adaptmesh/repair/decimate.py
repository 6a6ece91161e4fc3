"""Remove polyline vertices without changing the topology; the algorithm is in the core."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from adaptmesh._core import decimate as core_decimate
from adaptmesh.types import Floats, Int64s


@dataclass(frozen=True, eq=False)
class Decimated:
    """Edges after decimation.

    Attributes
    ----------
    edges : (e, 2) array
        Directed like the first of the edges that each replaces.
    source : (e,) array
        The index of that edge.
    removed : (d,) array
        The removed points, grouped by edge.
    starts : (e + 1,) array
        Edge i replaces the points ``removed[starts[i]:starts[i + 1]]``.
    """

    edges: Int64s
    source: Int64s
    removed: Int64s
    starts: Int64s


def decimate(
    points: Floats, tensors: Floats, edges: Int64s, kind: Int64s, share: float
) -> Decimated:
    """Remove points between two edges of one kind.

    Parameters
    ----------
    points : (n, 2) array
    tensors : (n, 3) array
        The metric at the points.
    edges : (e, 2) array
        They meet only at their ends.
    kind : (e,) array
        A point is removed only between edges of the same kind in the same direction; see `orient`.
    share : float
        Largest distance of a removed point from the edge that replaces its own, in the metric at
        that point. Only ends of edges shorter than 1 in the metric are removed.
    """
    left, source, removed, starts = core_decimate(
        np.ascontiguousarray(points),
        np.ascontiguousarray(tensors),
        edges.astype(np.int32),
        kind.astype(np.int32),
        share,
    )
    return Decimated(
        left.astype(np.int64), source.astype(np.int64), removed.astype(np.int64), starts
    )


def orient(edges: Int64s, left: Int64s, right: Int64s) -> tuple[Int64s, Int64s, Int64s]:
    """Direct edges so that the lower side number is on their left; return the new sides, too."""
    is_reversed = left > right
    edges = np.where(is_reversed[:, None], edges[:, ::-1], edges)
    return edges, np.minimum(left, right), np.maximum(left, right)
