"""How sizes grow with the distance.

Both laws are straight lines, ``h(d) = min(h_min + slope * d, h_max)``:

* linear: ``slope = growth``, the rise of h for each unit of distance; 0 is no growth.
* geometric: ``slope = growth - 1``, where growth is the ratio r of one size to the size one step
  before. A step as long as the size where it starts ends where the size is r times that,
  ``h(d + h(d)) = r h(d)``, so such steps from d = 0 are exactly ``h_min r**k`` long, k = 0, 1, ...

Steps of unit metric length, which are what a unit mesh is made of, are the integral of 1/h and
grow by ``exp(slope)`` instead: by 1.2214 for r = 1.2. For unit steps of ratio r exactly, the slope
is ``log(r)``.
"""

from __future__ import annotations

from typing import Any, Literal, TypeAlias

import numpy as np

from metrics.checks import number, one_of
from metrics.errors import MetricError
from metrics.types import Floats

__all__ = ["Law", "grown", "slope_of"]

Law: TypeAlias = Literal["linear", "geometric"]


def slope_of(growth: Any, law: Law, name: str = "growth") -> float:
    """The slope dh/dd of a law."""
    if one_of("law", law, ("linear", "geometric")) == "linear":
        return number(name, growth, minimum=0)
    if number(name, growth) < 1:
        raise MetricError(
            f"{name} = {growth!r} is the ratio of one size to the one before: it must be at least "
            "1, as 1.2 for sizes that grow by 20 % a step"
        )
    return float(growth) - 1


def grown(h: float | Floats, slope: float, distances: Floats, h_max: float) -> Floats:
    """Sizes at distances (n,) from where they are h."""
    return np.minimum(h + slope * distances, h_max)
