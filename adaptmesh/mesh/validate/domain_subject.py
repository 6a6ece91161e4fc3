"""A mesh and its domain: which of its vertices and edges stand for what of the domain."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np

from adaptmesh.domain.domain import Domain
from adaptmesh.domain.projection import Projection, project, shape_of, tolerance_of
from adaptmesh.domain.sides.side import Sides
from adaptmesh.mesh.boundary_polylines import vertices_at
from adaptmesh.mesh.polylines import Matching, followed, matched
from adaptmesh.types import Bools, Index, Int64s

from .subject import Subject


@dataclass(frozen=True)
class DomainSubject(Subject):
    """A mesh that is held against its domain.

    ``given_tolerance`` says how far off their lines vertices may be, `tolerance_of` if None.
    """

    given_tolerance: float | None = None

    @property
    def domain(self) -> Domain:
        """The domain of the mesh; only meshes that have one are held against it."""
        if self.mesh.domain is None:
            raise ValueError("the mesh has no domain")
        return self.mesh.domain

    @cached_property
    def tolerance(self) -> float:
        """How far off its line a vertex may be, in the units of the mesh."""
        given = self.given_tolerance
        return tolerance_of(self.domain) if given is None else given

    @cached_property
    def domain_sides(self) -> Sides:
        """The sides of the domain."""
        return self.domain.all_sides

    @cached_property
    def vertices(self) -> Int64s:
        """The vertex at each corner of the domain, (c,), -1 where there is none.

        One with the very coordinates, or else the nearest that is no other corner and within the
        tolerance.
        """
        from scipy.spatial import KDTree

        corners = self.domain_sides.corners
        out = vertices_at(self.mesh, corners).astype(np.int64)
        missing = np.flatnonzero(out < 0)
        left = np.setdiff1d(np.arange(len(self.mesh.points)), out)
        if len(missing) and len(left):
            off, nearest = KDTree(self.mesh.points[left]).query(corners[missing])
            nearest = np.where(off <= self.tolerance, left[np.minimum(nearest, len(left) - 1)], -1)
            _, once = np.unique(nearest, return_index=True)
            out[missing[once]] = nearest[once]
        return out

    @cached_property
    def corner(self) -> Int64s:
        """The corner of the domain that each vertex is, (n,), or -1."""
        out = np.full(len(self.mesh.points), -1, np.int64)
        found = np.flatnonzero(self.vertices >= 0)
        out[self.vertices[found]] = found
        return out

    @cached_property
    def polylines(self) -> Matching:
        """All constrained edges, in polylines between corners, and the one of each side."""
        found = followed(self.mesh.edges, self.corner)
        return matched(self.mesh.points, found, self.corner, self.domain_sides, self.tolerance)

    def project(self, side: Index, vertex: Index) -> Projection:
        """Where vertices (k,) are on sides (k,)."""
        return project(self.domain_sides, side, self.mesh.points[vertex], self.tolerance)

    @cached_property
    def missing(self) -> Int64s:
        """The sides that have no polyline."""
        return np.array([k for k, p in enumerate(self.polylines.of_side) if p is None], np.int64)

    @cached_property
    def is_on_missing_side(self) -> Bools:
        """Which constrained edges lie on a side that has no polyline: parts of a broken one."""
        import shapely

        out = np.zeros(len(self.mesh.edges), bool)
        edges = np.concatenate([np.empty(0, np.int64), *(p.edges for p in self.polylines.others)])
        if not len(self.missing) or not len(edges):
            return out
        near = [shape_of(self.domain_sides, side) for side in self.missing.tolist()]
        tree = shapely.STRtree(shapely.linestrings(self.mesh.points[self.mesh.edges[edges]]))
        straight = self.domain_sides.is_straight[self.missing]
        reach = np.where(straight, 0.0, 0.1 * shapely.length(near))
        side, edge = tree.query(near, "dwithin", distance=reach + self.tolerance)
        ends = self.mesh.edges[edges[edge]]
        off = [self.project(self.missing[side], ends[:, i]).off for i in (0, 1)]
        out[edges[edge[np.max(off, axis=0) <= self.tolerance]]] = True
        return out

    def side_text(self, side: int) -> str:
        """A side in words: what it is and where it begins and ends."""
        segment = int(self.domain_sides.segments[side])
        ends = self.domain_sides.corners[self.domain_sides.ends[side]]
        along = np.diff(self.domain.points[self.domain.segments[segment]], axis=0)[0]
        if self.domain_sides.is_straight[side] and (ends[1] - ends[0]) @ along < 0:
            ends = ends[::-1]  # in the direction in which the segment was given
        (x0, y0), (x1, y1) = ends.tolist()
        curve = int(self.domain.curved.segment_curves[segment])
        what = f"segment {segment}" if curve < 0 else self.domain.curved.describe(segment)
        return f"{what} from ({x0!r}, {y0!r}) to ({x1!r}, {y1!r})"
