"""The fields of a mesh, for what works on meshes without being a method of them."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from functools import cached_property
from typing import TypeVar

import numpy as np

from adaptmesh.checks import frozen_integers, frozen_reals, numbers, plane_points, rows
from adaptmesh.domain.domain import Domain
from adaptmesh.domain.sides.periodic import PeriodicSides
from adaptmesh.errors import DomainError
from adaptmesh.geometry.areas import triangle_areas
from adaptmesh.types import Floats, Ints
from adaptmesh.value import FrozenMapping, Value
from metrics.topology import mesh_edges


@dataclass(frozen=True, eq=False, repr=False)
class MeshData(Value):
    """What a mesh consists of; its fields are described in `Mesh`."""

    points: Floats
    triangles: Ints
    regions: Ints = field(default_factory=lambda: np.empty(0, np.int32))
    edges: Ints = field(default_factory=lambda: np.empty((0, 2), np.int32))
    edge_tags: Ints = field(default_factory=lambda: np.empty(0, np.int32))
    names: Mapping[str, int] = field(default_factory=dict)
    region_names: Mapping[str, int] = field(default_factory=dict)
    domain: Domain | None = None
    kept: Ints | None = None
    required_points: Ints = field(default_factory=lambda: np.empty(0, np.int32))
    required_edges: Ints = field(default_factory=lambda: np.empty(0, np.int32))
    periodic: tuple[PeriodicSides, ...] = ()

    def __post_init__(self) -> None:
        def put(name: str, value: object) -> None:
            object.__setattr__(self, name, value)

        points = frozen_reals(plane_points(self.points))
        put("points", points)
        put("triangles", frozen_integers(rows(self.triangles, "triangles", 3), "triangle"))
        put("edges", frozen_integers(rows(self.edges, "edges", 2), "edge"))
        regions = numbers(self.regions, "regions", len(self.triangles), "triangles")
        put("regions", frozen_integers(regions, "region"))
        tags = numbers(self.edge_tags, "edge_tags", len(self.edges), "edges")
        put("edge_tags", frozen_integers(tags, "edge tag"))
        if self.kept is not None:
            kept = numbers(self.kept, "kept", len(points), "points")
            put("kept", frozen_integers(kept, "number kept"))
        for name in ("required_points", "required_edges"):
            given = getattr(self, name)
            put(name, frozen_integers(np.ravel(() if given is None else given), name))
        put("names", FrozenMapping({} if self.names is None else dict(self.names)))
        names = {} if self.region_names is None else dict(self.region_names)
        put("region_names", FrozenMapping(names))

    def __repr__(self) -> str:
        names = ", ".join([*self.names, *self.region_names])
        return (
            f"<Mesh: {len(self.points)} points, {len(self.triangles)} triangles, "
            f"{len(self.edges)} constrained edges{'; ' + names if names else ''}>"
        )

    @cached_property
    def unique_edges(self) -> Ints:
        """All edges of the triangles once, (e, 2), smaller vertex number first, sorted."""
        return mesh_edges(self.triangles)[0]

    @cached_property
    def areas(self) -> Floats:
        """Area of each triangle, (m,), negative if clockwise; accurate however thin it is."""
        return triangle_areas(self.points[self.triangles])

    def edges_named(self, name: str) -> Ints:
        """The constrained edges that bear a name, (j, 2)."""
        return self.edges[self.edge_tags == _look_up(self.names, name, "edge")]

    def triangles_in(self, region: str) -> Ints:
        """Numbers of the triangles of a named region, (j,)."""
        number = _look_up(self.region_names, region, "region")
        return np.flatnonzero(self.regions == number).astype(np.int32)


M = TypeVar("M", bound=MeshData)
"""A mesh that a copy with other fields is made of, by `dataclasses.replace`: of the same type."""


def _look_up(names: Mapping[str, int], name: str, kind: str) -> int:
    if name not in names:
        known = ", ".join(map(repr, names)) or "none"
        raise KeyError(f"no {kind} is named {name!r}; the names are: {known}")
    return names[name]


def check_is_mesh(mesh: object) -> None:
    """Refuse what is no mesh."""
    if not isinstance(mesh, MeshData):
        raise DomainError(f"expected a Mesh, got {type(mesh).__name__}: generate makes one")
