"""Solve and adapt until the error or the count is met, in space and in time."""
