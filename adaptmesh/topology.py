"""Which edges triangles have, what lies beside them, and what hangs together; no coordinates."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np

from .types import Bools, Index, Int64s, Ints

OUTSIDE = -(2**40)  # a number that no region has


def edge_keys(edges: Index, n: int) -> Int64s:
    """One number for each pair (k, 2) out of n points, whatever their order."""
    a, b = edges[:, 0], edges[:, 1]
    return np.minimum(a, b).astype(np.int64) * n + np.maximum(a, b)


def half_edges(triangles: Index) -> tuple[Index, Ints]:
    """The directed edges of all triangles, (3 m, 2), and the triangle of each."""
    halves = np.concatenate([triangles[:, [1, 2]], triangles[:, [2, 0]], triangles[:, [0, 1]]])
    return halves, np.tile(np.arange(len(triangles), dtype=np.int32), 3)


@dataclass(frozen=True)
class HalfEdges:
    """The directed edges of triangles, sorted so that those of one edge stand together.

    ``tail``, ``head`` and ``triangle`` describe the sorted half-edges; edge ``e`` owns ``count[e]``
    of them from ``first[e]`` on; ``keys`` are the sorted keys of the edges, see `edge_keys`.
    """

    tail: Int64s
    head: Int64s
    triangle: Int64s
    first: Int64s
    count: Int64s
    keys: Int64s

    @classmethod
    def of(cls, triangles: Index, n_points: int) -> HalfEdges:
        """Of triangles (m, 3), whatever is wrong with them."""
        t = triangles.astype(np.int64)
        tail, head = t.T.ravel(), t[:, [1, 2, 0]].T.ravel()
        # the direction is the last bit of the key: equal half-edges of an edge stand together too
        keys = 2 * edge_keys(np.stack([tail, head], axis=1), n_points) + (tail > head)
        order = np.argsort(keys)
        edges = keys[order] >> 1
        first = np.flatnonzero(np.concatenate([[True], edges[1:] != edges[:-1]]))
        count = np.diff(np.append(first, len(edges)))
        return cls(tail[order], head[order], order % len(t), first, count, edges[first])

    @cached_property
    def border(self) -> Int64s:
        """Numbers of the edges with a single triangle; it lies on their left."""
        return np.flatnonzero(self.count == 1)

    def missing(self, keys: Int64s) -> Bools:
        """Which of these keys belong to no edge."""
        place = np.minimum(np.searchsorted(self.keys, keys), len(self.keys) - 1)
        return self.keys[place] != keys

    def ends(self, edges: Index) -> Int64s:
        """Tail and head of some edges, (k, 2), as the first triangle of each runs along it."""
        return np.stack([self.tail[self.first[edges]], self.head[self.first[edges]]], axis=1)


def triangles_beside(triangles: Ints, edges: Ints, n_points: int) -> tuple[Ints, Ints]:
    """The triangle on the left and on the right of each edge, -1 where there is none."""
    halves, owner = half_edges(triangles)
    keys = halves[:, 0].astype(np.int64) * n_points + halves[:, 1]
    order = np.argsort(keys)
    keys, owner = keys[order], owner[order]

    def left_of(a: Ints, b: Ints) -> Ints:
        asked = a.astype(np.int64) * n_points + b
        at = np.minimum(np.searchsorted(keys, asked), len(keys) - 1)
        return np.where(keys[at] == asked, owner[at], -1).astype(np.int32)

    return left_of(edges[:, 0], edges[:, 1]), left_of(edges[:, 1], edges[:, 0])


def regions_beside(triangles: Ints, regions: Ints, edges: Ints, n_points: int) -> Int64s:
    """The regions on the left and right of each edge, (e, 2), `OUTSIDE` for the outside."""
    beside = triangles_beside(triangles, edges, n_points)
    return np.append(regions.astype(np.int64), OUTSIDE)[np.stack(beside, axis=1)]


def parts_between(triangles: Ints, walls: Ints, n_points: int) -> Int64s:
    """The number of the part that each triangle is in; edges (w, 2) are walls between parts."""
    halves, owner = half_edges(triangles)
    keys = edge_keys(halves, n_points)
    order = np.argsort(keys, kind="stable")
    keys, owner = keys[order], owner[order]
    same = np.flatnonzero(keys[:-1] == keys[1:])
    free = same[~np.isin(keys[same], edge_keys(walls, n_points))]
    return components(len(triangles), np.stack([owner[free], owner[free + 1]], axis=1))


def components(n: int, links: Index) -> Int64s:
    """The number of the connected component of each of n items; links are pairs (k, 2) of them."""
    from scipy.sparse import coo_array
    from scipy.sparse.csgraph import connected_components

    graph = coo_array((np.ones(len(links)), (links[:, 0], links[:, 1])), shape=(n, n))
    return connected_components(graph, directed=False)[1].astype(np.int64)


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
    low = pieces.min(axis=1)
    keys, edge = np.unique(edge_keys(pieces, n), return_inverse=True)
    edges = np.stack([keys // n, keys % n], axis=1)
    return edges, edge.reshape(-1), np.where(pieces[:, 0] == low, 1, -1)
