"""Rows of a mesh along the lines of its domain, cut anew where they are not unit.

::

    A---o---o-----o--o---o---B      a line of the domain from A to B, and a mesh's row along it
            [-----------]           a stretch with an edge that is not unit, and its neighbours,
    A---o---o---n---n---o---B       cut into equal parts

1. Stretches are found, and how they would be cut is worked out: on curves as in `generate`, more
   finely where the curve asks for it; where boundaries are periodic, the same on both sides.
2. Those that this makes better are chosen: what the curve forces to be short stays as it is.
3. The mesh is changed (core/recut.hpp). A cut or a removal that would turn a triangle is left out.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from typing import Any, TypeVar

import numpy as np
from numpy.typing import NDArray

from adaptmesh._core import MetricMesh
from adaptmesh.boundary.edge_lengths import measured_edges, straight_lengths
from adaptmesh.boundary.path_cuts import TURN, RunParts, surroundings_of, unit_chords
from adaptmesh.domain.periodic import tied_chords
from adaptmesh.domain.polyline import Surroundings, chords_along
from adaptmesh.domain.side import Lines
from adaptmesh.mesh.boundary_polylines import Chains
from adaptmesh.types import Floats, Index, Ints
from metrics import ControlSpace

from .periodic_polylines import Strands, same_places
from .sub_polylines import is_better, is_off, stretches_of

T = TypeVar("T", bound=np.generic)

FAR = 1.1
"""Rows with so many times more, or fewer, edges than if cut anew are far from that."""

Rows = dict[int, Floats]
"""The places on some lines at which they are to be cut, ascending, with both ends."""


def recut(
    mesher: MetricMesh, chains: Chains, lines: Lines, field: ControlSpace, most_points: int
) -> Chains:
    """Cut the rows anew where their edges are not unit; what cannot be cut stays as it is.

    Returns the same rows if there is nothing to do.
    """
    points = mesher.points()[chains.vertices]
    rows = _Plan(chains, lines, field, points, most_points).rows()
    return _carried_out(rows, mesher, chains, lines, field)


def had_better_be_anew(
    mesher: MetricMesh, chains: Chains, lines: Lines, field: ControlSpace, most_points: int
) -> bool:
    """Whether rows that are tied differ, or rows off unit are far from what new ones would be.

    Where curves come very near each other, the vertices of each keep the other from being cut more
    coarsely, and triangles between them from being cut more finely.
    """
    points = mesher.points()[chains.vertices]
    return _Plan(chains, lines, field, points, most_points).had_better_be_anew()


@dataclass(frozen=True)
class _Sides:
    """Stretches on their lines: one side of each, or both if two lines are tied.

    Attributes
    ----------
    stretch, line : (k,) arrays of int
    ends : (k, 2) array of int
        Where each begins and ends in the rows of `Chains`.
    """

    stretch: Index
    line: Index
    ends: Index

    def of(self, chosen: NDArray[np.bool_]) -> _Sides:
        """The sides of some of the stretches (s,)."""
        mine = chosen[self.stretch]
        return _Sides(self.stretch[mine], self.line[mine], self.ends[mine])


@dataclass(frozen=True)
class _Plan:
    """Where rows are to be cut."""

    chains: Chains
    lines: Lines
    field: ControlSpace
    points: Floats
    most_points: int

    def rows(self) -> Rows:
        """The rows that are to change."""
        strands, starts, lengths = self.strands, self.strands.starts, self.lengths
        stretches = stretches_of(strands.line[starts], lengths, self.lines.is_frozen)
        touched = np.unique(self.chains.lines[~self.may_stay]).tolist()
        rows = {line: self.row(line) for line in touched}
        if not len(stretches):
            return rows
        sides = self.sides(np.stack([starts[stretches[:, 0]], starts[stretches[:, 1] - 1] + 1], 1))
        proposed = self.agreeing(self.replaced(rows, sides, self.unit_cuts(sides)))
        old = [lengths[a:b] for a, b in stretches]
        better = self.is_better(sides, proposed, old)
        if better.all():
            return proposed
        chosen = sides.of(better)
        return self.agreeing(self.replaced(rows, chosen, self.between(chosen, proposed)))

    def had_better_be_anew(self) -> bool:
        """See the function of this name."""
        if not self.may_stay.all():
            return True
        n, domain = self.lines.n_straight, self.lines.domain
        off = self.strands.line[self.strands.starts][is_off(self.lengths)]
        off = np.unique(off[off >= n]) - n
        if not len(off):
            return False
        whole = RunParts.whole(domain)
        chords = unit_chords(
            domain, whole, list(whole.u), self.around, self.field, self.most_points
        )
        chords = tied_chords(chords, domain.curved.runs, domain.periodic, TURN, self.around)
        anew = np.bincount(chords.run, minlength=len(whole.run))[off].sum()
        now = np.diff(self.chains.first)[n + off].sum() - len(off)
        return not anew / FAR <= now <= anew * FAR

    @cached_property
    def lengths(self) -> Floats:
        """The lengths of all edges of the strands, as they count."""
        strands = self.strands
        lengths = strands.lengths(self.points, self.field)
        return self.demands(strands.line, self.chains.places[strands.at], strands.starts, lengths)

    @cached_property
    def strands(self) -> Strands:
        return Strands.of(self.chains, self.lines)

    @cached_property
    def may_stay(self) -> NDArray[np.bool_]:
        return self.strands.may_stay(len(self.chains.vertices))

    @cached_property
    def around(self) -> Surroundings:
        return surroundings_of(self.lines.domain)

    def row(self, line: int) -> Floats:
        """The places of the vertices of a line that may stay."""
        row = slice(*self.chains.first[[line, line + 1]])
        return self.chains.places[row][self.may_stay[row]]

    def demands(self, line: Index, place: Floats, starts: Index, lengths: Floats) -> Floats:
        """Lengths of edges as they count: one that turns by as much as it may is no shorter than 1.

        Edges start at some of the places (k,) on lines (k,), and end at the next one.
        """
        if self.lines.n_straight == len(self.lines):
            return lengths
        turn = np.diff(self.lines.turns(line, place))[starts]
        return np.maximum(lengths, turn / np.radians(TURN))

    def sides(self, anchors: Index) -> _Sides:
        """The sides of stretches between anchors (s, 2)."""
        strands, ties = self.strands, self.lines.ties
        line, at, image = strands.line[anchors[:, 0]], strands.at[anchors], strands.image[anchors]
        tied = np.flatnonzero(image[:, 0] >= 0)
        others = np.array([ties[k].line for k in line[tied].tolist()], np.intp)
        return _Sides(
            np.concatenate([np.arange(len(anchors)), tied]),
            np.concatenate([line, others]),
            np.sort(np.concatenate([at, image[tied]]), axis=1),
        )

    def unit_cuts(self, sides: _Sides) -> list[Floats]:
        """The places at which each side is to be cut, without its ends, alike where two are tied.

        Of two that are tied, the one with fewer cuts gets the images of those of the other.
        """
        out: list[Floats] = [np.empty(0)] * len(sides.line)
        straight = sides.line < self.lines.n_straight
        for some, cut in ((straight, self.straight_cuts), (~straight, self.curved_cuts)):
            number = np.flatnonzero(some)
            if len(number):
                cuts = cut(sides.line[number], sides.ends[number])
                for k, places in zip(number.tolist(), cuts, strict=True):
                    out[k] = places
        first_second = np.flatnonzero(np.bincount(sides.stretch) == 2)
        for s in first_second.tolist():
            i, j = np.flatnonzero(sides.stretch == s).tolist()
            if len(out[i]) < len(out[j]):
                i, j = j, i
            out[j] = np.sort(self.lines.images(int(sides.line[i]), out[i]))
        return out

    def straight_cuts(self, line: Index, ends: Index) -> list[Floats]:
        """Places that cut stretches of straight lines into unit parts."""
        measured = measured_edges(self.points, self.field(self.points), ends, self.field)
        cuts, owner = measured.cut()
        start, vector = self.points[ends[:, 0]], np.diff(self.points[ends], axis=1)[:, 0]
        share = np.sum((cuts - start[owner]) * vector[owner], axis=1)
        share /= np.sum(vector[owner] ** 2, axis=1)
        low, high = self.chains.places[ends[owner]].T
        places = low + share * (high - low)
        return np.split(places, np.searchsorted(owner, np.arange(1, len(line))))

    def curved_cuts(self, line: Index, ends: Index) -> list[Floats]:
        """Places that cut stretches of runs into chords of unit length, or as the curve allows."""
        n, domain = self.lines.n_straight, self.lines.domain
        parts = RunParts(line - n, self.chains.places[ends])
        sides = _Sides(np.arange(len(line)), line, ends)
        rest = self.replaced({}, sides, [np.empty(0)] * len(line))
        runs = range(n, len(self.lines))
        rows = [rest[k] if k in rest else self.row(k) for k in runs]
        chords = unit_chords(domain, parts, rows, self.around, self.field, self.most_points)
        return self.between(sides, dict(zip(runs, chords.by_run(len(runs)), strict=True)))

    def replaced(self, rows: Rows, sides: _Sides, inner: list[Floats]) -> Rows:
        """The rows with other places between the ends of each side."""
        out = dict(rows)
        for line, ends, places in zip(sides.line.tolist(), sides.ends, inner, strict=True):
            row = out.get(line)
            row = self.row(line) if row is None else row
            low, high = self.chains.places[ends]
            out[line] = np.concatenate([row[row <= low], places, row[row >= high]])
        return out

    def between(self, sides: _Sides, rows: Rows) -> list[Floats]:
        """The places of rows between the ends of each side."""
        out = []
        for line, (low, high) in zip(
            sides.line.tolist(), self.chains.places[sides.ends], strict=True
        ):
            row = rows[line]
            out.append(row[(row > low) & (row < high)])
        return out

    def agreeing(self, rows: Rows) -> Rows:
        """The rows with more cuts of curves where chords would cross, the same where they are tied.

        Others than those given may need them.
        """
        n, runs = self.lines.n_straight, self.lines.domain.curved.runs
        if all(line < n for line in rows):
            return rows
        now = [self.row(n + r) for r in range(len(runs))]
        cuts = [rows.get(n + r, now[r]) for r in range(len(runs))]
        chords = chords_along(runs, cuts, TURN, self.around)
        chords = tied_chords(chords, runs, self.lines.domain.periodic, TURN, self.around)
        out = dict(rows)
        for r, u in enumerate(chords.by_run(len(runs))):
            k = same_places(u, now[r])
            u = np.where(k >= 0, now[r][k], u)
            if n + r in rows or len(u) != len(now[r]):
                out[n + r] = u
        return out

    def is_better(self, sides: _Sides, rows: Rows, old: list[Floats]) -> NDArray[np.bool_]:
        """Which stretches are nearer to unit with other rows than with their old lengths."""
        places = [
            np.concatenate([[low], inner, [high]])
            for (low, high), inner in zip(
                self.chains.places[sides.ends], self.between(sides, rows), strict=True
            )
        ]
        counts = [len(p) for p in places]
        line, where = np.repeat(sides.line, counts), np.concatenate(places)
        ends = np.cumsum(counts)
        starts = np.setdiff1d(np.arange(ends[-1]), ends - 1)
        edges = np.stack([starts, starts + 1], axis=1)
        lengths = straight_lengths(self.lines.points(line, where), edges, self.field)
        lengths = self.demands(line, where, starts, lengths)
        by_side = np.split(lengths, np.cumsum(np.array(counts[:-1]) - 1))
        new: list[Floats] = by_side[: len(old)]
        for k in range(len(old), len(by_side)):  # the second sides
            s = int(sides.stretch[k])
            turned = self.lines.ties[int(sides.line[k])].is_reversed
            new[s] = np.maximum(new[s], by_side[k][::-1] if turned else by_side[k])
        return np.array([is_better(n, o) for n, o in zip(new, old, strict=True)])


def _carried_out(
    rows: Rows, mesher: MetricMesh, chains: Chains, lines: Lines, field: ControlSpace
) -> Chains:
    """Cut the mesh as planned, where that turns no triangle; the rows as they are then.

    What stays between two vertices of a row, stays; all else between them is exchanged at once.
    """
    stretches, cuts = [], []
    for line in sorted(rows):
        start, stop = chains.first[[line, line + 1]].tolist()
        old = chains.places[start:stop]
        stays = np.flatnonzero(np.isin(old, rows[line]))
        new = np.setdiff1d(rows[line], old)
        at = np.searchsorted(old[stays], new)
        for k in range(1, len(stays)):
            if stays[k] - stays[k - 1] > 1 or (at == k).any():
                stretches.append((start + stays[k - 1], start + stays[k], line))
                cuts.append(new[at == k])
    if not stretches:
        return chains
    begin, end, line_of = np.array(stretches).T
    counts = [len(c) for c in cuts]
    places = np.concatenate(cuts)
    points = lines.points(np.repeat(line_of, counts), places)
    inside = np.concatenate([np.arange(b, e + 1) for b, e in zip(begin, end, strict=True)])
    vertices, places, first = mesher.recut(
        _offsets(end - begin + 1),
        chains.vertices[inside],
        chains.places[inside],
        _offsets(np.array(counts)),
        points,
        field(points),
        places,
        lines.segments[line_of],
    )
    grown = np.bincount(line_of, np.diff(first) - (end - begin + 1), len(chains.first) - 1)
    ends = np.stack([begin, end], axis=1)
    return Chains(
        _replaced(chains.vertices, ends, np.split(vertices, first[1:-1])),
        _replaced(chains.places, ends, np.split(places, first[1:-1])),
        (chains.first + _offsets(grown)).astype(np.int32),
    )


def _offsets(counts: NDArray[Any]) -> Ints:
    return np.concatenate([[0], np.cumsum(counts)]).astype(np.int32)


def _replaced(row: NDArray[T], stretches: Index, by: list[NDArray[T]]) -> NDArray[T]:
    """A row with each stretch [begin, end], sorted, replaced by another from and to the same.

    One may begin where another ends: the last of each is left to what follows.
    """
    by = [part[:-1] for part in by]
    cuts = [0, *stretches.ravel().tolist(), len(row)]
    kept = [row[i:j] for i, j in zip(cuts[::2], cuts[1::2], strict=True)]
    parts = [part for pair in zip(kept, by, strict=False) for part in pair]
    return np.concatenate([*parts, kept[-1]])
