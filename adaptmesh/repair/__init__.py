"""Repair of dirty input, and simplification of domains."""
