"""Runs of curves, or parts of them, cut into chords of unit length, where the curve allows it.

::

        o-------o====o===o====o-------o       a part of a run (=), given by the parameters of its
            ^ rest                ^ rest      ends, is cut; the chords of the rest stay, unless they
                                              would cross what is new
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from adaptmesh.domain.data import DomainData
from adaptmesh.domain.inscribed_polygon import MESH_TURN
from adaptmesh.domain.polyline import Chords, Surroundings, chords_along
from adaptmesh.types import Floats, Index
from metrics import ControlSpace

from .curve_cuts import equal_shares, measure_runs
from .edge_lengths import straight_lengths

# By how much a curve may turn along an edge of a mesh, in degrees: a circle gets at least six.
TURN = MESH_TURN

# A part with a chord longer than this is cut anew, up to so many times.
LONG_CHORD = 1.3
RECUTS = 4


@dataclass(frozen=True)
class RunParts:
    """Parts of runs, that do not overlap.

    Attributes
    ----------
    run : (s,) array of int
        The run of each.
    u : (s, 2) array
        The parameters of its ends.
    """

    run: Index
    u: Floats

    @classmethod
    def whole(cls, domain: DomainData) -> RunParts:
        """Each run as a part of itself."""
        lengths = [run.length for run in domain.curved.runs]
        return cls(np.arange(len(lengths)), np.stack([np.zeros(len(lengths)), lengths], axis=1))

    def looks(self, domain: DomainData) -> tuple[Index, Floats, Floats]:
        """Chords, close to the curve, in order: the part of each, its parameters, its vector."""
        curved = domain.curved
        on_run = curved.segment_runs >= 0
        run, u = curved.segment_runs[on_run], curved.segment_parameters[on_run]
        order = np.lexsort((u[:, 0], run))
        first = np.searchsorted(run[order], np.arange(len(curved.runs) + 1))
        part, ends, vectors = [], [], []
        for s, (r, (low, high)) in enumerate(zip(self.run.tolist(), self.u.tolist(), strict=True)):
            inner = u[order[first[r] : first[r + 1]], 0]
            at = np.concatenate([[low], inner[(low < inner) & (inner < high)], [high]])
            part.append(np.full(len(at) - 1, s))
            ends.append(np.stack([at[:-1], at[1:]], axis=1))
            vectors.append(np.diff(curved.runs[r].point(at), axis=0))
        return np.concatenate(part), np.concatenate(ends), np.concatenate(vectors)

    def of_chords(self, chords: Chords) -> Index:
        """The part that each chord lies in, (k,), -1 for none."""
        out = np.full(len(chords.run), -1)
        middle = chords.u.mean(axis=1)
        for s, (r, (low, high)) in enumerate(zip(self.run.tolist(), self.u.tolist(), strict=True)):
            i, j = np.searchsorted(chords.run, [r, r + 1])
            a, b = np.searchsorted(middle[i:j], [low, high])
            out[i + a : i + b] = s
        return out


def surroundings_of(domain: DomainData) -> Surroundings:
    """What there is in a domain besides its runs."""
    curved = domain.curved
    vertices = domain.points[curved.is_vertex]
    number = (np.cumsum(curved.is_vertex) - 1).astype(np.int32)
    is_straight = curved.segment_runs[domain.piece_segments] < 0
    return Surroundings(
        np.concatenate([vertices, domain.holes, domain.seeds]),
        len(vertices),
        number[domain.pieces[is_straight]],
        curved.segment_curves[domain.piece_segments[is_straight]],
        curved.curves,
    )


def unit_chords(
    domain: DomainData,
    parts: RunParts,
    rest: Sequence[Floats],
    around: Surroundings,
    field: ControlSpace,
    most_points: int,
) -> Chords:
    """Chords of all runs, those of the parts of unit length where they can be.

    They are as many as the curve needs: more where it turns by more than `TURN` along one, or where
    they would cross something.

    Parameters
    ----------
    domain : Domain
    parts : RunParts
    rest : sequence of (m,) arrays
        The parameters at which each run is cut outside the parts, with both its ends.
    around : Surroundings
    field : ControlSpace
    most_points : int
        A boundary of many more unit parts than this is refused.
    """
    runs = domain.curved.runs
    part, u, vectors = parts.looks(domain)
    turn = np.bincount(part[1:], turns_between(part, vectors), minlength=len(parts.run))
    least = np.maximum(1, np.ceil(turn / np.radians(TURN))).astype(int)
    measured = measure_runs([runs[r] for r in parts.run], part, u, field, most_points)
    cuts = measured.unit_cuts(least)
    for _ in range(RECUTS):
        chords = chords_along(runs, _together(rest, parts.run, cuts), TURN, around)
        part = parts.of_chords(chords)
        mine = np.flatnonzero(part >= 0)
        part, u = part[mine], chords.u[mine]
        straight = straight_lengths(chords.points, chords.ends[mine], field, most_points)
        if (straight <= LONG_CHORD).all():
            return chords
        cuts = _recut(part, u, cuts, measured.lengths_between(part, u), straight)
    return chords_along(runs, _together(rest, parts.run, cuts), TURN, around)


def _together(rest: Sequence[Floats], run: Index, cuts: Sequence[Floats]) -> list[Floats]:
    """The cuts of each run: those of its parts, and the rest."""
    out = list(rest)
    for r, more in zip(run.tolist(), cuts, strict=True):
        out[r] = np.union1d(out[r], more)
    return out


def turns_between(part: Index, vectors: Floats) -> Floats:
    """Angles between successive vectors (k, 2) of chords, (k - 1,), 0 from part to part."""
    before, after = vectors[:-1], vectors[1:]
    cross = before[:, 0] * after[:, 1] - before[:, 1] * after[:, 0]
    turn = np.abs(np.arctan2(cross, (before * after).sum(axis=1)))
    return np.where(np.diff(part) == 0, turn, 0.0)


def _recut(
    part: Index, u: Floats, cuts: list[Floats], along: Floats, straight: Floats
) -> list[Floats]:
    """Cuts of parts that have chords that are too long, so close that these become unit.

    A chord whose ends lie across a thin layer, not along it, is longer in the metric than its
    curve. Of its length l the part t along the curve goes with the number m of pieces that it is
    cut into, and the rest with m^2, as the turn does: 1 = (t / m)^2 + (l^2 - t^2) / m^4.
    """
    rest = np.maximum(straight**2 - along**2, 0)
    demand = np.sqrt(0.5 * (along**2 + np.sqrt(along**4 + 4 * rest)))
    out = list(cuts)
    for s in np.unique(part[straight > LONG_CHORD]):
        mine = part == s
        out[s] = equal_shares(u[mine], demand[mine])
    return out
