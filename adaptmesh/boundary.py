"""Cutting the segments and curves of a domain into unit pieces."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from metrics import ControlSpace

from . import _core
from .chords import Chords, Surroundings, chords_along
from .curve_cuts import LONGEST_CHORD, equal_shares, measure_runs
from .domain import Domain
from .errors import BudgetError
from .periodic import frozen_pieces, tied_chords, tied_cuts
from .spans import spans_of

Floats = NDArray[np.float64]
Ints = NDArray[np.int32]
Index = NDArray[np.integer]


# More chords at once would be a boundary of millions of vertices (and a gigabyte of memory).
MOST_CHORDS = 8_000_000

# By how much a curve may turn along an edge of a mesh, in degrees: a circle gets at least six.
TURN = 60.0

# A run with a chord longer than this is cut anew, up to so many times.
LONG_CHORD = 1.3
RECUTS = 4


@dataclass(frozen=True)
class Outline:
    """What is triangulated first, and the cuts that follow.

    Attributes
    ----------
    points, tensors : (n, 2), (n, 3) arrays
        The points that are triangulated, and the metric at each.
    segments : (k, 2) array of int32
        The constrained edges between them, of the domain or spans of chords of its curves.
    pieces : (p, 2) array of int32
        These edges, divided where points lie on them, each in the direction in which it is cut.
    piece_segments : (p,) array of int32
        The segment of the domain that each piece lies on; of a span, one of its run.
    is_span : (p,) array of bool
        Whether the piece is a span: each of its cuts must be made.
    cuts, cut_tensors : (c, 2), (c, 3) arrays
        The cuts, and the metric at each.
    piece : (c,) array of int32
        The piece that each cut lies on; those of a piece are in order.
    """

    points: Floats
    tensors: Floats
    segments: Ints
    pieces: Ints
    piece_segments: Ints
    is_span: NDArray[np.bool_]
    cuts: Floats
    cut_tensors: Floats
    piece: Ints

    def divided(self, spans: NDArray[np.bool_]) -> Outline:
        """The same, but these spans (p,) are divided at all their cuts."""
        moved = spans[self.piece]
        number = len(self.points) + np.cumsum(moved) - 1
        pieces, owners, new_number = [], [], np.cumsum(~spans) - 1
        for p in np.flatnonzero(spans):
            a, b = self.pieces[p]
            row = np.concatenate([[a], number[self.piece == p], [b]])
            pieces.append(np.stack([row[:-1], row[1:]], axis=1))
            owners.append(np.full(len(row) - 1, self.piece_segments[p]))
        gone = {tuple(sorted(pair)) for pair in self.pieces[spans].tolist()}
        stays = [tuple(sorted(pair)) not in gone for pair in self.segments.tolist()]
        chords = np.concatenate(pieces).astype(np.int32)
        return Outline(
            np.concatenate([self.points, self.cuts[moved]]),
            np.concatenate([self.tensors, self.cut_tensors[moved]]),
            np.concatenate([self.segments[stays], chords]),
            np.concatenate([self.pieces[~spans], chords]),
            np.concatenate([self.piece_segments[~spans], *owners]).astype(np.int32),
            np.concatenate([self.is_span[~spans], np.ones(len(chords), bool)]),
            self.cuts[~moved],
            self.cut_tensors[~moved],
            new_number[self.piece[~moved]].astype(np.int32),
        )


def measure_edges(
    sampler: _core.EdgeSampler, field: ControlSpace, most_points: float = np.inf
) -> Floats:
    """Metric lengths of the edges in a sampler, asking the field where it wants to know."""
    while len(wanted := sampler.wanted()):
        if len(wanted) > min(most_points * 2 / LONGEST_CHORD, MOST_CHORDS):
            x, y = wanted[len(wanted) // 2]
            raise BudgetError(
                f"the boundary alone needs more than {most_points:,} vertices, many of them near "
                f"({x:g}, {y:g}): ask for larger sizes, or allow more"
            )
        sampler.feed(field(wanted))
    lengths: Floats = sampler.lengths()
    return lengths


def cut_outline(domain: Domain, field: ControlSpace, most_points: int) -> Outline:
    """Cut every segment and every curve of the domain into pieces of (nearly) unit metric length.

    A segment, or a part of one between points that lie on it, or a run of curves, of length L
    becomes the n equal pieces for which sqrt((n - 1) n) < L <= sqrt(n (n + 1)): as near to unit as
    they can be. Each is cut once, a segment from its lower point to its upper, so that both its
    sides and all meshes of the domain with this metric agree on it. Curves get more pieces where
    they turn by more than `TURN` in one, or where their chords would cross something.
    """
    curved = domain.curved
    vertices = domain.points[curved.is_vertex]
    number = (np.cumsum(curved.is_vertex) - 1).astype(np.int32)
    is_straight = curved.segment_runs < 0
    tensors = field(vertices)

    kept = is_straight[domain.piece_segments]
    pieces = _canonical(vertices, number[domain.pieces[kept]])
    free = np.flatnonzero(~frozen_pieces(domain)[kept])
    starts, stops = pieces[free].T
    sampler = _core.edge_sampler(
        vertices[starts], tensors[starts], vertices[stops], tensors[stops], LONGEST_CHORD
    )
    total = measure_edges(sampler, field, most_points).sum()
    _check_budget(len(vertices) + total, most_points)
    cuts, piece = sampler.cut()
    piece = free[piece].astype(np.int32)
    if domain.periodic:
        cuts, piece = tied_cuts(
            vertices, pieces, cuts, piece, _ties(domain, kept, vertices, pieces)
        )
    straight = Outline(
        vertices,
        tensors,
        number[domain.segments[is_straight]],
        pieces,
        domain.piece_segments[kept],
        np.zeros(len(pieces), bool),
        cuts,
        field(cuts),
        piece,
    )
    if not curved.runs:
        return straight
    chords, around = _cut_runs(domain, straight, field, most_points)
    chords = tied_chords(chords, curved.runs, domain.periodic, TURN, around)
    _check_budget(len(chords.points) + total, most_points)
    return _with_spans(straight, domain, chords, spans_of(chords, around), field)


def _ties(domain: Domain, kept: NDArray[np.bool_], points: Floats, pieces: Ints) -> Index:
    """Pieces, numbered among those kept, that periodic boundaries tie; see `tied_cuts`."""
    number = np.cumsum(kept) - 1
    rows = []
    for pair in domain.periodic:
        for i, j in number[pair.pieces].tolist():
            start = pair.motion(points[pieces[i, :1]])
            off = np.abs(points[pieces[j]] - start).max(axis=1)
            rows.append((i, j, 0, int(off.argmin())))
    return np.array(rows, np.intp).reshape(-1, 4)


def _check_budget(n: float, most_points: int) -> None:
    if n > most_points:
        raise BudgetError(
            f"the boundary alone would have about {n:.3g} vertices, but max_vertices is "
            f"{most_points:,}: ask for larger sizes, or allow more"
        )


def _cut_runs(
    domain: Domain, straight: Outline, field: ControlSpace, most_points: int
) -> tuple[Chords, Surroundings]:
    """Chords of the runs, of unit length where they can be, and what else there is."""
    curved = domain.curved
    on_run = curved.segment_runs >= 0
    run, u = curved.segment_runs[on_run], curved.segment_parameters[on_run]
    turns = _turns(run, np.diff(domain.points[domain.segments[on_run]], axis=1)[:, 0])
    least = np.maximum(1, np.ceil(turns / np.radians(TURN))).astype(int)
    measured = measure_runs(curved.runs, run, u, field, most_points)
    cuts = measured.unit_cuts(least)
    around = Surroundings(
        np.concatenate([straight.points, domain.holes, domain.seeds]),
        len(straight.points),
        straight.pieces,
        curved.segment_curves[straight.piece_segments],
        curved.curves,
    )
    for _ in range(RECUTS):
        chords = chords_along(curved.runs, cuts, TURN, around)
        straight_length = _straight_lengths(chords, field, most_points)
        if (straight_length <= LONG_CHORD).all():
            break
        along = measured.lengths_between(chords.run, chords.u)
        cuts = _recut(chords, cuts, along, straight_length)
    else:
        chords = chords_along(curved.runs, cuts, TURN, around)
    return chords, around


def _turns(run: Ints, d: Floats) -> Floats:
    """By what angle each run turns, from the vectors of chords that are close to it."""
    cross = d[:-1, 0] * d[1:, 1] - d[:-1, 1] * d[1:, 0]
    turn = np.abs(np.arctan2(cross, (d[:-1] * d[1:]).sum(axis=1)))
    weights = np.where(np.diff(run) == 0, turn, 0.0)
    out: Floats = np.bincount(run[1:], weights, minlength=int(run.max()) + 1).astype(np.float64)
    return out


def _straight_lengths(chords: Chords, field: ControlSpace, most_points: int) -> Floats:
    tensors = field(chords.points)
    a, b = chords.ends.T
    sampler = _core.edge_sampler(
        chords.points[a], tensors[a], chords.points[b], tensors[b], LONGEST_CHORD
    )
    return measure_edges(sampler, field, most_points)


def _recut(chords: Chords, cuts: list[Floats], along: Floats, straight: Floats) -> list[Floats]:
    """Cuts of runs that have chords that are too long, so close that these become unit.

    A chord whose ends lie across a thin layer, not along it, is longer in the metric than its
    curve. Of its length l the part t along the curve goes with the number m of pieces that it is
    cut into, and the rest with m^2, as the turn does: 1 = (t / m)^2 + (l^2 - t^2) / m^4.
    """
    rest = np.maximum(straight**2 - along**2, 0)
    demand = np.sqrt(0.5 * (along**2 + np.sqrt(along**4 + 4 * rest)))
    out = list(cuts)
    for r in np.unique(chords.run[straight > LONG_CHORD]):
        mine = chords.run == r
        out[r] = equal_shares(chords.u[mine], demand[mine])
    return out


def _with_spans(
    straight: Outline, domain: Domain, chords: Chords, spans: Index, field: ControlSpace
) -> Outline:
    """The straight part of an outline and the spans of the curves."""
    n, s = len(straight.points), len(spans)
    ends = np.stack([chords.ends[spans[:, 0], 0], chords.ends[spans[:, 1] - 1, 1]], axis=1)
    inner = np.unique(ends[ends >= n])
    number = np.arange(len(chords.points))
    number[inner] = n + np.arange(len(inner))
    ends = number[ends].astype(np.int32)

    is_last = np.zeros(len(chords.run), bool)
    is_last[spans[:, 1] - 1] = True
    span = np.repeat(np.arange(s), np.diff(spans, axis=1)[:, 0])
    cut = chords.points[chords.ends[~is_last, 1]]

    first_of_run = np.full(len(domain.curved.runs), -1, np.int32)
    on_run = np.flatnonzero(domain.curved.segment_runs >= 0)[::-1]
    first_of_run[domain.curved.segment_runs[on_run]] = on_run
    skeleton = chords.points[inner]
    return Outline(
        np.concatenate([straight.points, skeleton]),
        np.concatenate([straight.tensors, field(skeleton)]),
        np.concatenate([straight.segments, ends]),
        np.concatenate([straight.pieces, ends]),
        np.concatenate([straight.piece_segments, first_of_run[chords.run[spans[:, 0]]]]),
        np.concatenate([straight.is_span, np.ones(s, bool)]),
        np.concatenate([straight.cuts, cut]),
        np.concatenate([straight.cut_tensors, field(cut)]),
        np.concatenate([straight.piece, len(straight.pieces) + span[~is_last]]).astype(np.int32),
    )


def _canonical(points: Floats, pieces: Ints) -> Ints:
    """Pieces, each from its lower left to its upper right end."""
    p, q = points[pieces[:, 0]], points[pieces[:, 1]]
    turned = (p[:, 0] > q[:, 0]) | ((p[:, 0] == q[:, 0]) & (p[:, 1] > q[:, 1]))
    out: Ints = np.where(turned[:, None], pieces[:, ::-1], pieces)
    return out
