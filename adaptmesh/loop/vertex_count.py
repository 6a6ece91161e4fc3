"""How many vertices a loop may ask for: bounds by the largest size, and checks."""

from __future__ import annotations

import numpy as np

from adaptmesh.checks import expect_number
from adaptmesh.mesh.mesh import Mesh
from metrics.measure.nodal import vertices_of
from metrics.topology import border_edges


def check_count(target_vertices: float) -> None:
    """Raise for a number of vertices that no mesh has."""
    expect_number("target_vertices", target_vertices)
    if not 3 <= target_vertices < np.inf:
        raise ValueError(f"target_vertices={target_vertices!r}: expected a number of at least 3")


def min_vertices(mesh: Mesh, h_max: float) -> float:
    """About how many vertices a mesh has in which all sizes are the largest allowed."""
    if h_max == np.inf:
        return 3.0
    ends = mesh.points[border_edges(mesh.triangles)]
    border = np.linalg.norm(ends[:, 1] - ends[:, 0], axis=1).sum()
    return vertices_of(mesh.areas.sum() / h_max**2, border / h_max)


def check_reachable(target_vertices: float, mesh: Mesh, h_max: float) -> None:
    """Raise for a number of vertices that is less than the coarsest mesh has."""
    coarsest = min_vertices(mesh, h_max)
    if target_vertices < coarsest:
        raise ValueError(
            f"target_vertices={target_vertices!r}: with all sizes h_max = {h_max:.6g} a mesh has "
            f"about {coarsest:.0f}; raise h_max, or ask for more"
        )
