"""Where to cut runs of curves so that the parts have unit metric length along the true curve.

As on straight segments, the metric is asked for in rounds, at all places of all runs at once: a
chord is trusted when its own length and that of its halves agree, and halved otherwise. The ends of
chords are on the curve, so that the metric is seen where the vertices will be.
"""

from __future__ import annotations

import itertools
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from adaptmesh._core import (
    AGREEMENT,
    FINE_DEPTH,
    LONGEST_CHORD,
    LONGEST_FINE_CHORD,
    SHORTEST_CHORD,
)
from adaptmesh.domain.paths import Run, points_on
from adaptmesh.errors import BudgetError
from adaptmesh.types import Floats, Index
from metrics import ControlSpace
from metrics.tensor import lengths

# Chords of curves are halved no more often; the other bounds are those of the core, which does the
# same on straight lines: see core/edge_sampler.hpp.
DEEPEST = 45


@dataclass(frozen=True)
class Measured:
    """Runs in chords so short that their metric lengths are trusted, in order along each run.

    Attributes
    ----------
    run : (k,) array of int
        The run of each chord.
    u : (k, 2) array
        The parameters of its ends.
    length : (k,) array
        Its metric length.
    speeds : (k, 2) array
        Its length in the metrics of both ends.
    first : (r + 1,) array of int
        The first chord of each run.
    """

    run: Index
    u: Floats
    length: Floats
    speeds: Floats
    first: Index

    def unit_cuts(self, least_parts: Index) -> list[Floats]:
        """Parameters that cut each run into parts of (nearly) unit length, at least so many.

        Ascending, with both ends. The parts are equal in metric length along the curve.
        """
        return [
            _equal_shares(self.u[i:j], self.length[i:j], self.speeds[i:j], int(least))
            for (i, j), least in zip(itertools.pairwise(self.first), least_parts, strict=True)
        ]

    def lengths_between(self, run: Index, u: Floats) -> Floats:
        """Metric lengths of parts of runs (k,) between parameters (k, 2), along the curve."""
        out = np.empty(len(run))
        for r in np.unique(run):
            i, j = self.first[r], self.first[r + 1]
            known = np.concatenate([self.u[i:j, 0], self.u[j - 1 : j, 1]])
            total = np.concatenate([[0.0], np.cumsum(self.length[i:j])])
            mine = run == r
            out[mine] = np.diff(np.interp(u[mine], known, total), axis=1)[:, 0]
        return out


def equal_shares(u: Floats, demand: Floats) -> Floats:
    """Parameters, with both ends, at equal shares of a demand given for each of some intervals."""
    return _equal_shares(u, demand, np.ones((len(u), 2)), 1)


def measure_runs(
    runs: Sequence[Run], run: Index, u: Floats, field: ControlSpace, most_points: int
) -> Measured:
    """Measure runs along their curves.

    Parameters
    ----------
    runs : sequence of Run
    run : (k,) array of int
    u : (k, 2) array
        Chords that cover the runs, to begin with.
    field : ControlSpace
    most_points : int
        A boundary of many more unit parts than this is refused.
    """
    places = points_on(runs, np.repeat(run, 2), u.ravel())
    tensors = field(places)
    chord = np.arange(2 * len(run)).reshape(-1, 2)  # its ends, by place
    trusted: list[list[NDArray[Any]]] = []
    depth = 0
    while len(chord):
        _check_budget(len(chord), most_points, places[chord[0, 0]])
        middle = len(places) + np.arange(len(chord))
        u_middle = u.mean(axis=1)
        new = points_on(runs, run, u_middle)
        places, tensors = np.concatenate([places, new]), np.concatenate([tensors, field(new)])
        left, right = (np.stack(e, axis=1) for e in ((chord[:, 0], middle), (middle, chord[:, 1])))
        whole, one, other = (_lengths(places, tensors, e) for e in (chord, left, right))
        both = one + other
        longest = LONGEST_CHORD if depth < FINE_DEPTH else LONGEST_FINE_CHORD
        enough = (np.abs(whole - both) <= AGREEMENT * both) & (both <= longest)
        enough |= (both <= SHORTEST_CHORD) | (depth >= DEEPEST)
        halves = (
            np.repeat(run, 2),
            np.stack([u[:, 0], u_middle, u_middle, u[:, 1]], axis=1).reshape(-1, 2),
            np.stack([left, right], axis=1).reshape(-1, 2),
            np.stack([one, other], axis=1).ravel(),
        )
        kept = np.repeat(enough, 2)
        trusted.append([a[kept] for a in halves])
        run, u, chord = halves[0][~kept], halves[1][~kept], halves[2][~kept]
        depth += 1
    run, u, chord, length = (np.concatenate([a[i] for a in trusted]) for i in range(4))
    order = np.lexsort((u[:, 0], run))
    vectors = places[chord[:, 1]] - places[chord[:, 0]]
    speeds = np.stack([lengths(m, m, vectors) for m in (tensors[chord[:, i]] for i in (0, 1))], 1)
    run = run[order]
    first = np.searchsorted(run, np.arange(len(runs) + 1))
    return Measured(run, u[order], length[order], speeds[order], first)


def _lengths(places: Floats, tensors: Floats, chord: Index) -> Floats:
    a, b = chord.T
    return lengths(tensors[a], tensors[b], places[b] - places[a])


def _check_budget(n_chords: int, most_points: int, near: Floats) -> None:
    if n_chords > max(most_points, 1000) * 2 / LONGEST_CHORD:
        x, y = near
        raise BudgetError(
            f"the boundary alone needs more than {most_points:,} vertices, many of them near "
            f"({x:g}, {y:g}): ask for larger sizes, or allow more"
        )


def _equal_shares(u: Floats, length: Floats, speeds: Floats, least: int) -> Floats:
    """Parameters at equal shares of the length of a run, both ends included.

    The size is taken to be geometric along a chord, as in `EdgeSampler::point_in_piece`.
    """
    ends = np.cumsum(length)
    total = ends[-1] * (1 - 1e-9)
    parts = max(least, int(0.5 * (1 + np.sqrt(1 + 4 * total * total))))
    goal = np.arange(1, parts) * (ends[-1] / parts)
    k = np.minimum(np.searchsorted(ends, goal), len(ends) - 1)
    share = np.clip(1 - (ends[k] - goal) / length[k], 0, 1)
    r = speeds[k, 1] / speeds[k, 0]
    flat = np.abs(r - 1) < 1e-6
    r = np.where(flat, 2.0, r)
    s = np.where(flat, share, np.log1p(share * (r - 1)) / np.log(r))
    inner = u[k, 0] + s * (u[k, 1] - u[k, 0])
    return np.unique(np.concatenate([u[:1, 0], inner, u[-1:, 1]]))
