"""Points of lines far from the origin, rounded to where they are nearest to their line.

Coordinates of a million are rounded to 1e-10. A point that divides a line of length one there is
off it by as much, and a border with many such points encloses another area, in the ninth digit. But
some of the places next to the point that coordinates can be rounded to are far nearer to the line::

    . . . . . . .-'.        along the line some of the places (.) lie nearly on it; the best of
    . . . . .-'. . .        the first hundred on either side is a hundred times nearer to the
    . . .-'. . . . .        line than that which is nearest to the point
    .-'. . . . . . .
"""

from __future__ import annotations

import numpy as np

from adaptmesh.geometry.products import cross
from adaptmesh.types import Floats, Index

FAR = 1e-12
"""Lines are far from the origin if their coordinates are rounded by more than this share of them.
Others are left as they are: nothing is gained in areas of ten digits."""

PLACES = 128
"""So many units in the last place a point may be moved along its line, ..."""

SHARE = 1e-3
"""... and by no more than this share of the mean distance of those that divide the line."""


def nearest_to_lines(points: Floats, starts: Floats, ends: Floats, line: Index) -> Floats:
    """Points (c, 2) near lines, rounded so that they are as near to them as they can be.

    Parameters
    ----------
    points : (c, 2) array
    starts, ends : (k, 2) arrays
        The ends of the lines.
    line : (c,) array of int
        The line that each point is on.

    Returns
    -------
    (c, 2) array
    """
    length = np.hypot(*(ends - starts).T)
    unit = np.spacing(np.maximum(np.abs(starts), np.abs(ends)).max(axis=1))
    far = np.flatnonzero((unit > FAR * length)[line])
    if not len(far):
        return points
    k = line[far]
    reach = SHARE * length / (1 + np.bincount(line, minlength=len(starts)))
    a, d, p = starts[k], ends[k] - starts[k], points[far]
    # One coordinate goes through its next values; the other, whose rounding matters less, follows.
    stepped = (np.spacing(np.abs(p)) * np.abs(d[:, ::-1])).argmax(axis=1)
    rows = np.arange(len(far))
    step = np.spacing(np.abs(p[rows, stepped]))
    best, best_off = p.copy(), np.abs(cross(p - a, d))
    with np.errstate(divide="ignore", invalid="ignore", over="ignore"):
        slope = d[rows, 1 - stepped] / d[rows, stepped]
        for n in range(-PLACES, PLACES + 1):
            q = p.copy()
            q[rows, stepped] += n * step
            follows = (q - a)[rows, stepped] * slope
            q[rows, 1 - stepped] = a[rows, 1 - stepped] + follows
            off = np.abs(cross(q - a, d))
            better = (off < best_off) & (np.abs(q - p).max(axis=1) <= reach[k])
            best[better], best_off[better] = q[better], off[better]
    out: Floats = points.copy()
    out[far] = best
    return out
