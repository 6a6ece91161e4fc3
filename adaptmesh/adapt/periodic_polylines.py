"""Vertices of boundary polylines that may stay: all, or where sides are periodic those of both.

::

    a---o---o-x-o-------b        A polyline, and that of its image. Anchors (o, and the ends) are
    :   :   :   :       :        vertices that both have; x has no image, and cannot stay. An edge
    a'--o---o---o-------b'       between anchors is as long as the longer of its two sides.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from adaptmesh import ragged
from adaptmesh.boundary.edge_lengths import straight_lengths
from adaptmesh.domain.sides.side import Sides
from adaptmesh.mesh.boundary_polylines import BoundaryPolylines
from adaptmesh.types import Bools, Floats, Index
from metrics import ControlSpace

SAME = 1e-6
"""Parameters are the same if they differ by less than this share of the way to the next one."""


@dataclass(frozen=True)
class Anchors:
    """All anchors, side after side, in order along each; of two periodic sides along the first.

    Attributes
    ----------
    side : (c,) array of int
        The side of each.
    at : (c,) array of int
        Its number in `BoundaryPolylines.vertices`.
    image : (c,) array of int
        That of its image, -1 where the side is not periodic.
    """

    side: Index
    at: Index
    image: Index

    @classmethod
    def of(cls, polylines: BoundaryPolylines, sides: Sides) -> Anchors:
        """The anchors of the polylines of a mesh."""
        side = polylines.sides
        image, is_anchor = np.full(len(side), -1), np.ones(len(side), bool)
        for i, other in sides.images.items():
            if other.side < i:
                continue
            mine, theirs = (np.arange(*polylines.first[[k, k + 1]]) for k in (i, other.side))
            k = same_parameters(sides.image(i, polylines.u[mine]), polylines.u[theirs])
            image[mine] = theirs[k]
            is_anchor[mine], is_anchor[theirs] = k >= 0, False
        at = np.flatnonzero(is_anchor)
        return cls(side[at], at, image[at])

    @property
    def starts(self) -> Index:
        """The anchors at which edges start, (e,); each ends at the next anchor."""
        return ragged.starts_of_pairs(self.side)

    def may_stay(self, n: int) -> Bools:
        """Which of the n vertices of polylines are anchors, or images of anchors."""
        out = np.zeros(n, bool)
        out[self.at] = out[self.image[self.image >= 0]] = True
        return out

    def lengths(self, points: Floats, metric: ControlSpace) -> Floats:
        """The length of each edge between anchors, (e,); `points` are those of the polylines."""
        a = self.starts
        ours = np.stack([self.at[a], self.at[a + 1]], axis=1)
        theirs = np.stack([self.image[a], self.image[a + 1]], axis=1)
        periodic = theirs[:, 0] >= 0
        length = straight_lengths(points, np.concatenate([ours, theirs[periodic]]), metric)
        out, other = length[: len(a)], length[len(a) :]
        out[periodic] = np.maximum(out[periodic], other)
        return out


def same_parameters(u: Floats, others: Floats) -> Index:
    """For each parameter the number of the same one of others, ascending, or -1."""
    gap = np.diff(others)
    room = SAME * np.minimum(np.append(gap, np.inf), np.append(np.inf, gap))
    k = np.searchsorted(others, u).clip(1, len(others) - 1)
    k = np.where(u - others[k - 1] < others[k] - u, k - 1, k)
    return np.where(np.abs(u - others[k]) <= room[k], k, -1)
