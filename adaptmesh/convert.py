"""Meshes as objects of other libraries."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import ArrayLike

from metrics import qualities

if TYPE_CHECKING:
    import pyvista as pv

    from .mesh import Mesh

__all__ = ["to_pyvista"]


def to_pyvista(mesh: Mesh, **fields: ArrayLike) -> pv.UnstructuredGrid:
    """The mesh as an unstructured grid of pyvista, in the plane z = 0.

    Parameters
    ----------
    mesh : Mesh
    **fields : array_like
        Values at the points, (n,) or (n, k), or of the triangles, (m,) or (m, k), by name.

    Returns
    -------
    pyvista.UnstructuredGrid
        The triangles, then the constrained edges as lines. Its cell data are ``region`` (0 for
        lines), ``tag`` (0 for triangles), ``quality`` and the fields of triangles (not a number
        for lines); its point data the fields of points. ``field_data`` holds ``names`` and
        ``region_names``, each as "number name".

    Raises
    ------
    ValueError
        A field of neither length, or with a name that is taken.
    """
    import pyvista as pv

    m, k = len(mesh.triangles), len(mesh.edges)
    corners = np.column_stack([np.full(m, 3), mesh.triangles]).ravel()
    ends = np.column_stack([np.full(k, 2), mesh.edges]).ravel()
    kinds = np.repeat([pv.CellType.TRIANGLE, pv.CellType.LINE], [m, k]).astype(np.uint8)
    points = np.column_stack([mesh.points, np.zeros(len(mesh.points))])
    grid = pv.UnstructuredGrid(np.concatenate([corners, ends]), kinds, points)
    grid.cell_data["region"] = np.concatenate([mesh.regions, np.zeros(k, np.int32)])
    grid.cell_data["tag"] = np.concatenate([np.zeros(m, np.int32), mesh.edge_tags])
    quality = qualities(mesh.points, mesh.triangles, 1.0)
    grid.cell_data["quality"] = np.concatenate([quality, np.full(k, np.nan)])
    for name, values in fields.items():
        _add_field(grid, mesh, name, np.asarray(values))
    for kind, names in (("names", mesh.names), ("region_names", mesh.region_names)):
        if names:
            grid.field_data[kind] = [f"{number} {name}" for name, number in names.items()]
    return grid


def _add_field(grid: pv.UnstructuredGrid, mesh: Mesh, name: str, values: np.ndarray) -> None:
    n, m = len(mesh.points), len(mesh.triangles)
    if name in grid.cell_data or name in grid.point_data:
        raise ValueError(f"the name {name!r} is taken: give the field another")
    if values.ndim and len(values) == n:
        grid.point_data[name] = values
    elif values.ndim and len(values) == m:
        lines = np.full((len(mesh.edges), *values.shape[1:]), np.nan)
        grid.cell_data[name] = np.concatenate([values, lines])
    else:
        raise ValueError(
            f"the field {name!r} has shape {values.shape}: {n} values at the points are wanted, "
            f"or {m} of the triangles"
        )
