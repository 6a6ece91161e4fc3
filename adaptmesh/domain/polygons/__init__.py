"""Polygons as users give them: rings, their nesting, and the borders that they share."""
