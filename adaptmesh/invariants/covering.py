"""Do the triangles cover what their border encloses, once and only once?

No search for overlapping triangles is needed. The triangles are positive and every inner edge has
one on each side; let them also turn once around every inner point, let their fans at a border point
not overlap, and let the border not cross itself. Then the number of triangles over a point of the
plane changes only across the border, and there by one. It is one everywhere inside as soon as no
connected piece of the border runs through foreign triangles, and a piece does so with all of its
points or with none: one point of each is looked up.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray
from scipy.sparse import coo_array
from scipy.sparse.csgraph import connected_components

from .. import _core
from .subject import Bools, Finding, Floats, Index, Ints, Subject, finding

BLOCK = 1_000_000  # pairs examined at a time
MOST = 50  # crossings and coverings counted


def single_turn(s: Subject) -> Finding:
    r"""The triangles of a point turn around it once, or form fans that do not overlap.

    Positive triangles make a whole number of turns around an inner point; two turns are a fold.
    Around a border point they make less than one; where the border touches itself in a point there
    are several fans, and going around the point each must end before the next begins::

          \ fan /
           \   /              start, end, start, end
        ----- P -----
           /   \
          / fan \
    """
    n = len(s.mesh.points)
    turns = np.bincount(s.mesh.triangles.T.ravel(), corner_angles(s), minlength=n) / (2 * np.pi)
    ends = s.sides.ends(s.sides.border)
    fans = np.bincount(ends[:, 0], minlength=n)
    bad = np.where(fans == 0, np.abs(turns - 1) > 1e-3, turns > 1 + 1e-9) & s.used
    bad[overlapping_fans(s.points, ends[(fans > 1)[ends].any(axis=1)], fans > 1)] = True

    def show(v: int) -> str:
        return f"point {s.at(v)}: {turns[v]:.6g} turns in {max(fans[v], 1)} fans"

    good = f"{np.count_nonzero(fans > 1)} points where the border touches itself"
    return finding(np.flatnonzero(bad), good, "points are surrounded more than once", show)


def corner_angles(s: Subject) -> Floats:
    """The angles of all triangles at their first, second and third vertex, (3m,)."""
    p = s.points[s.mesh.triangles]
    angles = []
    for i in range(3):
        u, v = p[:, (i + 1) % 3] - p[:, i], p[:, (i + 2) % 3] - p[:, i]
        u /= np.abs(u).max(axis=1, keepdims=True)  # so that no product underflows
        v /= np.abs(v).max(axis=1, keepdims=True)
        cross = u[:, 0] * v[:, 1] - u[:, 1] * v[:, 0]
        angles.append(np.arctan2(cross, (u * v).sum(axis=1)))
    return np.concatenate(angles)


def overlapping_fans(points: Floats, ends: Index, chosen: Bools) -> Ints:
    """Those of the chosen points around which beginnings and ends of fans do not alternate."""
    at = np.concatenate([ends[:, 0], ends[:, 1]])
    to = np.concatenate([ends[:, 1], ends[:, 0]])
    begins = np.repeat([True, False], len(ends))
    at, to, begins = at[chosen[at]], to[chosen[at]], begins[chosen[at]]
    d = points[to] - points[at]
    order = np.lexsort((np.arctan2(d[:, 1], d[:, 0]), at))
    at, begins = at[order], begins[order]
    again = (at[1:] == at[:-1]) & (begins[1:] == begins[:-1])
    out: Ints = at[1:][again]
    return out


def simple_border(s: Subject) -> Finding:
    """The border does not cross itself, and no point of it hangs on another edge of it."""
    ends = s.sides.ends(s.sides.border)
    pairs = crossings(s, ends)

    def show(k: int) -> str:
        e, f = pairs[k]
        return f"edges {s.at(*ends[e])} and {s.at(*ends[f])}"

    wrong = "pairs of border edges cross or overlap, and perhaps more"
    return finding(np.arange(len(pairs)), "exact signs", wrong, show)


def crossings(s: Subject, ends: Index) -> Ints:
    """The first pairs of edges that meet elsewhere than in a common end, (k, 2).

    Boxes come from a tree, signs are exact. The search goes on in blocks until one of them holds a
    crossing, so that a heap of triangles does not take quadratic time.
    """
    import shapely

    lines = shapely.linestrings(s.points[ends])
    tree = shapely.STRtree(lines)
    start, size = 0, 4
    while start < len(lines):
        e, f = tree.query(lines[start : start + size])
        found = len(e) + 1
        e += start
        e, f = e[e < f], f[e < f]
        met = meet(s.points, ends[e], ends[f])
        if len(met):
            return np.stack([e[met], f[met]], axis=1)[:MOST]
        start, size = start + size, int(np.clip(BLOCK * size // found, 1, 2**16))
    return np.empty((0, 2), np.int64)


def meet(points: Floats, e: Index, f: Index) -> Ints:
    """Which of the pairs of edges e (k, 2) and f (k, 2) have more in common than an end."""

    def orient(a: Index, b: Index, c: Index) -> NDArray[np.int8]:
        return np.asarray(_core.orient2d(points[a], points[b], points[c]))

    kept = np.arange(len(e))
    for one, other in ((e, f), (f, e)):  # keep pairs of which neither lies beside the other
        a, b = one[kept].T
        c, d = other[kept].T
        kept = kept[orient(a, b, c) * orient(a, b, d) <= 0]
    (a, b), (c, d) = e[kept].T, f[kept].T
    sides = [orient(a, b, c), orient(a, b, d), orient(c, d, a), orient(c, d, b)]
    out: Bools = np.all(np.not_equal(sides, 0), axis=0)  # they cross
    for side, p, q, r in zip(sides, (a, a, c, c), (b, b, d, d), (c, d, a, b), strict=True):
        x, y, z = points[p], points[q], points[r]
        between = ((np.minimum(x, y) <= z) & (z <= np.maximum(x, y))).all(axis=1)
        out |= (side == 0) & between & (r != p) & (r != q)  # r hangs on the edge pq
    return kept[out]


def covered_once(s: Subject) -> Finding:
    """No border point lies in a triangle that is not its own; see the top of this file."""
    ends = s.sides.ends(s.sides.border)
    _, piece = components(len(s.points), ends)
    border = np.unique(ends)
    sample = border[np.unique(piece[border], return_index=True)[1]]
    pairs = points_in_triangles(s, sample)

    def show(k: int) -> str:
        point, triangle = pairs[k]
        return f"point {s.at(point)} in triangle {triangle}: {s.at(*s.mesh.triangles[triangle])}"

    with np.errstate(over="ignore", invalid="ignore"):
        area = float(s.mesh.areas.sum())
    good = f"area {area:.12g}; pieces of border: {len(sample)}"
    wrong = "points of the border lie in foreign triangles, and perhaps more"
    return finding(np.arange(len(pairs)), good, wrong, show)


def points_in_triangles(s: Subject, sample: Index) -> Ints:
    """The first pairs (point, triangle) where the triangle contains the point but does not own it.

    Points are sorted along x or y, whichever pairs fewer of them with triangles of the same range.
    The search goes on in blocks until one of them holds a pair.
    """
    corners = s.points[s.mesh.triangles]
    low, high = corners.min(axis=1), corners.max(axis=1)
    ranges = [_ranges(s.points[sample], low, high, axis) for axis in (0, 1)]
    order, first, many = min(ranges, key=lambda r: float(r[2].sum()))
    triangles = np.flatnonzero(many)
    for block in np.split(triangles, _cuts(many[triangles])):
        t = np.repeat(block, many[block])
        k = np.arange(len(t)) - np.repeat(np.cumsum(many[block]) - many[block], many[block])
        p = sample[order[first[t] + k]]
        xy = s.points[p]
        near = ((low[t] <= xy) & (xy <= high[t])).all(axis=1)
        near &= (s.mesh.triangles[t] != p[:, None]).all(axis=1)
        t, p = t[near], p[near]
        a, b, c = s.mesh.triangles[t].T
        inside = (s.orient(a, b, p) >= 0) & (s.orient(b, c, p) >= 0) & (s.orient(c, a, p) >= 0)
        if inside.any():
            return np.stack([p[inside], t[inside]], axis=1)[:MOST]
    return np.empty((0, 2), np.int64)


def _ranges(points: Floats, low: Floats, high: Floats, axis: int) -> tuple[Ints, Ints, Ints]:
    """Points in order along an axis, and for each box the first in its range and how many."""
    order = np.argsort(points[:, axis])
    along = points[order, axis]
    first = np.searchsorted(along, low[:, axis])
    many = np.searchsorted(along, high[:, axis], side="right") - first
    return order, first, many


def _cuts(counts: Index) -> Ints:
    """Where to cut a list of lengths so that each block adds up to about BLOCK."""
    blocks = np.cumsum(counts) // BLOCK
    return np.flatnonzero(blocks[1:] != blocks[:-1]) + 1


def euler(s: Subject) -> Finding:
    """Points - edges + triangles is what the connected pieces and the holes say.

    Every piece that hangs together by points counts one, every hole takes one away. The border is a
    planar graph with 1 + (its pieces) - (its points) + (its edges) faces: the outside, the holes,
    and one for each piece of the mesh that hangs together by edges.
    """
    sides = s.sides
    inner = sides.first[sides.count == 2]
    across = np.stack([sides.triangle[inner], sides.triangle[inner + 1]], axis=1)
    ends = sides.ends(np.arange(len(sides.first)))
    border = ends[sides.border]
    n, border_points = np.count_nonzero(s.used), len(np.unique(border))
    spare = len(s.points) - n  # points without a triangle are components of their own
    by_points = components(len(s.points), ends)[0] - spare
    by_edges = components(len(s.mesh.triangles), across)[0]
    border_pieces = components(len(s.points), border)[0] - (len(s.points) - border_points)
    holes = border_pieces - border_points + len(border) - by_edges
    found, expected = n - len(ends) + len(s.mesh.triangles), by_points - holes
    note = f"{n} - {len(ends)} + {len(s.mesh.triangles)} = {found}"
    if found == expected:
        return Finding(0, f"{note}; {by_points} pieces, {holes} holes")
    return Finding(1, f"{note}, but {by_points} pieces with {holes} holes make {expected}")


def components(n: int, pairs: Index) -> tuple[int, Ints]:
    """How many connected components n items have with these links, and that of each item."""
    graph = coo_array((np.ones(len(pairs), np.int8), tuple(pairs.T)), shape=(n, n))
    count, label = connected_components(graph, directed=False)
    return int(count), label
