"""What a domain of segments is made of, as it was given: the arguments of `Domain`."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

from numpy.typing import ArrayLike

from adaptmesh.checks import checked_number
from adaptmesh.errors import DomainError
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


def given_rectangle(x0: float, y0: float, x1: float, y1: float) -> Given:
    """As `Domain.rectangle`."""
    x0, y0, x1, y1 = (
        checked_number(value, what)
        for value, what in ((x0, "x0"), (y0, "y0"), (x1, "x1"), (y1, "y1"))
    )
    if not (x0 < x1 and y0 < y1):
        raise DomainError(f"rectangle({x0}, {y0}, {x1}, {y1}): expected x0 < x1 and y0 < y1")
    corners = [(x0, y0), (x1, y0), (x1, y1), (x0, y1)]
    sides = {"bottom": [0], "right": [1], "top": [2], "left": [3]}
    return Given(corners, [(0, 1), (1, 2), (2, 3), (3, 0)], names=sides)


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
