"""Time-dependent problems: a mesh for each interval of time, all of them from one budget.

The global fixed point (Alauzet, Frey, George, Mohammadi 2007)::

    sweep     t0 ------- t1 ------- t2 ------- t3
      0        mesh 0     mesh 0     mesh 0          advance through all intervals; in each, the
                  \\          |         /             absolute Hessians at its samples are averaged,
      1        mesh a -> mesh b -> mesh c            or intersected; one factor for all metrics, so
                        transfer                     that the vertices are what was asked for; then
      2        mesh a' -> ...                        again from the start, on meshes that were made
                                                     for what is going to happen on them

In a single pass a mesh is made for what has been; in the fixed point it is there when the front
comes.
"""

from __future__ import annotations

import itertools
from collections.abc import Callable, Mapping, Sequence
from dataclasses import replace
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from adaptmesh.adapt.adapt import adapt
from adaptmesh.checks import expect_function, expect_whole
from adaptmesh.mesh.mesh import Mesh
from adaptmesh.types import Floats
from metrics import Background, Limits

from .advance import Advance
from .base_history import PathLike
from .errors import TransientError, TransientInterrupted
from .first_mesh import default_h_max, with_domain
from .records import Interval
from .resume import load_earlier, options_as_text, prepare_folder
from .step import Step
from .target_in_time import TargetInTime
from .transient_history import TransientHistory
from .vertex_count import check_reachable


def transient_loop(
    advance: Callable[[Mesh, Any, float, float], Any],
    initial: Callable[[Mesh], Any],
    mesh: Mesh,
    times: ArrayLike,
    *,
    target_vertices: float,
    sweeps: int = 3,
    fields: Sequence[str] | None = None,
    p: float = 2.0,
    in_time: str = "average",
    h_min: float = 0.0,
    h_max: float | None = None,
    max_anisotropy: float = np.inf,
    gradation: float | None = 2.0,
    recovery: str = "green",
    combine: str = "intersection",
    transfer: str = "conservative",
    keep_bounds: bool = False,
    callback: Callable[[int, int, Interval], object] | None = None,
    save: PathLike | None = None,
    resume: TransientHistory | PathLike | None = None,
) -> TransientHistory:
    """Solve in time, on a mesh for each interval, until the meshes fit what happens on them.

    Parameters
    ----------
    advance : callable
        Called as ``advance(mesh, fields, t0, t1)`` with the fields at t0, in the form in which
        `initial` returned them. It yields ``(t, fields)`` as it steps from t0 to t1, as often as
        the solution should be looked at, and last at t1; or it returns the fields at t1. Fields
        keep their names from first to last.
    initial : callable
        Called as ``initial(mesh)``: the fields at the first time, an array (n,) or a dict by name,
        as for `adapt_loop`.
    mesh : Mesh
        For all intervals of the first sweep.
    times : (k + 1,) array_like
        The ends of the k intervals, ascending.
    target_vertices : float
        The number of vertices, averaged over time.
    sweeps : int, optional
        How often all intervals are gone through, at least once.
    fields : sequence of str, optional
        Those that the meshes are adapted to; by default all that are real and at the vertices.
    p : float, optional
        Of the norm, in space and time.
    in_time : {"average", "intersection"}, optional
        How the absolute Hessians at the samples of an interval are put together: their mean over
        time, which minimises the error for so many vertices; or the finest in every direction,
        which holds the error at every moment.
    h_min, h_max, max_anisotropy, gradation, recovery, combine : optional
        As for `adapt_loop`.
    transfer : {"conservative", "interpolation"}, optional
        How fields are transferred from interval to interval.
    keep_bounds : bool, optional
        As for `adaptmesh.transfer`.
    callback : callable, optional
        Called as ``callback(sweep, number, interval)`` when an interval is complete.
    save : path, optional
        A folder, to which every interval is written when it is complete.
    resume : TransientHistory or path, optional
        What an earlier call left, or the folder where it was saved. The loop goes on at the start
        of the interval that was not completed, and gives what it would have given without
        interruption, bit for bit, if it is called with the same arguments. Other options for the
        meshes are refused.

    Returns
    -------
    TransientHistory

    Raises
    ------
    TransientError
        For any exception in `advance` or `initial`, or in what was made of their results: it says
        in which sweep and interval, and holds the history until then. The exception itself is its
        ``__cause__``.
    TransientInterrupted
        A KeyboardInterrupt that holds the history.
    ValueError, TypeError
        For options that make no sense, before anything is done.

    Notes
    -----
    If every time step costs what its mesh has vertices, and steps are equally long in all
    intervals, the minimal error in L^p over space and time has the same factor before the L^p
    metric of every interval. So intervals in which more happens get more vertices.

    References
    ----------
    Alauzet, Frey, George, Mohammadi: 3D transient fixed point mesh adaptation for time-dependent
    problems: application to CFD simulations. Journal of Computational Physics 222 (2007), 592-623:
    the fixed point, with intersection in time.

    Belme, Dervieux, Alauzet: Time accurate anisotropic goal-oriented mesh adaptation for unsteady
    flows. Journal of Computational Physics 231 (2012), 6323-6348: global, with averages in time.
    """
    ends = _check_times(times)
    n, lengths = len(ends) - 1, np.diff(ends)
    expect_whole("sweeps", sweeps, 1)
    expect_function("callback", callback)
    mesh = with_domain(mesh)
    limits = Limits(
        h_min, default_h_max(mesh) if h_max is None else h_max, max_anisotropy, gradation
    )
    target = TargetInTime(
        target_vertices=target_vertices,
        p=p,
        fields=fields,
        limits=limits,
        recovery=recovery,
        combine=combine,
        in_time=in_time,
    )
    check_reachable(target_vertices, mesh, limits.h_max)
    advancing = Advance(initial, advance, transfer, keep_bounds)
    history = _resume(resume, mesh, ends, target)
    folder = prepare_folder(save, history, resume)
    fitted: list[Background] = []
    for done in range(len(history.records), int(sweeps) * n):
        sweep, number = divmod(done, n)
        position = {"sweep": sweep, "interval": number}
        with Step(history, TransientError, TransientInterrupted, "metric", **position) as step:
            here = mesh
            if sweep:
                before = history.sweeps[sweep - 1]
                if number == 0 or not fitted:
                    with step.timed("metric"):
                        fitted = target.metrics(
                            [i.mesh for i in before], [i.hessians for i in before], lengths
                        )
                with step.timed("adapt"):
                    here = adapt(before[number].mesh, fitted[number])
            first = advancing.first(here, history.intervals[-1] if number else None, step)
            interval = advancing.interval(here, first, ends[number : number + 2], target, step)
            step.history = history = history.with_interval(interval, sweep)
            if folder is not None:
                step.stage = "save"
                history.append(folder)
            if callback is not None:
                step.stage = "callback"
                callback(sweep, number, interval)
    return history


def _check_times(times: ArrayLike) -> Floats:
    ends = np.asarray(times, np.float64)
    if ends.ndim != 1 or len(ends) < 2 or not np.isfinite(ends).all() or (np.diff(ends) <= 0).any():
        raise ValueError("times must be two or more finite numbers, ascending")
    return ends


def _resume(
    resume: TransientHistory | PathLike | None, mesh: Mesh, ends: Floats, target: TargetInTime
) -> TransientHistory:
    """The history to go on with: empty, or an earlier one of this mesh, times and options."""
    options = options_as_text(target)
    history = load_earlier(resume, TransientHistory, mesh)
    whole = list(itertools.pairwise(ends.tolist()))
    for k, sweep in enumerate(history.sweeps):
        had = [(i.start, i.end) for i in sweep]
        if had != (whole[: len(had)] if k == len(history.sweeps) - 1 else whole):
            raise ValueError(
                f"the history to resume has {len(had)} intervals from {had[0][0]:g} to "
                f"{had[-1][1]:g} in sweep {k}, which are not those of times: give the same"
            )
    if history.sweeps:
        _check_same_options(history.options, options)
    return history if history.options == options else replace(history, options=options)


def _check_same_options(earlier: Mapping[str, str], now: Mapping[str, str]) -> None:
    """Raise rather than go on with meshes that were made for something else."""
    for name in sorted({*earlier, *now} if earlier else ()):
        had, given = earlier.get(name), now.get(name)
        if had != given:
            raise ValueError(
                f"the history to resume was made with {name}={had}, not {given}: give the same "
                "options; or begin without `resume`, on the first mesh of its last sweep"
            )
