"""Cutting the segments and curves of a domain into unit pieces."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from adaptmesh._core import BoundaryCuts
from adaptmesh.domain.domain import Domain
from adaptmesh.domain.periodic import frozen_pieces, tied_chords, tied_cuts
from adaptmesh.domain.polyline import Chords
from adaptmesh.errors import BudgetError
from adaptmesh.types import Floats, Index, Ints
from metrics import ControlSpace

from .edge_lengths import measured_edges
from .line_rounding import nearest_to_lines
from .path_cuts import TURN, RunParts, surroundings_of, unit_chords
from .safe_chains import spans_of
from .vertex_limit import about


@dataclass(frozen=True)
class Outline:
    """What is triangulated first, and the cuts that follow.

    Attributes
    ----------
    points, tensors : (n, 2), (n, 3) arrays
        The points that are triangulated, and the metric at each.
    segments : (k, 2) array of int32
        The constrained edges between them, of the domain or spans of chords of its curves.
    segment_owners : (k,) array of int32
        The segment of the domain that each is; of a span, one of its run.
    pieces : (p, 2) array of int32
        These edges, divided where points lie on them, each in the direction in which it is cut.
    piece_segments : (p,) array of int32
        The segment of the domain that each piece lies on; of a span, one of its run.
    is_span : (p,) array of bool
        Whether the piece is a span: each of its cuts must be made.
    cuts, cut_tensors : (c, 2), (c, 3) arrays
        The cuts, and the metric at each.
    piece : (c,) array of int32
        The piece that each cut lies on, ascending; those of a piece are in order.
    ties : (t, 4) array of int
        Pieces that periodic boundaries tie, and which ends of theirs correspond; see `tied_cuts`.
    """

    points: Floats
    tensors: Floats
    segments: Ints
    segment_owners: Ints
    pieces: Ints
    piece_segments: Ints
    is_span: NDArray[np.bool_]
    cuts: Floats
    cut_tensors: Floats
    piece: Ints
    ties: Index

    def to_core(self) -> BoundaryCuts:
        """The same for the core."""
        piece, image, a, b = self.ties.T
        ties = np.stack([piece, image, a != b], axis=1).astype(np.int32)
        return BoundaryCuts(
            self.points,
            self.tensors,
            self.segments,
            self.segment_owners,
            self.pieces,
            self.piece_segments,
            self.is_span,
            self.cuts,
            self.cut_tensors,
            self.piece,
            ties,
        )


def cut_boundary(domain: Domain, field: ControlSpace, most_points: int) -> BoundaryCuts:
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
    measured = measured_edges(vertices, tensors, pieces[free], field, most_points)
    total = measured.lengths().sum()
    _check_budget(len(vertices) + total, most_points)
    cuts, piece = measured.cut()
    piece = free[piece].astype(np.int32)
    ties = _ties(domain, kept, vertices, pieces)
    cuts = nearest_to_lines(cuts, vertices[pieces[:, 0]], vertices[pieces[:, 1]], piece)
    if len(ties):
        cuts, piece = tied_cuts(vertices, pieces, cuts, piece, ties)
    straight = Outline(
        vertices,
        tensors,
        number[domain.segments[is_straight]],
        np.flatnonzero(is_straight).astype(np.int32),
        pieces,
        domain.piece_segments[kept],
        np.zeros(len(pieces), bool),
        cuts,
        field(cuts),
        piece,
        ties,
    )
    if not curved.runs:
        return straight.to_core()
    around, whole = surroundings_of(domain), RunParts.whole(domain)
    chords = unit_chords(domain, whole, list(whole.u), around, field, most_points)
    chords = tied_chords(chords, curved.runs, domain.periodic, TURN, around)
    _check_budget(len(chords.points) + total, most_points)
    return _with_spans(straight, domain, chords, spans_of(chords, around), field).to_core()


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
            f"the boundary alone would have about {about(n)} vertices, but max_vertices is "
            f"{most_points:,}: ask for larger sizes, or allow more"
        )


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
    owners = first_of_run[chords.run[spans[:, 0]]]
    return Outline(
        np.concatenate([straight.points, skeleton]),
        np.concatenate([straight.tensors, field(skeleton)]),
        np.concatenate([straight.segments, ends]),
        np.concatenate([straight.segment_owners, owners]),
        np.concatenate([straight.pieces, ends]),
        np.concatenate([straight.piece_segments, owners]),
        np.concatenate([straight.is_span, np.ones(s, bool)]),
        np.concatenate([straight.cuts, cut]),
        np.concatenate([straight.cut_tensors, field(cut)]),
        np.concatenate([straight.piece, len(straight.pieces) + span[~is_last]]).astype(np.int32),
        straight.ties,
    )


def _canonical(points: Floats, pieces: Ints) -> Ints:
    """Pieces, each from its lower left to its upper right end."""
    p, q = points[pieces[:, 0]], points[pieces[:, 1]]
    turned = (p[:, 0] > q[:, 0]) | ((p[:, 0] == q[:, 0]) & (p[:, 1] > q[:, 1]))
    return np.where(turned[:, None], pieces[:, ::-1], pieces)
