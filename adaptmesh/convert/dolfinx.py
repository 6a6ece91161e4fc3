"""FEniCSx, <https://fenicsproject.org>: meshes of dolfinx, and tags of cells and facets.

dolfinx renumbers cells and vertices, and keeps the old numbers in `original_cell_index` and
`input_global_indices`, through which everything here goes. It has no names: what comes out are the
numbers of `Mesh.names` and `Mesh.region_names`.

Tested with 0.5; written for later versions (up to 0.10) by their documentation.
"""

from __future__ import annotations

import inspect
from collections.abc import Mapping
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np

from adaptmesh.errors import FormatError
from adaptmesh.mesh.incoming import Content
from adaptmesh.mesh.mesh import Mesh
from adaptmesh.topology import edge_keys
from adaptmesh.types import Floats, Int64s

from .labels import incoming

if TYPE_CHECKING:
    import dolfinx
    import mpi4py.MPI

__all__ = ["from_dolfinx", "to_dolfinx", "vertex_values_of_dolfinx"]


def to_dolfinx(
    mesh: Mesh, comm: mpi4py.MPI.Comm | None = None
) -> tuple[dolfinx.mesh.Mesh, dolfinx.mesh.MeshTags, dolfinx.mesh.MeshTags]:
    """The mesh as one of dolfinx, in this process.

    Parameters
    ----------
    mesh : Mesh
    comm : mpi4py communicator, optional
        Of one process; ``MPI.COMM_SELF`` if not given.

    Returns
    -------
    domain : dolfinx.mesh.Mesh
    cell_tags : dolfinx.mesh.MeshTags
        Regions of all cells.
    facet_tags : dolfinx.mesh.MeshTags
        Tags of the constrained edges that have one: ``facet_tags.find(mesh.names["inlet"])``.

    Raises
    ------
    ValueError
        For a communicator of several processes.
    """
    import dolfinx
    from mpi4py import MPI

    comm = MPI.COMM_SELF if comm is None else comm
    if comm.size > 1:
        raise ValueError(f"the communicator has {comm.size} processes; a mesh is made in one")
    domain = dolfinx.mesh.create_mesh(
        comm, cells=mesh.triangles.astype(np.int64), x=mesh.points, **_coordinate_element()
    )
    numbering = _Numbering.of(domain)
    cells = np.arange(len(mesh.triangles), dtype=np.int32)
    cell_tags = dolfinx.mesh.meshtags(domain, 2, cells, mesh.regions[numbering.triangle_of_cell])

    tagged = mesh.edge_tags != 0
    ends, n = numbering.ends_of_facets(domain), len(mesh.points)
    keys = edge_keys(ends, n)
    order = np.argsort(keys)
    edges = mesh.edges[tagged]
    ours = edge_keys(edges, n)
    facets = order[np.searchsorted(keys, ours, sorter=order)].astype(np.int32)
    by_facet = np.argsort(facets)  # as meshtags wants them
    tags = mesh.edge_tags[tagged][by_facet]
    return domain, cell_tags, dolfinx.mesh.meshtags(domain, 1, facets[by_facet], tags)


def from_dolfinx(
    domain: dolfinx.mesh.Mesh,
    cell_tags: dolfinx.mesh.MeshTags | None = None,
    facet_tags: dolfinx.mesh.MeshTags | None = None,
    *,
    names: Mapping[str, int] | None = None,
    region_names: Mapping[str, int] | None = None,
) -> Mesh:
    """A mesh of dolfinx with its tags as a mesh.

    Parameters
    ----------
    domain : dolfinx.mesh.Mesh
        Straight triangles, in one process.
    cell_tags, facet_tags : dolfinx.mesh.MeshTags, optional
    names, region_names : mapping of str to int, optional
        What the numbers of the tags are called.

    Returns
    -------
    Mesh
        Points and triangles in the order in which dolfinx was given them.

    Raises
    ------
    FormatError
        For other cells, curved ones, and a mesh that is spread over several processes.
    """
    numbering = _Numbering.of(domain)
    points = np.empty((len(numbering.point_of_vertex), domain.geometry.x.shape[1]))
    points[np.asarray(domain.geometry.input_global_indices)] = domain.geometry.x
    triangles = np.empty_like(numbering.corners)
    triangles[numbering.triangle_of_cell] = numbering.point_of_vertex[numbering.corners]
    regions = np.zeros(len(triangles), np.int32)
    if cell_tags is not None:
        regions[numbering.triangle_of_cell[cell_tags.indices]] = cell_tags.values
    edges, tags = np.empty((0, 2), np.int64), np.empty(0, np.int32)
    if facet_tags is not None:
        edges, tags = numbering.ends_of_facets(domain)[facet_tags.indices], facet_tags.values
    content = Content(
        points, triangles, regions, edges, tags, dict(names or {}), dict(region_names or {})
    )
    return incoming(content, "the mesh of dolfinx")


def vertex_values_of_dolfinx(function: dolfinx.fem.Function) -> Floats:
    """Values of a Lagrange function at the points of the mesh that was given to `to_dolfinx`.

    Parameters
    ----------
    function : dolfinx.fem.Function
        Continuous or not, of order 1 or more, scalar or with k components; of a mixed space its
        parts, ``function.sub(0).collapse()``.

    Returns
    -------
    (n,) or (n, k) array
        In the order of `Mesh.points`. Of a discontinuous function the value in one of the cells.
    """
    space = function.function_space
    numbering = _Numbering.of(space.mesh)
    dofs, width = _table(space.dofmap.list, len(numbering.corners)), space.dofmap.index_map_bs
    if dofs.shape[1] < 3 or (width == 1 and space.num_sub_spaces > 0):
        raise ValueError(
            "expected a Lagrange function of order 1 or more, which has a value at each vertex; "
            "interpolate into one, and take mixed functions apart with .sub(i).collapse()"
        )
    values = function.x.array.reshape(-1, width)
    out = np.empty((len(numbering.point_of_vertex), width), values.dtype)
    out[numbering.point_of_vertex[numbering.corners]] = values[dofs[:, :3]]
    return out[:, 0] if width == 1 else out


@dataclass(frozen=True)
class _Numbering:
    """From the numbers of dolfinx to those that it was given.

    Attributes
    ----------
    corners : (m, 3) array
        The vertices of each cell, both as dolfinx numbers them.
    point_of_vertex : (n,) array
    triangle_of_cell : (m,) array
    """

    corners: Int64s
    point_of_vertex: Int64s
    triangle_of_cell: Int64s

    @classmethod
    def of(cls, domain: dolfinx.mesh.Mesh) -> _Numbering:
        topology, geometry = domain.topology, domain.geometry
        if domain.comm.size > 1:
            raise FormatError(f"the mesh is spread over {domain.comm.size} processes; gather it")
        if topology.dim != 2:
            raise FormatError(f"the mesh has cells of dimension {topology.dim}, not triangles")
        topology.create_connectivity(2, 0)
        triangle_of_cell = np.asarray(topology.original_cell_index)
        corners = _table(topology.connectivity(2, 0), len(triangle_of_cell))
        nodes = _table(geometry.dofmap, len(triangle_of_cell))
        if corners.shape[1] != 3 or nodes.shape != corners.shape:
            raise FormatError("the mesh has quadrilaterals or curved cells, not plain triangles")
        node_of_vertex = np.empty(len(geometry.x), np.int64)
        node_of_vertex[corners] = nodes
        points = np.asarray(geometry.input_global_indices)
        return cls(corners, points[node_of_vertex], triangle_of_cell)

    def ends_of_facets(self, domain: dolfinx.mesh.Mesh) -> Int64s:
        """The points of each facet, (e, 2)."""
        domain.topology.create_connectivity(1, 0)
        return self.point_of_vertex[
            np.asarray(domain.topology.connectivity(1, 0).array).reshape(-1, 2)
        ]


def _table(rows: Any, count: int) -> Int64s:
    """A table of `count` rows, which older versions keep as an adjacency list."""
    return np.asarray(getattr(rows, "array", rows), dtype=np.int64).reshape(count, -1)


def _coordinate_element() -> dict[str, Any]:
    """The argument of `create_mesh` that says that triangles are straight."""
    import dolfinx

    if "e" in inspect.signature(dolfinx.mesh.create_mesh).parameters:  # from 0.8 on
        import basix.ufl

        return {"e": basix.ufl.element("Lagrange", "triangle", 1, shape=(2,))}
    import ufl

    return {"domain": ufl.Mesh(ufl.VectorElement("Lagrange", "triangle", 1))}
