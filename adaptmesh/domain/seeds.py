"""The parts that the edges of a mesh divide the plane into: holes, regions, and what lies beside.

A point in each says to a triangulation of the edges alone what is what.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from adaptmesh._core import Fault, triangulate
from adaptmesh.errors import DomainError
from adaptmesh.geometry.containing import containing_triangles
from adaptmesh.mesh.mesh import Mesh
from adaptmesh.mesh.validate.subject import edge_keys
from adaptmesh.types import Floats, Ints

from .inputs import rows_of_each

OUTSIDE = -(2**40)  # a number that no region has


def seeds_in(mesh: Mesh) -> tuple[Floats, dict[int, Floats]]:
    """Points (k, 2) in holes, and by number in the parts of each region but 0.

    From these and the constrained edges alone follows what the mesh covers; where part of its
    border is not constrained, as in files of some programs, it does not, and there are none.
    """
    if not _border_is_constrained(mesh):
        return np.empty((0, 2)), {}
    used, renumbered = np.unique(mesh.edges, return_inverse=True)
    segments = renumbered.reshape(-1, 2).astype(np.int32)
    return hole_points(mesh, mesh.points[used], segments), region_points(mesh, mesh.edges)


def _border_is_constrained(mesh: Mesh) -> bool:
    n = len(mesh.points)
    halves, _ = _half_edges(mesh.triangles)
    keys, count = np.unique(edge_keys(halves[:, 0], halves[:, 1], n), return_counts=True)
    constrained = edge_keys(mesh.edges[:, 0], mesh.edges[:, 1], n)
    return bool(np.isin(keys[count == 1], constrained).all())


def hole_points(mesh: Mesh, points: Floats, segments: Ints) -> Floats:
    """A point inside every hole: those parts of the filled outline that the mesh does not cover."""
    nowhere = np.empty((0, 2))
    try:
        filled, _, pieces, _, _ = triangulate(points, segments, nowhere, nowhere, False)
    except Fault as fault:
        *_, x, y = fault.args
        raise DomainError(
            f"the mesh lies over itself near ({x:.17g}, {y:.17g}), so it covers no domain; its "
            "validate() lists what is wrong"
        ) from None
    part = parts_between(filled, pieces, len(points))

    # The largest triangle of each part stands for it.
    p = points[filled]
    u, v = p[:, 1] - p[:, 0], p[:, 2] - p[:, 0]
    by_area = np.argsort(u[:, 0] * v[:, 1] - u[:, 1] * v[:, 0])[::-1]
    _, first = np.unique(part[by_area], return_index=True)
    centres = p[by_area[first]].mean(axis=1)
    return centres[containing_triangles(mesh.points, mesh.triangles, centres) < 0]


def region_points(mesh: Mesh, edges: Ints) -> dict[int, Floats]:
    """For each region but 0 a point in each of its parts."""
    part = parts_between(mesh.triangles, edges, len(mesh.points))
    by_area = np.argsort(mesh.areas)[::-1]
    by_area = by_area[mesh.regions[by_area] != 0]
    kind = mesh.regions[by_area].astype(np.int64) * (int(part.max()) + 1) + part[by_area]
    _, first = np.unique(kind, return_index=True)  # the largest triangle of each
    largest = by_area[first]
    places = mesh.points[mesh.triangles[largest]].mean(axis=1)
    return {r: places[rows] for r, rows in rows_of_each(mesh.regions[largest]).items()}


def parts_between(triangles: Ints, walls: Ints, n_points: int) -> NDArray[np.intp]:
    """The number of the part that each triangle is in; edges (w, 2) are walls between parts."""
    from scipy.sparse import coo_array
    from scipy.sparse.csgraph import connected_components

    halves, owner = _half_edges(triangles)
    keys = edge_keys(halves[:, 0], halves[:, 1], n_points)
    order = np.argsort(keys, kind="stable")
    keys, owner = keys[order], owner[order]
    same = np.flatnonzero(keys[:-1] == keys[1:])
    open_ = same[~np.isin(keys[same], edge_keys(walls[:, 0], walls[:, 1], n_points))]
    links = owner[open_], owner[open_ + 1]
    graph = coo_array((np.ones(len(open_)), links), shape=(len(triangles), len(triangles)))
    return connected_components(graph, directed=False)[1]


def regions_beside(triangles: Ints, regions: Ints, edges: Ints, n_points: int) -> Ints:
    """The regions on the left and right of each edge, (e, 2), `OUTSIDE` for the outside."""
    beside = triangles_beside(triangles, edges, n_points)
    return np.append(regions.astype(np.int64), OUTSIDE)[np.stack(beside, axis=1)]


def triangles_beside(triangles: Ints, edges: Ints, n_points: int) -> tuple[Ints, Ints]:
    """The triangle on the left and on the right of each edge, -1 where there is none."""
    halves, owner = _half_edges(triangles)
    keys = halves[:, 0].astype(np.int64) * n_points + halves[:, 1]
    order = np.argsort(keys)
    keys, owner = keys[order], owner[order]

    def left_of(a: Ints, b: Ints) -> Ints:
        wanted = a.astype(np.int64) * n_points + b
        at = np.minimum(np.searchsorted(keys, wanted), len(keys) - 1)
        return np.where(keys[at] == wanted, owner[at], -1).astype(np.int32)

    return left_of(edges[:, 0], edges[:, 1]), left_of(edges[:, 1], edges[:, 0])


def _half_edges(triangles: Ints) -> tuple[Ints, Ints]:
    """The directed edges of all triangles, (3 m, 2), and the triangle of each."""
    halves = np.concatenate([triangles[:, [1, 2]], triangles[:, [2, 0]], triangles[:, [0, 1]]])
    return halves, np.tile(np.arange(len(triangles), dtype=np.int32), 3)
