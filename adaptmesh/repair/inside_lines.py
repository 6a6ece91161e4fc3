"""What is inside lines that may be dirty, and which of them lie in holes: as the core decides it.

`adaptmesh/core/carve.hpp` refuses what lies in a hole; a repair leaves it out.
"""

from __future__ import annotations

from functools import cached_property

import numpy as np

from adaptmesh.arrangement import Faces
from adaptmesh.domain.inputs import Inside
from adaptmesh.types import Bools, Floats


class Lines:
    """Edges that meet only at points, the faces between them, and what is said of holes."""

    def __init__(self, faces: Faces, inside: Inside) -> None:
        self.faces = faces
        self.inside = inside
        self.left, self.right = faces.left, faces.right

    @cached_property
    def is_solid(self) -> Bools:
        """Which faces are in the domain, (f,)."""
        if not self.inside.nesting:
            out = np.ones(self.faces.count, bool)
            out[0] = False
            out[self.faces.at(self.inside.holes)] = False
            return out
        return self._nested()

    def _nested(self) -> Bools:
        """Over lines from outside inwards, the domain and holes take turns."""
        from scipy.sparse import coo_array
        from scipy.sparse.csgraph import shortest_path

        n = self.faces.count
        graph = coo_array((np.ones(len(self.left)), (self.left, self.right)), shape=(n, n)).tocsr()
        depth = shortest_path(graph, directed=False, unweighted=True, indices=0)
        solid = np.zeros(n, bool)
        solid[self.faces.at(self.inside.seeds)] = True
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
        """Edges with the same face on both sides, outside of the domain."""
        return (self.left == self.right) & ~self.is_solid[self.left]

    @cached_property
    def is_in_hole(self) -> Bools:
        """Edges with holes, or a hole and the outside, on their sides.

        A hole given by a point that reaches the outside over an edge, and has an edge within, may
        be one whose border is open: then it is as well the domain that the point was not meant
        for, and nothing is said of its edges.
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

    def contains(self, places: Floats) -> Bools:
        """Which of the places are in the domain or on its border."""
        return self.is_solid[self.faces.at(places)]
