"""What is asked of a mesh that somebody hands in."""

from __future__ import annotations

from adaptmesh.errors import DomainError

from .mesh import Mesh


def check_is_mesh(mesh: object) -> None:
    """Refuse what is no mesh."""
    if not isinstance(mesh, Mesh):
        raise DomainError(f"expected a Mesh, got {type(mesh).__name__}: generate makes one")
