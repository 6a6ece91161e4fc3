"""Limits of a metric: sizes, their ratio, and their growth."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from metrics import tensor
from metrics.gradation import check_growth, graded
from metrics.types import Floats, Ints

__all__ = ["Limits"]


@dataclass(frozen=True)
class Limits:
    """Bounds on the sizes of a metric, their ratio, and how fast they may change.

    Attributes
    ----------
    h_min, h_max : float
        Bounds on sizes.
    max_anisotropy : float
        Bound on the ratio of the two sizes at a point.
    gradation : float or None
        Bound on growth, the `beta` of `graded`; None for no bound. Measured in docs/theory.
    law : str
        Of growth, see `graded`.
    """

    h_min: float = 0.0
    h_max: float = np.inf
    max_anisotropy: float = np.inf
    gradation: float | None = 2.0
    law: str = "mixed"

    def __post_init__(self) -> None:
        tensor.check_limits(self.h_min, self.h_max, self.max_anisotropy)
        if self.gradation is not None:
            check_growth(self.gradation, self.law)

    def bounded(self, metric: Floats) -> Floats:
        return tensor.limit(metric, self.h_min, self.h_max, self.max_anisotropy)

    def applied(self, metric: Floats, points: Floats, triangles: Ints) -> Floats:
        """Limits, gradation, and limits again: an intersection may be below `h_min`."""
        metric = self.bounded(metric)
        if self.gradation is None:
            return metric
        return self.bounded(graded(metric, points, triangles, self.gradation, self.law))
