"""The constrained edges of a mesh in polylines, each matched with the side of the domain it is on.

::

    A---o---o-----o--o---o---B      a side of the domain from A to B, and a mesh's polyline along it

Only the corners of the domain are looked up by coordinates. From there a polyline is followed from
edge to edge, and one from A to B belongs to the side from A to B: what lies near to what plays no
part in it, so that sides may be as near to each other, and as short, as they like. Where several
sides join the same two corners, the distances of the vertices tell them apart.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from scipy.optimize import linear_sum_assignment

from adaptmesh.domain.projection import project
from adaptmesh.domain.sides.side import Sides
from adaptmesh.topology import edge_keys
from adaptmesh.types import Floats, Index, Int64s


class Polyline(NamedTuple):
    """Edges of a mesh end to end.

    Attributes
    ----------
    vertices : (k + 1,) array of int
        From a corner of the domain, or from where it comes to an end.
    edges : (k,) array of int
        Numbers of constrained edges.
    """

    vertices: Int64s
    edges: Int64s

    @property
    def inner(self) -> Int64s:
        """The vertices but the first and the last."""
        return self.vertices[1:-1]

    def reversed(self) -> Polyline:
        """The same polyline from its other end."""
        return Polyline(self.vertices[::-1], self.edges[::-1])


def followed(edges: Index, corner: Index) -> list[Polyline]:
    """All polylines of edges (e, 2); `corner` has for each vertex its number as a corner, or -1.

    A polyline ends at corners, and where other than two edges meet.
    """
    at: dict[int, list[int]] = {}
    pairs = edges.tolist()
    for e, (a, b) in enumerate(pairs):
        at.setdefault(a, []).append(e)
        at.setdefault(b, []).append(e)
    is_end = {v for v, mine in at.items() if corner[v] >= 0 or len(mine) != 2}
    walked = [False] * len(pairs)
    out = []
    for start in [*(v for v in at if v in is_end), *at]:  # what is left then is closed
        for first in at[start]:
            if walked[first]:
                continue
            vertices, mine, e = [start], [], first
            while True:
                walked[e] = True
                mine.append(e)
                a, b = pairs[e]
                v = b if vertices[-1] == a else a
                vertices.append(v)
                if v in is_end or v == start:
                    break
                e = next((other for other in at[v] if not walked[other]), -1)
                if e < 0:  # an edge listed twice
                    break
            out.append(Polyline(np.array(vertices, np.int64), np.array(mine, np.int64)))
    return out


class Matching(NamedTuple):
    """Which polyline stands for which side.

    Attributes
    ----------
    of_side : list of Polyline or None
        That of each side, from its first corner to its second, or None.
    others : list of Polyline
        Those that belong to no side.
    """

    of_side: list[Polyline | None]
    others: list[Polyline]


def matched(
    points: Floats, polylines: list[Polyline], corner: Index, sides: Sides, tolerance: float
) -> Matching:
    """Find the polyline of each side.

    Parameters
    ----------
    points : (n, 2) array
        Of the mesh.
    polylines : list of Polyline
    corner : (n,) array of int
        The corner of the domain that each vertex is, or -1.
    sides : Sides
    tolerance : float
        How far off its side a vertex may be.
    """
    number = np.full(len(sides), -1)
    at_ends = np.array([corner[p.vertices[[0, -1]]] for p in polylines]).reshape(-1, 2)
    whole = np.flatnonzero((at_ends >= 0).all(axis=1))
    n = int(max(at_ends.max(initial=-1), sides.ends.max(initial=-1))) + 1
    sides_by_ends = _grouped(sides.ends, n)
    for key, some in _grouped(at_ends[whole], n).items():
        mine, candidates = whole[some], sides_by_ends.get(key)
        if candidates is None:
            continue
        if len(mine) > 1 or len(candidates) > 1:
            off = _distances(points, [polylines[k] for k in mine], candidates, sides, tolerance)
            row, column = linear_sum_assignment(off)
            mine, candidates = mine[row], candidates[column]
        number[candidates] = mine
    of_side = [
        _directed(points, polylines[k], corner, sides, side, tolerance) if k >= 0 else None
        for side, k in enumerate(number.tolist())
    ]
    taken = set(number.tolist())
    return Matching(of_side, [p for k, p in enumerate(polylines) if k not in taken])


def _distances(
    points: Floats, polylines: list[Polyline], candidates: Index, sides: Sides, tolerance: float
) -> Floats:
    """How far polylines are from sides, (p, s); one without inner vertices by its middle."""
    out = np.empty((len(polylines), len(candidates)))
    for i, polyline in enumerate(polylines):
        p = points[polyline.inner]
        if not len(p):
            p = points[polyline.vertices].mean(axis=0, keepdims=True)
        for j, side in enumerate(candidates.tolist()):
            off = project(sides, np.full(len(p), side), p, tolerance).off
            out[i, j] = off.mean() + tolerance * np.sum(off > tolerance)
    return out


def _directed(
    points: Floats, polyline: Polyline, corner: Index, sides: Sides, side: int, tolerance: float
) -> Polyline:
    """A polyline in the direction of its side."""
    begin, end = sides.ends[side]
    if begin != end:
        return polyline if corner[polyline.vertices[0]] == begin else polyline.reversed()
    inner = polyline.inner
    u = project(sides, np.full(len(inner), side), points[inner], tolerance).u
    u = u[~np.isnan(u)]
    return polyline if np.sum(np.diff(u) > 0) >= np.sum(np.diff(u) < 0) else polyline.reversed()


def _grouped(pairs: Index, n: int) -> dict[int, Index]:
    """The numbers of the pairs (k, 2) with each key; see `edge_keys`."""
    if not len(pairs):
        return {}
    keys = edge_keys(pairs, n)
    order = np.argsort(keys, kind="stable")
    first = np.flatnonzero(np.diff(keys[order], prepend=-1))
    groups = np.split(order, first[1:])
    return dict(zip(keys[order][first].tolist(), groups, strict=True))
