"""Fields that go with a mesh, told by their lengths."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from adaptmesh.mesh.mesh import Mesh

Fields = dict[str, NDArray[Any]]


def split_fields(mesh: Mesh, fields: Mapping[str, ArrayLike]) -> tuple[Fields, Fields]:
    """The fields at the points, and those of the triangles."""
    n, m = len(mesh.points), len(mesh.triangles)
    at_points: Fields = {}
    of_triangles: Fields = {}
    for name, given in fields.items():
        values = np.asarray(given)
        if values.ndim and len(values) == n:
            at_points[name] = values
        elif values.ndim and len(values) == m:
            of_triangles[name] = values
        else:
            raise ValueError(
                f"the field {name!r} has shape {values.shape}: {n} values at the points are "
                f"wanted, or {m} of the triangles"
            )
    return at_points, of_triangles
