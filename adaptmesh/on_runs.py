"""Whether points lie on the lines of a domain, and where on its runs."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from .runs import derivatives_on, points_on

if TYPE_CHECKING:
    from .domain import Domain

Floats = NDArray[np.float64]
Index = NDArray[np.integer]

REACH = 0.15
"""Curves are nearer to the chords of the domain than this share of the chord's length."""

NEWTON_STEPS = 8
"""Of the search for the nearest place of a curve; it converges quadratically from a chord of it."""

LAST_STEP = 1e-8
"""A step no longer than this leaves nothing but rounding to the next one."""

AN_END = 1e-9
"""A parameter this near to that of an end is what rounding leaves of it."""


TOLERANCE = 1e-12
"""How far off a line of a domain its vertices may be, as a share of the diameter of the domain."""


def tolerance_of(domain: Domain) -> float:
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


def places_on_runs(domain: Domain, points: Floats, tolerance: float) -> tuple[Index, Floats, Index]:
    """All places of runs that are as near as the tolerance to one of these points (n, 2).

    Returns
    -------
    run, u, point : (k,) arrays
        The run of each place, its parameter and the number of the point, in order along the runs.
        A point that several runs pass has a place on each, one where a closed run begins has two.
    """
    import shapely

    curved = domain.curved
    chords = np.flatnonzero(curved.segment_runs >= 0)
    a, b = (domain.points[i] for i in domain.segments[chords].T)
    lines = shapely.linestrings(np.stack([a, b], axis=1))
    tree = shapely.STRtree(shapely.points(points))
    chord, point = tree.query(lines, "dwithin", distance=REACH * shapely.length(lines))
    run = curved.segment_runs[chords[chord]].astype(np.intp)
    u = _nearest(domain, run, curved.segment_parameters[chords[chord]], points[point])
    ends = np.array([r.length for r in curved.runs])[run]
    for end in (np.zeros(len(u)), ends):
        u = np.where(np.abs(u - end) < AN_END, end, u)
    off = points_on(curved.runs, run, u) - points[point]
    on = np.hypot(*off.T) <= tolerance
    order = np.lexsort((u[on], run[on]))
    run, u, point = run[on][order], u[on][order], point[on][order]
    again = (np.diff(run, prepend=-1) == 0) & (np.diff(point, prepend=-1) == 0)
    return run[~again], u[~again], point[~again]


def _nearest(domain: Domain, run: Index, u: Floats, points: Floats) -> Floats:
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
    nearest: Floats = out
    return nearest
