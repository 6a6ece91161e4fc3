"""NGSolve, <https://ngsolve.org>, and its mesher Netgen: materials and boundaries by name."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from adaptmesh.errors import FormatError
from adaptmesh.mesh.incoming import Content
from adaptmesh.mesh.mesh import Mesh
from adaptmesh.mesh.to_domain import with_interfaces
from adaptmesh.types import Array, Ints

from .labels import incoming, names_of_tags

if TYPE_CHECKING:
    import netgen.meshing
    import ngsolve

__all__ = ["from_netgen", "to_netgen"]


UNNAMED = "default"  # what Netgen calls a material or boundary without a name


def to_netgen(mesh: Mesh) -> netgen.meshing.Mesh:
    """The mesh as one of Netgen; ``ngsolve.Mesh(to_netgen(mesh))`` is one of NGSolve.

    Returns
    -------
    netgen.meshing.Mesh
        Points in the same order: the first ``len(mesh.points)`` numbers of an H1 function of any
        order are its values there. Triangles are put in region by region. Regions are its
        materials; constrained edges, those inside too, its boundaries. Without a name they are
        called ``"default"``.
    """
    import netgen.meshing

    out = netgen.meshing.Mesh(dim=2)
    out.AddPoints(np.ascontiguousarray(mesh.points))
    edges, tags = with_interfaces(mesh)
    for dim, cells, numbers, names in (
        (2, mesh.triangles, mesh.regions, mesh.region_names),
        (1, edges, tags, mesh.names),
    ):
        for number, name in ({0: UNNAMED} | names_of_tags(numbers, names)).items():
            chosen = np.ascontiguousarray(cells[numbers == number])
            if len(chosen):
                out.AddElements(dim=dim, index=out.AddRegion(name, dim), data=chosen, base=0)
    return out


def from_netgen(m: netgen.meshing.Mesh | ngsolve.Mesh) -> Mesh:
    """A mesh of Netgen or NGSolve as a mesh; curved sides become straight.

    Returns
    -------
    Mesh
        Points and triangles in the same order. Boundaries and materials called ``"default"`` have
        no name here.

    Raises
    ------
    FormatError
        For a mesh of solids or surfaces in space, with quadrilaterals, or of second order.
    """
    m = getattr(m, "ngmesh", m)
    if m.dim != 2:
        raise FormatError(f"the mesh of Netgen has {m.dim} dimensions; only plane ones can be read")
    triangles, regions, region_names = _labelled(m, 2, m.Elements2D().NumPy())
    edges, tags, names = _labelled(m, 1, m.Elements1D().NumPy())
    # An edge between two materials may be there twice, once for either side.
    _, first = np.unique(np.sort(edges, axis=1), axis=0, return_index=True)
    first.sort()
    content = Content(
        np.asarray(m.Coordinates()),
        triangles,
        regions,
        edges[first],
        tags[first],
        names,
        region_names,
    )
    return incoming(content, "the mesh of Netgen")


def _labelled(
    m: netgen.meshing.Mesh, dim: int, elements: Array
) -> tuple[Ints, Ints, dict[str, int]]:
    """The elements of a dimension, from 0; the tag of each; the tag of each name."""
    nodes = elements["nodes"].astype(np.int32) - 1
    # Netgen fills up with zeros: a segment has room for the middle node of second order.
    if (nodes[:, dim + 1 :] >= 0).any():
        raise FormatError(
            "the mesh of Netgen has quadrilaterals or elements of second order; only triangles "
            "with three nodes can be read"
        )
    labels = m.GetRegionNames(dim=dim)
    names = {n: i for i, n in enumerate(dict.fromkeys(n for n in labels if n != UNNAMED), start=1)}
    tag_of_index = np.array([0, *(names.get(label, 0) for label in labels)], np.int32)
    return nodes[:, : dim + 1], tag_of_index[elements["index"]], names
