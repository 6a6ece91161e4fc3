"""Files that the commands read and write."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Any

import typer

from .output import Speaker

if TYPE_CHECKING:
    from adaptmesh.domain.domain import Domain
    from adaptmesh.mesh.mesh import Mesh


def check_outputs(mesh: Path | None = None, picture: Path | None = None) -> None:
    """Find out before the work, not after it, that the result cannot be put there."""
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
    if not path.parent.is_dir():
        raise typer.BadParameter(f"there is no folder {str(path.parent)!r} for {path.name!r}")


def is_outline(path: Path) -> bool:
    """Whether a file holds a domain but no mesh, by its suffix."""
    from adaptmesh.io.formats import OUTLINES

    return path.suffix.lower() in OUTLINES


def outline_and_mesh(
    path: Path,
    repair: bool,
    tolerance: float | None,
    straight_tolerance: float | None,
    no_holes: bool,
    speaker: Speaker,
) -> tuple[Domain, Mesh | None]:
    """The domain in a file, and the mesh that it is the domain of, if the file holds one."""
    import adaptmesh as am

    holes: list[tuple[float, float]] | None = [] if no_holes else None
    if repair:
        domain, repairs = am.repair(path, tolerance, holes=holes)
        speaker.say(repairs)
        speaker.note(repairs=[vars(r) for r in repairs])
        return domain, None
    if is_outline(path):
        return am.read_domain(path, holes=holes), None
    mesh = am.read(path)
    return mesh.to_domain(straight_tolerance=straight_tolerance), mesh


def cleaned(mesh: Mesh, clean: bool, merge: float | None, speaker: Speaker) -> Mesh:
    """The mesh, or what `Mesh.cleaned` makes of it if --clean or --merge ask for that."""
    if not clean and merge is None:
        return mesh
    new = mesh.cleaned(merge)
    dropped = len(mesh.points) - len(new.points)
    speaker.say(f"cleaned: {dropped:,} of {len(mesh.points):,} points left out or made one")
    speaker.note(dropped_points=dropped)
    return new


def fields_for(path: Path, read: Mesh, mesh: Mesh) -> dict[str, Any]:
    """Arguments of `adaptmesh.write` for the fields in the file of a mesh that may be cleaned."""
    import adaptmesh as am

    fields = am.read_fields(path)
    of_points = {k: v for k, v in fields.items() if len(v) == len(read.points)}
    of_triangles = {k: v for k, v in fields.items() if k not in of_points}
    if mesh is not read:
        of_points = {k: v[mesh.kept] for k, v in of_points.items()}
    return {"fields": of_points, "triangle_fields": of_triangles}


def field_of(path: Path, name: str) -> Any:
    """A field of real numbers in a mesh file."""
    import adaptmesh as am

    fields = am.read_fields(path)
    plain = [key for key, values in fields.items() if values.ndim == 1]
    if name not in plain:
        known = ", ".join(map(repr, plain)) or "none"
        raise typer.BadParameter(f"--field {name}: the file has no such field; it has {known}")
    return fields[name]
