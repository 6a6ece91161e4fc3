"""The polylines of a mesh along the sides of its domain, if it is a mesh of this domain."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from adaptmesh import ragged
from adaptmesh.domain.data import DomainData
from adaptmesh.domain.projection import project, tolerance_of
from adaptmesh.topology import edge_keys
from adaptmesh.types import Floats, Index, Ints

from .data import MeshData
from .polylines import followed, matched


@dataclass(frozen=True)
class BoundaryPolylines:
    """A polyline of vertices along each side.

    Attributes
    ----------
    vertices : (c,) array of int32
        All polylines, one after the other, each from the first end of its side to the second.
    u : (c,) array of float
        The parameter of each on its side.
    first : (s + 1,) array of int32
        Where the polyline of each side begins.
    """

    vertices: Ints
    u: Floats
    first: Ints

    @property
    def sides(self) -> Index:
        """The side of each vertex of the polylines, (c,)."""
        return ragged.owners(np.diff(self.first))

    @property
    def edges(self) -> Ints:
        """All edges of the polylines, (e, 2)."""
        at = ragged.starts_of_pairs(self.sides)
        return np.stack([self.vertices[at], self.vertices[at + 1]], axis=1)

    @property
    def edge_sides(self) -> Index:
        """The side that each edge lies on, (e,)."""
        side = self.sides
        return side[ragged.starts_of_pairs(side)]


def find_polylines(mesh: MeshData, domain: DomainData) -> BoundaryPolylines | None:
    """The polylines of a mesh along the sides of a domain; None if its edges are others."""
    sides, tolerance = domain.all_sides, tolerance_of(domain)
    vertex = vertices_at(mesh, sides.corners)
    if (vertex < 0).any() or not len(mesh.edges) or _regions_leak(mesh):
        return None
    corner = np.full(len(mesh.points), -1)
    corner[vertex] = np.arange(len(vertex))
    matching = matched(mesh.points, followed(mesh.edges, corner), corner, sides, tolerance)
    polylines = [p for p in matching.of_side if p is not None]
    if matching.others or len(polylines) < len(sides):
        return None
    vertices = np.concatenate([p.vertices for p in polylines])
    first = ragged.offsets(np.array([len(p.vertices) for p in polylines]))
    side = ragged.owners(np.diff(first))
    u, off = np.zeros(len(vertices)), np.zeros(len(vertices))
    u[first[1:] - 1] = sides.lengths
    inner = np.ones(len(vertices), bool)
    inner[first[:-1]] = inner[first[1:] - 1] = False
    u[inner], off[inner] = project(sides, side[inner], mesh.points[vertices[inner]], tolerance)
    in_order = (np.diff(u) > 0)[ragged.starts_of_pairs(side)].all()
    if not in_order or (off > tolerance).any():
        return None
    return BoundaryPolylines(vertices.astype(np.int32), u, first.astype(np.int32))


def vertices_at(mesh: MeshData, points: Floats) -> Ints:
    """The vertex of a mesh at each of these points (k, 2), bit for bit; -1 where there is none."""
    everything = np.concatenate([mesh.points, points]) + 0.0  # -0.0 becomes 0.0
    _, group = np.unique(everything, axis=0, return_inverse=True)
    group = group.ravel()
    vertex = np.full(group.max() + 1, -1, np.int32)
    vertex[group[: len(mesh.points)]] = np.arange(len(mesh.points))
    return vertex[group[len(mesh.points) :]]


def _regions_leak(mesh: MeshData) -> bool:
    """Whether two regions meet without a constrained edge between them."""
    if (mesh.regions == mesh.regions[0]).all():
        return False
    t, n = mesh.triangles, len(mesh.points)
    keys = np.stack([edge_keys(t[:, [i, i - 1]], n) for i in range(3)], axis=1)
    order = np.argsort(keys, axis=None, kind="stable")
    keys, regions = keys.ravel()[order], np.repeat(mesh.regions, 3)[order]
    differ = (keys[1:] == keys[:-1]) & (regions[1:] != regions[:-1])
    constrained = edge_keys(mesh.edges, n)
    return not np.isin(keys[1:][differ], constrained).all()
