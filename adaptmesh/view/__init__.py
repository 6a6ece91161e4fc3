"""Pictures of meshes and metrics, drawn by pyvista (imported with the first picture)."""
