"""Vertices and edges that every mesh of a domain has: what Medit calls required."""

from __future__ import annotations

import numpy as np

from adaptmesh.domain.projection import tolerance_of
from adaptmesh.mesh.mesh import Mesh
from adaptmesh.topology import edge_keys
from adaptmesh.types import Ints


def required_items(mesh: Mesh) -> tuple[Ints, Ints]:
    """Numbers of the vertices, and of the rows of `Mesh.edges`, that have to stay.

    Those at points of the domain and on its frozen segments; or as the mesh has them from a file.
    """
    if mesh.domain is None:
        return mesh.required_points, mesh.required_edges
    from scipy.spatial import KDTree

    domain = mesh.domain
    tolerance = tolerance_of(domain)
    distance, vertex = KDTree(mesh.points).query(domain.points)
    there = distance <= tolerance
    points = np.unique(vertex[there & domain.curved.is_vertex])

    ends = domain.segments[domain.segment_is_frozen]
    ends = vertex[ends[there[ends].all(axis=1)]]
    n = len(mesh.points)
    edges = np.isin(edge_keys(mesh.edges, n), edge_keys(ends, n))
    return points.astype(np.int32), np.flatnonzero(edges).astype(np.int32)
