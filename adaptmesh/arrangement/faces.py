"""The faces that noded segments divide the plane into, found exactly.

+-------------+   The segments are put in a frame and triangulated by the core, which proves that
|   +---+     |   they meet only at their ends: anything else is a fault. Triangles connected over
| 0 | 1 |--   |   edges that are no segment are one face; face 0 is the outside. A segment with
|   +---+     |   the same face on both sides bounds nothing.
+-------------+
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from adaptmesh._core import Fault, triangulate
from adaptmesh.errors import DomainError
from adaptmesh.geometry.containing import containing_triangles
from adaptmesh.topology import components, edge_keys, half_edges
from adaptmesh.types import Floats, Int64s

from .record import at


@dataclass(frozen=True)
class Faces:
    """Faces between edges.

    Attributes
    ----------
    points : (n, 2) array
        Those of the edges, then the four of the frame.
    triangles : (m, 3) array
    face : (m,) array
        Of each triangle.
    left, right : (e,) array
        The face beside each edge, seen from its first point to its second.
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
        """Area of each face; that of the outside reaches to the frame."""
        return np.bincount(self.face, self._doubled_areas) / 2

    @cached_property
    def places(self) -> Floats:
        """A point in each face, (f, 2): the centre of the triangle with the greatest height."""
        p = self.points[self.triangles]
        longest = np.square(p - np.roll(p, 1, axis=1)).sum(axis=2).max(axis=1)
        order = np.lexsort((self._doubled_areas / np.sqrt(longest), self.face))
        last = np.append(self.face[order][1:] != self.face[order][:-1], True)
        return p[order[last]].mean(axis=1)

    def at(self, places: Floats) -> Int64s:
        """The face that each place (k, 2) is in; on an edge one beside it, elsewhere 0."""
        found = containing_triangles(self.points, self.triangles, places)
        return np.append(self.face, 0)[found]

    @cached_property
    def _doubled_areas(self) -> Floats:
        p = self.points[self.triangles]
        u, v = p[:, 1] - p[:, 0], p[:, 2] - p[:, 0]
        return u[:, 0] * v[:, 1] - u[:, 1] * v[:, 0]

    def united(self, edges: NDArray[np.bool_]) -> Int64s:
        """For each face the number of the one it becomes when edges are taken away."""
        return components(self.count, np.stack([self.left[edges], self.right[edges]], axis=1))


def find_faces(points: Floats, edges: Int64s) -> Faces:
    """Triangulate edges in a frame, and number the faces.

    Parameters
    ----------
    points : (n, 2) array
        All used by edges, none twice.
    edges : (e, 2) array
        None twice, in either direction.

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
    except Fault as fault:
        kind, _, _, x, y = fault.args
        raise DomainError(
            f"{kind.replace('_', ' ')} are left at {at(x, y)} after the repair: features there are "
            "as small as the rounding of coordinates; choose a larger tolerance"
        ) from fault
    if len(pieces) != len(segments):
        lost = segments[~np.isin(edge_keys(segments, n + 4), edge_keys(pieces, n + 4))][0, 0]
        raise DomainError(
            f"a segment from {at(*framed[lost])} passes through other points after the repair: "
            "choose another tolerance"
        )
    corners = triangles.astype(np.int64)
    face, left, right = _faces_between(corners, segments.astype(np.int64), n)
    return Faces(framed, corners, face, left[: len(edges)], right[: len(edges)])


def _faces_between(
    triangles: Int64s, segments: Int64s, corner: int
) -> tuple[Int64s, Int64s, Int64s]:
    """The face of each triangle, and those on the left and right of each segment.

    The face of the frame's first corner is number 0; beyond the frame there is -1.
    """
    n = int(segments.max()) + 1
    halves, owner = half_edges(triangles)
    keys = edge_keys(halves, n)
    order = np.argsort(keys, kind="stable")
    keys, owner, upward = keys[order], owner[order], (halves[:, 0] < halves[:, 1])[order]
    wanted = edge_keys(segments, n)

    twin = np.flatnonzero(keys[1:] == keys[:-1])
    at_segment = np.searchsorted(np.sort(wanted), keys[twin])
    locked = np.append(np.sort(wanted), -1)[at_segment] == keys[twin]
    free = twin[~locked]
    face = components(len(triangles), np.stack([owner[free], owner[free + 1]], axis=1))
    outside = face[np.flatnonzero((triangles == corner).any(axis=1))[0]]
    face = np.where(face == outside, 0, np.where(face < outside, face + 1, face))

    first = np.searchsorted(keys, wanted)
    last = np.searchsorted(keys, wanted, side="right") - 1
    faces = np.append(face[owner], -1)
    # The triangle with the half edge from the lower to the higher point is on the left of it.
    low_left = np.where(upward[first], first, np.where(upward[last], last, len(owner)))
    low_right = np.where(~upward[first], first, np.where(~upward[last], last, len(owner)))
    turned = segments[:, 0] > segments[:, 1]
    left = faces[np.where(turned, low_right, low_left)]
    right = faces[np.where(turned, low_left, low_right)]
    return face, left, right
