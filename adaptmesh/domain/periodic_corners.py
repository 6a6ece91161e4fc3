"""Corners of one periodic boundary that the other one lacks.

A side that a repair or a neighbour has divided has corners where its partner is straight on::

       first       second            The image of b is put on the second side, and divides it, so
    a .------->------. a'            that both have the same pieces.
      |    motion    |
    b .------->------x b'
      |              |
    c '------->------' c'
"""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import replace

import numpy as np

from adaptmesh.domain.sides.motion import Motion
from adaptmesh.domain.sides.periodic import PeriodicPair, pair_motion, periodic_pair, used_tolerance
from adaptmesh.errors import DomainError
from adaptmesh.types import Floats, Int64s

from .data import D, DomainData, with_fields
from .from_segments import domain_of_segments
from .frozen import domain_with_frozen
from .given import given_of
from .inputs import labelled


def domain_with_pair(
    domain: DomainData, first: str, second: str, motion: Motion | None, tolerance: float | None
) -> DomainData:
    """The domain with two boundaries that correspond, each with the corners of the other."""
    for other in domain.periodic:
        for name in {first, second} & {other.first, other.second}:
            raise DomainError(
                f"{name!r} is periodic already, with {other.first!r} and {other.second!r}"
            )
    tolerance = used_tolerance(domain.points, tolerance)
    numbers = (domain.sides_named(first), domain.sides_named(second))
    motion = pair_motion(domain.all_sides, numbers, (first, second), motion)
    domain = _divided(domain, *_missing(domain, first, second, motion, tolerance))
    domain = _divided(domain, *_missing(domain, second, first, motion.inverse(), tolerance))
    return with_pair(domain, first, second, motion, tolerance)


def with_pair(domain: D, first: str, second: str, motion: Motion, tolerance: float) -> D:
    """The same domain with one more pair of periodic boundaries, whose corners correspond."""
    numbers = (domain.sides_named(first), domain.sides_named(second))
    pair = periodic_pair(domain.all_sides, numbers, (first, second), motion, tolerance)
    return with_fields(domain, periodic=(*domain.periodic, pair))


def with_pairs(domain: D, pairs: Iterable[PeriodicPair]) -> D:
    """The same domain with the periodic boundaries of another, by name."""
    for pair in pairs:
        domain = with_pair(domain, pair.first, pair.second, pair.motion, pair.tolerance)
    return domain


def _missing(
    domain: DomainData, source: str, target: str, motion: Motion, tolerance: float
) -> tuple[Floats, Int64s]:
    """Images of corners of the source within straight pieces of the target, and the segments."""
    import shapely
    from scipy.spatial import KDTree

    nothing = np.empty((0, 2)), np.empty(0, np.int64)
    if domain.curved.curves:
        return nothing
    theirs = domain.sides_named(target)
    theirs = theirs[~domain.segment_is_frozen[domain.piece_segments[theirs]]]
    corners = np.unique(domain.pieces[domain.sides_named(source)])
    if not len(theirs) or not len(corners):
        return nothing
    images = motion(domain.points[corners])
    ends = domain.points[np.unique(domain.pieces[theirs])]
    images = images[KDTree(ends).query(images, p=np.inf)[0] > tolerance]
    lines = shapely.STRtree(shapely.linestrings(domain.points[domain.pieces[theirs]]))
    image, piece = lines.query(shapely.points(images), predicate="dwithin", distance=tolerance)
    image, first = np.unique(image, return_index=True)
    return images[image], domain.piece_segments[theirs[piece[first]]].astype(np.int64)


def _divided(domain: DomainData, places: Floats, segment: Int64s) -> DomainData:
    """A domain of straight segments with further points on some of these, which divide them.

    The first part of a segment keeps its number; the others are numbered on after the last one.
    """
    if not len(places):
        return domain
    segments, tags = domain.segments.astype(np.int64), domain.segment_tags
    points = np.concatenate([domain.points, places])
    parts, owner = [], []
    for s in np.unique(segment).tolist():
        a, b = segments[s].tolist()
        within = np.setdiff1d(domain.pieces[domain.piece_segments == s], [a, b])
        within = np.append(within, len(domain.points) + np.flatnonzero(segment == s))
        along = (points[within] - points[a]) @ (points[b] - points[a])
        path = np.array([a, *within[np.argsort(along)].tolist(), b])
        links = np.stack([path[:-1], path[1:]], axis=1)
        segments[s] = links[0]
        parts.append(links[1:])
        owner += [s] * (len(links) - 1)
    given = replace(
        given_of(domain),
        points=points,
        segments=np.concatenate([segments, *parts]),
        names=labelled(np.append(tags, tags[owner])),
    )
    out = domain_of_segments(given)
    frozen = np.flatnonzero(np.append(domain.segment_is_frozen, domain.segment_is_frozen[owner]))
    out = domain_with_frozen(out, (), frozen) if len(frozen) else out
    out = with_fields(out, corners_found=domain.corners_found)
    return with_pairs(out, domain.periodic)
