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

from dataclasses import replace

import numpy as np

from adaptmesh.types import Floats, Int64s

from .data import D, DomainData, with_fields
from .from_segments import domain_of_segments
from .frozen import domain_with_frozen
from .given import given_of
from .inputs import labelled
from .periodic import Motion, PeriodicPair, pair_motion, periodic_pair, side_pieces, used_tolerance


def domain_with_pair(
    domain: DomainData, first: str, second: str, motion: Motion | None, tolerance: float | None
) -> DomainData:
    """The domain with two boundaries that correspond, each with the corners of the other."""
    tolerance = used_tolerance(domain, tolerance)
    motion = pair_motion(domain, first, second, motion)
    domain = _divided(domain, *_missing(domain, first, second, motion, tolerance))
    domain = _divided(domain, *_missing(domain, second, first, motion.inverse(), tolerance))
    return with_pair(domain, periodic_pair(domain, first, second, motion, tolerance))


def with_pair(domain: D, pair: PeriodicPair) -> D:
    """The same domain with one more pair of periodic boundaries."""
    return with_fields(domain, periodic=(*domain.periodic, pair))


def _missing(
    domain: DomainData, source: str, target: str, motion: Motion, tolerance: float
) -> tuple[Floats, Int64s]:
    """Images of corners of the source within straight pieces of the target, and the segments."""
    import shapely
    from scipy.spatial import KDTree

    nothing = np.empty((0, 2)), np.empty(0, np.int64)
    theirs = side_pieces(domain, target)
    theirs = theirs[~domain.segment_is_frozen[domain.piece_segments[theirs]]]
    corners = np.unique(domain.pieces[side_pieces(domain, source)])
    if domain.curved.curves or not len(theirs) or not len(corners):
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
    for pair in domain.periodic:
        again = periodic_pair(out, pair.first, pair.second, pair.motion, pair.tolerance)
        out = with_pair(out, again)
    return out
