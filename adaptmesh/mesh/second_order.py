"""Cells of higher order read as those of their corners.

A triangle of second order has three corners and three nodes on its sides; all formats list the
corners first. The mesh gets the corners only: sides that were curved become straight, and values at
the other nodes are left out, which a `FormatWarning` says.
"""

from __future__ import annotations

import warnings
from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from adaptmesh.errors import FormatWarning

from .incoming import Content, check_vertices


def with_corners_only(content: Content) -> Content:
    """The same, without the points that are nodes of cells, but corners of none."""
    others = content.others
    if not len(others):
        return content
    count = len(content.points)
    check_vertices("triangle", content.triangles, count)
    check_vertices("edge", content.edges, count)
    check_vertices("node of higher order, its cell", others[:, None], count)
    kept = np.ones(count, bool)
    kept[others] = False
    kept[content.triangles.ravel()] = kept[content.edges.ravel()] = True
    number = np.cumsum(kept) - 1
    warnings.warn(
        f"cells of higher order are read as those of their corners: {count - number[-1] - 1} nodes "
        "on sides and inside are left out, with the values there; curved sides become straight",
        FormatWarning,
        stacklevel=3,
    )
    return replace(
        content,
        points=content.points[kept],
        triangles=number[content.triangles],
        edges=number[content.edges],
        point_fields={name: values[kept] for name, values in content.point_fields.items()},
        metric=None if content.metric is None else content.metric[kept],
        required_points=_kept_of(content.required_points, kept, number),
        others=others[:0],
    )


def _kept_of(
    vertices: NDArray[np.int64], kept: NDArray[np.bool_], number: NDArray[np.intp]
) -> NDArray[np.intp]:
    """The new numbers of those of the vertices that are kept."""
    inside = vertices[(vertices >= 0) & (vertices < len(kept))]
    return number[inside[kept[inside]]]
