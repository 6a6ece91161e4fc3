"""Pictures of meshes and metrics, by pyvista (which is loaded when the first one is drawn)."""

from .picture import plot

__all__ = ["plot"]
