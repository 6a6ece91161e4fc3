"""Dirty segments, with seeds of holes and regions and with names, made into a domain."""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np
from numpy.typing import ArrayLike, NDArray

from .arrangement import Faces, Noded, Repair, Repairs, Words, at, find_faces, node, used_tolerance
from .arrangement.numbering import unique_edges, used_points
from .domain import Domain
from .domain_input import (
    checked_names,
    checked_pairs,
    checked_points,
    labelled,
    name_of_number,
)
from .errors import DomainError
from .raw import Outline

Floats = NDArray[np.float64]
Ints = NDArray[np.int64]
Bools = NDArray[np.bool_]


def repaired_domain_of_segments(
    outline: Outline, tolerance: float | None
) -> tuple[Domain, Repairs]:
    """A domain of points and segments, and what had to be done for it; see `adaptmesh.repair`."""
    points = checked_points(outline.points, "point")
    segments = checked_pairs(outline.segments, len(points)).astype(np.int64)
    names, tags32 = checked_names(outline.names, len(segments), given=outline.tags)
    tags = tags32.astype(np.int64)
    holes = (
        outline.holes
        if isinstance(outline.holes, str)
        else np.array(checked_points(outline.holes, "hole", least=0))
    )
    log = _segments_without_length(points, segments)
    tolerance = used_tolerance(points, tolerance)
    words = Words(lambda v: f"point {v}", lambda i: f"segment {i}")
    noded = node(points, segments, tolerance, words, log)
    drift = noded.drift(points, segments)

    edges, edge_of_piece, _ = unique_edges(noded.pieces)
    edge_tags = _tags(edge_of_piece, tags[noded.segment], len(edges))
    log += _overlaps(noded, edges, edge_of_piece, edge_tags, tags, names)
    kept = ~_spikes(noded, edges, edge_of_piece, holes, log)
    log += _lost_names(names, tags, edge_tags[kept], points, segments)
    if log:
        _check_seeds(outline, holes, noded.points[edges], max(tolerance, drift))
    domain = _domain(noded, edges[kept], edge_tags[kept], outline, holes, names)
    return domain, Repairs(tuple(log), tolerance, drift)


def _segments_without_length(points: Floats, segments: Ints) -> list[Repair]:
    ends = points[segments]
    log = []
    for i in np.flatnonzero((ends[:, 0] == ends[:, 1]).all(axis=1)).tolist():
        x, y = ends[i, 0].tolist()
        what = f"segment {i} starts where it ends; removed"
        log.append(Repair("segment without length", (x, y), what))
    return log


def _tags(edge: Ints, tag: Ints, count: int) -> Ints:
    """For each edge the tag of the first of its segments that has one."""
    out = np.zeros(count, np.int64)
    named = np.flatnonzero(tag)[::-1]
    out[edge[named]] = tag[named]  # of those with the same edge the last one written stays
    return out


def _overlaps(
    noded: Noded,
    edges: Ints,
    edge: Ints,
    edge_tags: Ints,
    tags: Ints,
    names: Mapping[str, int],
) -> list[Repair]:
    """Each pair of segments that have edges in common."""
    order = np.lexsort((noded.segment, edge))
    edge, segment = edge[order], noded.segment[order]
    again = np.append(False, edge[1:] == edge[:-1])
    owner = segment[np.maximum.accumulate(np.where(again, 0, np.arange(len(edge))))]
    name_of = name_of_number(names, tags)
    log = []
    pairs = np.unique(np.stack([owner, segment], axis=1)[again], axis=0)
    for i, j in pairs.tolist():
        common = edge[again & (owner == i) & (segment == j)]
        p, q = noded.points[edges[common]].transpose(1, 0, 2)
        length = float(np.hypot(*(q - p).T).sum())
        x, y = (0.5 * (p[0] + q[0])).tolist()
        what = f"segments {i} and {j} overlap" if i != j else f"segment {i} overlaps itself"
        what += f" over a length of {length:.3g}; one kept"
        tag = int(edge_tags[common[0]])
        if tags[j] not in (0, tag) or tags[i] not in (0, tag):
            loser = tags[j] if tags[j] not in (0, tag) else tags[i]
            what += f", named {name_of[tag]!r} and not {name_of[int(loser)]!r}"
        log.append(Repair("overlapping segments", (x, y), what))
    return log


def _spikes(noded: Noded, edges: Ints, edge: Ints, holes: Floats | str, log: list[Repair]) -> Bools:
    """Edges that were drawn more than once, and stick out of the domain."""
    doubled = np.bincount(edge, minlength=len(edges)) > 1
    if not doubled.any():
        return doubled
    used, renumbered = used_points(edges)
    faces = find_faces(noded.points[used], renumbered)
    spikes: Bools = doubled & (faces.left == faces.right) & ~_inside(faces, holes)[faces.left]
    for i in np.flatnonzero(spikes).tolist():
        p, q = noded.points[edges[i]]
        (x, y), length = (0.5 * (p + q)).tolist(), float(np.hypot(*(q - p)))
        what = f"a line drawn there and back sticks out of the domain by {length:.3g}; removed"
        log.append(Repair("spike", (x, y), what))
    return spikes


def _inside(faces: Faces, holes: Floats | str) -> Bools:
    """Which faces are in the domain."""
    if not isinstance(holes, str):
        out: Bools = np.ones(faces.count, bool)
        out[0] = False
        out[[faces.at(hole) for hole in holes]] = False
        return out

    from scipy.sparse import coo_array
    from scipy.sparse.csgraph import shortest_path

    links = (np.ones(len(faces.left)), (faces.left, faces.right))
    graph = coo_array(links, shape=(faces.count, faces.count)).tocsr()
    depth = shortest_path(graph, directed=False, unweighted=True, indices=0)
    odd: Bools = depth % 2 == 1
    return odd


def _lost_names(
    names: Mapping[str, int], tags: Ints, left: Ints, points: Floats, segments: Ints
) -> list[Repair]:
    name_of = name_of_number(names, tags)
    log = []
    for tag in np.setdiff1d(tags[tags != 0], left).tolist():
        first = np.flatnonzero(tags == tag)[0]
        x, y = points[segments[first, 0]].tolist()
        log.append(Repair("name lost", (x, y), f"no segment named {name_of[tag]!r} is left"))
    return log


def _check_seeds(outline: Outline, holes: Floats | str, segments: Floats, reach: float) -> None:
    """Refuse seeds that a segment may have been moved over."""
    import shapely

    seeds = [
        (f"the point of region {name!r}", p)
        for name, where in outline.regions.items()
        for p in np.atleast_2d(np.asarray(where, float))
    ]
    if not isinstance(holes, str):
        seeds += [(f"hole {i}", p) for i, p in enumerate(holes)]
    if not seeds:
        return
    tree = shapely.STRtree(shapely.linestrings(segments))
    places = shapely.points(np.array([p for _, p in seeds]))
    near = tree.query(places, predicate="dwithin", distance=reach)[0]
    if len(near):
        label, (x, y) = seeds[near.min()]
        raise DomainError(
            f"{label} at {at(x, y)} is within {reach:.3g} of a segment, so that the repair may "
            "have put it on the other side: move it away from segments"
        )


def _domain(
    noded: Noded,
    edges: Ints,
    edge_tags: Ints,
    outline: Outline,
    holes: ArrayLike | str,
    names: Mapping[str, int],
) -> Domain:
    if not len(edges):
        raise DomainError("no segment is longer than the tolerance: there is nothing to mesh")
    used = np.union1d(edges, noded.lone)
    return Domain(
        noded.points[used],
        np.searchsorted(used, edges),
        holes=holes,
        regions=outline.regions,
        names=labelled(edge_tags),
        tags=names,
        region_tags=outline.region_tags,
    )
