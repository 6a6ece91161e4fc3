"""What a script describes, whoever has read it: plane curves, surfaces, and the names of both."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import numpy as np

from adaptmesh.curves import Curve
from adaptmesh.domain.domain import Domain
from adaptmesh.domain.inputs import Holes, refuse_holes
from adaptmesh.domain.outline import Outline
from adaptmesh.domain.sides.coincident_curves import curves_once
from adaptmesh.domain.sides.skeleton import extent_of
from adaptmesh.domain.sides.surfaces import overlaps, seeds_of
from adaptmesh.errors import DomainError
from adaptmesh.geometry.distance import first_of_equal
from adaptmesh.io.domains.drawings.drawing import JOINED
from adaptmesh.types import Floats

from .groups import names_of_groups

_SAMPLES = np.linspace(0, 1, 33)
"""On each curve, for the polygons in which seeds are found."""

OVERLAP = 1e-4
"""Surfaces overlap if they share more than this share of the smaller one: polygons of samples on
curves that two surfaces share are only nearly the same."""


def samples_of(curve: Curve) -> Floats:
    """Places on a curve, of which polygons are made to find seeds in."""
    return curve.point([0, 1] if curve.is_straight else _SAMPLES)


class CurvesByNumber:
    """Curves, those that lie on one another once, by the numbers that a script gives them.

    Parameters
    ----------
    pieces : mapping of int to sequence of Curve
        The curves of each number: a polyline has several.
    """

    def __init__(self, pieces: Mapping[int, Sequence[Curve]]) -> None:
        found = [curve for curves in pieces.values() for curve in curves]
        kept, place = curves_once(found, JOINED * extent_of(found)) if found else ([], [])
        self.curves = [found[k] for k in kept]
        places = iter(place)
        self.places = {number: [next(places) for _ in curves] for number, curves in pieces.items()}

    def at(self, numbers: Iterable[int]) -> list[int]:
        """The places in `curves` of those with these numbers; unknown ones are passed over."""
        return [place for number in numbers for place in self.places.get(number, ())]

    def named(
        self, path: Path, groups: Iterable[tuple[str, Iterable[int]]]
    ) -> dict[str, list[int]]:
        """The places of the curves of each physical group, see `names_of_groups`."""
        return names_of_groups(
            path, [(name, self.at(members)) for name, members in groups], "curves"
        )


@dataclass(frozen=True)
class PlaneModel:
    """Curves and surfaces of a script.

    Attributes
    ----------
    curves : sequence of Curve
    names : mapping of str to list of int
        The curves of each name.
    tags, region_tags : mapping of str to int
        Numbers of names, of curves and of regions.
    faces : mapping of int to shapely polygon
        The area of each surface, to samples on its curves; without any, what the curves enclose is
        meshed.
    regions : mapping of str to sequence of int
        The surfaces of each region; each surface is in one at most.
    points : sequence of (x, y)
        Points inside, that every mesh has.
    """

    curves: Sequence[Curve]
    names: Mapping[str, list[int]]
    tags: Mapping[str, int]
    faces: Mapping[int, Any] = field(default_factory=dict)
    regions: Mapping[str, Sequence[int]] = field(default_factory=dict)
    region_tags: Mapping[str, int] = field(default_factory=dict)
    points: Sequence[Floats] = ()

    def domain(self, holes: Holes = None) -> Domain:
        """The domain, if the curves meet at their ends only and regions do not overlap."""
        if not self.curves:
            raise DomainError("it has no curves: there is nothing to mesh")
        if not self.faces:
            return self.domain_with(holes, {})
        refuse_holes(holes, "surfaces")
        for a, b, area in self.overlaps():
            where = "" if self.is_straight else ", if their curves do not cross,"
            raise DomainError(
                f"surfaces {a} and {b} overlap, on an area of {area:.3g}, and are not in the same "
                "physical group: take the one out of the other (BooleanDifference, or its loop as "
                f"a hole), or let adaptmesh.repair{where} give what they share to the first"
            )
        return self.domain_with(*seeds_of(self.faces, self.regions))

    @property
    def is_straight(self) -> bool:
        return all(curve.is_straight for curve in self.curves)

    @property
    def join_tolerance(self) -> float:
        """Ends that are nearer than this are one, in units of the coordinates."""
        return JOINED * extent_of(self.curves)

    def domain_with(self, holes: Holes, regions: Mapping[str, list[Floats]]) -> Domain:
        return Domain.from_curves(
            self.curves,
            names=self.names,
            tags=_of_names(self.tags, self.names),
            holes=holes,
            regions=regions,
            region_tags=_of_names(self.region_tags, regions),
            points=self.points,
            join_tolerance=self.join_tolerance,
        )

    def outline_with(self, holes: Holes, regions: Mapping[str, list[Floats]]) -> Outline:
        ends = np.array([end for curve in self.curves for end in (curve.start, curve.end)])
        points = np.concatenate([ends, np.reshape(self.points, (-1, 2))])
        once, number = np.unique(first_of_equal(points), return_inverse=True)
        return Outline(
            points[once],
            number[: len(ends)].reshape(-1, 2),
            holes=holes,
            regions=regions,
            names=self.names,
            tags=_of_names(self.tags, self.names),
            region_tags=_of_names(self.region_tags, regions),
        )

    def overlaps(self) -> list[tuple[int, int, float]]:
        """Pairs of surfaces that are not in one region and share an area, and the area."""
        region_of = {k: name for name, surfaces in self.regions.items() for k in surfaces}
        return [
            (a, b, area)
            for a, b, area in overlaps(self.faces, OVERLAP)
            if region_of.get(a) != region_of.get(b)
        ]


def _of_names(tags: Mapping[str, int], names: Iterable[str]) -> dict[str, int]:
    """The numbers that a domain can give these names: 0 is that of all without a name."""
    return {name: tags[name] for name in names if tags.get(name)}
