"""The metric that a file carries, as a control space."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path
from typing import Literal

import numpy as np

from adaptmesh.errors import FormatError, MetricError
from adaptmesh.files.located import located, only_our_errors
from adaptmesh.files.whole import read_bytes
from adaptmesh.io.meshes.sol import companion, companions
from adaptmesh.mesh.incoming import fields_of, mesh_of
from adaptmesh.mesh.second_order import with_corners_only
from adaptmesh.types import Array
from metrics import Background

from .formats import format_of
from .read import PathLike
from .solutions import SOLUTION_SUFFIXES, read_sizes_or_metrics

_MEDIT = (".mesh", ".meshb")
_METRIC = "metric"


def read_metric(
    path: PathLike,
    field: PathLike | None = None,
    outside: Literal["clamp", "error"] = "clamp",
) -> Background:
    """Read the metric of a file: a mesh with sizes or tensors at its vertices.

    Parameters
    ----------
    path : str or path-like
        A mesh in one of `FORMATS` with a field; or a solution, ``.sol``, ``.solb`` or BAMG's
        ``.mtr``, with the mesh ``name.mesh`` or ``name.meshb`` beside it. The values of ``.mesh``
        are in ``name.sol`` or ``name.mtr`` beside it.
    field : str or path-like, optional
        The name of the field; if not given, ``metric``, or the only one that can be sizes or
        tensors. Or a solution for the vertices of the mesh, ``.sol``, ``.solb`` or ``.mtr``.
    outside : {"clamp", "error"}, optional
        As in `metrics.Background`.

    Returns
    -------
    metrics.Background
        Of sizes h (n,), packed metrics (m11, m12, m22) (n, 3), or tensors (n, 2, 2) or (n, 3, 3),
        also in rows of 4 or 9.

    Raises
    ------
    FormatError
        A file is missing or damaged, or has no such field, or the values are not as many as the
        vertices.
    MetricError
        The values are not sizes or metrics.
    """
    path = Path(path)
    mesh_path, solution, name = path, None, None
    if path.suffix.lower() in SOLUTION_SUFFIXES:
        if field is not None:
            raise FormatError(
                f"{path}: has the values itself: give the path of the mesh, or leave out field"
            )
        mesh_path, solution = _mesh_beside(path), path
    elif field is not None and Path(field).suffix.lower() in SOLUTION_SUFFIXES:
        solution = Path(field)
    else:
        name = None if field is None else str(field)
        if path.suffix.lower() in _MEDIT:
            solution = _solution_beside(path, name)
    with only_our_errors(mesh_path):
        content = with_corners_only(format_of(mesh_path).load(mesh_path, solution is None))
        content.triangle_fields = {}
        with located(mesh_path):
            mesh = mesh_of(content)
            if solution is None:
                values = _chosen(fields_of(content, mesh), name, len(mesh.points))
    if solution is not None:
        values = read_sizes_or_metrics(solution)
        if len(values) != len(mesh.points):
            raise FormatError(
                f"{solution} has {len(values)} values, the mesh {mesh_path} has "
                f"{len(mesh.points)} vertices: they do not belong together"
            )
    with located(solution or mesh_path, MetricError):
        return Background(mesh.points, mesh.triangles, values, outside)


def _mesh_beside(solution: Path) -> Path:
    found = [p for suffix in _MEDIT if (p := solution.with_suffix(suffix)).exists()]
    if not found:
        raise FormatError(
            f"{solution}: expected its mesh {solution.with_suffix('.mesh').name} (or .meshb) "
            "beside it, found none; give the path of the mesh, and this file as field"
        )
    return found[-1 if solution.suffix.lower() == ".solb" else 0]


def _solution_beside(mesh: Path, name: str | None) -> Path:
    """The file of the field of that name beside a mesh of Medit, or of its metric."""
    read_bytes(mesh)  # that it is missing or no file is said first
    fields = companions(mesh)
    if name in (None, _METRIC) and None in fields:
        return fields[None]
    if name in fields:
        return fields[name]
    bamg = mesh.with_suffix(".mtr")
    if name is None and bamg.exists():
        return bamg
    if name is None and len(fields) == 1:
        return next(iter(fields.values()))
    found = ", ".join(repr(key or _METRIC) for key in fields) or "none"
    if name is None:
        raise FormatError(
            f"{mesh}: expected sizes or metrics in {companion(mesh, None).name} or {bamg.name} "
            f"beside it, found neither; other fields: {found}; choose one, or another file, by "
            "field (--metric-field)"
        )
    raise FormatError(f"{mesh}: there is no field {name!r} beside it; there is {found}")


def _chosen(fields: Mapping[str, Array], name: str | None, n: int) -> Array:
    """The field of that name; else the metric, or the only one that can be sizes or tensors."""
    able = {key: found for key, v in fields.items() if (found := _as_metric(v, n)) is not None}
    if name is None:
        name = _METRIC if _METRIC in able else next(iter(able)) if len(able) == 1 else None
    if name in able:
        return able[name]
    listed = ", ".join(map(repr, able)) or "none"
    if name is None:
        raise FormatError(
            f"expected one field of sizes or metrics at the vertices, got {listed}"
            + ("; choose one by field (--metric-field)" if able else "")
        )
    raise FormatError(f"has no field {name!r} of sizes or metrics at the vertices; it has {listed}")


def _as_metric(values: Array, n: int) -> Array | None:
    """Sizes (n,), packed metrics (n, 3) or tensors (n, 2, 2); None if it can't be one of these."""
    shape = values.shape[1:]
    if len(values) != n or values.dtype.kind not in "fiu":
        return None
    if shape in ((4,), (9,)):
        side = int(np.sqrt(shape[0]))
        values = values.reshape(n, side, side)
    if shape in ((3, 3), (9,)):
        values = values[:, :2, :2]
    return values if values.shape[1:] in ((), (3,), (2, 2)) else None
