"""Solve, estimate, adapt, transfer, and again, until nothing changes any more."""

from __future__ import annotations

import inspect
import time
from collections.abc import Callable, Iterator, Mapping, Sequence
from contextlib import contextmanager
from dataclasses import dataclass, field, replace
from pathlib import Path
from types import MappingProxyType
from typing import Any

import numpy as np

from adaptmesh.adapt.adapt import adapt
from adaptmesh.checks import expect_function
from adaptmesh.errors import BudgetError, MetricError
from adaptmesh.geometry.smallest_rectangle import longer_side
from adaptmesh.mesh.mesh import Mesh
from adaptmesh.transfer.transfer import METHODS
from adaptmesh.transfer.transfer import transfer as transferred
from adaptmesh.value import FrozenMapping
from metrics import Background, Limits, nodal_lengths

from . import history_files as files
from .errors import LoopError, LoopInterrupted
from .history import History, Iteration, PathLike, Seconds, Snapshot
from .option_text import option_as_text
from .solution import Solved, as_solved, space_of
from .stopping import Budget, StoppingRule
from .target import Steering, check_reachable

SHARE_OF_EXTENT = 0.25  # the largest size, where none is given
UNIT = (np.sqrt(0.5), np.sqrt(2.0))


def adapt_loop(
    solve: Callable[..., Any],
    mesh: Mesh,
    *,
    target_vertices: float | None = None,
    error: float | Mapping[str, float] | None = None,
    p: float = 2.0,
    fields: Sequence[str] | None = None,
    h_min: float = 0.0,
    h_max: float | None = None,
    max_anisotropy: float = np.inf,
    gradation: float | None = 2.0,
    recovery: str = "green",
    combine: str = "intersection",
    growth: float = 4.0,
    order: float = 1.0,
    tolerance: float = 0.02,
    max_iterations: int = 20,
    budget: Budget | None = None,
    transfer: str = "interpolation",
    save: PathLike | None = None,
    resume: History | PathLike | None = None,
    keep_last: int | None = None,
    callback: Callable[[Iteration], object] | None = None,
) -> History:
    """Solve and adapt in turn until the mesh is the best for the solution on it.

    In each iteration, `solve` is called with the mesh. From the values that it returns Hessians are
    recovered, and from these the metric of least interpolation error for the vertices or the error
    asked for; see `metrics.metric_from_hessians`. The mesh is adapted to it, the fields are
    transferred, and `solve` is called again.

    Parameters
    ----------
    solve : callable
        Called as ``solve(mesh)``; or, if it has a parameter of the name `previous`, as
        ``solve(mesh, previous=previous)`` with its last result transferred to this mesh, in the
        form in which it was returned: an initial guess. It is None in the first iteration.

        Returns one of: values at the vertices (n,); a dict of fields by name, each (n,), or (n, k)
        with k components; a metric, as a control space or an array (n, 3) or (n, 2, 2), which then
        steers the mesh; or a `Solution`, which can hold all of that and the solver's own error.
    mesh : Mesh
        To begin with. If it has no domain, `Mesh.to_domain` finds it once.
    target_vertices : float, optional
        The number of vertices wanted.
    error : float or mapping of str to float, optional
        Instead: the L^p norm of the interpolation error wanted, as estimated on the mesh
        (`metrics.interpolation_errors`); for each field, or by name. Without either, `solve` must
        return a metric, which is taken as it is.
    p : float, optional
        Of the norm, from 1 to inf.
    fields : sequence of str, optional
        The fields that steer the mesh; by default all that are real, at the vertices, and not the
        same everywhere. The others are transferred all the same.
    h_min, h_max, max_anisotropy, gradation : optional
        Bounds on sizes, their ratio and their growth; see `metrics.Limits`. By default `h_max` is
        a quarter of the longer side of the smallest rectangle around the mesh, in any direction:
        derivatives cannot be recovered across a mesh that is one triangle thick.
    recovery : {"green", "least squares", "projection"}, optional
        How Hessians are found from values, see `metrics.hessians`. Where they are noisy, as where
        a solver oscillates, the fit by least squares smooths them.
    combine : {"intersection", "average"}, optional
        As for `metrics.metric_from_solution`.
    growth : float, optional
        No mesh has more than so many times the vertices of the one before, or so many times less:
        where features are is found on small meshes.
    order : float, optional
        The power of the number of vertices with which the error falls, for `error` only, until
        meshes of different sizes tell. 1 for the interpolation error in L^p; other estimates that
        `solve` gives may have another.
    tolerance : float, optional
        The loop has converged when three meshes in a row have numbers of vertices, and estimates of
        each error, that differ by no more than this share.
    max_iterations : int, optional
        How often the mesh is adapted at most.
    budget : Budget, optional
        Bounds on vertices and seconds. The loop ends when they are reached, and says so.
    transfer : {"interpolation", "conservative"}, optional
        How fields are carried to the next mesh, see `adaptmesh.transfer`.
    save : path, optional
        A folder, to which every iteration is written when it is complete; see `History.save`.
    resume : History or path, optional
        What an earlier call left, or the folder where it was saved. The loop goes on after its last
        iteration, and gives what it would have given without interruption, bit for bit, if it is
        called with the same arguments. With another target, norm, choice of fields or limits it
        goes on from the last mesh: what was found for the earlier ones does not count as
        convergence, nor as iterations. If the last solution does not have what these options ask
        for, such as a field that only the new `solve` returns, `solve` is called again on the last
        mesh, with ``previous=None``.
    keep_last : int, optional
        Keep only so many of the last meshes in memory, and read the others from `save` if they are
        asked for.
    callback : callable, optional
        Called with each `Iteration` when it is complete.

    Returns
    -------
    History
        Its last mesh is the one that the last solution is on.

    Raises
    ------
    LoopError
        For any exception in `solve`, or in what was made of its result: it says in which iteration,
        and holds the history until then. The exception itself is its ``__cause__``.
    LoopInterrupted
        A KeyboardInterrupt that holds the history.
    ValueError, TypeError
        For options that contradict each other, before anything is done.
    """
    budget = budget or Budget()
    if not isinstance(budget, Budget):
        raise TypeError(f"budget={budget!r}: give adaptmesh.Budget(vertices=..., seconds=...)")
    expect_function("callback", callback)
    mesh = with_domain(mesh)
    if h_max is None:
        h_max = largest_size(mesh)
    steering = Steering(
        target_vertices,
        error,
        p,
        fields,
        Limits(h_min, h_max, max_anisotropy, gradation),
        recovery,
        combine,
        growth,
        order,
        budget.vertices,
    )
    if target_vertices is not None:
        check_reachable(target_vertices, mesh, h_max)
    rule = StoppingRule(tolerance, max_iterations, budget)
    work = Work(Solver(solve), mesh, steering, transfer)
    keeping = Keeping(None if save is None else Path(save).absolute(), keep_last)
    history = keeping.begun(_resumed(resume, mesh, steering, rule), resume)
    started = time.monotonic()
    while True:
        clock = Clock()
        number = len(history)
        with _explained(history, number, clock):
            ended = rule.ended(history, steering, time.monotonic() - started)
            if ended is None:
                try:
                    history = history.with_iteration(work.next(history, clock))
                except BudgetError as refusal:
                    ended = history.ended(str(refusal), False)
        with _explained(history, number, clock):
            if ended is not None:
                return keeping.finished(ended)
            history = keeping.kept(history, clock)
            if callback is not None:
                clock.stage = "callback"
                callback(history[-1])


@dataclass
class Clock:
    """Which stage is at work, and how long each has taken."""

    stage: str = "stopping rule"
    seconds: Seconds = field(default_factory=Seconds)

    @contextmanager
    def of(self, stage: str, name: str = "") -> Iterator[None]:
        """Count the time to a stage, which an error calls by another name if that is given."""
        self.stage = name or stage
        start = time.perf_counter()
        yield
        self.seconds += Seconds(**{stage: time.perf_counter() - start})


class Solver:
    """The user's solve, called in the way it is written for."""

    def __init__(self, solve: Callable[..., Any]) -> None:
        if not callable(solve):
            raise TypeError(f"solve must be a function of a mesh, not {type(solve).__name__}")
        try:
            parameters = inspect.signature(solve).parameters
        except (TypeError, ValueError):  # some callables made in C do not tell
            parameters = MappingProxyType({})
        self.solve = solve
        self.takes_previous = "previous" in parameters
        needed = [
            q.name
            for q in parameters.values()
            if q.default is q.empty and q.kind in (q.POSITIONAL_ONLY, q.POSITIONAL_OR_KEYWORD)
        ]
        if len(needed) > 1 and set(needed[1:]) != {"previous"}:
            raise TypeError(
                f"solve needs {len(needed)} arguments, {', '.join(needed)}: it is called with a "
                "mesh, and with the last fields if it has a parameter `previous`"
            )

    def __call__(self, mesh: Mesh, previous: Any) -> Any:
        return self.solve(mesh, previous=previous) if self.takes_previous else self.solve(mesh)


@dataclass(frozen=True, eq=False)
class Work:
    """What is done in an iteration."""

    solve: Solver
    mesh: Mesh
    steering: Steering
    transfer: str

    def __post_init__(self) -> None:
        if self.transfer not in METHODS:
            raise ValueError(
                f"transfer={self.transfer!r} is none of {', '.join(map(repr, METHODS))}"
            )

    def next(self, history: History, clock: Clock) -> Iteration:
        """A mesh for the last metric, the solution on it, and the metric for the next.

        The first solution for these options starts without a previous one.
        """
        mesh, previous, unit = self.mesh, None, np.nan
        if history:
            last = history[-1].snapshot
            with clock.of("adapt"):
                field = Background.on(last.mesh, last.metric)
                mesh = adapt(last.mesh, field, max_vertices=self.steering.max_vertices)
                unit = _unit_fraction(mesh, field)
            if self.solve.takes_previous and history.for_options:
                with clock.of("transfer"):
                    previous = self._carried(last.solved, last.mesh, mesh)
        with clock.of("solve"):
            solved = as_solved(self.solve(mesh, previous), mesh)
        with clock.of("metric"):
            metric, errors = self.steering.metric(mesh, solved, history.for_options)
        return Iteration(
            number=len(history),
            n_points=len(mesh.points),
            n_triangles=len(mesh.triangles),
            errors=FrozenMapping(errors),
            unit_fraction=unit,
            seconds=clock.seconds,
            kept=Snapshot(mesh, solved, metric),
        )

    def _carried(self, solved: Solved, old: Mesh, new: Mesh) -> Any:
        spaces = {name: space_of(values, old) for name, values in solved.fields.items()}
        fields = transferred(solved.fields, old, new, method=self.transfer, space=spaces)
        return solved.as_returned(fields)


@dataclass(frozen=True)
class Keeping:
    """Where iterations are kept: all in memory, or the older ones on disk only."""

    folder: Path | None
    last: int | None

    def __post_init__(self) -> None:
        if self.last is None:
            return
        if self.last < 1:
            raise ValueError(f"keep_last={self.last!r}: at least the last mesh is needed")
        if self.folder is None:
            raise ValueError("keep_last needs `save`, the folder where the other meshes are kept")

    def begun(self, history: History, resume: History | PathLike | None) -> History:
        """Refuse to write over another history; write what an earlier call has left."""
        if self.folder is None:
            return history
        same = not isinstance(resume, (History, type(None))) and (
            Path(resume).resolve() == self.folder.resolve()
        )
        if not same:
            files.refuse_history(self.folder)
            files.save(history, self.folder)
        elif history and isinstance(history[-1].kept, Snapshot):  # estimated again
            files.append(history, self.folder)
        return history

    def kept(self, history: History, clock: Clock) -> History:
        """Write the last iteration, and let go of the arrays that need not be in memory."""
        if self.folder is None:
            return history
        clock.stage = "save"
        files.append(history, self.folder)
        if self.last is None:
            return history
        return files.left_on_disk(history, self.folder, self.last, history[-1].mesh.domain)

    def finished(self, history: History) -> History:
        if self.folder is not None:
            files.write_list(history, self.folder)
        return history


@contextmanager
def _explained(history: History, number: int, clock: Clock) -> Iterator[None]:
    """Any exception, with the iteration, the stage, and the history until then."""
    try:
        yield
    except KeyboardInterrupt as interrupt:
        raise LoopInterrupted(history, number, clock.stage) from interrupt
    except Exception as error:
        raise LoopError(history, number, clock.stage, error) from error


def largest_size(mesh: Mesh) -> float:
    """That of a loop, where none is given: a share of the mesh, whichever way it is turned."""
    return SHARE_OF_EXTENT * longer_side(mesh.points)


def with_domain(mesh: Mesh) -> Mesh:
    """The mesh with its domain, found once."""
    if not isinstance(mesh, Mesh):
        raise TypeError(f"a Mesh is wanted to begin with, not {type(mesh).__name__}")
    return mesh if mesh.domain is not None else replace(mesh, domain=mesh.to_domain())


def _resumed(
    resume: History | PathLike | None, mesh: Mesh, steering: Steering, rule: StoppingRule
) -> History:
    """The history to go on with: empty, or an earlier one that began with this mesh."""
    options = {
        name: option_as_text(value)
        for options in (steering, rule)
        for name, value in vars(options).items()
        if value is not None
    }
    if resume is None:
        return History(options=options)
    earlier = resume if isinstance(resume, History) else History.load(resume, mesh.domain)
    if earlier:
        refuse_other_mesh(earlier[0].mesh, mesh)
    going_on = replace(earlier, reason="", converged=False, options=options)
    if earlier.for_options and any(
        earlier.options.get(name) != options.get(name) for name in steering.asked_for
    ):
        return _with_last_estimated_again(going_on, steering)
    return going_on


def _with_last_estimated_again(history: History, steering: Steering) -> History:
    """The history with the metric and the errors of its last mesh by other options.

    Nothing of what was found for the earlier options counts as convergence. Where the last solution
    does not do for these options, its iteration is left out, so that it is made again: the mesh
    is the same then, bit for bit.
    """
    *before, last = history.iterations
    snapshot = last.snapshot
    try:
        metric, errors = steering.metric(snapshot.mesh, snapshot.solved)
    except MetricError:
        again = []
    else:
        kept = replace(snapshot, metric=metric)
        again = [replace(last, errors=FrozenMapping(errors), kept=kept)]
    return replace(history, iterations=(*before, *again), options_since=len(before))


def refuse_other_mesh(first: Mesh, mesh: Mesh) -> None:
    """Refuse to go on with a history that began with another mesh, or one of another domain."""
    same = np.array_equal(first.points, mesh.points)
    if not (same and np.array_equal(first.triangles, mesh.triangles)):
        raise ValueError(
            f"the history to resume began with another mesh ({len(first.points)} vertices) "
            f"than is given ({len(mesh.points)} vertices)"
        )
    one, two = first.domain, mesh.domain
    if one is None or two is None or one is two:
        return
    arrays = ("points", "segments", "segment_tags", "holes", "seeds", "seed_regions")
    if not all(np.array_equal(getattr(one, name), getattr(two, name)) for name in arrays) or (
        [(p.first, p.second) for p in one.periodic] != [(p.first, p.second) for p in two.periodic]
    ):
        raise ValueError(
            "the history to resume is of another domain than the mesh that is given: give its "
            "first mesh, or begin anew with its last"
        )


def _unit_fraction(mesh: Mesh, field: Background) -> float:
    lengths = nodal_lengths(mesh.points, mesh.unique_edges, field, "simpson")
    return float(np.mean((lengths >= UNIT[0]) & (lengths <= UNIT[1])))
