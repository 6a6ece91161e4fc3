"""Vertices of a mesh that a periodic boundary makes one."""

from __future__ import annotations

import numpy as np

from adaptmesh.domain.sides.periodic import PeriodicPair, PeriodicSides
from adaptmesh.types import Ints

from .data import MeshData


def periodic_vertices(mesh: MeshData, pair: PeriodicPair | PeriodicSides) -> Ints:
    """Vertices (k, 2) of a mesh on the first boundary, and their images on the second."""
    from scipy.spatial import KDTree

    first, second = (np.unique(mesh.edges_named(name)) for name in (pair.first, pair.second))
    images = pair.motion(mesh.points[first])
    _, at = KDTree(mesh.points[second]).query(images)
    return np.stack([first, second[at]], axis=1).astype(np.int32)
