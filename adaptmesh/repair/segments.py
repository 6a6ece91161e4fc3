"""Repair of segments with names and with seeds of holes and regions."""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np

from adaptmesh.arrangement.faces import find_faces
from adaptmesh.arrangement.noding import Labels, Noded, node, resolve_tolerance
from adaptmesh.arrangement.record import Repair, Repairs, point_text
from adaptmesh.checks import checked_pairs, checked_points
from adaptmesh.domain.domain import Domain
from adaptmesh.domain.inputs import Inside, checked_names, labelled, name_of_number
from adaptmesh.domain.naming import split_names
from adaptmesh.domain.outline import Outline
from adaptmesh.errors import DomainError
from adaptmesh.topology import unique_edges, used_points
from adaptmesh.types import Bools, Floats, Int64s

from .inside_lines import Lines


def repair_segments(outline: Outline, tolerance: float | None) -> tuple[Domain, Repairs]:
    """Make a domain of points and segments, and record the repairs; see `adaptmesh.repair`."""
    points = checked_points(outline.points, "point")
    segments = checked_pairs(outline.segments, len(points)).astype(np.int64)
    given, selectors = split_names(outline.names)
    names, tags32 = checked_names(given, len(segments), given=outline.tags)
    tags = tags32.astype(np.int64)
    inside = Inside.checked(outline.holes, outline.regions, outline.region_tags)
    log = _record_segments_without_length(points, segments)
    tolerance = resolve_tolerance(points, tolerance)
    item_labels = Labels(lambda v: f"point {v}", lambda i: f"segment {i}")
    noded = node(points, segments, tolerance, item_labels, log)
    displacement = noded.displacement(points, segments)

    edges, edge_of_piece, _ = unique_edges(noded.pieces)
    edge_tags = _first_tags(edge_of_piece, tags[noded.segment], len(edges))
    log += _record_overlaps(noded, edges, edge_of_piece, edge_tags, tags, names)
    if not len(edges):
        raise DomainError("no segment is longer than the tolerance: nothing is left to mesh")
    used, renumbered = used_points(edges)
    lines = Lines(find_faces(noded.points[used], renumbered), inside)
    spikes = _find_spikes(noded, edges, edge_of_piece, lines, log)
    kept = ~(spikes | _find_lines_in_holes(noded, edges, lines, spikes, log))
    if np.count_nonzero(kept) < 3:
        raise DomainError(
            f"nothing is left to mesh: {np.count_nonzero(kept)} segments remain, which enclose no "
            "area" + (f"; the last repair: {log[-1]}" if log else "")
        )
    lone = _find_lone_points_inside(noded, edges[kept], lines, log)
    log += _record_lost_names(names, tags, edge_tags[kept], points, segments)
    if log:
        _check_seeds(inside, noded.points[edges], max(tolerance, displacement))
    domain = _make_domain(noded, edges[kept], edge_tags[kept], lone, outline, names)
    domain = domain.with_names(selectors) if selectors else domain
    return domain, Repairs(tuple(log), tolerance, displacement)


def _record_segments_without_length(points: Floats, segments: Int64s) -> list[Repair]:
    ends = points[segments]
    log = []
    for i in np.flatnonzero((ends[:, 0] == ends[:, 1]).all(axis=1)).tolist():
        x, y = ends[i, 0].tolist()
        what = f"segment {i} starts where it ends; removed"
        log.append(Repair("segment without length", (x, y), what))
    return log


def _first_tags(edge: Int64s, tag: Int64s, count: int) -> Int64s:
    """Return for each edge the tag of the first of its segments that has one."""
    out = np.zeros(count, np.int64)
    named = np.flatnonzero(tag)[::-1]
    out[edge[named]] = tag[named]  # the first segment of an edge is written last
    return out


def _record_overlaps(
    noded: Noded,
    edges: Int64s,
    edge: Int64s,
    edge_tags: Int64s,
    tags: Int64s,
    names: Mapping[str, int],
) -> list[Repair]:
    """Record each pair of segments with common edges."""
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
            what += f", with the name {name_of[tag]!r} instead of {name_of[int(loser)]!r}"
        log.append(Repair("overlapping segments", (x, y), what))
    return log


def _find_spikes(
    noded: Noded, edges: Int64s, edge: Int64s, lines: Lines, log: list[Repair]
) -> Bools:
    """Find edges drawn more than once that stick out of the domain."""
    doubled = np.bincount(edge, minlength=len(edges)) > 1
    spikes: Bools = doubled & lines.is_loose
    for i in np.flatnonzero(spikes).tolist():
        place, length = _measure_edge(noded, edges[i])
        what = f"a line drawn there and back sticks out of the domain by {length:.3g}; removed"
        log.append(Repair("spike", place, what))
    return spikes


def _find_lines_in_holes(
    noded: Noded, edges: Int64s, lines: Lines, spikes: Bools, log: list[Repair]
) -> Bools:
    """Find edges in holes or between two holes, other than spikes."""
    lost = lines.is_in_hole & ~spikes
    for i in np.flatnonzero(lost).tolist():
        place, length = _measure_edge(noded, edges[i])
        what = f"a line of length {length:.3g} is in a hole, which is not meshed; removed"
        log.append(Repair("line in a hole", place, what))
    return lost


def _measure_edge(noded: Noded, edge: Int64s) -> tuple[tuple[float, float], float]:
    p, q = noded.points[edge]
    x, y = (0.5 * (p + q)).tolist()
    return (x, y), float(np.hypot(*(q - p)))


def _find_lone_points_inside(
    noded: Noded, edges: Int64s, lines: Lines, log: list[Repair]
) -> Int64s:
    """Find points of no segment that lie in the domain or on an edge of it."""
    lone = np.setdiff1d(noded.lone, edges)
    is_inside = lines.contains(noded.points[lone])
    for x, y in noded.points[lone[~is_inside]].tolist():
        what = "a point of no segment is outside or in a hole; removed"
        log.append(Repair("point outside", (x, y), what))
    return lone[is_inside]


def _record_lost_names(
    names: Mapping[str, int], tags: Int64s, left: Int64s, points: Floats, segments: Int64s
) -> list[Repair]:
    name_of = name_of_number(names, tags)
    log = []
    for tag in np.setdiff1d(tags[tags != 0], left).tolist():
        first = np.flatnonzero(tags == tag)[0]
        x, y = points[segments[first, 0]].tolist()
        log.append(Repair("name lost", (x, y), f"no segment named {name_of[tag]!r} is left"))
    return log


def _check_seeds(inside: Inside, segments: Floats, distance: float) -> None:
    """Raise `DomainError` for a seed so close to a segment that the repair may have crossed it."""
    import shapely

    name_of = name_of_number(inside.region_names, inside.seed_regions)
    labels = [f"the point of region {name_of[r]!r}" for r in inside.seed_regions.tolist()]
    labels += [f"hole {i}" for i in range(len(inside.holes))]
    if not labels:
        return
    places = np.concatenate([inside.seeds, inside.holes])
    tree = shapely.STRtree(shapely.linestrings(segments))
    near = tree.query(shapely.points(places), predicate="dwithin", distance=distance)[0]
    if len(near):
        k = int(near.min())
        raise DomainError(
            f"{labels[k]} at {point_text(*places[k])} is within {distance:.3g} of a segment, which "
            "the repair may have moved across it: move it away from segments"
        )


def _make_domain(
    noded: Noded,
    edges: Int64s,
    edge_tags: Int64s,
    lone: Int64s,
    outline: Outline,
    names: Mapping[str, int],
) -> Domain:
    used = np.union1d(edges, lone)
    return Domain(
        noded.points[used],
        np.searchsorted(used, edges),
        holes=outline.holes,
        regions=outline.regions,
        names=labelled(edge_tags),
        tags=names,
        region_tags=outline.region_tags,
    )
