"""meshio, <https://github.com/nschloe/meshio>: the way to some forty file formats."""

from __future__ import annotations

from collections import Counter
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from adaptmesh.errors import FormatError
from adaptmesh.files.located import located
from adaptmesh.mesh.incoming import Content, refuse_cells
from adaptmesh.mesh.mesh import Mesh

from .labels import incoming, split_fields, tags_of_sets

if TYPE_CHECKING:
    import meshio

__all__ = ["from_meshio", "to_meshio"]

# What the readers of meshio call the numbers of regions and boundaries, the most telling first.
NUMBERS = ("gmsh:physical", "medit:ref", "cell_tags", "gmsh:geometrical")
_DIMENSIONS = {"triangle": 2, "line": 1}


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
    ``field_data``; or else the ``cell_sets``.

    Raises
    ------
    FormatError
        For cells that are not triangles, lines or vertices, for points out of the plane, and for
        a cell in two sets.
    """
    counts = Counter[str]()
    for block in m.cells:
        counts[block.type] += len(block.data)
    refuse_cells({k: c for k, c in counts.items() if k not in (*_DIMENSIONS, "vertex")})
    triangles, regions, region_names = _labelled(m, "triangle")
    edges, tags, names = _labelled(m, "line")
    content = Content(m.points, triangles, regions, edges, tags, names, region_names)
    return incoming(content, "the mesh of meshio")


def _labelled(m: meshio.Mesh, kind: str) -> tuple[NDArray[Any], NDArray[Any], dict[str, int]]:
    """The cells of a kind, in all blocks; the tag of each; the tag of each name."""
    blocks = [i for i, block in enumerate(m.cells) if block.type == kind]
    if not blocks:
        return np.empty((0, _DIMENSIONS[kind] + 1), np.int64), np.empty(0, np.int32), {}
    cells = np.concatenate([m.cells[i].data for i in blocks])
    for key in NUMBERS:
        if key in m.cell_data:
            numbers = np.concatenate([np.asarray(m.cell_data[key][i]) for i in blocks])
            return cells, numbers.astype(np.int64), _names(m, _DIMENSIONS[kind])
    starts = np.cumsum([0, *(len(m.cells[i].data) for i in blocks)])
    sets = {}
    for name, parts in m.cell_sets.items():
        items = [
            start + np.asarray(parts[i], np.int64)
            for start, i in zip(starts, blocks, strict=False)
            if parts[i] is not None and len(parts[i])
        ]
        if items and not name.startswith("gmsh:"):
            sets[name] = np.concatenate(items)
    with located("the mesh of meshio"):
        numbers, names = tags_of_sets(sets, len(cells), kind, None)
    return cells, numbers, names


def _names(m: meshio.Mesh, dimension: int) -> dict[str, int]:
    out: dict[str, int] = {}
    for name, entry in m.field_data.items():
        values = np.ravel(entry)
        if len(values) != 2:
            raise FormatError(f"field_data[{name!r}] is {entry}, not a number and a dimension")
        if values[1] == dimension:
            out[name] = int(values[0])
    return out
