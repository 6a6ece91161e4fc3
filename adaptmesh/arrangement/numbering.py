"""Points and edges numbered anew."""

from __future__ import annotations

import numpy as np

from adaptmesh.types import Int64s


def used_points(pairs: Int64s) -> tuple[Int64s, Int64s]:
    """The points that pairs are made of, sorted, and the pairs in numbers of these."""
    is_used = np.bincount(pairs.ravel()) > 0
    number = np.cumsum(is_used) - 1
    return np.flatnonzero(is_used), number[pairs]


def unique_edges(pieces: Int64s) -> tuple[Int64s, Int64s, Int64s]:
    """The pairs of points that pieces join, each once, lower first.

    Returns
    -------
    edges : (e, 2) array
    edge : (p,) array
        That of each piece.
    sign : (p,) array
        1 where a piece runs along its edge, -1 where against it.
    """
    n = int(pieces.max(initial=0)) + 1
    low, high = pieces.min(axis=1), pieces.max(axis=1)
    keys, edge = np.unique(low * n + high, return_inverse=True)
    edges = np.stack([keys // n, keys % n], axis=1)
    return edges, edge.reshape(-1), np.where(pieces[:, 0] == low, 1, -1)
