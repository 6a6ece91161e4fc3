"""Meshes and domains as objects of other libraries, and back.

==============  ==========================================  ======================================
scikit-fem      `to_skfem`, `from_skfem`                    ``MeshTri``
NGSolve         `to_netgen`, `from_netgen`                  ``netgen.meshing.Mesh``
FEniCSx         `to_dolfinx`, `from_dolfinx`                ``Mesh`` and two ``MeshTags``
meshio          `to_meshio`, `from_meshio`                  ``Mesh``
pyvista         `to_pyvista`, `from_pyvista`                ``UnstructuredGrid``
matplotlib      `to_matplotlib`, `from_matplotlib`          ``tri.Triangulation``
shapely         `to_shapely`; `adaptmesh.Domain.polygon`    a ``MultiPolygon`` for each region
==============  ==========================================  ======================================

Points keep their order, so that values at the points need no map, except in FEniCSx, which
renumbers them: `vertex_values_of_dolfinx` puts values back. Boundaries, internal lines and regions
go by their names; a tag or region that has a number but no name is called by its number. What comes
in is checked as a file is: clockwise triangles are turned over, and a `FormatError` names what is
not a plane mesh of triangles. Nothing is loaded before it is asked for.
"""

from .dolfinx import from_dolfinx, to_dolfinx, vertex_values_of_dolfinx
from .matplotlib import from_matplotlib, to_matplotlib
from .meshio import from_meshio, to_meshio
from .netgen import from_netgen, to_netgen
from .pyvista import from_pyvista, to_pyvista
from .shapely import to_shapely
from .skfem import from_skfem, to_skfem

__all__ = [
    "from_dolfinx",
    "from_matplotlib",
    "from_meshio",
    "from_netgen",
    "from_pyvista",
    "from_skfem",
    "to_dolfinx",
    "to_matplotlib",
    "to_meshio",
    "to_netgen",
    "to_pyvista",
    "to_shapely",
    "to_skfem",
    "vertex_values_of_dolfinx",
]
