"""The mesh that a loop begins with: its domain, and sizes that it allows."""

from __future__ import annotations

from dataclasses import replace

from adaptmesh.geometry.smallest_rectangle import longer_side
from adaptmesh.mesh.mesh import Mesh

SHARE_OF_EXTENT = 0.25  # the largest size, where none is given


def with_domain(mesh: Mesh) -> Mesh:
    """The mesh with its domain, found once."""
    if not isinstance(mesh, Mesh):
        raise TypeError(f"expected a Mesh to begin with, got {type(mesh).__name__}")
    return mesh if mesh.domain is not None else replace(mesh, domain=mesh.to_domain())


def default_h_max(mesh: Mesh) -> float:
    """The largest size where none is given: a share of the mesh, whichever way it is turned."""
    return SHARE_OF_EXTENT * longer_side(mesh.points)
