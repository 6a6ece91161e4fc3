"""Points of chains of edges left out, so that nothing is swept over; the work is in the core."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from adaptmesh._core import decimate as core_decimate
from adaptmesh.types import Floats, Int64s


@dataclass(frozen=True, eq=False)
class Decimated:
    """What is left of edges.

    Attributes
    ----------
    edges : (e, 2) array
        Directed as the first of the edges that they replace.
    source : (e,) array
        The number of that edge.
    passed : (d,) array
        The points left out, those of one edge after those of another.
    starts : (e + 1,) array
        Edge i passes by the points ``passed[starts[i]:starts[i + 1]]``.
    """

    edges: Int64s
    source: Int64s
    passed: Int64s
    starts: Int64s


def decimate(
    points: Floats, tensors: Floats, edges: Int64s, kind: Int64s, share: float
) -> Decimated:
    """Leave out points between two edges of one kind.

    Parameters
    ----------
    points : (n, 2) array
    tensors : (n, 3) array
        The metric at the points.
    edges : (e, 2) array
        They meet only at points.
    kind : (e,) array
        A point is left out only between edges of the same kind, seen in the same direction; see
        `turned`.
    share : float
        The most that a point may lie off the edge that replaces its own, as a length in the metric
        at that point. Only ends of edges shorter than 1 in the metric are left out.
    """
    left, source, passed, starts = core_decimate(
        np.ascontiguousarray(points),
        np.ascontiguousarray(tensors),
        edges.astype(np.int32),
        kind.astype(np.int32),
        share,
    )
    return Decimated(
        left.astype(np.int64), source.astype(np.int64), passed.astype(np.int64), starts
    )


def turned(edges: Int64s, left: Int64s, right: Int64s) -> tuple[Int64s, Int64s, Int64s]:
    """Edges turned so that the lower number is on their left, and their sides then."""
    turn = left > right
    edges = np.where(turn[:, None], edges[:, ::-1], edges)
    return edges, np.minimum(left, right), np.maximum(left, right)
