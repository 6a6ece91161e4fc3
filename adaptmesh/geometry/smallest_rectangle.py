"""The smallest rectangle around points, in any direction: an extent that does not know the axes."""

from __future__ import annotations

import numpy as np
from scipy.spatial import ConvexHull

from adaptmesh.types import Floats

TIE = 1e-9  # areas that differ by less are the same: rounding, which differs by frame, decides not


def longer_side(points: Floats) -> float:
    """The longer side of the rectangle of least area around points (n, 2), not all on a line.

    One of its sides lies along an edge of the convex hull. Of several rectangles of one area, the
    longest counts. For a rectangle along the axes it is the larger extent, to the bit.
    """
    places = points - points.min(axis=0)
    scale = float(places.max())
    hull = places[ConvexHull(places / scale).vertices] / scale  # anticlockwise
    edges = np.roll(hull, -1, axis=0) - hull
    angles = np.arctan2(edges[:, 1], edges[:, 0])
    first = int(angles.argmin())
    hull, edges, angles = (np.roll(a, -first, axis=0) for a in (hull, edges, angles))
    angles = np.maximum.accumulate(angles)  # to rounding they are in order
    along = edges / np.hypot(*edges.T)[:, None]
    across = np.stack([-along[:, 1], along[:, 0]], axis=1)

    def support(directions: Floats) -> Floats:
        """How far the hull, whose edges turn anticlockwise, reaches in each direction."""
        turned = np.arctan2(directions[:, 0], -directions[:, 1])
        reached: Floats = hull[np.searchsorted(angles, turned) % len(hull)]
        return np.einsum("ij,ij->i", reached, directions)

    sides = np.stack([support(d) + support(-d) for d in (along, across)], axis=1)
    areas = sides.prod(axis=1)
    return scale * float(sides[areas <= (1 + TIE) * areas.min()].max())
