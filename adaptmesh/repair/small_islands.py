"""Closed loops of edges that touch no other line: small islands and holes."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np

from adaptmesh.arrangement.faces import Faces
from adaptmesh.arrangement.winding import walk
from adaptmesh.topology import components
from adaptmesh.types import Floats, Int64s


@dataclass(frozen=True)
class Loop:
    """Connected edges, with all edges and faces inside them.

    Attributes
    ----------
    edges, faces : arrays
        Indices of the edges and faces.
    place : (float, float)
        The mean of its points.
    area, size : float
        The total area of the faces, and the diagonal of the bounding box.
    """

    edges: Int64s
    faces: Int64s
    place: tuple[float, float]
    area: float
    size: float


def find_small_loops(
    points: Floats, tensors: Floats, edges: Int64s, faces: Faces, below: float
) -> Iterator[Loop]:
    """Find the outermost loops that are smaller than a length in the metric.

    The size of a loop is twice the largest distance of its points from their mean, in the metric at
    each point.
    """
    of_point = components(len(points), edges)
    of_edge = of_point[edges[:, 0]]
    order, before, through = walk(faces)
    parent_face = np.zeros(faces.count, np.int64)
    parent_face[order] = before
    entered = np.full(faces.count, -1)
    entered[order] = of_edge[through]  # the component that each face is inside of

    # The first face reached through a component is entered from the component around it.
    around: dict[int, int] = {}
    for face in order.tolist():
        around.setdefault(int(entered[face]), int(entered[parent_face[face]]))
    small: set[int] = set()
    for component in around:  # from the outside inwards
        mine = np.flatnonzero(of_point == component)
        if around[component] in small or _size(points[mine], tensors[mine]) < below:
            small.add(component)
    for component in sorted(small):
        if around[component] in small:
            continue
        within = {component}
        for inner, outer in around.items():
            if outer in within:
                within.add(inner)
        ids = list(within)
        mine = points[of_point == component]
        inside = np.flatnonzero(np.isin(entered, ids))
        x, y = mine.mean(axis=0).tolist()
        yield Loop(
            np.flatnonzero(np.isin(of_edge, ids)),
            inside,
            (x, y),
            float(faces.areas[inside].sum()),
            float(np.hypot(*np.ptp(mine, axis=0))),
        )


def _size(points: Floats, tensors: Floats) -> float:
    x, y = (points - points.mean(axis=0)).T
    m11, m12, m22 = tensors.T
    return float(2 * np.sqrt((m11 * x * x + 2 * m12 * x * y + m22 * y * y).max()))
