"""Which triangle a place is in, by exact signs."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from adaptmesh._core import orient2d
from adaptmesh.types import Floats, Index


def containing_triangles(points: Floats, triangles: Index, places: Floats) -> NDArray[np.intp]:
    """For each place (k, 2) the first triangle that it is in or on the border of; -1 for none.

    The triangles are counter-clockwise. Boxes are found in a tree, the rest is exact.
    """
    import shapely

    corners = points[triangles]
    tree = shapely.STRtree(shapely.box(*corners.min(axis=1).T, *corners.max(axis=1).T))
    place, triangle = tree.query(shapely.points(places))
    x = places[place]
    inside = np.ones(len(place), bool)
    for i, j in ((0, 1), (1, 2), (2, 0)):
        start, end = corners[triangle, i], corners[triangle, j]
        inside &= orient2d(start, end, x) >= 0
    out = np.full(len(places), len(triangles), np.intp)
    np.minimum.at(out, place[inside], triangle[inside])
    return np.where(out == len(triangles), -1, out)
