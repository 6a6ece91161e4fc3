"""Meshes and what is given at their points, as `metrics.read` asks for them.

`metrics` knows nothing of this package: it finds this function by the entry point
``metrics.meshes`` of the suffix.
"""

from __future__ import annotations

from pathlib import Path

from adaptmesh.files.located import located, only_our_errors
from adaptmesh.mesh.incoming import fields_of, mesh_of
from adaptmesh.types import Array

from .formats import format_of


def read(path: Path) -> tuple[Array, Array, dict[str, Array]]:
    """Points (n, 2), triangles (m, 3), and the fields at the points by name, ``metric`` packed.

    Raises
    ------
    FormatError
        As `adaptmesh.read`.
    """
    with only_our_errors(path):
        content = format_of(path).load(path, True)
        content.triangle_fields = {}
        with located(path):
            mesh = mesh_of(content)
            return mesh.points, mesh.triangles, fields_of(content, mesh)
