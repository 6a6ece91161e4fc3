"""From closed rings, or what stands for polygons, to a domain."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from typing import Any

from numpy.typing import ArrayLike

from adaptmesh.domain.polygons.polygon_input import (
    is_collection,
    shape_of_polygon,
    shapes_of,
    without_empty,
)
from adaptmesh.domain.polygons.ring_nesting import (
    refuse_rings_out_of_place,
    rings_with_labels,
)
from adaptmesh.domain.polygons.shared_borders import given_of_shapes
from adaptmesh.errors import DomainError

from .data import DomainData
from .from_segments import domain_of_segments, with_chosen_names
from .given import Given
from .inputs import ByLabel, checked_names, joined_rings, labelled
from .naming import Chosen, split_names


def domain_of_rings(
    outer: Any, holes: Sequence[ArrayLike] | None, names: ByLabel[Chosen] | None
) -> DomainData:
    """As `Domain.polygon`."""
    holes = () if holes is None else holes
    if isinstance(holes, str) or not isinstance(holes, Iterable):
        raise DomainError(f"holes={holes!r}: expected a sequence of rings, [ring]")
    holes = list(holes)
    if is_collection(outer):
        if names is not None or len(holes):
            raise DomainError("features have names and holes of their own: leave out yours")
        shapes = without_empty(shapes_of(outer), stacklevel=4)
        return domain_of_segments(given_of_shapes(shapes))
    shape = shape_of_polygon(outer, holes)
    shape.refuse_what_is_left_out()
    rings, points = rings_with_labels(shape)
    joined = joined_rings(points)
    numbers, selectors = split_names(names)
    tag_of, tags = checked_names(numbers, joined.n_given)
    domain = domain_of_segments(
        Given(
            joined.points,
            joined.segments,
            "nesting",
            names=labelled(tags[joined.given]),
            tags=tag_of,
        )
    )
    if len(rings) > 1 or len(joined.points) < len(joined.segments):
        start, end = domain.points[domain.pieces].transpose(1, 0, 2)
        first, last = domain.points[domain.segments[domain.piece_segments]].transpose(1, 0, 2)
        along = ((end - start) * (last - first)).sum(axis=1) > 0
        ring = joined.ring[domain.piece_segments]
        refuse_rings_out_of_place(shape, rings, domain.points, domain.pieces, along, ring)
    return with_chosen_names(domain, selectors)
