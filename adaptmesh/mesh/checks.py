"""What is asked of a mesh that somebody hands in."""

from __future__ import annotations

import numpy as np

from adaptmesh.mesh.validate.validate import InvalidMeshError

from .data import check_is_mesh
from .mesh import Mesh


def check_measurable(mesh: Mesh) -> None:
    """Refuse a mesh whose triangles cannot be measured."""
    check_is_mesh(mesh)
    t, n = mesh.triangles, len(mesh.points)
    if len(t) == 0:
        raise InvalidMeshError("the mesh has no triangles: there is nothing to measure")
    bad = np.flatnonzero(((t < 0) | (t >= n)).any(axis=1))
    if len(bad):
        raise InvalidMeshError(
            f"triangle {bad[0]} has the vertices {t[bad[0]].tolist()}, but the points are numbered "
            f"0 to {n - 1}: see mesh.validate()"
        )
    bad = np.flatnonzero(~np.isfinite(mesh.points).all(axis=1))
    if len(bad):
        x, y = mesh.points[bad[0]]
        raise InvalidMeshError(f"point {bad[0]} is ({x}, {y}): see mesh.validate()")
