"""How near points and segments are, and where segments meet."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from adaptmesh.types import Floats, Int64s

from .products import cross


def first_of_equal(points: Floats) -> Int64s:
    """For each point the number of the first that is equal to it."""
    order = np.lexsort((points[:, 1], points[:, 0]))  # stable: equal points by their number
    p = points[order]
    new = np.append(True, (p[1:] != p[:-1]).any(axis=1))[: len(p)]
    first = np.empty(len(p), int)
    first[order] = order[new][np.cumsum(new) - 1]
    return first


def near_points(points: Floats, tolerance: float) -> Iterator[tuple[int, int]]:
    """Pairs (point, kept): each kept point takes in the later ones within the tolerance."""
    from scipy.spatial import cKDTree

    first = first_of_equal(points)
    kept = np.flatnonzero(first == np.arange(len(points)))
    yield from zip(*(x.tolist() for x in _others(first)), strict=True)
    if len(kept) < 2:
        return
    tree = cKDTree(points[kept])
    gap, _ = tree.query(points[kept], k=2)
    gone: set[int] = set()
    for i in np.flatnonzero(gap[:, 1] <= tolerance).tolist():
        if i in gone:
            continue
        for j in sorted(tree.query_ball_point(points[kept[i]], tolerance)):
            if j > i and j not in gone:
                gone.add(j)
                yield int(kept[j]), int(kept[i])


def _others(first: Int64s) -> tuple[Int64s, Int64s]:
    """Points that are equal to an earlier one, and that one."""
    again = np.flatnonzero(first != np.arange(len(first)))
    return again, first[again]


def distance(p: Floats, a: Floats, b: Floats) -> tuple[Floats, Floats]:
    """Distance of points from segments ab, and the feet."""
    u, w = b - a, p - a
    length2 = (u * u).sum(axis=1)
    t = np.clip((u * w).sum(axis=1) / np.where(length2 > 0, length2, 1.0), 0.0, 1.0)
    foot = np.where((t < 0.5)[:, None], a + t[:, None] * u, b - (1.0 - t)[:, None] * u)
    return np.hypot(*(p - foot).T), foot


def meeting(first: Floats, second: Floats) -> Floats:
    """Where segments (n, 2, 2) that cross each other meet, rounded; never outside of their ends."""
    (a, b), (c, d) = first.transpose(1, 0, 2), second.transpose(1, 0, 2)
    u, w, r = b - a, d - c, c - a
    across = cross(u, w)
    along = cross(r, w)
    flat = across == 0  # it crosses by exact signs, but not in doubles
    t = np.clip(np.where(flat, 0.5, along / np.where(flat, 1.0, across)), 0.0, 1.0)
    return np.where((t < 0.5)[:, None], a + t[:, None] * u, b - (1.0 - t)[:, None] * u)
