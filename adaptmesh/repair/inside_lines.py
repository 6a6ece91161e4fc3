"""Which faces between lines are in the domain, by the rules of `core/triangulation/carve.hpp`.

The core refuses lines in holes; the repair removes them.
"""

from __future__ import annotations

from functools import cached_property

import numpy as np

from adaptmesh.arrangement.faces import Faces
from adaptmesh.domain.inputs import Inside
from adaptmesh.types import Bools, Floats


class Lines:
    """Edges that meet only at their ends, the faces between them, and the holes given."""

    def __init__(self, faces: Faces, inside: Inside) -> None:
        self.faces = faces
        self.inside = inside
        self.left, self.right = faces.left, faces.right

    @cached_property
    def is_solid(self) -> Bools:
        """Whether each face is in the domain, (f,)."""
        if not self.inside.nesting:
            out = np.ones(self.faces.count, bool)
            out[0] = False
            out[self.faces.locate(self.inside.holes)] = False
            return out
        return self._alternate_by_nesting()

    def _alternate_by_nesting(self) -> Bools:
        """Alternate between domain and hole at each line from the outside inwards."""
        from scipy.sparse import coo_array
        from scipy.sparse.csgraph import shortest_path

        n = self.faces.count
        graph = coo_array((np.ones(len(self.left)), (self.left, self.right)), shape=(n, n)).tocsr()
        depth = shortest_path(graph, directed=False, unweighted=True, indices=0)
        solid = np.zeros(n, bool)
        solid[self.faces.locate(self.inside.seeds)] = True
        solid[0] = False
        ends = np.stack([self.left, self.right], axis=1)
        inwards = ends[depth[self.left] != depth[self.right]]
        outer_first = depth[inwards[:, 0]] < depth[inwards[:, 1]]
        inwards = np.where(outer_first[:, None], inwards, inwards[:, ::-1])
        inwards = inwards[np.argsort(depth[inwards[:, 0]], kind="stable")]
        levels = np.flatnonzero(np.diff(depth[inwards[:, 0]])) + 1
        for step in np.split(inwards, levels):
            solid[step[~solid[step[:, 0]], 1]] = True
        return solid

    @cached_property
    def is_loose(self) -> Bools:
        """Whether each edge has the same face, outside the domain, on both sides."""
        return (self.left == self.right) & ~self.is_solid[self.left]

    @cached_property
    def is_in_hole(self) -> Bools:
        """Whether each edge has holes, or a hole and the outside, on its sides.

        A hole that shares an edge with the outside and has another edge in its interior may have
        an open border, so that its seed spreads over a part of the domain. The edges beside such a
        hole are left out here.
        """
        void = ~self.is_solid
        out: Bools = void[self.left] & void[self.right] & ((self.left > 0) | (self.right > 0))
        at_outside = np.zeros(self.faces.count, bool)
        at_outside[self.right[self.left == 0]] = at_outside[self.left[self.right == 0]] = True
        has_edge_within = np.zeros(self.faces.count, bool)
        has_edge_within[self.left[self.left == self.right]] = True
        doubtful = void & at_outside & has_edge_within
        doubtful[0] = False
        return out & ~doubtful[self.left] & ~doubtful[self.right]

    def contains(self, points: Floats) -> Bools:
        """Whether each point is in the domain or on its border."""
        return self.is_solid[self.faces.locate(points)]
