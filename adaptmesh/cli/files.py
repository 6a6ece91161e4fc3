"""Reading the input of the commands, and checks of their output paths."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import typer

from adaptmesh.domain.domain import Domain
from adaptmesh.mesh.mesh import Mesh

from .output import Reporter


def check_outputs(mesh: Path | None = None, picture: Path | None = None) -> None:
    """Raise an error before the work if the results cannot be written to these paths."""
    from adaptmesh.io.formats import format_of
    from adaptmesh.view.plotter import check_path

    for path in (mesh, picture):
        if path is not None:
            check_folder(path)
    if mesh is not None:
        format_of(mesh)
    if picture is not None:
        check_path(picture)


def check_folder(path: Path) -> None:
    """Raise a usage error if the folder of a path does not exist."""
    if not path.parent.is_dir():
        raise typer.BadParameter(f"there is no folder {str(path.parent)!r} for {path.name!r}")


def is_outline(path: Path) -> bool:
    """Return whether a file holds a domain but no mesh, by its suffix."""
    from adaptmesh.io.formats import OUTLINES

    return path.suffix.lower() in OUTLINES


def read_outline_and_mesh(
    path: Path,
    repair: bool,
    tolerance: float | None,
    straight_tolerance: float | None,
    no_holes: bool,
    reporter: Reporter,
) -> tuple[Domain, Mesh | None]:
    """Read a domain, and the mesh that it belongs to if the file holds one."""
    import adaptmesh as am

    holes: list[tuple[float, float]] | None = [] if no_holes else None
    if repair:
        domain, repairs = am.repair(path, tolerance, holes=holes)
        reporter.print(repairs)
        reporter.record(repairs=[vars(r) for r in repairs])
        return domain, None
    if is_outline(path):
        return am.read_domain(path, holes=holes), None
    mesh = am.read(path)
    return mesh.to_domain(straight_tolerance=straight_tolerance), mesh


def clean_mesh(mesh: Mesh, clean: bool, merge: float | None, reporter: Reporter) -> Mesh:
    """Clean a mesh by `Mesh.cleaned` if --clean or --merge is given."""
    if not clean and merge is None:
        return mesh
    new = mesh.cleaned(merge)
    dropped = len(mesh.points) - len(new.points)
    reporter.print(f"cleaned: {dropped:,} of {len(mesh.points):,} points removed or merged")
    reporter.record(dropped_points=dropped)
    return new


def read_fields_of_mesh(path: Path, read: Mesh, mesh: Mesh) -> dict[str, Any]:
    """Read the fields of a mesh, which may be cleaned, as arguments of `adaptmesh.write`."""
    import adaptmesh as am

    fields = am.read_fields(path)
    of_points = {k: v for k, v in fields.items() if len(v) == len(read.points)}
    of_triangles = {k: v for k, v in fields.items() if k not in of_points}
    if mesh is not read:
        of_points = {k: v[mesh.kept] for k, v in of_points.items()}
    return {"fields": of_points, "triangle_fields": of_triangles}


def read_field(path: Path, name: str) -> Any:
    """Read a field of real numbers from a mesh file."""
    import adaptmesh as am

    fields = am.read_fields(path)
    plain = [key for key, values in fields.items() if values.ndim == 1]
    if name not in plain:
        known = ", ".join(map(repr, plain)) or "none"
        raise typer.BadParameter(f"--field: expected one of the fields {known}, got {name!r}")
    return fields[name]
