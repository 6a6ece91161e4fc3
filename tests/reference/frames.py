"""A mesh and what is known on it, as another would write them down.

A `Frame` is a map of the plane that keeps shapes, and another numbering: of vertices, of triangles,
and of the vertex that each triangle starts with. What a test computes in it is brought back, and
must be what was computed in the frame of the figure itself.
"""

import numpy as np
from reference.transforms import SIMILARITIES


class Frame:
    """`points` and `triangles` of a figure in another frame, and its values to and fro."""

    def __init__(self, transform, points, triangles, seed=None):
        n, m = len(points), len(triangles)
        rng = np.random.default_rng(seed)
        renumbered = seed is not None
        self.transform = transform
        self.order = rng.permutation(n) if renumbered else np.arange(n)  # old numbers of new
        self.triangle_order = rng.permutation(m) if renumbered else np.arange(m)
        self.number = np.argsort(self.order)  # new numbers of old
        self.points = transform(points)[self.order]
        turned = transform.triangles(self.number[triangles])[self.triangle_order]
        first = rng.integers(0, 3, m) if renumbered else np.zeros(m, int)
        k = (first[:, None] + np.arange(3)) % 3
        self.triangles = np.take_along_axis(turned, k, axis=1).astype(np.int32)
        self.matrix = np.array(transform.matrix)
        self.scale = float(transform.scale)

    # --- into the frame ---

    def at_vertices(self, values):
        return np.asarray(values)[self.order]

    def on_triangles(self, values):
        return np.asarray(values)[self.triangle_order]

    def vectors(self, vectors):
        """Components along the new axes, lengths as they were."""
        return np.asarray(vectors) @ (self.matrix / self.scale).T

    def metric(self, tensors):
        return self.transform.metric(tensors)

    # --- back ---

    def old_vertices(self, values):
        return np.asarray(values)[self.number]

    def old_triangles(self, values):
        return np.asarray(values)[np.argsort(self.triangle_order)]

    def old_edges(self, edges, *values):
        """Edges in the old numbers, sorted, and the values on them in that order."""
        old = np.sort(self.order[np.asarray(edges)], axis=1)
        k = np.lexsort(old.T[::-1])
        return (old[k], *(np.asarray(v)[k] for v in values))

    def old_tensors(self, tensors):
        """Metrics, Hessians (..., 3): bilinear forms of vectors in the old coordinates."""
        m11, m12, m22 = np.moveaxis(np.asarray(tensors), -1, 0)
        full = np.stack([np.stack([m11, m12], -1), np.stack([m12, m22], -1)], -2)
        full = self.matrix.T @ full @ self.matrix
        return np.stack([full[..., 0, 0], full[..., 0, 1], full[..., 1, 1]], -1)

    def old_gradients(self, gradients):
        return np.asarray(gradients) @ self.matrix

    def old_vectors(self, vectors):
        return np.asarray(vectors) @ (self.matrix / self.scale)

    def old_points(self, points):
        return self.transform.inverse(points)


def frames(points, triangles):
    """The figure as it is, and in all other frames by name: mapped, renumbered, and both."""
    own, *others = SIMILARITIES
    out = {str(t): Frame(t, points, triangles) for t in others}
    out["renumbered"] = Frame(own, points, triangles, seed=1)
    out["turned and renumbered"] = Frame(others[0], points, triangles, seed=2)
    return Frame(own, points, triangles), out
