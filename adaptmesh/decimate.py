r"""Points of chains of edges left out, one at a time, so that nothing is swept over.

        v               Leaving out v replaces two edges by one. If no other point lies in the
      /   \             triangle (a, v, b), by exact signs, the new edge meets nothing: an edge
    a ..... b           through the triangle would have to cross one of the old ones, or the new
                        one twice. So nothing crosses, and nothing changes sides.

Points go in the order of how far that moves the chain, the least first (Visvalingam and Whyatt).
"""

from __future__ import annotations

import heapq
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from . import _core

Floats = NDArray[np.float64]
Ints = NDArray[np.int64]


@dataclass(frozen=True)
class Decimated:
    """What is left of edges.

    Attributes
    ----------
    edges : (e, 2) array
        Directed as the first of the edges that they replace.
    source : (e,) array
        The number of that edge.
    dropped : list of list of int
        The points that each edge passes by now.
    """

    edges: Ints
    source: Ints
    dropped: list[list[int]]


def decimate(points: Floats, tensors: Floats, edges: Ints, kind: Ints, share: float) -> Decimated:
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
    return _Decimation(points, tensors, edges, kind, share).run()


class _Decimation:
    def __init__(
        self, points: Floats, tensors: Floats, edges: Ints, kind: Ints, share: float
    ) -> None:
        from scipy.spatial import cKDTree

        self.points, self.tensors, self.share = points, tensors, share
        self.tree = cKDTree(points)
        self.alive = np.ones(len(points), bool)
        #: The edge from each point to the next, by (from, to) in both directions: its number.
        self.edge: dict[tuple[int, int], int] = {}
        self.ends: list[tuple[int, int] | None] = [(a, b) for a, b in edges.tolist()]
        self.dropped: list[list[int]] = [[] for _ in range(len(edges))]
        self.beside: list[list[int]] = [[] for _ in range(len(points))]
        for e, (a, b) in enumerate(edges.tolist()):
            self.edge[a, b] = self.edge[b, a] = e
            self.beside[a].append(b)
            self.beside[b].append(a)
        self.kind = kind.tolist()
        self.heap: list[tuple[float, int, int, int]] = []

    def run(self) -> Decimated:
        for v in range(len(self.points)):
            self.consider(v)
        while self.heap:
            _, v, a, b = heapq.heappop(self.heap)
            same = self.alive[v] and self.beside[v] == [a, b] and (a, b) not in self.edge
            if same and self.sweeps_over_nothing(a, v, b):
                self.leave_out(a, v, b)
        left = [e for e, ends in enumerate(self.ends) if ends is not None]
        pairs = np.array([self.ends[e] for e in left], dtype=np.int64).reshape(-1, 2)
        return Decimated(pairs, np.array(left, np.int64), [self.dropped[e] for e in left])

    def consider(self, v: int) -> None:
        """Queue a point that may be left out."""
        if len(self.beside[v]) != 2:
            return
        a, b = self.beside[v]
        first, second = self.edge[a, v], self.edge[v, b]
        if self.kind[first] != self.kind[second] or (a, b) in self.edge:
            return
        # Along a chain of one kind all edges have to point the same way.
        if (self.ends[first] == (a, v)) != (self.ends[second] == (v, b)):
            return
        if min(self.length(a, v), self.length(v, b)) >= 1:
            return
        off = self.offset([*self.dropped[first], v, *self.dropped[second]], a, b)
        if off <= self.share:
            heapq.heappush(self.heap, (off, v, a, b))

    def length(self, a: int, b: int) -> float:
        x, y = self.points[b] - self.points[a]
        m11, m12, m22 = 0.5 * (self.tensors[a] + self.tensors[b])
        return float(np.sqrt(m11 * x * x + 2 * m12 * x * y + m22 * y * y))

    def offset(self, passed: list[int], a: int, b: int) -> float:
        """The farthest of the points from the edge ab, each in its own metric."""
        m11, m12, m22 = self.tensors[passed].T
        u, w = self.points[b] - self.points[a], self.points[passed] - self.points[a]

        def dot(p: Floats, q: Floats) -> Floats:
            out: Floats = (
                m11 * p[..., 0] * q[..., 0]
                + m12 * (p[..., 0] * q[..., 1] + p[..., 1] * q[..., 0])
                + m22 * p[..., 1] * q[..., 1]
            )
            return out

        t = np.clip(dot(u, w) / dot(u, u), 0.0, 1.0)
        off = w - t[:, None] * u
        return float(np.sqrt(dot(off, off).max()))

    def sweeps_over_nothing(self, a: int, v: int, b: int) -> bool:
        """Whether no other point lies in the triangle, its sides included."""
        corners = self.points[[a, v, b]]
        centre = corners.mean(axis=0)
        reach = np.hypot(*(corners - centre).T).max() * (1 + 1e-9)
        near = np.array(self.tree.query_ball_point(centre, reach), dtype=np.int64)
        near = near[self.alive[near] & ~np.isin(near, (a, v, b))]
        if not len(near):
            return True
        p = self.points[near]
        sides = []
        for i, j in ((0, 1), (1, 2), (2, 0)):
            start, end = (np.broadcast_to(corners[k], p.shape).copy() for k in (i, j))
            sides.append(_core.orient2d(start, end, p))
        inside = (np.min(sides, axis=0) >= 0) | (np.max(sides, axis=0) <= 0)
        return not inside.any()

    def leave_out(self, a: int, v: int, b: int) -> None:
        """Let the first edge run from a to b, and the second vanish."""
        first, second = self.edge.pop((a, v)), self.edge.pop((v, b))
        del self.edge[v, a], self.edge[b, v]
        self.ends[first] = (a, b) if self.ends[first] == (a, v) else (b, a)
        self.ends[second] = None
        self.edge[a, b] = self.edge[b, a] = first
        self.dropped[first] = [*self.dropped[first], v, *self.dropped[second]]
        self.alive[v] = False
        self.beside[a][self.beside[a].index(v)] = b
        self.beside[b][self.beside[b].index(v)] = a
        self.consider(a)
        self.consider(b)


def turned(edges: Ints, left: Ints, right: Ints) -> tuple[Ints, Ints, Ints]:
    """Edges turned so that the lower number is on their left, and their sides then."""
    turn = left > right
    edges = np.where(turn[:, None], edges[:, ::-1], edges)
    return edges, np.minimum(left, right), np.maximum(left, right)
