"""pyvista, <https://pyvista.org>: to look at, and to filter."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import ArrayLike

from adaptmesh.errors import FormatError
from adaptmesh.mesh.incoming import Content, refuse_cells
from adaptmesh.mesh.mesh import Mesh
from adaptmesh.types import Array
from metrics import qualities

from .labels import incoming, split_fields

if TYPE_CHECKING:
    import pyvista as pv

__all__ = ["from_pyvista", "to_pyvista"]


def to_pyvista(mesh: Mesh, /, **fields: ArrayLike) -> pv.UnstructuredGrid:
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
    at_points, of_triangles = split_fields(mesh, fields)
    taken = {*grid.cell_data.keys()} & {*fields}
    if taken:
        raise ValueError(f"the name {min(taken)!r} is taken: give the field another")
    for name, values in at_points.items():
        grid.point_data[name] = values
    for name, values in of_triangles.items():
        of_lines = np.full((k, *values.shape[1:]), np.nan)
        grid.cell_data[name] = np.concatenate([values, of_lines])
    for kind, names in (("names", mesh.names), ("region_names", mesh.region_names)):
        if names:
            grid.field_data[kind] = [f"{number} {name}" for name, number in names.items()]
    return grid


def from_pyvista(grid: pv.UnstructuredGrid | pv.PolyData) -> Mesh:
    """Triangles and lines of pyvista as a mesh.

    Regions, tags and names are taken from where `to_pyvista` puts them, if they are there. A file
    is better read by `adaptmesh.read`.

    Raises
    ------
    FormatError
        For other cells, points out of the plane z = 0, and lines that are not sides of triangles.
    """
    import pyvista as pv

    grid = grid if isinstance(grid, pv.UnstructuredGrid) else grid.cast_to_unstructured_grid()
    kinds = np.asarray(grid.celltypes)
    foreign = np.setdiff1d(kinds, [pv.CellType.TRIANGLE, pv.CellType.LINE, pv.CellType.VERTEX])
    refuse_cells({pv.CellType(k).name.lower(): int((kinds == k).sum()) for k in foreign})

    def cells(kind: pv.CellType, width: int, key: str) -> tuple[Array, Array]:
        corners = grid.cells_dict.get(int(kind), np.empty((0, width), np.int64))
        if key not in grid.cell_data:
            return corners, np.zeros(len(corners), np.int32)
        return corners, np.asarray(grid.cell_data[key])[kinds == kind].astype(np.int64)

    content = Content(
        np.asarray(grid.points),
        *cells(pv.CellType.TRIANGLE, 3, "region"),
        *cells(pv.CellType.LINE, 2, "tag"),
        names=_names(grid, "names"),
        region_names=_names(grid, "region_names"),
    )
    return incoming(content, "the grid of pyvista")


def _names(grid: pv.UnstructuredGrid, kind: str) -> dict[str, int]:
    """Names from where they stand as "number name"."""
    out: dict[str, int] = {}
    for line in grid.field_data.get(kind, ()):
        number, _, name = str(line).partition(" ")
        if not number.lstrip("-").isdigit() or not name:
            raise FormatError(f"field_data[{kind!r}] has {line!r}, not a number and a name")
        out[name] = int(number)
    return out
