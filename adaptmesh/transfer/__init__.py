"""Transfer of fields from one mesh to another."""
