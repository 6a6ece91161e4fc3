"""The constrained edges of a mesh in rows, each matched with the line of the domain it stands for.

::

    A---o---o-----o--o---o---B      a line of the domain from A to B, and a mesh's row along it

Only the corners of the domain are looked up by coordinates. From there a row is followed from edge
to edge, and a row from A to B belongs to the line from A to B: what lies near to what plays no part
in it, so that lines may be as near to each other, and as short, as they like. Where several lines
join the same two corners, the distances of their vertices tell them apart.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple

import numpy as np
from scipy.optimize import linear_sum_assignment

from adaptmesh.topology import edge_keys
from adaptmesh.types import Floats, Index, Int64s

if TYPE_CHECKING:
    from collections.abc import Callable


class Row(NamedTuple):
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

    def reversed(self) -> Row:
        """The same row from its other end."""
        return Row(self.vertices[::-1], self.edges[::-1])


def rows_of(edges: Index, corner: Index) -> list[Row]:
    """All rows of edges (e, 2); `corner` has for each vertex its number as a corner, or -1.

    A row ends at corners, and where other than two edges meet.
    """
    at: dict[int, list[int]] = {}
    pairs = edges.tolist()
    for e, (a, b) in enumerate(pairs):
        at.setdefault(a, []).append(e)
        at.setdefault(b, []).append(e)
    is_end = {v for v, mine in at.items() if corner[v] >= 0 or len(mine) != 2}
    walked = [False] * len(pairs)
    rows = []
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
            rows.append(Row(np.array(vertices, np.int64), np.array(mine, np.int64)))
    return rows


def rows_of_lines(
    rows: list[Row],
    corner: Index,
    ends: Index,
    distances: Callable[[Index, Index], Floats],
) -> Int64s:
    """The row of each line, (l,), -1 where there is none; lines have these corners at their ends.

    ``distances(rows, lines)`` says how far each row is from each line, by number, (r, l); it is
    asked only where several rows or lines join the same two corners.
    """
    out = np.full(len(ends), -1, np.int64)
    at_ends = np.array([corner[row.vertices[[0, -1]]] for row in rows]).reshape(-1, 2)
    whole = np.flatnonzero((at_ends >= 0).all(axis=1))
    n = int(max(at_ends.max(initial=-1), ends.max(initial=-1))) + 1
    rows_by_ends, lines_by_ends = _grouped(at_ends[whole], n), _grouped(ends, n)
    for key, some in rows_by_ends.items():
        mine, candidates = whole[some], lines_by_ends.get(key)
        if candidates is None:
            continue
        if len(mine) > 1 or len(candidates) > 1:
            row, line = linear_sum_assignment(distances(mine, candidates))
            mine, candidates = mine[row], candidates[line]
        out[candidates] = mine
    return out


def _grouped(pairs: Index, n: int) -> dict[int, Index]:
    """The numbers of the pairs (k, 2) with each key; see `edge_keys`."""
    if not len(pairs):
        return {}
    keys = edge_keys(pairs, n)
    order = np.argsort(keys, kind="stable")
    first = np.flatnonzero(np.diff(keys[order], prepend=-1))
    groups = np.split(order, first[1:])
    return dict(zip(keys[order][first].tolist(), groups, strict=True))
