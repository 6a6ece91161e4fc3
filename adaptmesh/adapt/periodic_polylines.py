"""Rows of a mesh that are cut together: one alone, or two that periodic boundaries tie.

::

    a---o---o-x-o-------b        A row, and the row of its image. Anchors (o, and the ends) are
    :   :   :   :       :        vertices that both have; x has no image, and cannot stay. An edge
    a'--o---o---o-------b'       between anchors is as long as the longer of its two sides.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from adaptmesh.boundary.edge_lengths import straight_lengths
from adaptmesh.domain.side import Lines
from adaptmesh.mesh.boundary_polylines import Chains
from adaptmesh.types import Floats, Index
from metrics import ControlSpace

SAME = 1e-6
"""Places are the same if they differ by less than this share of the way to the next place."""


@dataclass(frozen=True)
class Strands:
    """All anchors, strand after strand, each in order along its (first) line.

    Attributes
    ----------
    line : (c,) array of int
        The line of each.
    at : (c,) array of int
        Its number in the rows of `Chains`.
    image : (c,) array of int
        That of its image, -1 where the line has no tie.
    """

    line: Index
    at: Index
    image: Index

    @classmethod
    def of(cls, chains: Chains, lines: Lines) -> Strands:
        """The strands of the rows of a mesh."""
        line = chains.lines
        image, is_anchor = np.full(len(line), -1), np.ones(len(line), bool)
        for i, tie in lines.ties.items():
            if tie.line < i:
                continue
            mine, theirs = (np.arange(*chains.first[[k, k + 1]]) for k in (i, tie.line))
            k = same_places(lines.images(i, chains.places[mine]), chains.places[theirs])
            image[mine] = theirs[k]
            is_anchor[mine], is_anchor[theirs] = k >= 0, False
        at = np.flatnonzero(is_anchor)
        return cls(line[at], at, image[at])

    @property
    def starts(self) -> Index:
        """The anchors at which edges start, (e,); each ends at the next anchor."""
        return np.flatnonzero(np.diff(self.line) == 0)

    def may_stay(self, n: int) -> NDArray[np.bool_]:
        """Which of the n entries of rows are anchors, or images of anchors."""
        out = np.zeros(n, bool)
        out[self.at] = out[self.image[self.image >= 0]] = True
        return out

    def lengths(self, points: Floats, field: ControlSpace) -> Floats:
        """The length of each edge between anchors, (e,); `points` are those of the rows."""
        a = self.starts
        ours = np.stack([self.at[a], self.at[a + 1]], axis=1)
        theirs = np.stack([self.image[a], self.image[a + 1]], axis=1)
        tied = theirs[:, 0] >= 0
        length = straight_lengths(points, np.concatenate([ours, theirs[tied]]), field)
        out, other = length[: len(a)], length[len(a) :]
        out[tied] = np.maximum(out[tied], other)
        return out


def same_places(places: Floats, others: Floats) -> Index:
    """For each place the number of the same one of others, ascending, or -1."""
    gap = np.diff(others)
    room = SAME * np.minimum(np.append(gap, np.inf), np.append(np.inf, gap))
    k = np.searchsorted(others, places).clip(1, len(others) - 1)
    k = np.where(places - others[k - 1] < others[k] - places, k - 1, k)
    return np.where(np.abs(places - others[k]) <= room[k], k, -1)
