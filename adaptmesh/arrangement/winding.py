"""Winding numbers of rings around faces.

+-----------+          Crossing an edge of a ring from its right to its left raises the
|  1  +-----+----+     winding number by one. From the outside, where all are zero, a walk
|     |  2  | 1  |     over the faces gives the numbers of every face.
+-----+-----+    |
      +----------+
"""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Iterator

import numpy as np

from adaptmesh.types import Int64s

from .faces import Faces

Passes = tuple[Int64s, Int64s, Int64s]


def winding_changes(faces: Faces, passes: Passes) -> Iterator[tuple[int, dict[int, int]]]:
    """Visit all faces but the outside, with the changes of winding numbers since the last face.

    There are at most twice as many changes as passes, however deep rings are nested.

    Parameters
    ----------
    faces : Faces
    passes : (edge, ring, net) arrays
        As returned by `sum_passes`.

    Yields
    ------
    face : int
    changes : dict of int to int
        The change for each ring. Before the first face all winding numbers are zero.
    """
    edge, ring, net = passes
    order, before, through = walk(faces)
    start = np.searchsorted(edge, through).tolist()
    stop = np.searchsorted(edge, through, side="right").tolist()
    into_left = np.where(faces.left[through] == order, 1, -1).tolist()
    rings, nets = ring.tolist(), net.tolist()
    step_to = {face: k for k, face in enumerate(order.tolist())}
    next_to: dict[int, list[int]] = defaultdict(list)
    for face, previous in zip(order.tolist(), before.tolist(), strict=True):
        next_to[previous].append(face)

    changes: dict[int, int] = defaultdict(int)
    todo = [(face, 1) for face in next_to[0]]
    while todo:
        face, way = todo.pop()  # way: 1 into the face, -1 back out of it
        k = step_to[face]
        for i in range(start[k], stop[k]):
            changes[rings[i]] += way * into_left[k] * nets[i]
        if way == 1:
            yield face, changes
            changes = defaultdict(int)
            todo.append((face, -1))
            todo += [(beyond, 1) for beyond in next_to[face]]


def sum_passes(edge: Int64s, sign: Int64s, ring: Int64s) -> Passes:
    """Return edges, rings along them, and the passes along less those against, sorted by edge."""
    order = np.lexsort((ring, edge))
    edge, ring, sign = edge[order], ring[order], sign[order]
    start = np.flatnonzero(np.append(True, (edge[1:] != edge[:-1]) | (ring[1:] != ring[:-1])))
    return edge[start], ring[start], np.add.reduceat(sign, start)


def walk(faces: Faces) -> tuple[Int64s, Int64s, Int64s]:
    """Return an order of all faces but the outside, the face before each, and the edge between."""
    from scipy.sparse import coo_array
    from scipy.sparse.csgraph import breadth_first_order

    n = faces.count
    low, high = np.minimum(faces.left, faces.right), np.maximum(faces.left, faces.right)
    keys, first = np.unique(low * n + high, return_index=True)
    keys, first = keys[keys // n != keys % n], first[keys // n != keys % n]
    ends = (keys // n, keys % n)
    graph = coo_array((np.ones(len(keys)), ends), shape=(n, n)).tocsr()
    order, before = breadth_first_order(graph, 0, directed=False)
    order = order[1:].astype(np.int64)
    before = before[order].astype(np.int64)
    face_pairs = np.minimum(order, before) * n + np.maximum(order, before)
    return order, before, first[np.searchsorted(keys, face_pairs)]
