"""matplotlib: `tripcolor`, `tricontourf` and their like take a `Triangulation`."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from adaptmesh.mesh.incoming import Content
from adaptmesh.mesh.mesh import Mesh

from .labels import incoming

if TYPE_CHECKING:
    from matplotlib.tri import Triangulation

__all__ = ["from_matplotlib", "to_matplotlib"]


def to_matplotlib(mesh: Mesh) -> Triangulation:
    """The mesh as a `matplotlib.tri.Triangulation`; it knows neither regions nor names.

    Examples
    --------
    >>> import adaptmesh as am
    >>> from adaptmesh.convert import to_matplotlib
    >>> mesh = am.generate(am.Domain.rectangle(0, 0, 2, 1), 0.2)
    >>> to_matplotlib(mesh).triangles.shape == mesh.triangles.shape  # as plt.tricontourf takes it
    True
    """
    from matplotlib.tri import Triangulation

    return Triangulation(*mesh.points.T, mesh.triangles)


def from_matplotlib(triangulation: Triangulation) -> Mesh:
    """A `Triangulation` as a mesh: the triangles that are not masked, and all points.

    Raises
    ------
    FormatError
        For triangles without area, which Qhull makes along straight borders: mask them with
        `matplotlib.tri.TriAnalyzer.get_flat_tri_mask`.
    """
    points = np.column_stack([triangulation.x, triangulation.y])
    triangles = triangulation.get_masked_triangles()
    no_edges = np.empty((0, 2), np.int64), np.empty(0, np.int32)
    content = Content(points, triangles, np.zeros(len(triangles), np.int32), *no_edges)
    return incoming(content, "the Triangulation")
