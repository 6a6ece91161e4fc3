"""Which vertices of polylines are triangulated first, so that the others can follow one by one.

These divide polylines into ranges of edges. The vertices inside a range may be put in, in any
order, if nothing else reaches into its convex hull, and if it turns so little that it goes forward
in one direction: an edge between any two of its vertices then crosses nothing. A straight side is
one range.

::

        a --.                       a, b: ends of a range, triangulated
       /      `-- m -.              m: its other vertices, put in afterwards; the hull of a, m, ...
      / hull           b            b meets other hulls in a or b only
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from adaptmesh import ragged
from adaptmesh.domain.sides.polyline import Polylines
from adaptmesh.domain.sides.side import Sides
from adaptmesh.geometry.products import angles_between
from adaptmesh.types import Bools, Index

MAX_TURN = np.pi / 2

ONLY_AN_END = "FF*F0****"
"""Two convex sets meet in one point, which is on the border of both."""


def safe_ranges(sides: Sides, lines: Polylines) -> Index:
    """Ranges of edges, (r, 2), in order: from the first on, the second not included."""
    counts = np.bincount(lines.side, minlength=len(sides))[: sides.n_straight]
    first = ragged.offsets(counts)
    straight = np.stack([first[:-1], first[1:]], axis=1)
    if not sides.paths:
        return straight
    return np.concatenate([straight, _curved_ranges(sides, lines, int(first[-1]))])


def ends_of(lines: Polylines, ranges: Index) -> Index:
    """The vertices at the ends of ranges, (r, 2)."""
    return np.stack([lines.ends[ranges[:, 0], 0], lines.ends[ranges[:, 1] - 1, 1]], axis=1)


def _curved_ranges(sides: Sides, lines: Polylines, first: int) -> Index:
    """The ranges of the edges from the first curved one on."""
    ranges = _turning_little(lines, first)
    others, other_ends = _other_things(sides)
    while True:
        hulls, ends = _hulls(lines, ranges), ends_of(lines, ranges)
        split = _clashes(hulls, ends, others, other_ends) & (ranges[:, 1] - ranges[:, 0] > 1)
        if not split.any():
            return ranges
        middle = ranges[split].sum(axis=1) // 2
        halves = np.stack([ranges[split, 0], middle, middle, ranges[split, 1]], axis=1)
        ranges = np.concatenate([ranges[~split], halves.reshape(-1, 2)])
        ranges = ranges[np.argsort(ranges[:, 0])]


def _other_things(sides: Sides) -> tuple[NDArray[np.object_], Index]:
    """Straight sides, loose points and corners, and the corners at the ends of each, or -1."""
    import shapely

    ends = sides.ends[: sides.n_straight]
    corners = np.arange(len(sides.corners))
    things = [
        shapely.linestrings(sides.corners[ends]),
        shapely.points(sides.loose),
        shapely.points(sides.corners),
    ]
    nowhere = np.full((len(sides.loose), 2), -1)
    return np.concatenate(things), np.concatenate([ends, nowhere, np.stack([corners] * 2, axis=1)])


def _turning_little(lines: Polylines, first: int) -> Index:
    """Ranges of edges of one side that turn by no more than `MAX_TURN` together."""
    d = np.diff(lines.points[lines.ends[first:]], axis=1)[:, 0]
    turn = angles_between(np.roll(d, 1, axis=0), d)
    goes_on = np.diff(lines.side[first:], prepend=-1) == 0
    starts, total = [], 0.0
    for k, (follows, by) in enumerate(zip(goes_on.tolist(), turn.tolist(), strict=True)):
        total += by
        if not follows or total > MAX_TURN:
            starts.append(first + k)
            total = 0.0
    return np.stack([starts, [*starts[1:], len(lines.side)]], axis=1)


def _hulls(lines: Polylines, ranges: Index) -> NDArray[np.object_]:
    import shapely

    edges = ranges[:, 1] - ranges[:, 0]
    starts = lines.ends[ragged.ranges(ranges[:, 0], edges), 0]
    vertex = np.insert(starts, np.cumsum(edges), lines.ends[ranges[:, 1] - 1, 1])
    shapes = shapely.linestrings(lines.points[vertex], indices=ragged.owners(edges + 1))
    return np.asarray(shapely.convex_hull(shapes))


def _clashes(
    hulls: NDArray[np.object_], ends: Index, others: NDArray[np.object_], other_ends: Index
) -> Bools:
    """Which hulls meet another hull, or another thing, elsewhere than in a common end."""
    import shapely

    things, thing_ends = np.concatenate([hulls, others]), np.concatenate([ends, other_ends])
    i, j = shapely.STRtree(things).query(hulls, predicate="intersects")
    i, j = i[i != j], j[i != j]
    shared = (ends[i][:, :, None] == thing_ends[j][:, None, :]).any(axis=(1, 2))
    is_point = thing_ends[j, 0] == thing_ends[j, 1]
    fine = shared & is_point & (thing_ends[j, 0] >= 0)
    ask = shared & ~fine
    fine[ask] = shapely.relate_pattern(things[i[ask]], things[j[ask]], ONLY_AN_END)
    out = np.zeros(len(hulls), bool)
    out[i[~fine]] = True
    return out
