"""The mesh that comes out, what it says of its domain, and what a file or library gives."""
