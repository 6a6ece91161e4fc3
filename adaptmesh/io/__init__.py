"""Meshes and their fields in files.

=================  ==============================================================================
``.vtu``           VTK XML, for ParaView and pyvista; keeps everything as it is
``.vtk``           the same in VTK's legacy format, binary (or text)
``.msh``           Gmsh, version 4.1 (or 2.2), binary (or text); names are physical groups
``.mesh .meshb``   Medit, for Mmg, BAMG, FreeFEM; metric and fields in ``.sol``, ``.solb`` beside it
``.ele``           Triangle, with ``.node`` and ``.poly`` beside it; names are in comments
``.xdmf``          for DOLFIN, FEniCSx, ParaView; keeps everything, its arrays in ``.h5`` beside it
=================  ==============================================================================

Points, triangles, regions, constrained edges with their tags, and the names of both come back as
they were, points bit for bit. A file is written whole or not at all.
"""

from __future__ import annotations

import os
import warnings
from collections.abc import Mapping
from pathlib import Path

import numpy as np
from numpy.typing import ArrayLike, NDArray

from adaptmesh.domain.outline import Outline
from adaptmesh.domain.seeds import seeds_in
from adaptmesh.errors import FormatError, FormatWarning
from adaptmesh.files.located import located, only_our_errors
from adaptmesh.files.whole import read_bytes, replace_files
from adaptmesh.io.meshes.outlines import outline_of
from adaptmesh.io.meshes.required import required_items
from adaptmesh.io.meshes.second_order import with_corners_only
from adaptmesh.mesh.incoming import fields_of, mesh_of
from adaptmesh.mesh.mesh import Mesh
from adaptmesh.mesh.periodic_sides import periodic_rows
from adaptmesh.types import Array
from metrics.control import Metric

from .formats import FORMATS, Format, format_of
from .outgoing import all_fields, outgoing, solution_values

__all__ = ["FORMATS", "Format", "read", "read_fields", "read_sol", "write", "write_sol"]

PathLike = str | os.PathLike[str]


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


def write(
    path: PathLike,
    mesh: Mesh,
    /,
    *,
    metric: Metric | ArrayLike | None = None,
    fields: Mapping[str, ArrayLike] | None = None,
    triangle_fields: Mapping[str, ArrayLike] | None = None,
    version: str | None = None,
    binary: bool | None = None,
    **named: ArrayLike,
) -> None:
    """Write a mesh with its fields; the file is replaced whole, or on any error left as it was.

    Parameters
    ----------
    path : str or path-like
        The extension tells the format, see `FORMATS`.
    mesh : Mesh
        Must have triangles, finite points and vertex numbers in range.
    metric : array, size, callable or ControlSpace, optional
        At the points: packed (n, 3), tensors (n, 2, 2) or sizes (n,); or what can be evaluated
        there. `read_fields` gives it back packed. In Medit it is ``name.sol`` beside ``name.mesh``.
    fields : mapping of str to array, optional
        Fields by name, as `named`: for names that are no words (``"wind speed"``), those of
        options (``fields={"version": v}``), and all of a file; ``"metric"`` is the metric.
    triangle_fields : mapping of str to array, optional
        Fields of the triangles, (m,), (m, 2) or (m, 3).
    version : {"4.1", "2.2"}, optional
        Version of ``.msh``; 4.1 if not given.
    binary : bool, optional
        Whether ``.msh`` or ``.vtk`` is binary (if not given) or text.
    **named : array
        Fields of the points, (n,), (n, 2) or (n, 3); an array with as many rows as there are
        triangles (and not points) is a field of the triangles. Integers stay integers in
        ``.vtu`` and become reals elsewhere. NaN is written as it is.

    Raises
    ------
    FormatError
        Nothing has been written: unknown extension, no such folder, a field of another length, two
        of one name, a name or tag that the format cannot hold.
    MetricError
        The metric is not finite and positive definite, or of another shape.
    """
    path = Path(path)
    target = format_of(path)
    options = {"version": version, "binary": binary}
    given = {key: value for key, value in options.items() if value is not None}
    for key in given.keys() - target.options:
        raise FormatError(f"{path}: {path.suffix} has no option {key!r}")
    with located(path):
        of_either, metric = all_fields(fields, named, metric)
        content = outgoing(mesh, metric, of_either, triangle_fields or {})
        if target.required:
            content.required_points, content.required_edges = required_items(mesh)
        _warn_of_what_is_lost(path, mesh, target)
        if target.seeds:
            content.hole_seeds, content.region_seeds = seeds_in(mesh)
        files = target.save(path, content, **given)
    replace_files(files)


def _warn_of_what_is_lost(path: Path, mesh: Mesh, target: Format) -> None:
    """Name what a format has no place for, if the mesh has it."""
    lost = []
    if _any_frozen(mesh) and not target.required:
        lost.append("that edges are frozen (.mesh and .meshb keep it)")
    if not target.periodic and periodic_rows(mesh):
        lost.append("that boundaries are periodic (.mesh, .msh, .vtu and others keep it)")
    if lost:
        warnings.warn(
            f"{path}: {path.suffix} does not keep {', nor '.join(lost)}",
            FormatWarning,
            stacklevel=3,
        )


def _any_frozen(mesh: Mesh) -> bool:
    if mesh.domain is None:
        return len(mesh.required_edges) > 0
    return bool(np.any(mesh.domain.segment_is_frozen))


def read_sol(path: PathLike) -> NDArray[np.float64]:
    """Read a Medit solution, ``.sol`` or ``.solb``.

    Returns
    -------
    (n,), (n, 2) or (n, 3) array of float
        Scalars, vectors, or symmetric tensors as packed metrics (m11, m12, m22). Several fields in
        one file come side by side, (n, c).

    Raises
    ------
    FormatError
        The file is missing or damaged.
    """
    from adaptmesh.io.meshes.sol import decode

    path = Path(path)
    binary = _is_binary_sol(path)
    with only_our_errors(path):
        data = read_bytes(path)
        with located(path):
            return decode(data, binary=binary).values


def write_sol(path: PathLike, values: ArrayLike) -> None:
    """Write a Medit solution at vertices, ``.sol`` or ``.solb``.

    Parameters
    ----------
    path : str or path-like
        ``.sol`` is text, ``.solb`` binary.
    values : (n,), (n, 2), (n, 3) or (n, 2, 2) array of float
        Scalars (a size h for Mmg), vectors, or symmetric tensors (packed as m11, m12, m22).

    Raises
    ------
    FormatError
        An array of another shape, or the file cannot be written.
    """
    from adaptmesh.io.meshes.sol import encode

    path = Path(path)
    binary = _is_binary_sol(path)
    with located(path):
        array = solution_values(values)
    tensor = array.ndim == 2 and array.shape[1] == 3
    replace_files({path: encode(array, tensor=tensor, place="SolAtVertices", binary=binary)})


def _is_binary_sol(path: Path) -> bool:
    if path.suffix.lower() not in (".sol", ".solb"):
        raise FormatError(f"{path}: a solution is .sol or .solb, not {path.suffix!r}")
    return path.suffix.lower() == ".solb"
