"""From curves to a domain: joined, a polygon inscribed, triangulated, named."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence

from numpy.typing import ArrayLike

from adaptmesh.checks import checked_number, checked_points
from adaptmesh.curves import Curve
from adaptmesh.domain.sides.skeleton import skeleton_of
from adaptmesh.errors import DomainError

from .data import DomainData
from .from_segments import enclosed
from .inputs import ByLabel, Inside, checked_names, labelled
from .named_sides import sides_of_domain, tags_of_sides
from .naming import Chosen, chosen_tags, split_names


def domain_of_curves(
    curves: Sequence[Curve],
    names: ByLabel[Chosen] | None = None,
    holes: ArrayLike | str | None = None,
    regions: ByLabel[ArrayLike] | None = None,
    tags: Mapping[str, int] | None = None,
    region_tags: Mapping[str, int] | None = None,
    points: ArrayLike | None = None,
    corner_angle: float = 40.0,
    join_tolerance: float | None = None,
) -> DomainData:
    """As `Domain.from_curves`."""
    if isinstance(curves, Curve) or not isinstance(curves, Iterable):
        raise DomainError(f"curves={curves!r}: expected a sequence of curves, [curve]")
    corner_angle = checked_number(corner_angle, "corner_angle")
    if join_tolerance is not None:
        join_tolerance = checked_number(join_tolerance, "join_tolerance")
    curves = tuple(curves)
    given, selectors = split_names(names)
    numbers, tag_of = checked_names(given, len(curves), "curve", tags)
    inside = Inside.checked(holes, regions, region_tags)
    isolated = checked_points(() if points is None else points, "point", least=0)

    skeleton = skeleton_of(curves, tag_of, inside, isolated, corner_angle, join_tolerance)
    corners = checked_points(skeleton.points, "point")
    domain = enclosed(
        corners, skeleton.segments, skeleton.segment_tags, numbers, inside, skeleton.curved
    )
    if not selectors:
        return domain
    # Curves of one name are joined, so that those chosen by where they are are joined again.
    chosen = chosen_tags(tags_of_sides(domain), selectors, numbers, sides_of_domain(domain))
    return domain_of_curves(
        curves,
        names=labelled(chosen),
        holes=holes,
        regions=regions,
        tags=numbers,
        region_tags=region_tags,
        points=points,
        corner_angle=corner_angle,
        join_tolerance=join_tolerance,
    )
