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
from collections.abc import Callable, Iterator, Mapping, Sequence
from contextlib import contextmanager
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from adaptmesh.adapt.adapt import adapt
from adaptmesh.checks import expect_function, expect_whole
from adaptmesh.mesh.mesh import Mesh
from adaptmesh.transfer.transfer import METHODS
from adaptmesh.transfer.transfer import transfer as transferred
from adaptmesh.types import Floats
from adaptmesh.value import FrozenMapping
from metrics import Background, Limits

from . import transient_files as files
from .adapt_loop import Clock, largest_size, refuse_other_mesh, with_domain
from .errors import TransientError, TransientInterrupted
from .history import PathLike
from .history_files import refuse_history
from .option_text import option_as_text
from .solution import Solved, as_solved, space_of
from .target import check_reachable
from .target_in_time import SteeringInTime
from .transient_history import Interval, TransientHistory

ROUNDING = 1e-9
"""Share of an interval by which the last time may miss its end, as sums of steps do."""


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
        Those that steer the meshes; by default all that are real and at the vertices.
    p : float, optional
        Of the norm, in space and time.
    in_time : {"average", "intersection"}, optional
        How the absolute Hessians at the samples of an interval are put together: their mean over
        time, which is the least error for so many vertices; or the finest in every direction, which
        holds the error at every moment.
    h_min, h_max, max_anisotropy, gradation, recovery, combine : optional
        As for `adapt_loop`.
    transfer : {"conservative", "interpolation"}, optional
        How fields are carried from interval to interval.
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
    intervals, the least error in L^p over space and time has the same factor before the L^p metric
    of every interval. So intervals in which more happens get more vertices.

    References
    ----------
    Alauzet, Frey, George, Mohammadi: 3D transient fixed point mesh adaptation for time-dependent
    problems: application to CFD simulations. Journal of Computational Physics 222 (2007), 592-623:
    the fixed point, with intersection in time.

    Belme, Dervieux, Alauzet: Time accurate anisotropic goal-oriented mesh adaptation for unsteady
    flows. Journal of Computational Physics 231 (2012), 6323-6348: global, with averages in time.
    """
    ends = _checked_times(times)
    n, lengths = len(ends) - 1, np.diff(ends)
    expect_whole("sweeps", sweeps, 1)
    expect_function("callback", callback)
    mesh = with_domain(mesh)
    limits = Limits(
        h_min, largest_size(mesh) if h_max is None else h_max, max_anisotropy, gradation
    )
    steering = SteeringInTime(target_vertices, p, fields, limits, recovery, combine, in_time)
    check_reachable(target_vertices, mesh, limits.h_max)
    solver = _Solver(initial, advance, transfer, keep_bounds)
    history = _resumed(resume, mesh, ends, steering)
    folder = _begun(save, history, resume)
    fitted: list[Background] = []
    for place in range(sum(map(len, history.sweeps)), int(sweeps) * n):
        sweep, number = divmod(place, n)
        clock = Clock()
        with _explained(history, sweep, number, clock):
            here = mesh
            if sweep:
                before = history.sweeps[sweep - 1]
                if number == 0 or not fitted:
                    with clock.of("metric"):
                        fitted = steering.metrics(
                            [i.mesh for i in before], [i.hessians for i in before], lengths
                        )
                with clock.of("adapt"):
                    here = adapt(before[number].mesh, fitted[number])
            first = solver.first(here, history.intervals[-1] if number else None, clock)
            interval = solver.advanced(here, first, ends[number : number + 2], steering, clock)
            history = history.with_interval(interval, sweep)
        with _explained(history, sweep, number, clock):
            if folder is not None:
                clock.stage = "save"
                files.append(history, folder)
            if callback is not None:
                clock.stage = "callback"
                callback(sweep, number, interval)
    return history


@dataclass(frozen=True)
class _Solver:
    """What the user gave, and the form in which fields come and go."""

    initial: Callable[[Mesh], Any]
    advance: Callable[[Mesh, Any, float, float], Any]
    method: str
    keep_bounds: bool

    def __post_init__(self) -> None:
        for name in ("initial", "advance"):
            if not callable(getattr(self, name)):
                kind = type(getattr(self, name)).__name__
                raise TypeError(f"{name} must be a function, not {kind}")
        if self.method not in METHODS:
            raise ValueError(f"transfer={self.method!r} is none of {', '.join(map(repr, METHODS))}")

    def first(self, mesh: Mesh, before: Interval | None, clock: Clock) -> Solved:
        """The fields at the start of an interval: the initial ones, or those of the one before."""
        if before is None:
            with clock.of("solve", "initial"):
                return _fields_of(self.initial(mesh), mesh, "initial")
        with clock.of("transfer"):
            carried = transferred(
                before.last,
                before.mesh,
                mesh,
                method=self.method,
                space={name: space_of(values, before.mesh) for name, values in before.last.items()},
                keep_bounds=self.keep_bounds,
            )
            return replace(as_solved(carried, mesh), is_bare=before.is_bare)

    def advanced(
        self, mesh: Mesh, first: Solved, ends: Floats, steering: SteeringInTime, clock: Clock
    ) -> Interval:
        """Go through an interval."""
        with clock.of("metric"):
            times, hessians = [float(ends[0])], [steering.hessians(mesh, first.fields)]
        last = first
        for t, given in self.samples(mesh, first, float(ends[0]), float(ends[1]), clock):
            last = _fields_of(given, mesh, "advance")
            if last.fields.keys() != first.fields.keys():
                raise ValueError(
                    f"advance gave {_names(last)} at t = {t:g}, but began with {_names(first)}: "
                    "fields keep their names"
                )
            with clock.of("metric"):
                times.append(t)
                hessians.append(steering.hessians(mesh, last.fields))
        clock.stage = "advance"
        if times[-1] != ends[1]:
            raise ValueError(
                f"advance stopped at t = {times[-1]:g}; the interval ends at {ends[1]:g}"
            )
        with clock.of("metric"):
            over_time = steering.over_time(np.array(times), hessians)
        return Interval(
            start=times[0],
            end=times[-1],
            mesh=mesh,
            first=first.fields,
            last=last.fields,
            times=np.array(times),
            hessians=FrozenMapping(dict(over_time)),
            seconds=clock.seconds,
            is_bare=first.is_bare,
        )

    def samples(
        self, mesh: Mesh, first: Solved, t0: float, t1: float, clock: Clock
    ) -> Iterator[tuple[float, Any]]:
        """What advance yields, or the fields at the end if it returns these."""
        with clock.of("solve", "advance"):
            answer = self.advance(mesh, first.as_returned(first.fields), t0, t1)
        if not isinstance(answer, Iterator):
            yield t1, answer
            return
        before = t0
        while True:
            with clock.of("solve", "advance"):
                sample = next(answer, None)
            if sample is None:
                return
            if not isinstance(sample, tuple) or len(sample) != 2:
                raise TypeError(
                    f"advance yielded {type(sample).__name__}: a time and the fields then, "
                    "`yield t, fields`, are wanted"
                )
            t = float(sample[0])
            if abs(t - t1) <= ROUNDING * (t1 - t0):
                t = t1
            if not before < t <= t1:
                raise ValueError(f"advance came from t = {before:g} to {t:g}; the end is {t1:g}")
            before = t
            yield t, sample[1]


def _fields_of(answer: Any, mesh: Mesh, giver: str) -> Solved:
    solved = as_solved(answer, mesh, giver)
    if solved.metric is not None or solved.errors:
        raise TypeError(
            f"{giver} returned a metric or errors: in time only fields can steer the meshes"
        )
    return solved


def _names(solved: Solved) -> str:
    return ", ".join(map(repr, solved.fields))


def _checked_times(times: ArrayLike) -> Floats:
    ends = np.asarray(times, np.float64)
    if ends.ndim != 1 or len(ends) < 2 or not np.isfinite(ends).all() or (np.diff(ends) <= 0).any():
        raise ValueError("times must be two or more finite numbers, ascending")
    return ends


def _resumed(
    resume: TransientHistory | PathLike | None,
    mesh: Mesh,
    ends: Floats,
    steering: SteeringInTime,
) -> TransientHistory:
    """The history to go on with: empty, or an earlier one of this mesh, times and options."""
    options = {
        name: option_as_text(value) for name, value in vars(steering).items() if value is not None
    }
    if resume is None:
        return TransientHistory(options=options)
    if isinstance(resume, TransientHistory):
        history = resume
    else:
        history = TransientHistory.load(resume, mesh.domain)
    whole = list(itertools.pairwise(ends.tolist()))
    for k, sweep in enumerate(history.sweeps):
        had = [(i.start, i.end) for i in sweep]
        if had != (whole[: len(had)] if k == len(history.sweeps) - 1 else whole):
            raise ValueError(
                f"the history to resume has {len(had)} intervals from {had[0][0]:g} to "
                f"{had[-1][1]:g} in sweep {k}, which are not those of times: give the same"
            )
    if history.sweeps:
        refuse_other_mesh(history.sweeps[0][0].mesh, mesh)
        _refuse_other_options(history.options, options)
    return history if history.options == options else replace(history, options=options)


def _refuse_other_options(earlier: Mapping[str, str], now: Mapping[str, str]) -> None:
    """Refuse to go on with meshes that were made for something else."""
    for name in sorted({*earlier, *now} if earlier else ()):
        had, wanted = earlier.get(name), now.get(name)
        if had != wanted:
            raise ValueError(
                f"the history to resume was made with {name}={had}, not {wanted}: give the same "
                "options; or begin without `resume`, on the first mesh of its last sweep"
            )


def _begun(
    save: PathLike | None, history: TransientHistory, resume: TransientHistory | PathLike | None
) -> Path | None:
    """The folder to save to; it has what there is to go on with, and nobody else's history."""
    if save is None:
        return None
    folder = Path(save).absolute()
    is_there = isinstance(resume, (str, Path)) and Path(resume).resolve() == folder.resolve()
    if not is_there:
        refuse_history(folder, files.LIST)
        files.save(history, folder)
    return folder


@contextmanager
def _explained(
    history: TransientHistory, sweep: int, interval: int, clock: Clock
) -> Iterator[None]:
    """Any exception, with where it happened and what there was until then."""
    try:
        yield
    except KeyboardInterrupt as interrupt:
        raise TransientInterrupted(history, sweep, interval, clock.stage) from interrupt
    except Exception as error:
        raise TransientError(history, sweep, interval, clock.stage, error) from error
