"""Fields carried from one mesh to another."""
