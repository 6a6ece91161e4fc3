"""Meshes and fields to files."""

from __future__ import annotations

import os
import warnings
from collections.abc import Mapping
from pathlib import Path

import numpy as np
from numpy.typing import ArrayLike

from adaptmesh.errors import FormatError, FormatWarning
from adaptmesh.files.located import located
from adaptmesh.files.whole import replace_files
from adaptmesh.mesh.mesh import Mesh
from adaptmesh.mesh.periodic_sides import periodic_rows
from adaptmesh.mesh.seeds import seeds_in
from metrics.control import Metric

from .formats import Format, format_of
from .outgoing import all_fields, outgoing
from .required import required_items


def write(
    path: str | os.PathLike[str],
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
