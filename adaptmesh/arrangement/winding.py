"""How often each ring goes around each face.

+-----------+          Crossing an edge of a ring from its right to its left raises the
|  1  +-----+----+     winding number by one. From the outside, where all are zero, a walk
|     |  2  | 1  |     over the faces gives those of every face.
+-----+-----+    |
      +----------+
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from .faces import Faces

Ints = NDArray[np.int64]


def winding_numbers(faces: Faces, edge: Ints, sign: Ints, ring: Ints) -> list[dict[int, int]]:
    """For each face the rings that wind around it, and how often.

    Parameters
    ----------
    faces : Faces
    edge, sign, ring : (p,) arrays
        The edge of each piece of a ring, whether it runs along (1) or against it (-1), and the
        ring.
    """
    edge, ring, net = net_passes(edge, sign, ring)
    order, before, through = walk(faces)
    numbers: list[dict[int, int]] = [{} for _ in range(faces.count)]
    start = np.searchsorted(edge, through)
    stop = np.searchsorted(edge, through, side="right")
    forward = faces.left[through] == order
    rings, nets = ring.tolist(), net.tolist()
    steps = (column.tolist() for column in (order, before, start, stop, forward))
    for face, previous, i, j, into_left in zip(*steps, strict=True):
        here = dict(numbers[previous])
        for k in range(i, j):
            number = here.pop(rings[k], 0) + (nets[k] if into_left else -nets[k])
            if number:
                here[rings[k]] = number
        numbers[face] = here
    return numbers


def net_passes(edge: Ints, sign: Ints, ring: Ints) -> tuple[Ints, Ints, Ints]:
    """Edges, rings along them, and how often more along than against; sorted by edge."""
    order = np.lexsort((ring, edge))
    edge, ring, sign = edge[order], ring[order], sign[order]
    start = np.flatnonzero(np.append(True, (edge[1:] != edge[:-1]) | (ring[1:] != ring[:-1])))
    return edge[start], ring[start], np.add.reduceat(sign, start)


def walk(faces: Faces) -> tuple[Ints, Ints, Ints]:
    """All faces but the outside in an order of visit; where from, and through which edge."""
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
    wanted = np.minimum(order, before) * n + np.maximum(order, before)
    return order, before, first[np.searchsorted(keys, wanted)]
