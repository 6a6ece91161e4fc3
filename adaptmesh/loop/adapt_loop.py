"""Solve, estimate, adapt, transfer, and again, until nothing changes any more."""

from __future__ import annotations

import time
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, replace
from typing import Any

import numpy as np

from adaptmesh.adapt.adapt import adapt
from adaptmesh.checks import expect_function
from adaptmesh.errors import BudgetError, MetricError
from adaptmesh.mesh.mesh import Mesh
from adaptmesh.value import FrozenMapping
from metrics import Background, Limits, nodal_lengths

from .base_history import PathLike
from .errors import LoopError, LoopInterrupted
from .field_transfer import check_transfer, transfer_fields
from .first_mesh import default_h_max, with_domain
from .history import History
from .iteration import Iteration
from .records import Snapshot
from .resume import (
    is_saved_in,
    load_earlier,
    options_as_text,
    prepare_folder,
)
from .solution import Solution, check_solution
from .solve import Solve
from .step import Step
from .stopping import Budget, StoppingRule
from .target import Target
from .vertex_count import check_reachable

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
    recovered, and from these the metric of minimal interpolation error for the vertices or the
    error asked for; see `metrics.metric_from_hessians`. The mesh is adapted to it, the fields are
    transferred, and `solve` is called again.

    Parameters
    ----------
    solve : callable
        Called as ``solve(mesh)``; or, if it has a parameter of the name `previous`, as
        ``solve(mesh, previous=previous)`` with its last result transferred to this mesh, in the
        form in which it was returned: an initial guess. It is None in the first iteration.

        Returns one of: values at the vertices (n,); a dict of fields by name, each (n,), or (n, k)
        with k components; a metric, as a control space or an array (n, 3) or (n, 2, 2), to which
        the mesh is then adapted; or a `Solution`, which can hold all of that and the solver's own
        error.
    mesh : Mesh
        To begin with. If it has no domain, `Mesh.to_domain` finds it once.
    target_vertices : float, optional
        The number of vertices of the mesh.
    error : float or mapping of str to float, optional
        Instead: the L^p norm of the interpolation error, as estimated on the mesh
        (`metrics.interpolation_errors`); for each field, or by name. Without either, `solve` must
        return a metric, which is taken as it is.
    p : float, optional
        Of the norm, from 1 to inf.
    fields : sequence of str, optional
        The fields that the mesh is adapted to; by default all that are real, at the vertices, and
        not the same everywhere. The others are transferred all the same.
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
        Bound on the ratio of the numbers of vertices of a mesh and the next, either way: features
        are found on small meshes first.
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
        How fields are transferred to the next mesh, see `adaptmesh.transfer`.
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
        The number of last meshes kept in memory; the others are read from `save` when they are
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
    _check_keep_last(keep_last, save)
    mesh = with_domain(mesh)
    if h_max is None:
        h_max = default_h_max(mesh)
    target = Target(
        target_vertices=target_vertices,
        error=error,
        p=p,
        fields=fields,
        limits=Limits(h_min, h_max, max_anisotropy, gradation),
        recovery=recovery,
        combine=combine,
        growth=growth,
        order=order,
        max_vertices=budget.vertices,
    )
    if target_vertices is not None:
        check_reachable(target_vertices, mesh, h_max)
    rule = StoppingRule(tolerance, max_iterations, budget)
    adaptation = Adaptation(Solve(solve), mesh, target, transfer)
    history = _resume(resume, mesh, target, rule)
    folder = prepare_folder(save, history, resume)
    if folder is not None and is_saved_in(folder, resume) and _is_estimated_again(history):
        history.append(folder)
    started = time.monotonic()
    while True:
        number = len(history)
        with Step(history, LoopError, LoopInterrupted, "stopping rule", iteration=number) as step:
            ended = rule.end(history, target, time.monotonic() - started)
            if ended is None:
                try:
                    history = history.with_iteration(adaptation.next(history, step))
                except BudgetError as refusal:
                    ended = history.ended(str(refusal), False)
            if ended is not None:
                if folder is not None:
                    ended.write_list(folder)
                return ended
            step.history = history
            if folder is not None:
                step.stage = "save"
                history.append(folder)
                if keep_last is not None:
                    step.history = history = history.left_on_disk(folder, keep_last)
            if callback is not None:
                step.stage = "callback"
                callback(history[-1])


def _check_keep_last(keep_last: int | None, save: PathLike | None) -> None:
    if keep_last is not None and keep_last < 1:
        raise ValueError(f"keep_last={keep_last!r}: at least the last mesh is needed")
    if keep_last is not None and save is None:
        raise ValueError("keep_last needs `save`, the folder where the other meshes are kept")


@dataclass(frozen=True, eq=False)
class Adaptation:
    """What is done in an iteration."""

    solve: Solve
    mesh: Mesh
    target: Target
    transfer: str

    def __post_init__(self) -> None:
        check_transfer(self.transfer)

    def next(self, history: History, step: Step[History]) -> Iteration:
        """A mesh for the last metric, the solution on it, and the metric for the next.

        The first solution for these options starts without a previous one.
        """
        mesh, previous, unit = self.mesh, None, np.nan
        if history:
            last = history[-1].snapshot
            with step.timed("adapt"):
                field = Background.on(last.mesh, last.metric)
                mesh = adapt(last.mesh, field, max_vertices=self.target.max_vertices)
                unit = _unit_fraction(mesh, field)
            if self.solve.takes_previous and history.for_options:
                with step.timed("transfer"):
                    previous = self._transfer(last.solution, last.mesh, mesh)
        with step.timed("solve"):
            solution = check_solution(self.solve(mesh, previous), mesh)
        with step.timed("metric"):
            metric, errors = self.target.metric(mesh, solution, history.for_options)
        return Iteration(
            number=len(history),
            n_points=len(mesh.points),
            n_triangles=len(mesh.triangles),
            errors=FrozenMapping(errors),
            unit_fraction=unit,
            seconds=step.seconds,
            kept=Snapshot(mesh, solution, metric),
        )

    def _transfer(self, solution: Solution, old: Mesh, new: Mesh) -> Any:
        fields = transfer_fields(solution.fields, old, new, self.transfer)
        return solution.as_returned(fields)


def _resume(
    resume: History | PathLike | None, mesh: Mesh, target: Target, rule: StoppingRule
) -> History:
    """The history to go on with: empty, or an earlier one that began with this mesh."""
    options = options_as_text(target, rule)
    earlier = load_earlier(resume, History, mesh)
    going_on = replace(earlier, reason="", converged=False, options=options)
    if earlier.for_options and not target.asks_for_the_same(earlier.options, options):
        return _with_last_estimated_again(going_on, target)
    return going_on


def _is_estimated_again(history: History) -> bool:
    """Whether the last metric is not the one on disk."""
    return bool(history) and isinstance(history[-1].kept, Snapshot)


def _with_last_estimated_again(history: History, target: Target) -> History:
    """The history with the metric and the errors of its last mesh by other options.

    Nothing of what was found for the earlier options counts as convergence. Where the last solution
    does not do for these options, its iteration is left out, so that it is made again: the mesh
    is the same then, bit for bit.
    """
    *before, last = history.iterations
    snapshot = last.snapshot
    try:
        metric, errors = target.metric(snapshot.mesh, snapshot.solution)
    except MetricError:
        again = []
    else:
        kept = replace(snapshot, metric=metric)
        again = [replace(last, errors=FrozenMapping(errors), kept=kept)]
    return replace(history, iterations=(*before, *again), options_since=len(before))


def _unit_fraction(mesh: Mesh, field: Background) -> float:
    lengths = nodal_lengths(mesh.points, mesh.unique_edges, field, "simpson")
    return float(np.mean((lengths >= UNIT[0]) & (lengths <= UNIT[1])))
