"""The fields of a domain, for what works on domains without making them from what users give."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field, replace
from functools import cached_property
from typing import Any, TypeVar

import numpy as np

from adaptmesh.domain.sides.inscribed_polygon import InscribedPolygon, sides_between
from adaptmesh.domain.sides.periodic import PeriodicPair, with_images
from adaptmesh.domain.sides.side import Sides
from adaptmesh.errors import DomainError
from adaptmesh.types import Bools, Floats, Index, Ints
from adaptmesh.value import Value, contents


@dataclass(frozen=True)
class CornersFound:
    """How the corners of a domain were found among the vertices on the border of a mesh.

    Attributes
    ----------
    corners, vertices : int
        So many of so many vertices on the border and on inner lines are corners of the domain.
    tolerance : float
        All others are no farther than this from the straight lines between corners.
    why : str
        What the tolerance comes from.
    """

    corners: int
    vertices: int
    tolerance: float
    why: str

    def __str__(self) -> str:
        return (
            f"{self.corners} corners of {self.vertices} vertices, "
            f"straight to {self.tolerance:.2g} ({self.why})"
        )


@dataclass(frozen=True, eq=False, repr=False)
class DomainData(Value):
    """What a domain consists of.

    Attributes
    ----------
    points : (n, 2) array
    segments : (k, 2) array of int32
        Those of curves are chords of a polygon inscribed in them.
    segment_tags : (k,) array of int32
    names, region_names : mapping of str to int
    nesting : bool
        Whether holes are found by the nesting of lines.
    holes : (h, 2) array
        A point in each hole that is given.
    seeds : (s, 2) array
        A point in each part of a region.
    seed_regions : (s,) array of int32
    curved : InscribedPolygon
        Which of the points and segments lie on curves, and where.
    triangles, triangle_regions : (m, 3), (m,) arrays of int32
        Constrained Delaunay triangles of the points alone, and their regions.
    pieces : (p, 2) array of int32
        The segments, divided where points lie on them.
    piece_segments : (p,) array of int32
        The segment that each is a piece of.
    piece_is_boundary : (p,) array of bool
        Whether it has the outside on one side.
    segment_is_frozen : (k,) array of bool
        Which segments are not cut, see `Domain.with_frozen`.
    periodic : tuple of PeriodicPair
        Pairs of boundaries whose vertices correspond, see `Domain.with_periodic`.
    corners_found : CornersFound or None
        How corners were told from other vertices on the border of a mesh, see `Mesh.to_domain`.
    """

    points: Floats
    segments: Ints
    segment_tags: Ints
    names: Mapping[str, int]
    region_names: Mapping[str, int]
    nesting: bool
    holes: Floats
    seeds: Floats
    seed_regions: Ints
    curved: InscribedPolygon
    triangles: Ints = field(default_factory=lambda: np.empty((0, 3), np.int32))
    triangle_regions: Ints = field(default_factory=lambda: np.empty(0, np.int32))
    pieces: Ints = field(default_factory=lambda: np.empty((0, 2), np.int32))
    piece_segments: Ints = field(default_factory=lambda: np.empty(0, np.int32))
    piece_is_boundary: Bools = field(default_factory=lambda: np.empty(0, np.bool_))
    segment_is_frozen: Bools = field(default_factory=lambda: np.empty(0, np.bool_))
    periodic: tuple[PeriodicPair, ...] = ()
    corners_found: CornersFound | None = None

    def __repr__(self) -> str:
        names = ", ".join([*self.names, *self.region_names])
        return (
            f"<Domain: {len(self.points)} points, {len(self.segments)} segments"
            f"{'; ' + names if names else ''}>"
        )

    def tag_named(self, name: str) -> int:
        """The tag of a boundary or line by its name, or a `DomainError`."""
        if name not in self.names:
            known = ", ".join(map(repr, self.names)) or "none"
            raise DomainError(f"no boundary is named {name!r}; the names are: {known}")
        return self.names[name]

    @cached_property
    def all_sides(self) -> Sides:
        """All lines from corner to corner, straight or curved, with what is known of each."""
        sides = sides_between(
            self.points,
            self.pieces,
            self.piece_segments,
            self.segment_tags,
            self.curved,
            np.concatenate([self.holes, self.seeds]),
        )
        frozen = self.segment_is_frozen[sides.segments]
        return with_images(replace(sides, is_frozen=frozen), self.periodic)

    def sides_named(self, name: str) -> Index:
        """The numbers in `all_sides` of those that bear a name, or a `DomainError`."""
        return np.flatnonzero(self.all_sides.tags == self.tag_named(name))

    def region_of_label(self, labels: Ints) -> Ints:
        """Region numbers from what the core numbers by seed: 0 is no seed, i + 1 is seed i."""
        return np.concatenate([[0], self.seed_regions]).astype(np.int32)[labels]


D = TypeVar("D", bound=DomainData)


def with_fields(domain: D, **changes: Any) -> D:
    """A copy of a domain, of the same type, with other values of some fields."""
    return made_of(type(domain), {**contents(domain), **changes})


def made_of(kind: type[D], fields: Mapping[str, Any]) -> D:
    """A domain of a type with these fields; nothing is checked."""
    out = object.__new__(kind)
    vars(out).update(fields)
    return out
