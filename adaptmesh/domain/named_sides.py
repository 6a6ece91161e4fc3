"""The sides of a domain, its curves or segments, to choose among and to name."""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np

from adaptmesh.domain.sides.joining import name_of_curve
from adaptmesh.errors import DomainError
from adaptmesh.topology import triangles_beside
from adaptmesh.types import Floats, Ints

from .data import DomainData
from .inputs import ByLabel, checked_names, numbered
from .messages import segment_text
from .naming import LOOKS, Chosen, SideSamples, chosen_tags, split_names, straight_sides


def sides_of_domain(domain: DomainData) -> SideSamples:
    """Its curves if it is made of these, else its segments."""
    return _sides_of_curves(domain) if domain.curved.curves else _sides_of_segments(domain)


def _sides_of_segments(domain: DomainData) -> SideSamples:
    ends = domain.points[domain.segments]
    return straight_sides(ends, _outward(domain), lambda i: segment_text(domain, i))


def _outward(domain: DomainData) -> Floats:
    """Unit normals of segments away from the domain, (k, 2); NaN where it is on both sides."""
    left, right = triangles_beside(domain.triangles, domain.pieces, len(domain.points))
    start, end = domain.points[domain.pieces].transpose(1, 0, 2)
    first, last = domain.points[domain.segments[domain.piece_segments]].transpose(1, 0, 2)
    along = ((end - start) * (last - first)).sum(axis=1) > 0
    inside_left = (left >= 0) == along
    k = len(domain.segments)
    pieces = np.bincount(domain.piece_segments, minlength=k)
    border = (left < 0) != (right < 0)
    lefts = np.bincount(domain.piece_segments[border & inside_left], minlength=k)
    rights = np.bincount(domain.piece_segments[border & ~inside_left], minlength=k)
    d = np.diff(domain.points[domain.segments], axis=1)[:, 0]
    to_right = np.stack([d[:, 1], -d[:, 0]], axis=1) / np.hypot(*d.T)[:, None]
    sign = np.where(lefts == pieces, 1.0, np.where(rights == pieces, -1.0, np.nan))
    return sign[:, None] * to_right


def _sides_of_curves(domain: DomainData) -> SideSamples:
    curved = domain.curved
    normals = _outward(domain)
    middles = domain.points[domain.segments].mean(axis=1)
    first_of = np.argsort(curved.segment_curves, kind="stable")
    starts = np.searchsorted(curved.segment_curves[first_of], np.arange(len(curved.curves) + 1))
    ends, places, outward = [], [], []
    for i, curve in enumerate(curved.curves):
        mine = first_of[starts[i] : starts[i + 1]]
        p, d = curve.point(LOOKS), curve.derivative(LOOKS)
        ends.append([curve.start, curve.end])
        places.append(p)
        to_right = np.stack([d[:, 1], -d[:, 0]], axis=1)
        with np.errstate(invalid="ignore"):
            to_right /= np.hypot(*d.T)[:, None]
        # The chord nearest to each place says on which side of the curve the domain is.
        near = mine[((p[:, None] - middles[mine]) ** 2).sum(axis=2).argmin(axis=1)]
        outward.append(np.sign((normals[near] * to_right).sum(axis=1))[:, None] * to_right)
    return SideSamples(
        np.array(ends),
        np.array(places),
        np.array(outward),
        lambda i: name_of_curve(curved.curves, i),
    )


def tags_of_sides(domain: DomainData) -> Ints:
    """The tag of each curve, or each segment."""
    curved = domain.curved
    if not curved.curves:
        return domain.segment_tags
    tags = np.zeros(len(curved.curves), np.int32)
    tags[curved.segment_curves] = domain.segment_tags
    return tags


def renamed_tags(
    names: ByLabel[Chosen], sides: SideSamples, old: Ints, old_names: Mapping[str, int], what: str
) -> tuple[Mapping[str, int], Ints]:
    """Names and tags of sides after some got new names, in place of those that they had.

    Names that no side bears any longer are dropped.
    """
    given, selectors = split_names(names)
    if given and not len(sides):
        raise DomainError(f"there are no sides to give the name {next(iter(given))!r} to")
    unnamed = np.setdiff1d(old[old != 0], list(old_names.values())).tolist()
    numbers, _ = numbered([*given, *unnamed], old_names, "tag")
    numbers, tags = checked_names(given, len(sides), what, numbers)
    tags = chosen_tags(tags, selectors, numbers, sides)
    out = np.where(tags != 0, tags, old).astype(np.int32)
    gone = {name for name, tag in old_names.items() if tag in old and tag not in out}
    old_first = {**old_names, **numbers}
    return {name: tag for name, tag in old_first.items() if name not in gone}, out
