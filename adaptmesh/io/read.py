"""Meshes and fields from files."""

from __future__ import annotations

import os
from pathlib import Path
from typing import TypeAlias

from adaptmesh.domain.outline import Outline
from adaptmesh.files.located import located, only_our_errors
from adaptmesh.io.meshes.outlines import outline_of
from adaptmesh.mesh.incoming import fields_of, mesh_of
from adaptmesh.mesh.mesh import Mesh
from adaptmesh.mesh.second_order import with_corners_only
from adaptmesh.types import Array

from .formats import format_of

PathLike: TypeAlias = "str | os.PathLike[str]"


def read(path: PathLike) -> Mesh:
    """Read a mesh.

    Parameters
    ----------
    path : str or path-like
        A file in one of `FORMATS`, told by its extension.

    Returns
    -------
    Mesh
        With tags 0 and no names where the file has none, and `domain` None. Vertices keep the
        order of the file (in ``.msh``: the order of their tags). Clockwise triangles come out
        counter-clockwise; lone vertices in the file are kept as points.

    Raises
    ------
    FormatError
        The file is missing, damaged, or holds something else than a plane triangle mesh: other
        cells, z not 0, a triangle without area or listed twice, an edge that is not a side of a
        triangle. The message names the first such item.

    See Also
    --------
    read_fields : the fields of the same file.
    """
    path = Path(path)
    with only_our_errors(path):
        content = with_corners_only(format_of(path).load(path, False))
        with located(path):
            return mesh_of(content)


def read_mesh_or_outline(path: PathLike) -> Mesh | Outline:
    """The mesh of a file, or, where it has edges and no triangles, these as an outline."""
    path = Path(path)
    with only_our_errors(path):
        content = with_corners_only(format_of(path).load(path, False))
        with located(path):
            is_outline = len(content.edges) and not len(content.triangles)
            return outline_of(content) if is_outline else mesh_of(content)


def read_fields(path: PathLike) -> dict[str, Array]:
    """Read the fields that are in a mesh file, or for Medit in the solutions beside it.

    ``write(copy, read(path), fields=read_fields(path))`` copies a file.

    Parameters
    ----------
    path : str or path-like
        A file in one of `FORMATS`.

    Returns
    -------
    dict of str to array
        Fields at the points (n,) or (n, c), fields of the triangles (m,) or (m, c), and under
        ``"metric"`` the packed metric (n, 3) = (m11, m12, m22) if there is one.

    Raises
    ------
    FormatError
        As `read`; or a field that does not fit the mesh, or two of one name.
    """
    path = Path(path)
    with only_our_errors(path):
        content = with_corners_only(format_of(path).load(path, True))
        with located(path):
            return fields_of(content, mesh_of(content))
