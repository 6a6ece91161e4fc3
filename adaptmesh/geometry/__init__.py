"""Exact questions about points and segments, and distances between them."""
