"""Lengths, areas, qualities and complexity in a metric."""
