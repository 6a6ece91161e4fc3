"""What makes the output of the constrained triangulation right, checked slowly and exactly."""

from __future__ import annotations

from fractions import Fraction
from itertools import pairwise

from reference import exact
from reference.delaunay import border_of, edges_of, incircle, orient2d, rational


def on_segment(p, a, b):
    """Whether p lies exactly on the closed segment ab."""
    if orient2d(a, b, p) != 0:
        return False
    return all(min(a[k], b[k]) <= p[k] <= max(a[k], b[k]) for k in (0, 1))


def cut_segments(points, segments):
    """The pieces (a, b, segment) that all the points exactly on each segment cut it into."""
    pieces = []
    for k, (a, b) in enumerate(segments):
        along = sorted(
            (v for v in range(len(points)) if on_segment(points[v], points[a], points[b])),
            key=lambda v: sum(abs(Fraction(points[v][i]) - Fraction(points[a][i])) for i in (0, 1)),
        )
        assert along[0] == a and along[-1] == b
        pieces += [(u, v, k) for u, v in pairwise(along)]
    return pieces


def twice_area(points, triangles):
    """Exactly."""
    total = Fraction(0)
    for t in triangles:
        total += exact.orient2d(*(rational(points[k]) for k in t))
    return total


def check_constrained_delaunay(points, triangles, sub_edges, is_boundary):
    """Every triangle counter-clockwise, every edge locked or Delaunay, the border as flagged.

    By the lemma of constrained Delaunay triangulations (Lee and Lin 1986) an edge that is locally
    Delaunay everywhere but on locked edges is enough.
    """
    triangles = [tuple(t) for t in triangles]
    assert all(orient2d(*(points[v] for v in t)) > 0 for t in triangles)
    opposite = edges_of(triangles)
    locked = {frozenset(e) for e in sub_edges}
    assert len(locked) == len(sub_edges)
    for (u, v), w in opposite.items():
        far = opposite.get((v, u))
        if far is None or frozenset((u, v)) in locked:
            continue
        circle = (points[u], points[v], points[w], points[far])
        assert incircle(*circle) <= 0, f"edge {u}-{v} is not Delaunay"
    border = {frozenset(e) for e in border_of(opposite)}
    assert border == {frozenset(e) for e, b in zip(sub_edges, is_boundary, strict=True) if b}
    edges = {frozenset(e) for e in opposite}
    assert locked <= edges, "a locked edge is no edge of the triangulation"
    return edges
