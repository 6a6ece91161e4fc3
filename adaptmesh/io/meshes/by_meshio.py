"""Formats that meshio reads and writes, <https://github.com/nschloe/meshio>.

What a format keeps is found by reading again what was written: what does not come back is named in
a `FormatWarning`, and a file that would hold another mesh is refused. Sets of cells, families of
MED, markers of SU2 and names of Netgen become names; numbers become regions and tags.

============ =======================================================================================
suffix       what
============ =======================================================================================
.inp         Abaqus: element sets
.bdf ...     Nastran: numbers of properties; coordinates have some 11 digits
.su2         SU2: markers; regions have no place
.med         Salome: groups, fields
.vol         Netgen: numbers and names
.e ...       Exodus: element blocks are regions and tags; sets of sides are not read (netCDF4)
.dat .tec    Tecplot: fields
============ =======================================================================================
"""

from __future__ import annotations

import re
import warnings
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from adaptmesh.errors import FormatError, FormatWarning
from adaptmesh.files.hdf5 import Hdf5File
from adaptmesh.files.located import located
from adaptmesh.files.whole import read_bytes
from adaptmesh.io.formats import mesh_suffix
from adaptmesh.mesh.incoming import Content
from adaptmesh.mesh.meshio_parts import DIMENSIONS, Parts, content_of, sets_of
from adaptmesh.types import Array

from . import meshio_process
from .what_is_kept import what_is_lost

_HDF5 = b"\x89HDF\r\n\x1a\n"


@dataclass(frozen=True)
class Kind:
    """How meshio takes a mesh for a format.

    Parameters
    ----------
    name : str
        What meshio calls it.
    numbers : str
        The cell data in which regions and tags are written.
    names : {"", "field_data", "sets", "families", "markers", "blocks"}
        Where the names are.
    edges : bool
        Whether edges are written.
    fields : {"", "points", "both"}
        Fields that are written.
    dimension : int
        How many coordinates the points are given.
    """

    name: str
    numbers: str = ""
    names: str = ""
    edges: bool = True
    fields: str = ""
    dimension: int = 3


_ABAQUS = Kind("abaqus", names="sets")
_EXODUS = Kind("exodus", names="blocks", fields="points")
_NASTRAN = Kind("nastran", "nastran:ref")
_NETGEN = Kind("netgen", "netgen:index", "field_data", dimension=2)
_PERMAS = Kind("permas")
_TECPLOT = Kind("tecplot", "regions", edges=False, fields="both", dimension=2)
KINDS = {
    ".avs": Kind("avsucd", "avsucd:material", fields="points"),
    ".bdf": _NASTRAN,
    ".dat": _TECPLOT,
    ".dato": _PERMAS,
    ".dato.gz": _PERMAS,
    ".e": _EXODUS,
    ".ex2": _EXODUS,
    ".exo": _EXODUS,
    ".fem": _NASTRAN,
    ".h5m": Kind("h5m", fields="points"),
    ".hmf": Kind("hmf", "regions", edges=False, fields="both"),
    ".inp": _ABAQUS,
    ".mdpa": Kind("mdpa"),
    ".med": Kind("med", "cell_tags", "families", fields="both", dimension=2),
    ".nas": _NASTRAN,
    ".obj": Kind("obj", edges=False),
    ".off": Kind("off", edges=False),
    ".ply": Kind("ply", fields="points"),
    ".post": _PERMAS,
    ".post.gz": _PERMAS,
    ".stl": Kind("stl", edges=False),
    ".su2": Kind("su2", "su2:tag", "markers", dimension=2),
    ".tec": _TECPLOT,
    ".ugrid": Kind("ugrid", "ugrid:ref", edges=False),
    ".vol": _NETGEN,
    ".vol.gz": _NETGEN,
    ".xml": Kind("dolfin-xml", edges=False, dimension=2),
}


def load(path: Path, fields: bool) -> Content:
    """What a file says, as meshio reads it."""
    data = read_bytes(path)
    with located(path):
        return _decode(path, data)


def save(path: Path, content: Content) -> dict[Path, bytes]:
    """The bytes of a file that meshio writes; a `FormatWarning` names what it can't hold."""
    kind = KINDS[mesh_suffix(path) or ""]
    data = meshio_process.write(_parts(content, kind), kind.name, _name(path))
    if kind.names == "markers":
        data = _with_markers(data, content.names)
    try:
        with warnings.catch_warnings():
            warnings.simplefilter("ignore", FormatWarning)
            back = _decode(path, data)
    except FormatError as error:
        raise FormatError(f"meshio cannot read what it has written: {error}") from None
    lost = what_is_lost(content, back)
    if lost:
        warnings.warn(
            f"{path}: {mesh_suffix(path)} does not keep {', nor '.join(lost)}",
            FormatWarning,
            stacklevel=4,
        )
    return {path: data}


def _name(path: Path) -> str:
    """A name that says no more than meshio finds in suffixes; UGRID has two (``.lb8.ugrid``)."""
    suffix = mesh_suffix(path) or path.suffix
    return "mesh" + ("".join(path.suffixes[-2:]) if suffix == ".ugrid" else suffix)


def _decode(path: Path, data: bytes) -> Content:
    kind = KINDS[mesh_suffix(path) or ""]
    names: dict[str, int] = {}
    if kind.names == "markers":
        data, names = _numbered_markers(data)
    if data.startswith(_HDF5):
        Hdf5File(data, path.name).check_all()
    parts = meshio_process.read(data, kind.name, _name(path))
    if names:
        parts.field_data = {name: np.array([tag, 1]) for name, tag in names.items()}
    if kind.names == "blocks":
        _number_blocks(parts)
    if parts.said:
        warnings.warn(f"{path}: meshio: {parts.said}", FormatWarning, stacklevel=5)
    if parts.point_sets:
        warnings.warn(
            f"{path}: passed over the sets of points {', '.join(map(repr, parts.point_sets[:5]))}",
            FormatWarning,
            stacklevel=5,
        )
    return content_of(parts)


def _number_blocks(parts: Parts) -> None:
    """Give the blocks of each kind of cells numbers from 1 on, if there are several."""
    kinds = [kind for kind, _ in parts.cells]
    numbers = [
        kinds[: i + 1].count(kind) if kinds.count(kind) > 1 else 0 for i, kind in enumerate(kinds)
    ]
    parts.cell_data = {
        **parts.cell_data,
        "regions": [
            np.full(len(cells), number)
            for number, (_, cells) in zip(numbers, parts.cells, strict=True)
        ],
    }


# ---------------------------------------------------------------------------------------- writing


def _parts(content: Content, kind: Kind) -> Parts:
    """The mesh as the writer of that kind takes it."""
    points = np.asarray(content.points, np.float64)
    if kind.dimension > points.shape[1]:
        points = np.column_stack([points, np.zeros(len(points))])
    numbered = [("triangle", content.triangles, content.regions, content.region_names)]
    if kind.edges and len(content.edges):
        numbered.append(("line", content.edges, content.edge_tags, content.names))
    cells = [(of, np.asarray(rows)) for of, rows, _, _ in numbered]
    parts = Parts(points, cells)
    if kind.names == "blocks":
        parts.cells = [
            (of, rows[tags == tag])
            for of, rows, tags, _ in numbered
            for tag in np.unique(tags).tolist()
        ]
    elif kind.names == "sets":
        parts.cell_sets = {
            name: [items if i == j else items[:0] for j in range(len(cells))]
            for i, (of, _, tags, names) in enumerate(numbered)
            for name, items in sets_of(tags, names, of).items()
            if _is_word(name)
        }
    elif kind.names == "families":
        parts.cell_data, parts.families = _families(numbered)
    elif kind.numbers:
        parts.cell_data = {kind.numbers: [np.asarray(tags) for _, _, tags, _ in numbered]}
        if kind.names == "field_data":
            parts.field_data = {
                name: np.array([tag, DIMENSIONS[of]])
                for of, _, _, names in numbered
                for name, tag in names.items()
                if _is_word(name) and tag > 0
            }
    if kind.fields:
        parts.point_data = dict(content.point_fields)
        if content.metric is not None:
            parts.point_data["metric"] = content.metric
    if kind.fields == "both":
        parts.cell_data = {
            **parts.cell_data,
            **{
                name: [values, *(_nothing(values, rows) for _, rows in parts.cells[1:])]
                for name, values in content.triangle_fields.items()
            },
        }
    return parts


def _nothing(values: Array, rows: Array) -> Array:
    return np.full((len(rows), *values.shape[1:]), np.nan)


def _families(
    numbered: list[tuple[str, Array, Array, dict[str, int]]],
) -> tuple[dict[str, list[Array | None]], dict[int, list[str]]]:
    """Numbers of the families of cells, below zero, and the names of each."""
    families: dict[int, list[str]] = {}
    data: list[Array | None] = []
    for of, rows, tags, names in numbered:
        numbers = np.zeros(len(rows), np.int64)
        for name, items in sets_of(tags, names, of).items():
            families[-1 - len(families)] = [name]
            numbers[items] = -len(families)
        data.append(numbers)
    return {"cell_tags": data}, families


def _is_word(name: str) -> bool:
    """Whether a name can stand between blanks, commas and signs of equality."""
    return bool(re.fullmatch(r"[^\s,=*$#%\"'!]+", name))


# --------------------------------------------------------------------------------- markers of SU2


def _numbered_markers(data: bytes) -> tuple[bytes, dict[str, int]]:
    """The same file with numbers for the names of markers, which meshio knows no other way."""
    lines = re.sub(rb"(?m)^[ \t]*([A-Z_]+)[ \t]*=[ \t]*", rb"\1= ", data)
    found = [m.decode("utf-8", "replace") for m in re.findall(rb"(?m)^MARKER_TAG= (\S+)", lines)]
    numbers = {int(name) for name in found if re.fullmatch(r"-?\d{1,9}", name)}
    names: dict[str, int] = {}
    free = 1
    for name in found:
        if name in names or re.fullmatch(r"-?\d{1,9}", name):
            continue
        while free in numbers:
            free += 1
        names[name] = free
        numbers.add(free)

    def number(match: re.Match[bytes]) -> bytes:
        name = match[1].decode("utf-8", "replace")
        return b"MARKER_TAG= %s" % str(names.get(name, name)).encode()

    return re.sub(rb"(?m)^MARKER_TAG= (\S+)", number, lines), names


def _with_markers(data: bytes, names: dict[str, int]) -> bytes:
    """The same file with the names of markers for their numbers."""
    name_of = {str(tag): name for name, tag in names.items() if _is_word(name)}

    def named(match: re.Match[bytes]) -> bytes:
        number = match[1].decode()
        return b"MARKER_TAG= " + name_of.get(number, number).encode()

    return re.sub(rb"(?m)^MARKER_TAG= (\S+)", named, data)
