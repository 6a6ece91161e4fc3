"""Areas by winding numbers, slab by slab: slow, and without any topology that rounding could spoil.

Between the abscissas of all points and crossings, segments do not cross: they lie above each other
like the rungs of a ladder, and each raises or lowers the winding number of its ring by one. A slab
whose bounds are rounded is a little too wide or narrow, no more.
"""

import itertools

import numpy as np


def area(rings, is_inside):
    """The area of the places where ``is_inside(winding numbers of the rings)``."""
    start = np.concatenate(rings)
    end = np.concatenate([np.roll(ring, -1, axis=0) for ring in rings])
    ring = np.repeat(np.arange(len(rings)), [len(r) for r in rings])
    steep = start[:, 0] != end[:, 0]
    start, end, ring = start[steep], end[steep], ring[steep]
    if not len(ring):
        return 0.0
    slope = (end[:, 1] - start[:, 1]) / (end[:, 0] - start[:, 0])
    low, high = np.minimum(start[:, 0], end[:, 0]), np.maximum(start[:, 0], end[:, 0])
    x = np.unique(np.concatenate([start[:, 0], end[:, 0], _crossings(start, end)]))
    total = 0.0
    for x0, x1 in itertools.pairwise(x):
        middle = 0.5 * (x0 + x1)
        here = np.flatnonzero((low <= middle) & (middle <= high))
        y = start[here, 1] + (middle - start[here, 0]) * slope[here]
        order = np.argsort(y)
        winding = np.zeros(len(rings), int)
        for k, upper in itertools.pairwise(order):
            s = here[k]
            winding[ring[s]] += 1 if end[s, 0] > start[s, 0] else -1
            if is_inside(winding):
                total += (x1 - x0) * (y[upper] - y[k])
    return total


def area_within(ring):
    """The area that one ring winds around, in whatever direction and however often."""
    return area([np.asarray(ring, float)], lambda winding: winding[0] != 0)


def _crossings(start, end):
    """The abscissas where two segments cross, or nearly."""
    i, j = np.triu_indices(len(start), 1)
    u, w, r = end[i] - start[i], end[j] - start[j], start[j] - start[i]
    across = u[:, 0] * w[:, 1] - u[:, 1] * w[:, 0]
    with np.errstate(divide="ignore", invalid="ignore"):
        t = (r[:, 0] * w[:, 1] - r[:, 1] * w[:, 0]) / across
        s = (r[:, 0] * u[:, 1] - r[:, 1] * u[:, 0]) / across
    meet = (t >= 0) & (t <= 1) & (s >= 0) & (s <= 1)
    return start[i][meet, 0] + t[meet] * u[meet, 0]
