"""How many vertices a mesh may have, and errors that say so."""

from __future__ import annotations

import operator
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from dataclasses import dataclass

from adaptmesh._core import MAX_VERTICES, Monitor, TooManyVertices
from adaptmesh.errors import BudgetError

Progress = Callable[[str, float], None]
"""Called with the stage at work and how much of all the work is done, from 0 to 1."""


def about(n: float) -> str:
    """A predicted number, in words for people: all digits of small ones, three of large ones."""
    return f"{n:,.0f}" if n < 1e6 else f"{n:.3g}"


@dataclass(frozen=True)
class VertexLimit:
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

    def monitor(self, report: Progress) -> Monitor:
        """What keeps the core within the limit."""
        return Monitor(self.max_vertices, self.expected, report)

    @contextmanager
    def explained(self) -> Iterator[None]:
        """Say what has become too large although it was not expected to."""
        try:
            yield
        except TooManyVertices as error:
            near = "; many of them near ({:g}, {:g})".format(*error.args) if error.args else ""
            raise BudgetError(
                f"the mesh needs more than max_vertices = {self.max_vertices:,} vertices (about "
                f"{self.expected:,} were predicted{near}): ask for larger sizes, or allow more"
            ) from None
