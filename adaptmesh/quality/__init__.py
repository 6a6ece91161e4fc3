"""What was asked of a mesh, what was met, and why not where it was not."""
