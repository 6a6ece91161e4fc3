"""Is it a mesh, and of that domain? Exactly, slowly, and with no code of the package.

Signs are those of integers. A mesh is right if its triangles are counter-clockwise, its points are
distinct, no two of its edges meet but in a common end, no part of it lies inside a foreign
triangle, and Euler's relation holds: that is all there is to a plane triangulation. It is one of a
domain if along each segment there is a path of constrained edges, within rounding of it, and the
areas are the same.
"""

from __future__ import annotations

from collections import Counter, defaultdict
from fractions import Fraction

import numpy as np

PLACES = 4
"""A vertex is on a segment if it is no further off than this many units in the last place."""


class Signs:
    """Orientations of points (n, 2), by number: floating point where it can tell, else integers."""

    def __init__(self, points):
        self.points = points
        ratios = [[float(x).as_integer_ratio() for x in p] for p in points]
        common = max((d for p in ratios for _, d in p), default=1)
        self.exact = [[n * (common // d) for n, d in p] for p in ratios]

    def twice_area(self, a, b, c):
        (ax, ay), (bx, by), (cx, cy) = (self.exact[v] for v in (a, b, c))
        return (bx - ax) * (cy - ay) - (by - ay) * (cx - ax)

    def __call__(self, a, b, c):
        p = self.points
        with np.errstate(all="ignore"):
            left = (p[a, 0] - p[c, 0]) * (p[b, 1] - p[c, 1])
            right = (p[a, 1] - p[c, 1]) * (p[b, 0] - p[c, 0])
            sure = np.abs(left - right) > 1e-15 * (np.abs(left) + np.abs(right)) + 1e-250
        out = np.sign(left - right)
        for k in np.flatnonzero(~sure):
            area = self.twice_area(a[k], b[k], c[k])
            out[k] = (area > 0) - (area < 0)
        return out


def faults_of_mesh(mesh):
    """What is wrong with a mesh, in words; empty if nothing is."""
    points, triangles = np.asarray(mesh.points), np.asarray(mesh.triangles).astype(np.intp)
    if not len(triangles):
        return ["no triangles"]
    if not np.isfinite(points).all():
        return ["points that are not finite"]
    signs, out = Signs(points), []
    if len({tuple(p) for p in (points + 0.0).tolist()}) < len(points):
        out.append("two points are equal")
    if (signs(*triangles.T) <= 0).any():
        out.append("a triangle is not counter-clockwise")
    if len(np.unique(triangles)) < len(points):
        out.append("a point has no triangle")
    directed = Counter(
        (int(t[i]), int(t[i - 2])) for t in triangles for i in range(3)
    )  # t[i - 2] follows t[i]
    if max(directed.values()) > 1:
        out.append("two triangles on one side of an edge")
    edges = np.array(sorted({tuple(sorted(e)) for e in directed}))
    constrained = {tuple(sorted(map(int, e))) for e in mesh.edges}
    if len(constrained) < len(mesh.edges):
        out.append("a constrained edge twice")
    if not constrained <= set(map(tuple, edges.tolist())):
        out.append("a constrained edge is no edge of a triangle")
    border = {e for e in directed if (e[1], e[0]) not in directed}
    if not {tuple(sorted(e)) for e in border} <= constrained:
        out.append("the border is not constrained")
    out += _meetings(signs, edges)
    out += _foreign(signs, triangles, edges)
    out += _euler(len(points), edges, triangles, border)
    return out


def _meetings(signs, edges):
    """Edges that cross, overlap, or touch elsewhere than in a common end."""
    p = signs.points
    low, high = np.minimum(*p[edges.T]), np.maximum(*p[edges.T])
    order = np.argsort(low[:, 0], kind="stable")
    edges, low, high = edges[order], low[order], high[order]
    last = np.searchsorted(low[:, 0], high[:, 0], side="right")
    first, second = [], []
    for k, end in enumerate(last.tolist()):
        near = np.arange(k + 1, end)
        near = near[(low[near, 1] <= high[k, 1]) & (low[k, 1] <= high[near, 1])]
        first.append(np.full(len(near), k))
        second.append(near)
    e, f = edges[np.concatenate(first)], edges[np.concatenate(second)]
    (a, b), (c, d) = e.T, f.T
    abc, abd, cda, cdb = signs(a, b, c), signs(a, b, d), signs(c, d, a), signs(c, d, b)
    met = (abc * abd < 0) & (cda * cdb < 0)
    for side, u, v, w in ((abc, a, b, c), (abd, a, b, d), (cda, c, d, a), (cdb, c, d, b)):
        low, high = np.minimum(p[u], p[v]), np.maximum(p[u], p[v])
        hangs = (side == 0) & (low <= p[w]).all(axis=1) & (p[w] <= high).all(axis=1)
        met |= hangs & (w != u) & (w != v)
    return [f"edges {e[k].tolist()} and {f[k].tolist()} meet" for k in np.flatnonzero(met)[:1]]


def _foreign(signs, triangles, edges):
    """Connected parts of the mesh that lie in triangles of others."""
    leader = list(range(len(signs.points)))

    def find(v):
        while leader[v] != v:
            leader[v] = leader[leader[v]]
            v = leader[v]
        return v

    for a, b in edges.tolist():
        leader[find(a)] = find(b)
    for v in {find(int(v)) for v in triangles[:, 0]}:
        at = np.full(len(triangles), v)
        sides = [signs(triangles[:, i], triangles[:, i - 2], at) for i in range(3)]
        inside = np.all([s >= 0 for s in sides], axis=0) & (triangles != v).all(axis=1)
        if inside.any():
            return [f"point {v} lies in triangle {inside.argmax()}"]
    return []


def _euler(n, edges, triangles, border):
    """V - E + T = parts - holes; where parts touch in a point, each counts it for itself."""
    around = defaultdict(list)
    for k, t in enumerate(triangles.tolist()):
        for i in range(3):
            around[t[i]].append((t[i - 2], t[i - 1], k))
    corner, fans = {}, 0
    for v, fan in around.items():
        after = {first: (second, k) for first, second, k in fan}
        seconds = {second for _, second, _ in fan}
        starts = [first for first in after if first not in seconds] or [next(iter(after))]
        seen = 0
        for start in starts:
            at = start
            while at in after:
                second, k = after.pop(at)
                corner[v, k] = fans
                at, seen = second, seen + 1
            fans += 1
        if seen < len(fan):
            return [f"the triangles of point {v} turn around it more than once"]
    leader = list(range(fans))

    def find(v):
        while leader[v] != v:
            leader[v] = leader[leader[v]]
            v = leader[v]
        return v

    for k, t in enumerate(triangles.tolist()):
        for v in t[1:]:
            leader[find(corner[v, k])] = find(corner[t[0], k])
    parts = len({find(v) for v in range(fans)})
    owner = {}
    for k, t in enumerate(triangles.tolist()):
        for i in range(3):
            owner[t[i], t[i - 2]] = k
    begins = {corner[a, owner[a, b]]: corner[b, owner[a, b]] for a, b in border}
    loops, left = 0, set(begins)
    while left:
        at = left.pop()
        while begins[at] in left:
            at = begins[at]
            left.remove(at)
        loops += 1
    if fans - len(edges) + len(triangles) != 2 * parts - loops:
        return [f"Euler: {fans} - {len(edges)} + {len(triangles)}, {parts} parts, {loops} loops"]
    return []


def faults_of_segments(mesh, points, segments, area):
    """Segments without a path of constrained edges along them; and whether the area is another.

    ``area`` is the exact one, or None if it is not to be compared.
    """
    p = np.asarray(mesh.points)
    places = PLACES * np.spacing(np.abs(np.concatenate([p, points])).max())
    at = {tuple(x): v for v, x in enumerate((p + 0.0).tolist())}
    ends = np.asarray(mesh.edges)
    out = []
    for s, (i, j) in enumerate(np.asarray(segments).tolist()):
        a, b = (np.asarray(points[k], float) for k in (i, j))
        start, goal = at.get(tuple((a + 0.0).tolist())), at.get(tuple((b + 0.0).tolist()))
        if start is None or goal is None:
            out.append(f"an end of segment {s} is no point")
        elif not _has_path(p, ends, a, b, start, goal, places):
            out.append(f"segment {s} is no path of edges")
    if area is not None:
        length = sum(np.hypot(*(points[i] - points[j])) for i, j in np.asarray(segments).tolist())
        mine = sum(_area(p[t]) for t in np.asarray(mesh.triangles))
        if abs(mine - area) > Fraction(float(places * length)):
            out.append(f"area {float(mine)!r}, not {float(area)!r}")
    return out


def _area(corners):
    (ax, ay), (bx, by), (cx, cy) = ([Fraction(float(x)) for x in c] for c in corners)
    return ((bx - ax) * (cy - ay) - (by - ay) * (cx - ax)) / 2


def _has_path(p, ends, a, b, start, goal, places):
    """Whether constrained edges lead from one vertex to another, forwards, near the line ab."""
    d = (b - a) / np.hypot(*(b - a))
    off = np.abs((p[:, 0] - a[0]) * d[1] - (p[:, 1] - a[1]) * d[0])
    along = (p - a) @ d
    near = off <= 2 * places
    after = defaultdict(list)
    for u, v in ends[near[ends].all(axis=1)].tolist():
        if along[u] > along[v]:
            u, v = v, u
        after[u].append(v)
        if along[v] - along[u] <= 2 * places:
            after[v].append(u)
    stack, seen = [start], {start}
    while stack:
        v = stack.pop()
        if v == goal:
            return True
        for w in after[v]:
            if w not in seen:
                seen.add(w)
                stack.append(w)
    return False


def area_of_rings(points, segments):
    """The exact area between segments by the even-odd rule, if they are closed rings that do not
    cross; each ring is added, or taken away if it lies in an odd number of others."""
    after = defaultdict(list)
    for i, j in np.asarray(segments).tolist():
        after[i].append(j)
        after[j].append(i)
    exact = [[Fraction(float(x)) for x in q] for q in points]
    rings, seen = [], set()
    for start in after:
        if start in seen:
            continue
        ring, at, before = [], start, None
        while at not in seen:
            seen.add(at)
            ring.append(at)
            onward = [v for v in after[at] if v != before]
            before, at = at, onward[0]
        rings.append(ring)

    def contains(ring, q):
        inside = False
        for u, v in zip(ring, [*ring[1:], ring[0]], strict=True):
            (ux, uy), (vx, vy) = exact[u], exact[v]
            if (uy > q[1]) != (vy > q[1]):
                x = ux + (q[1] - uy) * (vx - ux) / (vy - uy)
                inside ^= x > q[0]
        return inside

    total = Fraction(0)
    for ring in rings:
        twice = sum(
            exact[u][0] * exact[v][1] - exact[v][0] * exact[u][1]
            for u, v in zip(ring, [*ring[1:], ring[0]], strict=True)
        )
        depth = sum(contains(other, exact[ring[0]]) for other in rings if other is not ring)
        total += (-1) ** depth * abs(twice) / 2
    return total
