"""What comes out: a triangle mesh with its constrained edges, regions and names."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

from adaptmesh.domain.background import TriangleMesh
from adaptmesh.domain.domain import Domain
from adaptmesh.domain.inputs import ByLabel
from adaptmesh.domain.naming import Chosen
from adaptmesh.domain.sides.periodic import PeriodicPair, PeriodicSides
from adaptmesh.mesh.validate.validate import Validity, validate
from adaptmesh.types import Ints

from .cleaned import cleaned_mesh
from .data import MeshData
from .names import mesh_with_names
from .periodic_vertices import periodic_vertices
from .to_domain import domain_of_mesh


@dataclass(frozen=True, eq=False, repr=False)
class Mesh(MeshData):
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
        The constrained edges: the boundary and the internal lines of the domain. Where that is
        curved, ``points[edges]`` are chords; measure distances from `domain` or its `sides`.
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

    def background_mesh(self, metric: Any) -> TriangleMesh:
        """Another mesh of the same domain, for this metric; see `Domain.background_mesh`."""
        return (self.domain or self.to_domain()).background_mesh(metric)

    def periodic_vertices(self) -> dict[tuple[str, str], Ints]:
        """For each pair of periodic boundaries, vertices that correspond, (k, 2).

        In each row a vertex on the first boundary and its image on the second; see
        `Domain.with_periodic`.
        """
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
        return cleaned_mesh(self, merge)

    def validate(self, *, tolerance: float | None = None) -> Validity:
        """Check every invariant of a mesh by name; see `adaptmesh.validate`."""
        return validate(self, tolerance=tolerance)

    def to_domain(
        self, corner_angle: float | None = None, *, straight_tolerance: float | None = None
    ) -> Domain:
        """The domain that the mesh covers, from its constrained edges, regions and names.

        Vertices on a straight line of the border are no corners of the domain: they can be left out
        of the next mesh. `corners_found` of the domain says how many corners there are, of how many
        vertices, to what tolerance the rest is straight, and why to that.

        Parameters
        ----------
        corner_angle : float, optional
            In degrees. If given, the border is taken to be smooth where it turns by at most this
            from edge to edge: it becomes splines through its vertices, from corner to corner, and
            stays straight where several edges lie on one line. If not, it is the polygon that the
            mesh has.
        straight_tolerance : float, optional
            How far vertices may be off a straight line, in units of the coordinates. If not given,
            by their digits: 1e-12 of the extent, and twice the rounding error of points, which is
            8 units in the last place of the largest coordinate; half a unit of the last decimal
            digit, or of float32, where all coordinates have no more digits than that (at least 8
            different values, whose last digit is mostly not zero, and a unit smaller than 1/20 of
            the shortest edge of the border or 1e-5 of the extent); or, where coordinates were
            turned or scaled since, 8 times what neighbours on the border are off, mostly to
            opposite sides (at least 24 pairs of them, off by less than 4e-6 of the extent).
            Deviations that are larger than the tolerance are corners, however small the angle.

        Raises
        ------
        DomainError
            It is no mesh of a domain, or the tolerance is negative, or so large that sides meet.
        """
        return domain_of_mesh(self, corner_angle, straight_tolerance)
