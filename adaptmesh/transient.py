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
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from metrics import Background, Curvature, Limits, absolute, combined
from metrics.nodal import predicted_vertices
from metrics.solution import optimal_tensors

from .adapt import adapt
from .errors import AdaptmeshError
from .loop import largest_size, with_domain
from .mesh import Mesh
from .solved import Solved, as_solved, space_of
from .steering import can_steer
from .transfer import METHODS, transfer

Floats = NDArray[np.float64]
Fields = Mapping[str, NDArray[Any]]

IN_TIME = ("average", "intersection")
PRECISION = 1e-3  # of the mean number of vertices predicted
TRIALS = 8
FLATNESS = 1e-8  # curvature below this share of the largest is not told from none


@dataclass(frozen=True, eq=False)
class Interval:
    """What happened on one mesh.

    Attributes
    ----------
    start, end : float
        Of the interval.
    mesh : Mesh
    first, last : mapping of str to array
        The fields at its start, as they were carried there, and at its end.
    times : (k,) array
        Of the samples from which the metric was made.
    """

    start: float
    end: float
    mesh: Mesh
    first: Fields
    last: Fields
    times: Floats


class TransientError(AdaptmeshError):
    """A sweep that was stopped by an exception, which is its ``__cause__``.

    Attributes
    ----------
    history : TransientHistory
        All sweeps that were completed, and the intervals of the one that was not.
    sweep, interval : int
        Where it stopped; the interval is -1 while meshes were made for the sweep.
    """

    def __init__(
        self, history: TransientHistory, sweep: int, interval: int, error: BaseException
    ) -> None:
        self.history, self.sweep, self.interval = history, sweep, interval
        super().__init__(f"sweep {sweep}, interval {interval}: {type(error).__name__}: {error}")


@dataclass(frozen=True, eq=False)
class TransientHistory:
    """The intervals of each sweep; print it.

    Attributes
    ----------
    sweeps : tuple of tuple of Interval
        The last is the best.
    """

    sweeps: tuple[tuple[Interval, ...], ...] = ()

    @property
    def intervals(self) -> tuple[Interval, ...]:
        """Those of the last sweep."""
        return self.sweeps[-1] if self.sweeps else ()

    def with_sweep(self, intervals: Sequence[Interval]) -> TransientHistory:
        """The same with another sweep, if it has any intervals."""
        return TransientHistory((*self.sweeps, tuple(intervals))) if intervals else self

    def mean_vertices(self, sweep: int = -1) -> float:
        """The number of vertices, averaged over time."""
        intervals = self.sweeps[sweep]
        weights = [i.end - i.start for i in intervals]
        return float(np.average([len(i.mesh.points) for i in intervals], weights=weights))

    def __str__(self) -> str:
        lines = ["sweep  vertices, averaged over time    least     most"]
        for k, sweep in enumerate(self.sweeps):
            counts = [len(i.mesh.points) for i in sweep]
            lines.append(f"{k:5d}  {self.mean_vertices(k):28.0f} {min(counts):8d} {max(counts):8d}")
        return "\n".join(lines)


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
    recovery: str = "least squares",
    combine: str = "intersection",
    transfer: str = "conservative",
    keep_bounds: bool = False,
    callback: Callable[[int, int, Interval], object] | None = None,
) -> TransientHistory:
    """Solve in time, on a mesh for each interval, until the meshes fit what happens on them.

    Parameters
    ----------
    advance : callable
        Called as ``advance(mesh, fields, t0, t1)`` with the fields at t0, in the form in which
        `initial` returned them. It yields ``(t, fields)`` as it steps from t0 to t1, as often as
        the solution should be looked at, and last at t1; or it returns the fields at t1.
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

    Returns
    -------
    TransientHistory

    Raises
    ------
    TransientError
        For any exception on the way; it has the history until then.

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
    if transfer not in METHODS:
        raise ValueError(f"transfer={transfer!r} is none of {', '.join(map(repr, METHODS))}")
    if in_time not in IN_TIME:
        raise ValueError(f"in_time={in_time!r} is none of {', '.join(map(repr, IN_TIME))}")
    if sweeps < 1 or sweeps != int(sweeps):
        raise ValueError(f"sweeps={sweeps!r}: a whole number from 1 on is wanted")
    if h_max is None:
        h_max = largest_size(mesh)
    limits = Limits(h_min, h_max, max_anisotropy, gradation)
    steering = _Steering(fields, recovery, in_time, p, limits, combine, target_vertices)
    solver = _Solver(initial, advance, transfer, keep_bounds)
    meshes = [with_domain(mesh)] * (len(ends) - 1)
    history = TransientHistory()
    hessians: list[list[Floats]] = []
    for sweep in range(int(sweeps)):
        if sweep:
            with _explained(history, sweep, -1):
                fitted = steering.metrics(meshes, hessians, np.diff(ends))
                meshes = [adapt(m, f) for m, f in zip(meshes, fitted, strict=True)]
        intervals: list[Interval] = []
        hessians = []
        for number, (t0, t1) in enumerate(itertools.pairwise(ends.tolist())):
            with _explained(history.with_sweep(intervals), sweep, number):
                first = solver.first(meshes[number], intervals)
                interval, curved = solver.advanced(meshes[number], first, t0, t1, steering)
                intervals.append(interval)
                hessians.append(curved)
                if callback is not None:
                    callback(sweep, number, interval)
        history = history.with_sweep(intervals)
    return history


@contextmanager
def _explained(history: TransientHistory, sweep: int, interval: int) -> Iterator[None]:
    """Any exception, with where it happened and what there was until then."""
    try:
        yield
    except Exception as error:
        raise TransientError(history, sweep, interval, error) from error


def _checked_times(times: ArrayLike) -> Floats:
    ends = np.asarray(times, np.float64)
    if ends.ndim != 1 or len(ends) < 2 or not np.isfinite(ends).all() or (np.diff(ends) <= 0).any():
        raise ValueError("times must be two or more finite numbers, ascending")
    return ends


@dataclass
class _Solver:
    """What the user gave, and the form in which fields come and go."""

    initial: Callable[[Mesh], Any]
    advance: Callable[[Mesh, Any, float, float], Any]
    method: str
    keep_bounds: bool
    is_bare: bool = False

    def first(self, mesh: Mesh, intervals: list[Interval]) -> Solved:
        """The fields at the start of an interval: the initial ones, or those of the one before."""
        if not intervals:
            solved = as_solved(self.initial(mesh), mesh)
            self.is_bare = solved.is_bare
            return solved
        before = intervals[-1]
        carried = transfer(
            before.last,
            before.mesh,
            mesh,
            method=self.method,
            space={name: space_of(values, before.mesh) for name, values in before.last.items()},
            keep_bounds=self.keep_bounds,
        )
        return replace(as_solved(carried, mesh), is_bare=self.is_bare)

    def advanced(
        self, mesh: Mesh, first: Solved, t0: float, t1: float, steering: _Steering
    ) -> tuple[Interval, list[Floats]]:
        """Go through an interval; what happened, and the Hessian of each field over it."""
        times, kept, last = [t0], [steering.curvature(mesh, first.fields)], first
        for t, given in _samples(self.advance(mesh, first.as_returned(first.fields), t0, t1), t1):
            if not times[-1] < t <= t1:
                raise ValueError(f"advance came from t = {times[-1]:g} to {t:g}; the end is {t1:g}")
            last = as_solved(given, mesh)
            times.append(float(t))
            kept.append(steering.curvature(mesh, last.fields))
        if times[-1] != t1:
            raise ValueError(f"advance stopped at t = {times[-1]:g}; the interval ends at {t1:g}")
        interval = Interval(t0, t1, mesh, first.fields, last.fields, np.array(times))
        return interval, steering.over_time(np.array(times), kept)


def _samples(answer: Any, end: float) -> Iterator[tuple[float, Any]]:
    """What advance yields, or the fields at the end if it returns these."""
    if isinstance(answer, Iterator):
        yield from answer
    else:
        yield end, answer


@dataclass(frozen=True)
class _Steering:
    """From fields in time to metrics for all intervals."""

    fields: Sequence[str] | None
    recovery: str
    in_time: str
    p: float
    limits: Limits
    combine: str
    target: float

    def curvature(self, mesh: Mesh, fields: Fields) -> list[Floats]:
        """The absolute Hessian of each field that steers."""
        chosen = [
            name
            for name, values in fields.items()
            if (name in self.fields if self.fields is not None else can_steer(values, mesh))
        ]
        missing = set(self.fields or ()) - set(chosen)
        if missing or not chosen:
            names = ", ".join(map(repr, fields))
            raise ValueError(
                f"no field {min(missing, default='')!r} to steer by; there are {names}"
            )
        return [self._absolute(mesh, fields[name]) for name in chosen]

    def _absolute(self, mesh: Mesh, values: NDArray[Any]) -> Floats:
        """Zero where a field is still the same everywhere, as before anything has happened."""
        if not np.ptp(values.reshape(len(values), -1), axis=0).any():
            return np.zeros((len(values), 3))
        return Curvature.of(mesh.points, mesh.triangles, values, self.recovery).absolute

    def over_time(self, times: Floats, samples: list[list[Floats]]) -> list[Floats]:
        """One Hessian of each field for an interval: the mean by trapezoids, or the finest."""
        weights = np.gradient(times)
        weights[[0, -1]] /= 2
        out = []
        for of_field in zip(*samples, strict=True):
            if self.in_time == "average":
                out.append(np.average(of_field, axis=0, weights=weights))
            else:
                bent = [h for h in of_field if h.any()]
                out.append(combined(bent) if bent else of_field[0])
        return out

    def metrics(
        self, meshes: list[Mesh], hessians: list[list[Floats]], lengths: Floats
    ) -> list[Background]:
        """One factor for all intervals, by which the mean number of vertices is the target.

        All meshes side by side are one mesh of many parts, to which the metric of a solution
        applies as it stands; its total is corrected until the mean over time is right.
        """
        n_of = np.cumsum([0, *(len(m.points) for m in meshes)])
        points = np.concatenate([m.points for m in meshes])
        triangles = np.concatenate([m.triangles + k for m, k in zip(meshes, n_of, strict=False)])
        stacked = [
            absolute(h, FLATNESS * np.abs(h).max())
            for h in map(np.concatenate, zip(*hessians, strict=True))
            if h.any()
        ]
        total = self.target * len(meshes)
        for _ in range(TRIALS):
            whole = optimal_tensors(
                points,
                triangles,
                stacked,
                target_vertices=total,
                p=self.p,
                limits=self.limits,
                combine=self.combine,
            )
            parts = [whole[a:b] for a, b in itertools.pairwise(n_of)]
            counts = [
                predicted_vertices(m.points, m.triangles, part)
                for m, part in zip(meshes, parts, strict=True)
            ]
            mean = float(np.average(counts, weights=lengths))
            if abs(mean / self.target - 1) < PRECISION:
                break
            total *= self.target / mean
        return [
            Background(m.points, m.triangles, part) for m, part in zip(meshes, parts, strict=True)
        ]
