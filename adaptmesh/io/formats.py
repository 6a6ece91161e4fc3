"""The file formats by extension; a new one is a row of `FORMATS` and a module beside this one."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from pathlib import Path

from adaptmesh.errors import FormatError
from adaptmesh.files.located import located
from adaptmesh.files.whole import read_bytes
from adaptmesh.mesh.incoming import Content


@dataclass(frozen=True)
class Format:
    """How files of one extension are read and written.

    Parameters
    ----------
    load : callable
        ``load(path, fields)`` gives what the file says; with `fields` false, files beside it that
        hold only fields need not be read.
    save : callable
        ``save(path, content, **options)`` gives the bytes of each file to be written; it writes
        none itself.
    options : frozenset of str
        The keywords of `save`.
    required : bool
        Whether it can tell which vertices and edges every mesh has to keep.
    periodic : bool
        Whether it can tell which boundaries are periodic.
    seeds : bool
        Whether it tells holes and regions by points in them.
    """

    load: Callable[[Path, bool], Content]
    save: Callable[..., Mapping[Path, bytes]]
    options: frozenset[str] = frozenset()
    required: bool = False
    periodic: bool = True
    seeds: bool = False


def _load_vtu(path: Path, fields: bool) -> Content:
    from adaptmesh.io.meshes.vtu import decode

    data = read_bytes(path)
    with located(path):
        return decode(data)


def _save_vtu(path: Path, content: Content) -> dict[Path, bytes]:
    from adaptmesh.io.meshes.vtu import encode

    return {path: encode(content)}


def _load_vtk(path: Path, fields: bool) -> Content:
    from adaptmesh.io.meshes.vtk import decode

    data = read_bytes(path)
    with located(path):
        return decode(data)


def _save_vtk(path: Path, content: Content, **options: bool) -> dict[Path, bytes]:
    from adaptmesh.io.meshes.vtk import encode

    return {path: encode(content, **options)}


def _load_gmsh(path: Path, fields: bool) -> Content:
    from adaptmesh.io.meshes.msh import decode

    data = read_bytes(path)
    with located(path):
        return decode(data)


def _save_gmsh(path: Path, content: Content, **options: object) -> dict[Path, bytes]:
    from adaptmesh.io.meshes.gmsh import encode

    return {path: encode(content, **options)}  # type: ignore[arg-type]


def _load_medit(path: Path, fields: bool) -> Content:
    from adaptmesh.io.meshes.medit import decode
    from adaptmesh.io.meshes.sol import add_companions

    data = read_bytes(path)
    with located(path):
        content = decode(data, binary=path.suffix.lower() == ".meshb")
    if fields:
        add_companions(content, path)
    return content


def _save_medit(path: Path, content: Content) -> dict[Path, bytes]:
    from adaptmesh.io.meshes.medit import encode
    from adaptmesh.io.meshes.sol import encode_companions

    binary = path.suffix.lower() == ".meshb"
    return {path: encode(content, binary=binary), **encode_companions(content, path)}


def _load_xdmf(path: Path, fields: bool) -> Content:
    from adaptmesh.io.meshes.xdmf import decode

    data = read_bytes(path)
    with located(path):
        return decode(data, path.parent)


def _save_xdmf(path: Path, content: Content) -> dict[Path, bytes]:
    from adaptmesh.io.meshes.xdmf import encode

    arrays = path.with_suffix(".h5")
    xml, hdf = encode(content, arrays.name)
    return {arrays: hdf, path: xml}


def _load_triangle(path: Path, fields: bool) -> Content:
    from adaptmesh.io.meshes.triangle import decode

    return decode(path)


def _save_triangle(path: Path, content: Content) -> Mapping[Path, bytes]:
    from adaptmesh.io.meshes.triangle import encode

    return encode(content, path)


FORMATS: dict[str, Format] = {
    ".vtu": Format(_load_vtu, _save_vtu),
    ".vtk": Format(_load_vtk, _save_vtk, frozenset({"binary"})),
    ".msh": Format(_load_gmsh, _save_gmsh, frozenset({"version", "binary"})),
    ".mesh": Format(_load_medit, _save_medit, required=True),
    ".meshb": Format(_load_medit, _save_medit, required=True, periodic=False),
    ".xdmf": Format(_load_xdmf, _save_xdmf),
    ".ele": Format(_load_triangle, _save_triangle, seeds=True),
}
"""Format by extension in lower case."""


def format_of(path: Path) -> Format:
    """The format that the extension of a path tells."""
    found = FORMATS.get(path.suffix.lower())
    if found is None:
        from adaptmesh.io.domains.read import OUTLINE_SUFFIXES  # which reads meshes, too

        if path.suffix.lower() in OUTLINE_SUFFIXES:
            raise FormatError(
                f"{path}: {path.suffix!r} is the extension of an outline, which read_domain reads, "
                f"not of a mesh; those are {', '.join(FORMATS)}"
            )
        raise FormatError(
            f"{path}: the extension {path.suffix!r} is not known; known are {', '.join(FORMATS)}"
        )
    return found
