"""meshio, <https://github.com/nschloe/meshio>: the way to some forty file formats."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import ArrayLike

from adaptmesh.files.located import located
from adaptmesh.mesh.mesh import Mesh
from adaptmesh.mesh.meshio_parts import NUMBERS, Parts, content_of
from adaptmesh.mesh.second_order import with_corners_only

from .labels import incoming, split_fields

if TYPE_CHECKING:
    import meshio

__all__ = ["NUMBERS", "from_meshio", "to_meshio"]


def to_meshio(mesh: Mesh, /, **fields: ArrayLike) -> meshio.Mesh:
    """The mesh as one of meshio, in the plane z = 0.

    Parameters
    ----------
    mesh : Mesh
    **fields : array_like
        Values at the points, (n,) or (n, k), or of the triangles, (m,) or (m, k), by name.

    Returns
    -------
    meshio.Mesh
        A block of triangles and one of lines, the constrained edges. Regions and tags are
        ``cell_data["gmsh:physical"]``, their names in ``field_data``, as meshio has them of Gmsh.

    Raises
    ------
    ValueError
        A field of neither length.
    """
    import meshio

    at_points, of_triangles = split_fields(mesh, fields)
    numbers = [mesh.regions, mesh.edge_tags]
    lines = len(mesh.edges)
    cell_data = {
        name: [values, np.full((lines, *values.shape[1:]), np.nan)]
        for name, values in of_triangles.items()
    }
    names = ((2, mesh.region_names), (1, mesh.names))
    return meshio.Mesh(
        np.column_stack([mesh.points, np.zeros(len(mesh.points))]),
        [("triangle", mesh.triangles), ("line", mesh.edges)],
        point_data=at_points,
        cell_data={"gmsh:physical": numbers, "gmsh:geometrical": numbers, **cell_data},
        field_data={
            name: np.array([number, dim]) for dim, of in names for name, number in of.items()
        },
    )


def from_meshio(m: meshio.Mesh) -> Mesh:
    """A mesh of meshio as a mesh.

    Regions and tags are those under the first of `NUMBERS` that there is, with the names in
    ``field_data``; or else the ``cell_sets``: a cell in several sets has the names of all, with a
    `FormatWarning`.

    Raises
    ------
    FormatError
        For cells that are not triangles, lines or vertices, and for points out of the plane.
    """
    parts = Parts(
        m.points,
        [(block.type, np.asarray(block.data)) for block in m.cells],
        cell_data=m.cell_data,
        cell_sets=m.cell_sets,
        field_data=m.field_data,
        families=getattr(m, "cell_tags", {}),
    )
    with located("the mesh of meshio"):
        content = with_corners_only(content_of(parts))
    return incoming(content, "the mesh of meshio")
