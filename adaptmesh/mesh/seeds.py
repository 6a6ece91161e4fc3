"""The parts that the edges of a mesh divide the plane into: holes, regions, and what lies beside.

A point in each says to a triangulation of the edges alone what is what.
"""

from __future__ import annotations

import numpy as np

from adaptmesh._core import InputError, triangulate
from adaptmesh.domain.inputs import rows_of_each
from adaptmesh.errors import DomainError
from adaptmesh.geometry.containing import containing_triangles
from adaptmesh.geometry.products import cross
from adaptmesh.topology import edge_keys, half_edges, parts_between
from adaptmesh.types import Floats, Ints

from .data import MeshData


def seeds_in(mesh: MeshData) -> tuple[Floats, dict[int, Floats]]:
    """Points (k, 2) in holes, and by number in the parts of each region but 0.

    From these and the constrained edges alone follows what the mesh covers; where part of its
    border is not constrained, as in files of some programs, it does not, and there are none.
    """
    if not _border_is_constrained(mesh):
        return np.empty((0, 2)), {}
    used, renumbered = np.unique(mesh.edges, return_inverse=True)
    segments = renumbered.reshape(-1, 2).astype(np.int32)
    return hole_points(mesh, mesh.points[used], segments), region_points(mesh, mesh.edges)


def _border_is_constrained(mesh: MeshData) -> bool:
    n = len(mesh.points)
    halves, _ = half_edges(mesh.triangles)
    keys, count = np.unique(edge_keys(halves, n), return_counts=True)
    constrained = edge_keys(mesh.edges, n)
    return bool(np.isin(keys[count == 1], constrained).all())


def hole_points(mesh: MeshData, points: Floats, segments: Ints) -> Floats:
    """A point inside every hole: those parts of the filled outline that the mesh does not cover."""
    nowhere = np.empty((0, 2))
    try:
        filled, _, pieces, _, _ = triangulate(points, segments, nowhere, nowhere, False)
    except InputError as fault:
        *_, x, y = fault.args
        raise DomainError(
            f"the mesh lies over itself near ({x:.17g}, {y:.17g}), so it covers no domain; its "
            "validate() lists what is wrong"
        ) from None
    part = parts_between(filled, pieces, len(points))

    # The largest triangle of each part stands for it.
    p = points[filled]
    u, v = p[:, 1] - p[:, 0], p[:, 2] - p[:, 0]
    by_area = np.argsort(cross(u, v))[::-1]
    _, first = np.unique(part[by_area], return_index=True)
    centres = p[by_area[first]].mean(axis=1)
    return centres[containing_triangles(mesh.points, mesh.triangles, centres) < 0]


def region_points(mesh: MeshData, edges: Ints) -> dict[int, Floats]:
    """For each region but 0 a point in each of its parts."""
    part = parts_between(mesh.triangles, edges, len(mesh.points))
    by_area = np.argsort(mesh.areas)[::-1]
    by_area = by_area[mesh.regions[by_area] != 0]
    kind = mesh.regions[by_area].astype(np.int64) * (int(part.max()) + 1) + part[by_area]
    _, first = np.unique(kind, return_index=True)  # the largest triangle of each
    largest = by_area[first]
    places = mesh.points[mesh.triangles[largest]].mean(axis=1)
    return {r: places[rows] for r, rows in rows_of_each(mesh.regions[largest]).items()}
