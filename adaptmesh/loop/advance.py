"""The user's `initial` and `advance`, and how they are called."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import dataclass, replace
from typing import Any

import numpy as np

from adaptmesh.mesh.mesh import Mesh
from adaptmesh.types import Floats
from adaptmesh.value import FrozenMapping

from .field_transfer import check_transfer, transfer_fields
from .records import Interval
from .solution import Solution, check_solution
from .step import Step
from .target_in_time import TargetInTime
from .transient_history import TransientHistory

ROUNDING = 1e-9
"""Share of an interval by which the last time may miss its end, as sums of steps do."""


@dataclass(frozen=True)
class Advance:
    """The user's functions for fields in time, and how fields are transferred between meshes."""

    initial: Callable[[Mesh], Any]
    advance: Callable[[Mesh, Any, float, float], Any]
    method: str
    keep_bounds: bool

    def __post_init__(self) -> None:
        for name in ("initial", "advance"):
            if not callable(getattr(self, name)):
                kind = type(getattr(self, name)).__name__
                raise TypeError(f"{name} must be a function, got {kind}")
        check_transfer(self.method)

    def first(self, mesh: Mesh, before: Interval | None, step: Step[TransientHistory]) -> Solution:
        """The fields at the start of an interval: the initial ones, or those of the one before."""
        if before is None:
            with step.timed("solve", "initial"):
                return _fields_of(self.initial(mesh), mesh, "initial")
        with step.timed("transfer"):
            there = transfer_fields(before.last, before.mesh, mesh, self.method, self.keep_bounds)
            return replace(check_solution(there, mesh), is_bare=before.is_bare)

    def interval(
        self,
        mesh: Mesh,
        first: Solution,
        ends: Floats,
        target: TargetInTime,
        step: Step[TransientHistory],
    ) -> Interval:
        """Advance from the first fields to the end of an interval."""
        with step.timed("metric"):
            times, hessians = [float(ends[0])], [target.hessians(mesh, first.fields)]
        last = first
        for t, given in self.samples(mesh, first, float(ends[0]), float(ends[1]), step):
            last = _fields_of(given, mesh, "advance")
            if last.fields.keys() != first.fields.keys():
                raise ValueError(
                    f"advance gave {_names(last)} at t = {t:g}, but began with {_names(first)}: "
                    "fields keep their names"
                )
            with step.timed("metric"):
                times.append(t)
                hessians.append(target.hessians(mesh, last.fields))
        step.stage = "advance"
        if times[-1] != ends[1]:
            raise ValueError(
                f"advance stopped at t = {times[-1]:g}; the interval ends at {ends[1]:g}"
            )
        with step.timed("metric"):
            over_time = target.over_time(np.array(times), hessians)
        return Interval(
            start=times[0],
            end=times[-1],
            mesh=mesh,
            first=first.fields,
            last=last.fields,
            times=np.array(times),
            hessians=FrozenMapping(dict(over_time)),
            seconds=step.seconds,
            is_bare=first.is_bare,
        )

    def samples(
        self, mesh: Mesh, first: Solution, t0: float, t1: float, step: Step[TransientHistory]
    ) -> Iterator[tuple[float, Any]]:
        """What advance yields, or the fields at the end if it returns these."""
        with step.timed("solve", "advance"):
            answer = self.advance(mesh, first.as_returned(first.fields), t0, t1)
        if not isinstance(answer, Iterator):
            yield t1, answer
            return
        before = t0
        while True:
            with step.timed("solve", "advance"):
                sample = next(answer, None)
            if sample is None:
                return
            if not isinstance(sample, tuple) or len(sample) != 2:
                raise TypeError(
                    "expected a time and the fields then, `yield t, fields`: advance yielded "
                    f"{type(sample).__name__}"
                )
            t = float(sample[0])
            if abs(t - t1) <= ROUNDING * (t1 - t0):
                t = t1
            if not before < t <= t1:
                raise ValueError(f"advance came from t = {before:g} to {t:g}; the end is {t1:g}")
            before = t
            yield t, sample[1]


def _fields_of(answer: Any, mesh: Mesh, function: str) -> Solution:
    solution = check_solution(answer, mesh, function)
    if solution.metric is not None or solution.errors:
        raise TypeError(
            f"{function} returned a metric or errors: in time meshes are adapted to fields only"
        )
    return solution


def _names(solution: Solution) -> str:
    return ", ".join(map(repr, solution.fields))
