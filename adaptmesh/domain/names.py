"""Copies of a domain with other names."""

from __future__ import annotations

import numpy as np

from adaptmesh.checks import read_only
from adaptmesh.errors import DomainError
from adaptmesh.value import FrozenMapping

from .data import DomainData, with_fields
from .from_curves import domain_of_curves
from .inputs import ByLabel, labelled
from .named_sides import renamed_tags, sides_of_domain, tags_of_sides
from .naming import Chosen


def domain_with_names(domain: DomainData, names: ByLabel[Chosen]) -> DomainData:
    """As `Domain.with_names`."""
    sides, old = sides_of_domain(domain), tags_of_sides(domain)
    curves = domain.curved.curves
    numbers, tags = renamed_tags(names, sides, old, domain.names, "curve" if curves else "segment")
    for pair in domain.periodic:
        for name in (pair.first, pair.second):
            tag = domain.names[name]
            if curves or not np.array_equal(tags == tag, old == tag):
                raise DomainError(f"{name!r} is periodic: give names before with_periodic")
    if not curves:
        return with_fields(domain, names=FrozenMapping(numbers), segment_tags=read_only(tags))
    if domain.segment_is_frozen.any():
        raise DomainError("some segments are frozen: give names before with_frozen")
    regions = {r: domain.seeds[i] for r, i in labelled(domain.seed_regions).items()}
    return domain_of_curves(
        curves,
        names=labelled(tags),
        holes="nesting" if domain.nesting else domain.holes,
        regions=regions,
        tags=numbers,
        region_tags=domain.region_names,
        points=domain.points[domain.curved.is_vertex],
        corner_angle=domain.curved.corner_angle,
        join_tolerance=domain.curved.join_tolerance,
    )
