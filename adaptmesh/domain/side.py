"""The straight pieces of a domain and its runs of curves, alike: places along them.

A place on a straight piece is a share of its length, from 0 to 1; on a run it is its parameter.
Where two lines are periodic, each place on the one has an image on the other.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from adaptmesh.boundary.path_cuts import RunParts, turns_between
from adaptmesh.types import Floats, Index, Ints

from .data import DomainData
from .paths import points_on
from .periodic import Motion, frozen_pieces, images_on


@dataclass(frozen=True)
class Tie:
    """The line that is the image of another, by which motion, and whether it runs backwards."""

    line: int
    motion: Motion
    is_reversed: bool


@dataclass(frozen=True, eq=False)
class Lines:
    """What rows of edges lie along: first the straight pieces of a domain, then its runs.

    Attributes
    ----------
    domain : Domain
    corners : (n, 2) array
        The points of the domain that are vertices of every mesh.
    ends : (l, 2) array of int
        The corners where each line begins and ends.
    segments : (l,) array of int32
        A segment of the domain that lies on each.
    lengths : (l,) array
        The place of the second end; that of the first is 0.
    n_straight : int
        So many are straight.
    is_frozen : (l,) array of bool
        Which are not to be cut.
    ties : dict of int to Tie
        For each line that is periodic with another one.
    """

    domain: DomainData
    corners: Floats
    ends: Index
    segments: Ints
    lengths: Floats
    n_straight: int
    is_frozen: NDArray[np.bool_]
    ties: dict[int, Tie]

    @classmethod
    def of(cls, domain: DomainData) -> Lines:
        """The lines of a domain."""
        curved, n_runs = domain.curved, len(domain.curved.runs)
        number = np.cumsum(curved.is_vertex) - 1
        straight = np.flatnonzero(curved.segment_runs[domain.piece_segments] < 0)
        run_ends = np.array([run.ends for run in curved.runs], np.intp).reshape(-1, 2)
        on_run, first = np.unique(curved.segment_runs, return_index=True)
        return cls(
            domain,
            domain.points[curved.is_vertex],
            np.concatenate([number[domain.pieces[straight]], run_ends]),
            np.concatenate([domain.piece_segments[straight], first[on_run >= 0]]).astype(np.int32),
            np.concatenate([np.ones(len(straight)), [run.length for run in curved.runs]]),
            len(straight),
            np.concatenate([frozen_pieces(domain)[straight], np.zeros(n_runs, bool)]),
            _ties(domain, straight),
        )

    def __len__(self) -> int:
        return len(self.ends)

    def points(self, line: Index, place: Floats) -> Floats:
        """Points (k, 2) at places (k,) on lines (k,)."""
        out = np.empty((len(line), 2))
        straight = line < self.n_straight
        a, b = (self.corners[self.ends[line[straight], i]] for i in (0, 1))
        out[straight] = a + place[straight, None] * (b - a)
        run = line[~straight] - self.n_straight
        out[~straight] = points_on(self.domain.curved.runs, run, place[~straight])
        return out

    def turns(self, line: Index, place: Floats) -> Floats:
        """By what angle lines (k,) have turned from their beginnings to places (k,), in radians.

        From the chords of the domain, about: a chord has the direction of the curve at its middle.
        """
        out = np.zeros(len(line))
        first, middle, turned = self._turning
        for r in np.unique(line[line >= self.n_straight]) - self.n_straight:
            mine, known = line == self.n_straight + r, slice(*first[[r, r + 1]])
            out[mine] = np.interp(place[mine], middle[known], turned[known])
        return out

    @cached_property
    def _turning(self) -> tuple[Index, Floats, Floats]:
        """Middles of chords of all runs and turns from the first, and where each run begins."""
        part, u, vectors = RunParts.whole(self.domain).looks(self.domain)
        turn = np.concatenate([[0.0], turns_between(part, vectors)])
        first = np.searchsorted(part, np.arange(len(self.domain.curved.runs) + 1))
        return first, u.mean(axis=1), np.cumsum(turn)

    def images(self, line: int, places: Floats) -> Floats:
        """The places on the other line of a tie of the images of places; ends go to ends."""
        tie, length = self.ties[line], self.lengths[line]
        if line < self.n_straight:
            return 1 - places if tie.is_reversed else places
        at = self.points(np.full(len(places), line), places)
        out = images_on(self.domain.curved.runs[tie.line - self.n_straight], tie.motion(at))
        far = self.lengths[tie.line]
        begin, end = (far, 0.0) if tie.is_reversed else (0.0, far)
        return np.where(places == 0, begin, np.where(places == length, end, out))


def _ties(domain: DomainData, straight: Index) -> dict[int, Tie]:
    """The ties of lines, from the pairs of pieces and runs of a domain."""
    out: dict[int, Tie] = {}
    number = np.full(len(domain.pieces), -1)
    number[straight] = np.arange(len(straight))
    runs = domain.curved.runs

    def tie(i: int, j: int, motion: Motion, is_reversed: bool) -> None:
        out[i] = Tie(j, motion, is_reversed)
        out[j] = Tie(i, motion.inverse(), is_reversed)

    for pair in domain.periodic:
        for p, q in pair.pieces.tolist():
            start = pair.motion(domain.points[domain.pieces[p, :1]])
            off = np.abs(domain.points[domain.pieces[q]] - start).max(axis=1)
            tie(int(number[p]), int(number[q]), pair.motion, bool(off[1] < off[0]))
        for r, s in pair.runs.tolist():
            looks = runs[r].point(np.array([0.25, 0.5]) * runs[r].length)
            near, far = images_on(runs[s], pair.motion(looks))
            tie(len(straight) + r, len(straight) + s, pair.motion, bool(near > far))
    return out
