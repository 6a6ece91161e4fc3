"""The boundary polylines of a mesh cut again where they are not unit (core/edit/recut.hpp)."""

from __future__ import annotations

from typing import TypeVar

import numpy as np
from numpy.typing import NDArray

from adaptmesh import ragged
from adaptmesh._core import MetricMesh
from adaptmesh.domain.sides.polyline import vertices_at
from adaptmesh.domain.sides.side import SidePoints
from adaptmesh.mesh.boundary_polylines import BoundaryPolylines
from adaptmesh.types import Index

from .plan_boundary import Boundary

T = TypeVar("T", bound=np.generic)


def recut(core: MetricMesh, boundary: Boundary) -> BoundaryPolylines:
    """Cut the mesh as planned, where that turns no triangle; the polylines as they are then.

    What stays between two vertices of a polyline, stays; all else between them is exchanged at
    once. Returns the same polylines if there is nothing to do.
    """
    old, planned = boundary.polylines, boundary.planned()
    now = SidePoints(old.sides, old.u)
    is_kept = now.is_in(planned)
    is_kept[old.first[:-1]] = is_kept[old.first[1:] - 1] = True
    kept = np.flatnonzero(is_kept)
    new = planned.where(~planned.is_in(now))
    counts = np.bincount(new.rank_in(now.where(kept)) - 1, minlength=len(kept))
    changes = np.append((np.diff(kept) > 1) & (np.diff(now.side[kept]) == 0), False)
    changed = np.flatnonzero(changes | (counts > 0))
    if not len(changed):
        return old
    begin, end, counts = kept[changed], kept[changed + 1], counts[changed]
    side = now.side[begin]
    inside = ragged.ranges(begin, end - begin + 1)
    points = vertices_at(boundary.sides, new)
    vertices, u, first = core.recut(
        ragged.offsets(end - begin + 1).astype(np.int32),
        old.vertices[inside],
        old.u[inside],
        ragged.offsets(counts).astype(np.int32),
        points,
        boundary.metric(points),
        new.u,
        boundary.sides.segments[side],
    )
    grown = np.bincount(side, np.diff(first) - (end - begin + 1), len(old.first) - 1)
    return BoundaryPolylines(
        _replaced(old.vertices, begin, end, np.split(vertices, first[1:-1])),
        _replaced(old.u, begin, end, np.split(u, first[1:-1])),
        (old.first + ragged.offsets(grown)).astype(np.int32),
    )


def _replaced(row: NDArray[T], begin: Index, end: Index, by: list[NDArray[T]]) -> NDArray[T]:
    """A row with each part [begin, end], sorted, replaced by another from and to the same.

    One may begin where another ends: the last of each is left to what follows.
    """
    kept = np.split(row, np.stack([begin, end], axis=1).ravel())[::2]
    parts = [part for pair in zip(kept, (b[:-1] for b in by), strict=False) for part in pair]
    return np.concatenate([*parts, kept[-1]])
