"""Whether points lie on the lines of a domain, and where on its runs."""

from __future__ import annotations

import itertools
from collections.abc import Callable
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from adaptmesh.types import Floats, Index

from .paths import derivatives_on, points_on

if TYPE_CHECKING:
    from .data import DomainData


REACH = 0.15
"""Curves are nearer to the chords of the domain than this share of the chord's length."""

NEWTON_STEPS = 8
"""Of the search for the nearest place of a curve; it converges quadratically from a chord of it."""

LAST_STEP = 1e-8
"""A step no longer than this leaves nothing but rounding to the next one."""

AN_END = 1e-9
"""A parameter this near to that of an end is what rounding leaves of it."""

BENT = np.radians(30)
BENT_REACH = 0.3
"""A part that turns by no more is nearer to its chord than this share of the chord's length."""

SHORTEST = 1e-12
"""Parts of runs are not halved beyond this, as a share of their parameters: a kink never ends."""

HALVINGS = 80
"""So many find a parameter to the last place, even if Newton's steps are of no use."""

ROUNDING = 4 * float(np.finfo(float).eps)
"""Of a parameter, by its share; it moves the point by so much times the derivative."""


TOLERANCE = 1e-12
"""How far off a line of a domain its vertices may be, as a share of the diameter of the domain."""


def tolerance_of(domain: DomainData) -> float:
    """How far off a line of the domain its vertices may be.

    Points along slanted segments are rounded to the nearest coordinates: that is `TOLERANCE` times
    the diameter of the domain plus a few units in the last place of the largest coordinate; and
    those of a mesh that the domain was found from may be off by what that took for straight.
    """
    diameter = float(np.hypot(*np.ptp(domain.points, axis=0)))
    largest = float(np.abs(domain.points).max())
    rounding = TOLERANCE * diameter + 8 * float(np.finfo(float).eps) * largest
    found = domain.corners_found
    return rounding if found is None else max(rounding, found.tolerance)


def places_on_runs(
    domain: DomainData, points: Floats, tolerance: float
) -> tuple[Index, Floats, Index]:
    """All places of runs that are as near as the tolerance to one of these points (n, 2).

    Returns
    -------
    run, u, point : (k,) arrays
        The run of each place, its parameter and the number of the point, in order along the runs.
        A point that several runs pass has a place on each, one where a closed run begins has two.
    """
    curved = domain.curved
    chords = np.flatnonzero(curved.segment_runs >= 0)
    parts = Parts(curved.segment_runs[chords].astype(np.intp), curved.segment_parameters[chords])
    found = _places(domain, parts, points, tolerance, REACH, _nearest)
    missing = np.setdiff1d(np.arange(len(points)), found[2])
    if len(missing):  # where chords of the domain turn by much, Newton's steps may lead astray
        bent = parts.bent_little(domain)
        run, u, k = _places(
            domain, bent, points[missing], tolerance, BENT_REACH, _nearest_bracketed
        )
        more = (run, u, missing[k])
        run, u, point = (np.concatenate(both) for both in zip(found, more, strict=True))
    else:
        run, u, point = found
    order = np.lexsort((u, run))
    run, u, point = run[order], u[order], point[order]
    again = (np.diff(run, prepend=-1) == 0) & (np.diff(point, prepend=-1) == 0)
    return run[~again], u[~again], point[~again]


class Parts(NamedTuple):
    """Parts of runs: the run (k,) and the parameters of the ends (k, 2) of each."""

    run: Index
    u: Floats

    def bent_little(self, domain: DomainData) -> Parts:
        """The same parts, halved until none turns by more than `BENT`."""
        runs, (run, u) = domain.curved.runs, self
        done = []
        while len(run):
            du = u[:, 1] - u[:, 0]
            d = [
                derivatives_on(runs, run, u[:, 0] + share * du)
                for share in (1e-3, 0.25, 0.75, 0.999)
            ]
            turns = [
                np.abs(np.arctan2(a[:, 0] * b[:, 1] - a[:, 1] * b[:, 0], (a * b).sum(axis=1)))
                for a, b in itertools.pairwise(d)
            ]
            bent = (np.sum(turns, axis=0) > BENT) & (du > SHORTEST * np.maximum(1, u[:, 1]))
            done.append(Parts(run[~bent], u[~bent]))
            (low, high), run = u[bent].T, np.repeat(run[bent], 2)
            middle = 0.5 * (low + high)
            u = np.stack([low, middle, middle, high], axis=1).reshape(-1, 2)
        return Parts(*(np.concatenate(x) for x in zip(*done, strict=True)))


def _places(
    domain: DomainData,
    parts: Parts,
    points: Floats,
    tolerance: float,
    reach: float,
    nearest: Callable[[DomainData, Index, Floats, Floats], Floats],
) -> tuple[Index, Floats, Index]:
    """Places of points on parts of runs: the run, the parameter and the point of each, (k,)."""
    import shapely

    runs = domain.curved.runs
    a, b = (points_on(runs, parts.run, parts.u[:, i]) for i in (0, 1))
    lines = shapely.linestrings(np.stack([a, b], axis=1))
    tree = shapely.STRtree(shapely.points(points))
    part, point = tree.query(lines, "dwithin", distance=reach * shapely.length(lines) + tolerance)
    run = parts.run[part]
    u = nearest(domain, run, parts.u[part], points[point])
    ends = np.array([r.length for r in runs])[run]
    for end in (np.zeros(len(u)), ends):
        u = np.where(np.abs(u - end) < AN_END, end, u)
    off = points_on(runs, run, u) - points[point]
    rounding = ROUNDING * np.maximum(1, u) * np.hypot(*derivatives_on(runs, run, u).T)
    on = np.hypot(*off.T) <= tolerance + rounding
    return run[on], u[on], point[on]


def _nearest(domain: DomainData, run: Index, u: Floats, points: Floats) -> Floats:
    """The parameters of runs (k,), about in these ranges (k, 2), nearest to points (k, 2)."""
    runs = domain.curved.runs
    a, b = (points_on(runs, run, u[:, i]) for i in (0, 1))
    along = ((points - a) * (b - a)).sum(axis=1) / ((b - a) ** 2).sum(axis=1)
    length = u[:, 1] - u[:, 0]
    low = np.maximum(u[:, 0] - length, 0)
    high = np.minimum(u[:, 1] + length, [runs[r].length for r in run])
    out = np.clip(u[:, 0] + along * length, low, high)
    for _ in range(NEWTON_STEPS):
        d = derivatives_on(runs, run, out)
        step = ((points - points_on(runs, run, out)) * d).sum(axis=1) / (d**2).sum(axis=1)
        out, before = np.clip(out + step, low, high), out
        if (np.abs(out - before) <= LAST_STEP).all():
            break
    return out


def _nearest_bracketed(domain: DomainData, run: Index, u: Floats, points: Floats) -> Floats:
    """The same for ranges in which runs turn by little.

    There (p(u) - x) . p'(u) grows with u for a point x on the run, so that Newton's steps and
    halving, where a step would leave what is known to hold the zero, find it.
    """
    runs = domain.curved.runs
    low, high = u[:, 0].copy(), u[:, 1].copy()
    out = 0.5 * (low + high)
    left = np.arange(len(out))
    for _ in range(HALVINGS):
        at = out[left]
        d = derivatives_on(runs, run[left], at)
        g = ((points_on(runs, run[left], at) - points[left]) * d).sum(axis=1)
        low[left] = np.where(g <= 0, at, low[left])
        high[left] = np.where(g >= 0, at, high[left])
        squared = (d**2).sum(axis=1)
        step = at - np.divide(g, squared, out=np.zeros_like(g), where=squared > 0)
        inside = (low[left] <= step) & (step <= high[left])
        out[left] = np.where(inside, step, 0.5 * (low[left] + high[left]))
        left = left[np.abs(out[left] - at) > ROUNDING * np.maximum(1, at)]
        if not len(left):
            break
    return out
