"""Metric lengths along curved sides, and the parameters that cut them into unit parts.

As on straight edges, the metric is asked for in rounds, at points of all sides at once: a chord is
trusted when its own length and that of its halves agree, and halved otherwise. The ends of chords
are on the curve, so that the metric is seen where the vertices will be.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from adaptmesh import ragged
from adaptmesh._core import (
    AGREEMENT,
    FINE_DEPTH,
    LONGEST_CHORD,
    LONGEST_FINE_CHORD,
    SHORTEST_CHORD,
)
from adaptmesh.domain.side import SideParts, Sides
from adaptmesh.errors import BudgetError
from adaptmesh.types import Array, Floats, Index
from metrics import ControlSpace
from metrics.tensor import lengths

# Chords of curves are halved no more often; the other bounds are those of the core, which does the
# same on straight lines: see core/edge_sampler.hpp.
DEEPEST = 45


@dataclass(frozen=True)
class MeasuredParts:
    """Parts of curved sides in chords so short that their metric lengths are trusted, in order.

    Attributes
    ----------
    part : (k,) array of int
        The part of each chord.
    u : (k, 2) array
        The parameters of its ends.
    length : (k,) array
        Its metric length.
    speeds : (k, 2) array
        Its length in the metrics of both ends.
    """

    part: Index
    u: Floats
    length: Floats
    speeds: Floats

    def unit_cuts(self, min_parts: Index) -> list[Floats]:
        """Parameters that cut each part into (nearly) unit parts, at least so many, ascending.

        They are equal in metric length along the curve.
        """
        counts = np.bincount(self.part, minlength=len(min_parts))
        rows = (ragged.split(a, counts) for a in (self.u, self.length, self.speeds))
        return [equal_shares(*row) for row in zip(*rows, min_parts.tolist(), strict=True)]

    def lengths_between(self, part: Index, u: Floats) -> Floats:
        """Metric lengths between parameters u (k, 2) of these parts (k,), along the curve."""
        out = np.empty(len(part))
        for p in np.unique(part):
            mine, asked = self.part == p, part == p
            known = np.append(self.u[mine, 0], self.u[mine, 1][-1])
            total = np.concatenate([[0.0], np.cumsum(self.length[mine])])
            out[asked] = np.diff(np.interp(u[asked], known, total), axis=1)[:, 0]
        return out


def measure_parts(
    sides: Sides,
    parts: SideParts,
    chords: tuple[Index, Floats],
    metric: ControlSpace,
    max_vertices: int,
) -> MeasuredParts:
    """Measure parts of curved sides along their curves.

    Parameters
    ----------
    sides : Sides
    parts : SideParts
    chords : (k,) array of int and (k, 2) array
        Chords that cover the parts, to begin with: the part and the parameters of each.
    metric : ControlSpace
    max_vertices : int
        A boundary of many more unit parts than this is refused.
    """
    part, u = chords
    places = sides.point(parts.side[np.repeat(part, 2)], u.ravel())
    tensors = metric(places)
    chord = np.arange(2 * len(part)).reshape(-1, 2)  # its ends, by place
    trusted: list[list[Array]] = []
    depth = 0
    while len(chord):
        _check_budget(len(chord), max_vertices, places[chord[0, 0]])
        middle = len(places) + np.arange(len(chord))
        u_middle = u.mean(axis=1)
        new = sides.point(parts.side[part], u_middle)
        places, tensors = np.concatenate([places, new]), np.concatenate([tensors, metric(new)])
        left, right = (np.stack(e, axis=1) for e in ((chord[:, 0], middle), (middle, chord[:, 1])))
        whole, one, other = (_lengths(places, tensors, e) for e in (chord, left, right))
        both = one + other
        longest = LONGEST_CHORD if depth < FINE_DEPTH else LONGEST_FINE_CHORD
        enough = (np.abs(whole - both) <= AGREEMENT * both) & (both <= longest)
        enough |= (both <= SHORTEST_CHORD) | (depth >= DEEPEST)
        halves = (
            np.repeat(part, 2),
            np.stack([u[:, 0], u_middle, u_middle, u[:, 1]], axis=1).reshape(-1, 2),
            np.stack([left, right], axis=1).reshape(-1, 2),
            np.stack([one, other], axis=1).ravel(),
        )
        kept = np.repeat(enough, 2)
        trusted.append([a[kept] for a in halves])
        part, u, chord = halves[0][~kept], halves[1][~kept], halves[2][~kept]
        depth += 1
    part, u, chord, length = (np.concatenate(a) for a in zip(*trusted, strict=True))
    order = np.lexsort((u[:, 0], part))
    vectors = places[chord[:, 1]] - places[chord[:, 0]]
    speeds = np.stack([lengths(m, m, vectors) for m in (tensors[chord[:, i]] for i in (0, 1))], 1)
    return MeasuredParts(part[order], u[order], length[order], speeds[order])


def _lengths(places: Floats, tensors: Floats, chord: Index) -> Floats:
    a, b = chord.T
    return lengths(tensors[a], tensors[b], places[b] - places[a])


def _check_budget(n_chords: int, max_vertices: int, near: Floats) -> None:
    if n_chords > max(max_vertices, 1000) * 2 / LONGEST_CHORD:
        x, y = near
        raise BudgetError(
            f"the boundary alone needs more than {max_vertices:,} vertices, many of them near "
            f"({x:g}, {y:g}): ask for larger sizes, or allow more"
        )


def equal_shares(u: Floats, length: Floats, speeds: Floats, min_parts: int = 1) -> Floats:
    """Parameters at equal shares of the length of a row of chords, without its ends.

    The size is taken to be geometric along a chord, as in `EdgeSampler::point_in_piece`.
    """
    ends = np.cumsum(length)
    total = ends[-1] * (1 - 1e-9)
    parts = max(min_parts, int(0.5 * (1 + np.sqrt(1 + 4 * total * total))))
    goal = np.arange(1, parts) * (ends[-1] / parts)
    k = np.minimum(np.searchsorted(ends, goal), len(ends) - 1)
    share = np.clip(1 - (ends[k] - goal) / length[k], 0, 1)
    r = speeds[k, 1] / speeds[k, 0]
    flat = np.abs(r - 1) < 1e-6
    r = np.where(flat, 2.0, r)
    s = np.where(flat, share, np.log1p(share * (r - 1)) / np.log(r))
    out: Floats = np.unique(u[k, 0] + s * (u[k, 1] - u[k, 0]))
    return out[(out > u[0, 0]) & (out < u[-1, 1])]
