"""Edges of triangles: which there are, and which are on the border."""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike

import metrics._core as _core

from .checks import as_triangles
from .types import Ints

__all__ = ["border_edges", "mesh_edges"]

_SPARSE = 16  # with so many times more numbers than corners, most have no triangle


def mesh_edges(triangles: ArrayLike) -> tuple[Ints, Ints]:
    """The edges of triangles, each once, and which of them each triangle has.

    Returns
    -------
    edges : (e, 2) array of int32
        Smaller vertex number first, sorted.
    sides : (m, 3) array of int32
        ``sides[t, i]`` is the number of the edge opposite vertex i of triangle t.
    """
    t = as_triangles(triangles, np.iinfo(np.int32).max)
    count = int(t.max(initial=-1)) + 1
    if count <= _SPARSE * t.size:
        return _core.mesh_edges(t, count)
    used, dense = np.unique(t, return_inverse=True)
    edges, sides = _core.mesh_edges(dense.reshape(-1, 3).astype(np.int32), len(used))
    return used[edges], sides


def border_edges(triangles: ArrayLike) -> Ints:
    """The edges with one triangle only, (k, 2)."""
    edges, sides = mesh_edges(triangles)
    return edges[np.bincount(sides.ravel(), minlength=len(edges)) == 1]
