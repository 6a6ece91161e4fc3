"""What comes out: a triangle mesh with its constrained edges, regions and names."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from functools import cached_property
from typing import TYPE_CHECKING, Any

import numpy as np

from adaptmesh.types import Floats, Ints
from adaptmesh.value import FrozenMapping, Value
from metrics.measure.exact import mesh_edges

from .arrays import frozen_integers, frozen_reals, numbers, plane_points, rows, triangle_areas

if TYPE_CHECKING:
    from adaptmesh.domain.domain import Domain
    from adaptmesh.domain.inputs import ByLabel
    from adaptmesh.domain.naming import Chosen
    from adaptmesh.domain.periodic import PeriodicPair, PeriodicSides
    from adaptmesh.mesh.validate.validate import Validity


@dataclass(frozen=True, eq=False, repr=False)
class Mesh(Value):
    """A conforming triangle mesh; it never changes.

    Parameters
    ----------
    points : (n, 2) array of float
        The vertices.
    triangles : (m, 3) array of int32
        Counter-clockwise vertex numbers, from 0.
    regions : (m,) array of int32, optional
        Region of each triangle, 0 where it has no name; see `region_names`.
    edges : (k, 2) array of int32, optional
        The constrained edges: the boundary and the internal lines of the domain.
    edge_tags : (k,) array of int32, optional
        Tag of each constrained edge, 0 where it has no name; see `names`.
    names : mapping of str to int, optional
        Edge tag of each named boundary or line.
    region_names : mapping of str to int, optional
        Region number of each named region.
    domain : Domain, optional
        What was meshed. `adapt` meshes it again; a mesh without one (read from a file) gets it
        from its constrained edges.
    kept : (n,) array of int32, optional
        The number that each vertex had in the mesh it was made from by ``adapt(..., keep=True)`` or
        `cleaned`, -1 for those that are new or have moved.
    required_points : (p,) array of int32, optional
        In a mesh without a domain, read from a file: numbers of the vertices that every mesh made
        of it has to have, too.
    required_edges : (q,) array of int32, optional
        Likewise, the rows of `edges` that have to stay undivided; see `Domain.with_frozen`.
    periodic : tuple, optional
        Likewise, pairs of boundaries whose vertices correspond, each with `first`, `second` and the
        motion between; see `Domain.with_periodic`.
    """

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

    def background_mesh(self, metric: Any) -> Mesh:
        """Another mesh of the same domain, for this metric; see `Domain.background_mesh`."""
        from adaptmesh.domain.domain import Domain

        return (self.domain or Domain.of_mesh(self)).background_mesh(metric)

    def edges_named(self, name: str) -> Ints:
        """The constrained edges that bear a name, (j, 2)."""
        return self.edges[self.edge_tags == _look_up(self.names, name, "edge")]

    def triangles_in(self, region: str) -> Ints:
        """Numbers of the triangles of a named region, (j,)."""
        number = _look_up(self.region_names, region, "region")
        return np.flatnonzero(self.regions == number).astype(np.int32)

    def periodic_vertices(self) -> dict[tuple[str, str], Ints]:
        """For each pair of periodic boundaries, vertices that correspond, (k, 2).

        In each row a vertex on the first boundary and its image on the second; see
        `Domain.with_periodic`.
        """
        from adaptmesh.domain.periodic import periodic_vertices

        pairs: Sequence[PeriodicPair | PeriodicSides] = (
            self.periodic if self.domain is None else self.domain.periodic
        )
        return {(p.first, p.second): periodic_vertices(self, p) for p in pairs}

    def with_names(self, names: ByLabel[Chosen]) -> Mesh:
        """The same mesh with names for constrained edges that are chosen by where they are.

        Parameters
        ----------
        names : mapping of str or int to a choice
            As in `Domain.with_names`; sides are the constrained edges, together with edges of the
            border and between regions that the mesh does not list, which are listed then. If the
            mesh has a domain, sides are those of the domain, which gets the names, too; numbers
            are not taken then.

        Raises
        ------
        DomainError
            As `Domain.with_names`.

        Examples
        --------
        >>> from adaptmesh import Mesh
        >>> mesh = Mesh([(0, 0), (1, 0), (1, 1), (0, 1)], [(0, 1, 2), (0, 2, 3)])
        >>> mesh = mesh.with_names({"floor": lambda x: x[:, 1] < 1e-9})
        >>> mesh.edges_named("floor").tolist()
        [[0, 1]]
        """
        from .names import mesh_with_names

        return mesh_with_names(self, names)

    def cleaned(self, merge: float | None = None) -> Mesh:
        """The same mesh without points in no triangle, and with each constrained edge listed once.

        Meshes of other programs may have such points, which `validate` finds and metrics refuse;
        and vertices twice, along seams of blocks that were meshed one by one.

        Parameters
        ----------
        merge : float, optional
            Vertices at most this far apart are made one, the first of them; 0 for those that are
            equal. If not given, none are.

        Returns
        -------
        Mesh
            Its `kept` are the numbers that the vertices had: ``values[mesh.kept]`` are those of a
            field on the new mesh.

        Raises
        ------
        DomainError
            An edge has two tags, a triangle would lose its area, or something that is asked for
            (an edge, a required point) is in no triangle.

        Examples
        --------
        >>> from adaptmesh import Mesh
        >>> points = [(0, 0), (1, 0), (0, 1), (1, 0), (1, 1), (0, 1), (5, 5)]
        >>> seam = Mesh(points, [(0, 1, 2), (3, 4, 5)])
        >>> seam.cleaned(merge=0.0).triangles.tolist()
        [[0, 1, 2], [1, 3, 2]]
        """
        from .cleaned import cleaned_mesh

        return cleaned_mesh(self, merge)

    def validate(self, *, tolerance: float | None = None) -> Validity:
        """Check every invariant of a mesh by name; see `adaptmesh.validate`."""
        from .validate.validate import validate

        return validate(self, tolerance=tolerance)


def _look_up(names: Mapping[str, int], name: str, kind: str) -> int:
    if name not in names:
        known = ", ".join(map(repr, names)) or "none"
        raise KeyError(f"no {kind} is named {name!r}; the names are: {known}")
    return names[name]
