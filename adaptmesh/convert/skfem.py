"""scikit-fem, <https://scikit-fem.readthedocs.io>: `MeshTri`, its boundaries and subdomains."""

from __future__ import annotations

from collections.abc import Iterable
from typing import TYPE_CHECKING

import numpy as np

from adaptmesh.errors import FormatError
from adaptmesh.files.located import located
from adaptmesh.mesh.incoming import Content
from adaptmesh.mesh.mesh import Mesh
from adaptmesh.topology import edge_keys

from .labels import incoming, members, tags_of_sets

if TYPE_CHECKING:
    import skfem

__all__ = ["from_skfem", "to_skfem"]


def to_skfem(mesh: Mesh) -> skfem.MeshTri:
    """The mesh as a `MeshTri` of scikit-fem.

    Returns
    -------
    skfem.MeshTri
        Points and triangles in the same order; `boundaries` and `subdomains` by name, internal
        lines among the boundaries. Values of linear elements at the points are
        ``u[basis.nodal_dofs[0]]``.

    Examples
    --------
    >>> import adaptmesh as am
    >>> from adaptmesh.convert import to_skfem
    >>> m = to_skfem(am.generate(am.Domain.rectangle(0, 0, 2, 1), 0.5))
    >>> len(m.boundaries["left"])
    2
    """
    import skfem

    # Contiguous in memory, as skfem asks for with a warning otherwise.
    m = skfem.MeshTri(np.ascontiguousarray(mesh.points.T), np.ascontiguousarray(mesh.triangles.T))
    keys = edge_keys(m.facets.T, len(mesh.points))
    order = np.argsort(keys)
    edges = edge_keys(mesh.edges, len(mesh.points))
    facets = order[np.searchsorted(keys, edges, sorter=order)]
    boundaries = members(mesh.edge_tags, mesh.names)
    subdomains = members(mesh.regions, mesh.region_names)
    if boundaries:
        m = m.with_boundaries({name: facets[items] for name, items in boundaries.items()})
    return m.with_subdomains(subdomains) if subdomains else m


def from_skfem(
    m: skfem.MeshTri,
    *,
    boundaries: Iterable[str] | None = None,
    subdomains: Iterable[str] | None = None,
) -> Mesh:
    """A `MeshTri` of scikit-fem as a mesh.

    Parameters
    ----------
    m : skfem.MeshTri
        Of straight triangles.
    boundaries, subdomains : iterable of str, optional
        The names to be taken, if not all; a facet or an element has one only.

    Returns
    -------
    Mesh
        Points and triangles in the same order. Its constrained edges are the named facets, the
        border, and what lies between subdomains.

    Raises
    ------
    FormatError
        For a mesh of other or curved cells, and for a facet or element with two names.
    """
    import skfem

    if not isinstance(m, skfem.MeshTri) or m.doflocs.shape != (2, m.nvertices):
        raise FormatError(
            f"the {type(m).__name__} is not a plane MeshTri of straight triangles; "
            "`skfem.MeshTri.from_mesh(m)` makes one of curved triangles"
        )
    with located("the MeshTri"):
        tags, names = tags_of_sets(m.boundaries, m.facets.shape[1], "facet", boundaries)
        regions, region_names = tags_of_sets(m.subdomains, m.nelements, "element", subdomains)
    named = np.flatnonzero(tags)
    content = Content(
        m.p.T, m.t.T, regions, m.facets.T[named], tags[named], names, region_names
    )  # fmt: skip
    return incoming(content, "the MeshTri")
