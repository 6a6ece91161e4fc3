"""From points and segments to a domain: checked, triangulated, named."""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np

from adaptmesh._core import InputError, triangulate
from adaptmesh.checks import checked_points, read_only
from adaptmesh.domain.sides.inscribed_polygon import InscribedPolygon
from adaptmesh.errors import DomainError
from adaptmesh.types import Floats, Ints

from .data import DomainData, with_fields
from .given import Given
from .inputs import Inside, Label, checked_names, checked_segments
from .messages import fault_text
from .named_sides import sides_of_domain
from .naming import Selector, chosen_tags, split_names


def domain_of_segments(given: Given) -> DomainData:
    """As `Domain`, of its arguments."""
    points = checked_points(given.points, "point")
    segments = checked_segments(given.segments, points)
    n = len(segments)
    numbers, selectors = split_names(given.names)
    names, tags = checked_names(numbers, n, "segment", given.tags)
    inside = Inside.checked(given.holes, given.regions, given.region_tags)
    domain = enclosed(
        points, segments, tags, names, inside, InscribedPolygon.nothing(len(points), n)
    )
    return with_chosen_names(domain, selectors)


def enclosed(
    points: Floats,
    segments: Ints,
    tags: Ints,
    names: Mapping[str, int],
    inside: Inside,
    curved: InscribedPolygon,
) -> DomainData:
    """Triangulate what segments enclose, or raise a `DomainError` that says what is wrong."""
    domain = DomainData(
        points,
        segments,
        tags,
        names,
        inside.region_names,
        inside.nesting,
        inside.holes,
        inside.seeds,
        inside.seed_regions,
        curved,
    )
    try:
        triangles, labels, pieces, segment, is_boundary = triangulate(
            points, segments, inside.holes, inside.seeds, inside.nesting, inside.certain
        )
    except InputError as fault:
        raise DomainError(fault_text(domain, *fault.args)) from None
    return with_fields(
        domain,
        triangles=read_only(triangles),
        triangle_regions=read_only(domain.region_of_label(labels)),
        pieces=read_only(pieces),
        piece_segments=read_only(segment),
        piece_is_boundary=read_only(is_boundary),
        segment_is_frozen=read_only(np.zeros(len(segments), bool)),
    )


def with_chosen_names(domain: DomainData, selectors: Mapping[Label, Selector]) -> DomainData:
    """Give names to the segments that are chosen for them, by where they are."""
    if not selectors:
        return domain
    tags = chosen_tags(domain.segment_tags, selectors, domain.names, sides_of_domain(domain))
    return with_fields(domain, segment_tags=read_only(tags))
