"""The sides of a domain as straight pieces and short cubics, to measure distances from them.

A curve from u0 to u1 is followed by the cubic that has its ends and its derivatives there
(Hermite): the distance between the two falls with the fourth power of the turn, so that pieces that
turn by half a degree are as good as the curve.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import NamedTuple

import numpy as np

from adaptmesh import ragged
from adaptmesh.domain.sides.paths import derivatives_of_parts, points_on
from adaptmesh.types import Bools, Floats, Index, Ints

from .data import DomainData

CHORD, CUBIC = 1e-6, 1e-10
"""How far chords, and cubics, are off the curves at most, as shares of the extent of the domain."""

MOST_PARTS, MOST_ROUNDS = 256, 8
"""Pieces are divided into so many parts at a time, and so often."""

LOOKS = np.array([0.25, 0.5, 0.75])
"""Where on a piece it is compared with the curve."""


class CubicPieces(NamedTuple):
    """Pieces of the sides of a domain, each a function of t from 0 to 1.

    Attributes
    ----------
    ends, derivatives : (k, 2, 2) arrays
        The points at t = 0 and 1, and the derivatives there; those of straight pieces are the
        vectors from end to end.
    segments : (k,) array of int
        The segment of the domain that each is, or is a part of the curve of, in its direction.
    heights : (k,) array of float
        How far the curve of that segment is off the segment; 0 where it is straight.
    """

    ends: Floats
    derivatives: Floats
    segments: Index
    heights: Floats


class SomeSides(NamedTuple):
    """Some of the segments of a domain, by number, with the curves that they are chords of."""

    domain: DomainData
    segments: Ints

    def cubic_pieces(self) -> CubicPieces:
        """The sides as straight pieces and short cubics."""
        chosen = np.zeros(len(self.domain.segments), bool)
        chosen[self.segments] = True
        return cubic_pieces(self.domain, chosen)


def some_sides(domain: DomainData, names: Sequence[str]) -> SomeSides:
    """As `Domain.sides`."""
    tags = [domain.tag_named(name) for name in names]
    chosen = np.isin(domain.segment_tags, tags) if names else np.ones(len(domain.segments), bool)
    return SomeSides(domain, np.flatnonzero(chosen).astype(np.int32))


def cubic_pieces(domain: DomainData, chosen: Bools) -> CubicPieces:
    """The pieces of some of the segments of a domain, chosen by number (n,)."""
    curved = domain.curved
    straight = np.flatnonzero(chosen & (curved.segment_paths < 0))
    ends = domain.points[domain.segments[straight]]
    vectors = np.repeat(np.diff(ends, axis=1), 2, axis=1)
    segments = np.flatnonzero(chosen & (curved.segment_paths >= 0))
    if not len(segments):
        return CubicPieces(ends, vectors, straight, np.zeros(len(straight)))
    segment, p, d = _divided(domain, segments)
    chord = domain.points[domain.segments[segment]]
    middle = 0.5 * (p[:, 0] + p[:, 1]) + 0.125 * (d[:, 0] - d[:, 1])
    heights = np.zeros(len(chosen))
    for places in (p[:, 0], p[:, 1], middle):
        np.maximum.at(heights, segment, _off_chord(places[:, None], chord)[:, 0])
    return CubicPieces(
        np.concatenate([ends, p]),
        np.concatenate([vectors, d]),
        np.concatenate([straight, segment]),
        np.concatenate([np.zeros(len(straight)), heights[segment]]),
    )


def _divided(domain: DomainData, segment: Index) -> tuple[Index, Floats, Floats]:
    """Parts of the curves of segments: the segment of each, the points and derivatives at its ends.

    They are divided until they, and their chords, are as near to the curves as they must be.
    """
    curved, paths = domain.curved, domain.curved.paths
    extent = float(np.ptp(domain.points, axis=0).max())
    u = curved.segment_parameters[segment]
    for again in range(MOST_ROUNDS, -1, -1):
        path, n = curved.segment_paths[segment].astype(np.intp), len(segment)
        part = u.mean(axis=1).astype(np.intp)
        p = np.stack([points_on(paths, path, u[:, i]) for i in (0, 1)], axis=1)
        d = np.stack([derivatives_of_parts(paths, path, part, u[:, i]) for i in (0, 1)], axis=1)
        d *= np.diff(u, axis=1)[:, :, None]
        at = u[:, :1] + LOOKS * np.diff(u, axis=1)
        looks = points_on(paths, np.repeat(path, len(LOOKS)), at.ravel()).reshape(n, -1, 2)
        off = np.linalg.norm(looks - hermite(p, d, LOOKS), axis=2).max(axis=1)
        height = _off_chord(looks, p).max(axis=1)
        want = np.maximum((off / (CUBIC * extent)) ** 0.25, (height / (CHORD * extent)) ** 0.5)
        parts = np.ceil(want).clip(1, MOST_PARTS).astype(np.intp)
        if (parts == 1).all() or not again:
            break
        segment, u = np.repeat(segment, parts), ragged.equal_parts(u, parts)
    return segment, p, d


def hermite(ends: Floats, derivatives: Floats, t: Floats) -> Floats:
    """Points (k, len(t), 2) of cubics with these ends and derivatives (k, 2, 2)."""
    a, b = ends[:, None, 0], ends[:, None, 1]
    c, d = derivatives[:, None, 0], derivatives[:, None, 1]
    t = t[None, :, None]
    return a + t * (c + t * (3 * (b - a) - 2 * c - d + t * (c + d - 2 * (b - a))))


def _off_chord(points: Floats, ends: Floats) -> Floats:
    """Distances (k, m) of points (k, m, 2) from the lines through ends (k, 2, 2)."""
    v, w = np.diff(ends, axis=1), points - ends[:, :1]
    length = np.maximum(np.hypot(v[..., 0], v[..., 1]), np.finfo(float).tiny)
    return np.abs(v[..., 0] * w[..., 1] - v[..., 1] * w[..., 0]) / length
