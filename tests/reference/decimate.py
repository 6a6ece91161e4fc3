"""Points of chains of edges left out, one at a time: slow and obvious.

Points go in the order of how far that moves the chain, the least first (Visvalingam and Whyatt).
"""

from __future__ import annotations

import heapq

import numpy as np
from scipy.spatial import cKDTree

from adaptmesh import _core


def decimate(points, tensors, edges, kind, share):
    """The edges that are left, each with its source and the points that it passes by."""
    return Decimation(points, tensors, edges, kind, share).run()


class Decimation:
    def __init__(self, points, tensors, edges, kind, share):
        self.points, self.tensors, self.share = points, tensors, share
        self.tree = cKDTree(points)
        self.alive = np.ones(len(points), bool)
        #: The edge from each point to the next, by (from, to) in both directions: its number.
        self.edge = {}
        self.ends = [(a, b) for a, b in edges.tolist()]
        self.dropped = [[] for _ in range(len(edges))]
        self.beside = [[] for _ in range(len(points))]
        for e, (a, b) in enumerate(edges.tolist()):
            self.edge[a, b] = self.edge[b, a] = e
            self.beside[a].append(b)
            self.beside[b].append(a)
        self.kind = kind.tolist()
        self.heap = []

    def run(self):
        for v in range(len(self.points)):
            self.consider(v)
        while self.heap:
            _, _, v, a, b = heapq.heappop(self.heap)
            same = self.alive[v] and self.beside[v] == [a, b] and (a, b) not in self.edge
            if same and self.sweeps_over_nothing(a, v, b):
                self.leave_out(a, v, b)
        return [
            (*ends, e, sorted(self.dropped[e]))
            for e, ends in enumerate(self.ends)
            if ends is not None
        ]

    def consider(self, v):
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
        passed = [*self.dropped[first], v, *self.dropped[second]]
        off = self.offset(passed, a, b)
        if off <= self.share:
            heapq.heappush(self.heap, (off, len(passed), v, a, b))

    def length(self, a, b):
        x, y = self.points[b] - self.points[a]
        m11, m12, m22 = 0.5 * (self.tensors[a] + self.tensors[b])
        return float(np.sqrt(m11 * x * x + 2 * m12 * x * y + m22 * y * y))

    def offset(self, passed, a, b):
        """The farthest of the points from the edge ab, each in its own metric."""
        m11, m12, m22 = self.tensors[passed].T
        u, w = self.points[b] - self.points[a], self.points[passed] - self.points[a]

        def dot(p, q):
            return (
                m11 * p[..., 0] * q[..., 0]
                + m12 * (p[..., 0] * q[..., 1] + p[..., 1] * q[..., 0])
                + m22 * p[..., 1] * q[..., 1]
            )

        t = np.clip(dot(u, w) / dot(u, u), 0.0, 1.0)
        off = w - t[:, None] * u
        return float(np.sqrt(dot(off, off).max()))

    def sweeps_over_nothing(self, a, v, b):
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

    def leave_out(self, a, v, b):
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
