"""What makes a triangulation (constrained) Delaunay, checked slowly and exactly."""

from __future__ import annotations

from collections import Counter
from fractions import Fraction
from itertools import combinations

from reference import exact


def rational(p):
    return tuple(Fraction(float(v)) for v in p)


def orient2d(*points):
    """Exact; only the sign counts. Points are pairs of float."""
    return exact.orient2d(*map(rational, points))


def incircle(*points):
    """Exact; only the sign counts. Points are pairs of float."""
    return exact.incircle(*map(rational, points))


def delaunay_triangles(points):
    """Every counter-clockwise triple (lowest number first) with an empty open circumcircle.

    Without four points on a circle these are the triangles of the Delaunay triangulation; with
    them, all triangles that any Delaunay triangulation may have. No duplicates, please.
    """
    found = set()
    for i, j, k in combinations(range(len(points)), 3):
        turn = orient2d(points[i], points[j], points[k])
        if turn == 0:
            continue
        t = (i, j, k) if turn > 0 else (i, k, j)
        corners = [points[v] for v in t]
        if all(incircle(*corners, p) <= 0 for p in points):
            found.add(t)
    return found


def edges_of(triangles):
    """Directed edge -> the vertex opposite; fails if a directed edge is in two triangles."""
    opposite = {}
    for a, b, c in triangles:
        for u, v, w in ((a, b, c), (b, c, a), (c, a, b)):
            assert (u, v) not in opposite, f"two triangles on the same side of edge {u}-{v}"
            opposite[u, v] = w
    return opposite


def border_of(opposite):
    """The directed edges with a triangle on their left only."""
    return [(u, v) for u, v in opposite if (v, u) not in opposite]


def loops_of(border):
    """The border as closed loops of vertices; at a vertex shared by loops any continuation."""
    following = {}
    for u, v in border:
        following.setdefault(u, []).append(v)
    outgoing, incoming = Counter(u for u, _ in border), Counter(v for _, v in border)
    assert outgoing == incoming, "the border is not closed"
    loops = []
    while following:
        start = next(iter(following))
        loop = [start]
        while True:
            here = loop[-1]
            there = following[here].pop()
            if not following[here]:
                del following[here]
            if there == start:
                break
            loop.append(there)
        loops.append(loop)
    return loops
