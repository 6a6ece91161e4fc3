"""What a domain of segments is made of, as it was given: the arguments of `Domain`."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

from numpy.typing import ArrayLike

from adaptmesh.value import Value

from .data import DomainData
from .inputs import ByLabel, labelled
from .naming import Chosen


@dataclass(frozen=True, eq=False)
class Given(Value):
    """The arguments of `Domain`, which mean the same here; nothing is checked."""

    points: ArrayLike
    segments: ArrayLike
    holes: ArrayLike | str | None = None
    regions: ByLabel[ArrayLike] | None = None
    names: ByLabel[Chosen] | None = None
    tags: Mapping[str, int] | None = None
    region_tags: Mapping[str, int] | None = None


def given_of(domain: DomainData) -> Given:
    """The arguments that a domain of straight segments was made of."""
    return Given(
        domain.points,
        domain.segments,
        holes="nesting" if domain.nesting else domain.holes,
        regions={r: domain.seeds[i] for r, i in labelled(domain.seed_regions).items()},
        names=labelled(domain.segment_tags),
        tags=domain.names,
        region_tags=domain.region_names,
    )
