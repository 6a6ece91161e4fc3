"""Metric lengths along curved sides, and the parameters that cut them into unit parts.

As on straight edges, the metric is asked for in rounds, at points of all sides at once: a chord is
trusted when its own length and that of its halves agree (core/mesher/chord.hpp), and halved
otherwise. The ends of chords are on the curve, so that the metric is seen where vertices will be.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from adaptmesh import ragged
from adaptmesh._core import LONGEST_CHORD, halve_chords
from adaptmesh.domain.sides.side import SideParts, Sides
from adaptmesh.errors import BudgetError
from adaptmesh.types import Array, Floats, Index
from metrics import ControlSpace, tensor


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


def inscribed_chords(sides: Sides, parts: SideParts) -> tuple[Index, Floats]:
    """Chords that cover curved parts: the part and the parameters of each."""
    rows = []
    for side, (low, high) in zip(parts.side.tolist(), parts.u.tolist(), strict=True):
        u = sides.inscribed[side - sides.n_straight]
        rows.append(np.concatenate([[low], u[(low < u) & (u < high)], [high]]))
    part = ragged.owners(np.array([len(row) - 1 for row in rows]))
    return part, np.concatenate([np.stack([row[:-1], row[1:]], axis=1) for row in rows])


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
    side = parts.side
    ends = sides.point(side[np.repeat(part, 2)], u.ravel())
    points, tensors = ends.reshape(-1, 2, 2), metric(ends).reshape(-1, 2, 3)
    lengths = tensor.lengths(tensors[:, 0], tensors[:, 1], points[:, 1] - points[:, 0])
    by_speeds = np.zeros(len(part), bool)
    trusted: list[list[Array]] = []
    depth = 0
    while len(part):
        _check_budget(len(part), max_vertices, points[0, 0])
        middle = u.mean(axis=1)
        new = sides.point(side[part], middle)
        points, tensors = _with_middles(points, new), _with_middles(tensors, metric(new))
        halves, by_speeds, enough = halve_chords(points, tensors, lengths, by_speeds, depth)
        rows: list[Array] = [
            np.repeat(part, 2),
            _halved(_with_middles(u, middle)),
            _halved(points),
            _halved(tensors),
            halves.ravel(),
        ]
        done = np.repeat(enough, 2)
        trusted.append([a[done] for a in rows])
        part, u, points, tensors, lengths = (a[~done] for a in rows)
        by_speeds = np.repeat(by_speeds, 2)[~done]
        depth += 1
    part, u, points, tensors, lengths = (np.concatenate(a) for a in zip(*trusted, strict=True))
    order = np.lexsort((u[:, 0], part))
    vectors = points[:, 1] - points[:, 0]
    speeds = [tensor.lengths(tensors[:, k], tensors[:, k], vectors) for k in (0, 1)]
    return MeasuredParts(part[order], u[order], lengths[order], np.stack(speeds, axis=1)[order])


def _with_middles(ends: Floats, middles: Floats) -> Floats:
    """What chords (k, 2, ...) have at both ends, and half way between."""
    return np.stack([ends[:, 0], middles, ends[:, 1]], axis=1)


def _halved(stations: Floats) -> Floats:
    """What the halves (2 k, 2, ...) of chords have at their ends, from chords (k, 3, ...)."""
    return stations[:, [[0, 1], [1, 2]]].reshape(-1, 2, *stations.shape[2:])


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
