"""The errors that this distribution raises on purpose."""

from __future__ import annotations


class AdaptmeshError(Exception):
    """Base of every error raised on purpose by `metrics` and `adaptmesh`."""


class MetricError(AdaptmeshError, ValueError):
    """A size or metric that cannot be used: not finite, not positive definite, wrong shape."""
