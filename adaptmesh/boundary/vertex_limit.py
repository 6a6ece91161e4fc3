"""How many vertices a mesh may have, and how far the work on it is."""

from __future__ import annotations

import operator
from collections.abc import Callable
from dataclasses import dataclass

from adaptmesh._core import MAX_VERTICES
from adaptmesh.errors import BudgetError

Progress = Callable[[str, float], None]
"""Called with the stage at work and how much of all the work is done, from 0 to 1."""


def about(n: float) -> str:
    """A predicted number, in words for people: all digits of small ones, three of large ones."""
    return f"{n:,.0f}" if n < 1e6 else f"{n:.3g}"


@dataclass(frozen=True)
class Budget:
    """How many vertices a mesh may have, and is expected to have."""

    max_vertices: int
    expected: int

    def __post_init__(self) -> None:
        try:
            most = operator.index(self.max_vertices)
        except TypeError:
            raise TypeError(f"max_vertices must be an integer, not {self.max_vertices!r}") from None
        if most < 3:
            raise ValueError(f"max_vertices={most}: the smallest mesh has 3 vertices")
        object.__setattr__(self, "max_vertices", min(most, MAX_VERTICES))

    def check_prediction(self) -> None:
        """Refuse what is expected to be too large."""
        if self.expected > self.max_vertices:
            raise BudgetError(
                f"the mesh would have about {about(self.expected)} vertices, but max_vertices is "
                f"{self.max_vertices:,}: ask for larger sizes, or allow more"
            )

    def check(self, n_vertices: int) -> None:
        """Stop what has become too large although it was not expected to."""
        if n_vertices > self.max_vertices:
            raise BudgetError(
                f"the mesh needs more than max_vertices = {self.max_vertices:,} vertices (about "
                f"{self.expected:,} were predicted): ask for larger sizes, or allow more"
            )

    def progress(self, n_vertices: int) -> float:
        """How much of the work of placing points is behind us, as a share of all work."""
        return min(0.7, 0.05 + 0.65 * n_vertices / max(self.expected, 1))
