"""The faces between noded segments, found by an exact triangulation.

+-------------+   The segments are triangulated within a frame by the core, which proves that they
|   +---+     |   meet only at their ends and reports anything else as a fault. Triangles that
| 0 | 1 |--   |   share an edge that is not a segment belong to one face; face 0 is the outside.
|   +---+     |   A segment with the same face on both sides bounds nothing.
+-------------+
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np

from adaptmesh._core import InputError, triangulate
from adaptmesh.errors import DomainError
from adaptmesh.geometry.containing import containing_triangles
from adaptmesh.geometry.products import cross
from adaptmesh.topology import components, edge_keys, half_edges
from adaptmesh.types import Bools, Floats, Int64s

from .record import point_text


@dataclass(frozen=True)
class Faces:
    """Faces between edges.

    Attributes
    ----------
    points : (n, 2) array
        The points of the edges, then the four of the frame.
    triangles : (m, 3) array
    face : (m,) array
        The face of each triangle.
    left, right : (e,) array
        The faces on the left and right of each edge, directed from its first point to its second.
    """

    points: Floats
    triangles: Int64s
    face: Int64s
    left: Int64s
    right: Int64s

    @property
    def count(self) -> int:
        """Number of faces, the outside included."""
        return int(self.face.max()) + 1

    @cached_property
    def areas(self) -> Floats:
        """Area of each face; the outside is counted up to the frame."""
        return np.bincount(self.face, self._doubled_areas) / 2

    @cached_property
    def inner_points(self) -> Floats:
        """A point in each face, (f, 2): the centroid of its triangle of largest minimal height."""
        p = self.points[self.triangles]
        longest = np.square(p - np.roll(p, 1, axis=1)).sum(axis=2).max(axis=1)
        order = np.lexsort((self._doubled_areas / np.sqrt(longest), self.face))
        last = np.append(self.face[order][1:] != self.face[order][:-1], True)
        return p[order[last]].mean(axis=1)

    def locate(self, points: Floats) -> Int64s:
        """Return the face of each point (k, 2): a face beside it on an edge, 0 out of the frame."""
        found = containing_triangles(self.points, self.triangles, points)
        return np.append(self.face, 0)[found]

    @cached_property
    def _doubled_areas(self) -> Floats:
        p = self.points[self.triangles]
        u, v = p[:, 1] - p[:, 0], p[:, 2] - p[:, 0]
        return cross(u, v)

    def merge_across(self, edges: Bools) -> Int64s:
        """Number the faces that are left without some edges; return the number of each old face."""
        return components(self.count, np.stack([self.left[edges], self.right[edges]], axis=1))


def find_faces(points: Floats, edges: Int64s) -> Faces:
    """Triangulate edges within a frame and number the faces.

    Parameters
    ----------
    points : (n, 2) array
        Distinct points, each an end of an edge.
    edges : (e, 2) array
        Distinct edges, in either direction.

    Raises
    ------
    DomainError
        If they do not meet only at their ends.
    """
    n = len(points)
    low, high = points.min(axis=0), points.max(axis=0)
    margin = float((high - low).max())
    (x0, y0), (x1, y1) = low - margin, high + margin
    framed = np.concatenate([points, [(x0, y0), (x1, y0), (x1, y1), (x0, y1)]])
    frame = n + np.array([(0, 1), (1, 2), (2, 3), (3, 0)])
    segments = np.concatenate([edges, frame]).astype(np.int32)
    none = np.empty((0, 2))
    try:
        triangles, _, pieces, _, _ = triangulate(framed, segments, none, none, False)
    except InputError as fault:
        kind, _, _, x, y = fault.args
        raise DomainError(
            f"{kind.name.replace('_', ' ')} remain at {point_text(x, y)} after the repair: "
            "features there are as small as the rounding of coordinates; choose a larger tolerance"
        ) from fault
    if len(pieces) != len(segments):
        lost = segments[~np.isin(edge_keys(segments, n + 4), edge_keys(pieces, n + 4))][0, 0]
        raise DomainError(
            f"a segment from {point_text(*framed[lost])} passes through other points after the "
            "repair: choose another tolerance"
        )
    corners = triangles.astype(np.int64)
    face, left, right = _faces_between(corners, segments.astype(np.int64), n)
    return Faces(framed, corners, face, left[: len(edges)], right[: len(edges)])


def _faces_between(
    triangles: Int64s, segments: Int64s, corner: int
) -> tuple[Int64s, Int64s, Int64s]:
    """Return the face of each triangle, and the faces on the left and right of each segment.

    The face at the frame's first corner is 0; outside the frame it is -1.
    """
    n = int(segments.max()) + 1
    halves, owner = half_edges(triangles)
    keys = edge_keys(halves, n)
    order = np.argsort(keys, kind="stable")
    keys, owner, upward = keys[order], owner[order], (halves[:, 0] < halves[:, 1])[order]
    segment_keys = edge_keys(segments, n)

    twin = np.flatnonzero(keys[1:] == keys[:-1])
    at_segment = np.searchsorted(np.sort(segment_keys), keys[twin])
    locked = np.append(np.sort(segment_keys), -1)[at_segment] == keys[twin]
    free = twin[~locked]
    face = components(len(triangles), np.stack([owner[free], owner[free + 1]], axis=1))
    outside = face[np.flatnonzero((triangles == corner).any(axis=1))[0]]
    face = np.where(face == outside, 0, np.where(face < outside, face + 1, face))

    first = np.searchsorted(keys, segment_keys)
    last = np.searchsorted(keys, segment_keys, side="right") - 1
    faces = np.append(face[owner], -1)
    # The triangle with the half edge from the lower to the higher point is on the left of it.
    low_left = np.where(upward[first], first, np.where(upward[last], last, len(owner)))
    low_right = np.where(~upward[first], first, np.where(~upward[last], last, len(owner)))
    turned = segments[:, 0] > segments[:, 1]
    left = faces[np.where(turned, low_right, low_left)]
    right = faces[np.where(turned, low_left, low_right)]
    return face, left, right
