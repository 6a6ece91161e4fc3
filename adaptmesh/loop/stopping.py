"""When a loop has done enough, or has to end."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import dataclass, field

import numpy as np

from adaptmesh.checks import expect_number, expect_whole

from .history import History
from .iteration import Iteration
from .target import Target

AGREE = 3  # iterations in a row that agree end the loop
COARSENED = 1.1  # a mesh with more than this many times the vertices of another is finer
FAR_BELOW = 0.5  # of the error asked for: a mesh that could be coarsened further
LOST = 2.0  # an error that is smaller on a coarser mesh by this factor is not seen there
UNIFORM = 0.05  # how near to the vertices asked for a mesh of one size is taken as it is


@dataclass(frozen=True)
class Budget:
    """Limits of a loop; it stops normally when one is reached.

    Parameters
    ----------
    vertices : int
        The largest mesh.
    seconds : float
        Of wall-clock time, from the call; no iteration is begun after.
    """

    vertices: int = 5_000_000
    seconds: float = np.inf

    def __post_init__(self) -> None:
        expect_number("vertices", self.vertices)
        expect_number("seconds", self.seconds)
        if not self.vertices >= 3:
            raise ValueError(f"a budget of {self.vertices!r} vertices: at least 3 are needed")
        if not self.seconds >= 0:
            raise ValueError(f"a budget of {self.seconds!r} seconds: must not be negative")


@dataclass(frozen=True)
class StoppingRule:
    """Convergence, and what ends a loop that does not converge.

    Attributes
    ----------
    tolerance : float
        The last three meshes agree if their numbers of vertices, and the estimates of each error,
        differ by no more than this share.
    max_iterations : int
        How often the mesh is adapted.
    budget : Budget
    """

    tolerance: float = 0.02
    max_iterations: int = 20
    budget: Budget = field(default_factory=Budget)

    def __post_init__(self) -> None:
        expect_number("tolerance", self.tolerance)
        if not self.tolerance >= 0:
            raise ValueError(f"tolerance={self.tolerance!r}: must not be negative")
        expect_whole("max_iterations", self.max_iterations, 0)

    def end(self, history: History, target: Target, elapsed: float) -> History | None:
        """The history with its end, or None if there is to be another iteration."""
        if not history.for_options:
            return None
        if self._nothing_to_reduce(history, target):
            return history.ended(
                "the fields are linear, to rounding: there is no interpolation error to reduce",
                True,
            )
        if self.agree(history.for_options):
            short = target.error is not None and (
                target.excess(history[-1].errors) > 1 + self.tolerance
            )
            lost = self._lost(history, target)
            if lost:
                return history.ended(lost, False)
            if not short:
                return history.ended(
                    f"the last {AGREE} meshes agree within {100 * self.tolerance:g} %", True
                )
            if history[-1].n_points >= 0.9 * self.budget.vertices:
                return history.ended(
                    f"the budget of {self.budget.vertices:,} vertices is used up", False
                )
        adapted = len(history.for_options) - 1
        if adapted >= self.max_iterations:
            return history.ended(f"the mesh was adapted {adapted} times", False)
        if elapsed >= self.budget.seconds:
            return history.ended(f"the budget of {self.budget.seconds:g} s is used up", False)
        return None

    def _nothing_to_reduce(self, history: History, target: Target) -> bool:
        """Whether the mesh is adapted to linear fields only, and has the vertices asked for."""
        last = history[-1]
        if not last.errors or any(any(it.errors.values()) for it in history.for_options):
            return False
        if last.snapshot.solution.metric is not None:
            return False
        count = target.target_vertices
        return count is None or (
            len(history.for_options) > 1
            and abs(last.n_points - count) <= max(self.tolerance, UNIFORM) * count
        )

    def _lost(self, history: History, target: Target) -> str:
        """What to say if a feature has fallen between the vertices of a mesh that was coarsened.

        Errors grow as a mesh is coarsened. One that is far below what was asked for, and was much
        larger on a finer mesh of this loop, is not small: it is no longer seen.
        """
        if target.error is None:
            return ""
        last = history[-1]
        now = target.excess(last.errors)
        finer = [it for it in history.for_options if it.n_points > COARSENED * last.n_points]
        before = max((target.excess(it.errors) for it in finer), default=0.0)
        if now > FAR_BELOW or before <= LOST * now:
            return ""
        return (
            f"the error was {before:.3g} times the one asked for on a finer mesh, and is {now:.3g} "
            f"times on the last, of {last.n_points} vertices: a feature has probably fallen "
            "between them; lower h_max, or ask for a smaller error"
        )

    def agree(self, iterations: Sequence[Iteration]) -> bool:
        """Whether counts and errors of the last meshes agree within the tolerance."""
        last = iterations[-AGREE:]
        if len(last) < AGREE or any(it.errors.keys() != last[0].errors.keys() for it in last):
            return False
        rows = [[float(it.n_points) for it in last]]
        rows += [[it.errors[name] for it in last] for name in last[0].errors]
        return all(self._close(row) for row in rows)

    def _close(self, values: Iterable[float]) -> bool:
        numbers = list(values)
        return max(numbers) <= (1 + self.tolerance) * min(numbers)
