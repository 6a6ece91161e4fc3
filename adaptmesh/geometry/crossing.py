"""Which edges have more in common than an end, by exact signs."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from adaptmesh._core import orient2d
from adaptmesh.types import Bools, Floats, Index, Int64s


def meet(points: Floats, e: Index, f: Index) -> Int64s:
    """Which of the pairs of edges e (k, 2) and f (k, 2) have more in common than an end."""

    def orient(a: Index, b: Index, c: Index) -> NDArray[np.int8]:
        return np.asarray(orient2d(points[a], points[b], points[c]))

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
