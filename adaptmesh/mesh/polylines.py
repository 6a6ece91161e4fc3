"""The constrained edges of a mesh in polylines, each matched with the side of the domain it is on.

::

    A---o---o-----o--o---o---B      a side of the domain from A to B, and a mesh's polyline along it

Only the corners of the domain are looked up by coordinates. From there a polyline is followed from
edge to edge, and one from A to B belongs to the side from A to B: what lies near to what plays no
part in it, so that sides may be as near to each other, and as short, as they like. Where several
sides join the same two corners, the distances of the vertices tell them apart.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import NamedTuple

import numpy as np
from scipy.optimize import linear_sum_assignment

from adaptmesh.domain.projection import Projection, project
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
    groups = []
    for key, some in _grouped(at_ends[whole], n).items():
        mine, candidates = whole[some], sides_by_ends.get(key)
        if candidates is None:
            continue
        if len(mine) > 1 or len(candidates) > 1:
            groups.append((mine, candidates))
        else:
            number[candidates] = mine
    tables = _distances(points, polylines, groups, sides, tolerance)
    for (mine, candidates), off in zip(groups, tables, strict=True):
        row, column = linear_sum_assignment(off)
        number[candidates[column]] = mine[row]
    of_side = [polylines[k] if k >= 0 else None for k in number.tolist()]
    taken = set(number.tolist())
    others = [p for k, p in enumerate(polylines) if k not in taken]
    return Matching(_directed(points, of_side, corner, sides, tolerance), others)


def _distances(
    points: Floats,
    polylines: list[Polyline],
    groups: Sequence[tuple[Index, Index]],
    sides: Sides,
    tolerance: float,
) -> list[Floats]:
    """How far the polylines (p,) of each group are from its sides (s,), (p, s) for each group.

    One without inner vertices is as far as its middle.
    """
    pairs = [
        (k, side)
        for mine, candidates in groups
        for k in mine.tolist()
        for side in candidates.tolist()
    ]
    places = {k: _places_along(points, polylines[k]) for k, _ in pairs}
    projected = _projected(sides, [(side, places[k]) for k, side in pairs], tolerance)
    off = [each.off.mean() + tolerance * np.sum(each.off > tolerance) for each in projected]
    shapes = [(len(mine), len(candidates)) for mine, candidates in groups]
    first = np.cumsum([0, *(p * s for p, s in shapes)])
    return [
        np.reshape(off[begin:end], shape)
        for begin, end, shape in zip(first[:-1], first[1:], shapes, strict=True)
    ]


def _places_along(points: Floats, polyline: Polyline) -> Floats:
    """The inner vertices, or else the middle."""
    inner = points[polyline.inner]
    return inner if len(inner) else points[polyline.vertices].mean(axis=0, keepdims=True)


def _directed(
    points: Floats,
    of_side: list[Polyline | None],
    corner: Index,
    sides: Sides,
    tolerance: float,
) -> list[Polyline | None]:
    """The polyline of each side, in the direction of the side."""
    is_backward = [
        p is not None and corner[p.vertices[0]] != begin
        for p, begin in zip(of_side, sides.ends[:, 0], strict=True)
    ]
    closed = np.flatnonzero(sides.ends[:, 0] == sides.ends[:, 1]).tolist()
    asked = [(side, points[p.inner]) for side in closed if (p := of_side[side]) is not None]
    for (side, _), (u, _) in zip(asked, _projected(sides, asked, tolerance), strict=True):
        du = np.diff(u[~np.isnan(u)])
        is_backward[side] = bool(np.sum(du > 0) < np.sum(du < 0))
    return [
        p.reversed() if p is not None and back else p
        for p, back in zip(of_side, is_backward, strict=True)
    ]


def _projected(sides: Sides, asked: list[tuple[int, Floats]], tolerance: float) -> list[Projection]:
    """For each of (side, points) the points projected on the side; all at once.

    To project each apart would look through all sides each time.
    """
    if not asked:
        return []
    counts = [len(p) for _, p in asked]
    side = np.repeat([side for side, _ in asked], counts)
    u, off = project(sides, side, np.concatenate([p for _, p in asked]), tolerance)
    last = np.cumsum(counts)[:-1]
    return [Projection(*each) for each in zip(np.split(u, last), np.split(off, last), strict=True)]


def _grouped(pairs: Index, n: int) -> dict[int, Index]:
    """The numbers of the pairs (k, 2) with each key; see `edge_keys`."""
    if not len(pairs):
        return {}
    keys = edge_keys(pairs, n)
    order = np.argsort(keys, kind="stable")
    first = np.flatnonzero(np.diff(keys[order], prepend=-1))
    groups = np.split(order, first[1:])
    return dict(zip(keys[order][first].tolist(), groups, strict=True))
