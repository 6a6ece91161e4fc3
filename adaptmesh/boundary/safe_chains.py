"""Which of the cuts of curves are triangulated first, so that the others can follow one by one.

A span is a row of chords along a run. The others of its vertices may be put in, in any order, if
nothing else reaches into the convex hull of the span, and if it turns so little that it goes
forward in one direction: a chord between any two of its vertices then crosses nothing.

::

        a --.                       a, b: ends of the span, triangulated
       /      `-- m -.              m: its other vertices, put in afterwards; the hull of a, m, ...
      / hull           b            b meets other hulls in a or b only
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from adaptmesh.domain.polyline import Chords, Surroundings
from adaptmesh.types import Bools, Index

MOST_TURN = np.pi / 2

ONLY_AN_END = "FF*F0****"
"""Two convex sets meet in one point, which is on the border of both."""


def spans_of(chords: Chords, around: Surroundings) -> Index:
    """Spans as ranges of chords, (s, 2): from the first on, the second not included."""
    import shapely

    turn = _turns(chords)
    spans = _turning_little(chords.run, turn)
    others = np.concatenate(
        [
            shapely.linestrings(around.points[around.lines]),
            shapely.points(around.points[around.n_corners :]),
            shapely.points(around.points[: around.n_corners]),
        ]
    )
    other_ends = np.full((len(others), 2), -1)
    other_ends[: len(around.lines)] = around.lines
    other_ends[len(others) - around.n_corners :] = np.arange(around.n_corners)[:, None]
    while True:
        ends = np.stack([chords.ends[spans[:, 0], 0], chords.ends[spans[:, 1] - 1, 1]], axis=1)
        hulls = _hulls(chords, spans)
        clash = _clashes(hulls, ends, others, other_ends)
        split = clash & (spans[:, 1] - spans[:, 0] > 1)
        if not split.any():
            return spans
        middle = spans[split].sum(axis=1) // 2
        halves = np.stack([spans[split, 0], middle, middle, spans[split, 1]], axis=1)
        spans = np.concatenate([spans[~split], halves.reshape(-1, 2)])
        spans = spans[np.argsort(spans[:, 0])]


def _turns(chords: Chords) -> NDArray[np.float64]:
    """By how much each chord turns from the one before it; no matter for the first of a run."""
    d = np.diff(chords.points[chords.ends], axis=1)[:, 0]
    before = np.roll(d, 1, axis=0)
    cross = before[:, 0] * d[:, 1] - before[:, 1] * d[:, 0]
    return np.asarray(np.abs(np.arctan2(cross, (before * d).sum(axis=1))))


def _turning_little(run: Index, turn: NDArray[np.float64]) -> Index:
    """Rows of chords of one run that turn by no more than `MOST_TURN` together."""
    starts, total = [], 0.0
    same = np.diff(run, prepend=-1) == 0
    for k, (goes_on, by) in enumerate(zip(same.tolist(), turn.tolist(), strict=True)):
        total += by
        if not goes_on or total > MOST_TURN:
            starts.append(k)
            total = 0.0
    return np.stack([starts, [*starts[1:], len(run)]], axis=1)


def _hulls(chords: Chords, spans: Index) -> NDArray[np.object_]:
    import shapely

    counts = np.diff(spans, axis=1)[:, 0] + 1
    row = np.repeat(np.arange(len(spans)), counts)
    k = np.repeat(spans[:, 0] - np.cumsum(counts) + counts, counts) + np.arange(counts.sum())
    is_last = np.append(row[1:] != row[:-1], True)
    vertex = np.where(
        is_last, chords.ends[np.where(is_last, k - 1, k), 1], chords.ends[k - is_last, 0]
    )
    lines = shapely.linestrings(chords.points[vertex], indices=row)
    return np.asarray(shapely.convex_hull(lines))


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
