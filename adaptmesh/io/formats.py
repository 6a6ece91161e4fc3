"""The formats of files by extension; a new one is a row here and a module in `meshes` or `domains`.

A module in `meshes` has ``decode(data) -> Content`` and ``encode(content, **options) -> bytes``;
or, where a mesh is more than one file, ``load(path, fields)`` and ``save(path, content)`` as
`Format` has them. A module is imported when the first file of its kind is read or written.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from importlib import import_module
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
    reader : str
        The module in `adaptmesh.io.meshes` that reads it.
    writer : str, optional
        That which writes it, if it is another.
    has_more_files : bool
        Whether a mesh may be more than one file.
    options : frozenset of str
        The keywords of `save`.
    required : bool
        Whether it can tell which vertices and edges every mesh has to keep.
    periodic : bool
        Whether it can tell which boundaries are periodic.
    seeds : bool
        Whether it tells holes and regions by points in them.
    """

    reader: str
    writer: str = ""
    has_more_files: bool = False
    options: frozenset[str] = frozenset()
    required: bool = False
    periodic: bool = True
    seeds: bool = False

    def load(self, path: Path, fields: bool) -> Content:
        """What a file says; without `fields`, files with nothing but fields need not be read."""
        module = import_module(f"adaptmesh.io.meshes.{self.reader}")
        if self.has_more_files:
            return module.load(path, fields)
        data = read_bytes(path)
        with located(path):
            content = module.decode(data)
        return content

    def save(self, path: Path, content: Content, **options: object) -> Mapping[Path, bytes]:
        """The bytes of each file to be written; none is written yet."""
        module = import_module(f"adaptmesh.io.meshes.{self.writer or self.reader}")
        if self.has_more_files:
            return module.save(path, content, **options)
        return {path: module.encode(content, **options)}


FORMATS: dict[str, Format] = {
    ".vtu": Format("vtu"),
    ".vtk": Format("vtk", options=frozenset({"binary"})),
    ".msh": Format("msh", "gmsh", options=frozenset({"version", "binary"})),
    ".mesh": Format("medit", has_more_files=True, required=True),
    ".meshb": Format("medit", has_more_files=True, required=True, periodic=False),
    ".xdmf": Format("xdmf", has_more_files=True),
    ".xmf": Format("xdmf", has_more_files=True),
    ".ele": Format("triangle", has_more_files=True, seeds=True),
}
_MESHIO = Format("by_meshio", has_more_files=True, periodic=False)
FORMATS |= dict.fromkeys(
    (
        ".inp", ".bdf", ".nas", ".fem", ".su2", ".med", ".vol", ".vol.gz", ".e", ".exo", ".ex2",
        ".dat", ".tec", ".avs", ".dato", ".dato.gz", ".post", ".post.gz", ".h5m", ".hmf", ".mdpa",
        ".obj", ".off", ".ply", ".stl", ".ugrid", ".xml",
    ),
    _MESHIO,
)  # fmt: skip
"""Format of meshes by extension in lower case; one may have two parts, ``.vol.gz``."""

SOLIDS = {".cgns": "CGNS", ".f3grid": "FLAC3D", ".node": "TetGen"}
"""Formats of which meshio knows solids only."""

OUTLINES = {
    ".geojson": "geojson:read_geojson",
    ".json": "geojson:read_geojson",
    ".wkt": "wkt:read_wkt",
    ".shp": "shapefile:read_shapefile",
    ".poly": "poly:read_poly",
    ".svg": "drawings.svg:read_svg",
    ".dxf": "drawings.dxf:read_dxf",
    ".geo": "geo.model:read_geo",
    ".g": "bamg:read_bamg_geometry",
    ".gmesh": "bamg:read_bamg_geometry",
}
"""Module in `adaptmesh.io.domains` and its function, by the extension of files that hold a domain
but no mesh."""


def mesh_suffix(path: Path) -> str | None:
    """The extension of a mesh, of two parts or one; None if it is not that of a mesh."""
    both = "".join(path.suffixes[-2:]).lower()
    suffix = both if both in FORMATS else path.suffix.lower()
    return suffix if suffix in FORMATS else None


def format_of(path: Path) -> Format:
    """The format of meshes that the extension of a path tells."""
    found = mesh_suffix(path)
    if found is not None:
        return FORMATS[found]
    suffix = path.suffix.lower()
    if suffix in OUTLINES:
        raise FormatError(
            f"{path}: {path.suffix!r} is the extension of an outline, which read_domain reads, "
            f"not of a mesh; those are {', '.join(FORMATS)}"
        )
    if suffix in SOLIDS:
        raise FormatError(
            f"{path}: of {SOLIDS[suffix]}, meshio reads and writes tetrahedra only; expected a "
            f"mesh of triangles in one of {', '.join(FORMATS)}"
        )
    raise FormatError(
        f"{path}: the extension {path.suffix!r} is not known; known are {', '.join(FORMATS)}"
    )
