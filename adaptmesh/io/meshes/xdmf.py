"""XDMF, `.xdmf` with its arrays in `.h5` beside it: what DOLFIN, FEniCSx and ParaView read.

As DOLFINx writes it, one grid for the mesh and one for each kind of tag::

    Grid "mesh"         Topology Triangle, Geometry XY; nodal fields, fields of the triangles
    Grid "cell_tags"    the same triangles; Attribute "cell_tags", the regions
    Grid "facet_tags"   Topology PolyLine, the constrained edges; Attribute "facet_tags"
    Information         "names" and "region_names", one line of number and name each

so that there ``read_mesh(name="mesh")`` and ``read_meshtags(mesh, name="facet_tags")`` work.
Read are also files by meshio and by DOLFINx itself, where any further grid with an integer
attribute holds tags. The arrays need h5py. meshio (5.3.5) is not used: it writes one kind of cell
a file, drops names, and follows any path that a file names.
"""

from __future__ import annotations

import io
import json
import warnings
from collections.abc import Iterator
from pathlib import Path
from typing import TYPE_CHECKING, Any
from xml.sax.saxutils import quoteattr

import numpy as np

from adaptmesh.errors import FormatError, FormatWarning
from adaptmesh.files.bounded import read_json, read_xml
from adaptmesh.files.hdf5 import import_h5py
from adaptmesh.files.located import located
from adaptmesh.files.whole import read_bytes
from adaptmesh.mesh.incoming import Content, check_vertices, refuse_cells
from adaptmesh.mesh.periodic_sides import Rows, checked_rows
from adaptmesh.types import Array

from .counts import check_stated, stated
from .xdmf_arrays import XdmfArrays

if TYPE_CHECKING:
    from xml.etree.ElementTree import Element

_CELLS, _FACETS = "cell_tags", "facet_tags"
_WIDTHS = {
    "triangle": 3, "triangle_6": 6, "tri_6": 6, "polyline": 2, "edge_3": 3, "polyvertex": 1,
}  # fmt: skip
_MIXED = {1: "polyvertex", 2: "polyline", 4: "triangle", 34: "edge_3", 36: "tri_6"}
"""Kinds of cells by their number in mixed topologies."""
_CORNERS = {"triangle_6": "triangle", "tri_6": "triangle", "edge_3": "polyline"}
"""What is left of cells of second order."""
_MOST_NODES = 6


def load(path: Path, fields: bool) -> Content:
    """What a file and its arrays beside it say."""
    data = read_bytes(path)
    with located(path):
        return decode(data, path.parent)


def save(path: Path, content: Content) -> dict[Path, bytes]:
    """The bytes of both files."""
    arrays = path.with_suffix(".h5")
    xml, hdf = encode(content, arrays.name)
    return {arrays: hdf, path: xml}


# ---------------------------------------------------------------------------------------- writing


def encode(content: Content, arrays_name: str) -> tuple[bytes, bytes]:
    """The bytes of a `.xdmf` file, and of the `.h5` file of that name with its arrays."""
    h5py = import_h5py()
    buffer = io.BytesIO()
    with h5py.File(buffer, "w") as file:
        arrays = _Written(file, arrays_name)
        geometry = arrays.item("Geometry", "geometry", content.points, 'GeometryType="XY"')
        triangles = arrays.cells("Triangle", "triangles", content.triangles)
        fields = [
            arrays.attribute(name, center, values)
            for center, given in (
                ("Node", content.point_fields),
                ("Node", {} if content.metric is None else {"metric": content.metric}),
                ("Cell", content.triangle_fields),
            )
            for name, values in given.items()
        ]
        regions = arrays.attribute(_CELLS, "Cell", content.regions)
        grids = [
            _grid("mesh", triangles, geometry, *fields),
            _grid(_CELLS, triangles, geometry, regions),
        ]
        if len(content.edges):
            edges = arrays.cells("PolyLine", "edges", content.edges)
            tags = arrays.attribute(_FACETS, "Cell", content.edge_tags)
            grids.append(_grid(_FACETS, edges, geometry, tags))
    xml = [
        '<?xml version="1.0" encoding="utf-8"?>',
        '<Xdmf Version="3.0">',
        "<Domain>",
        f'<Information Name="counts" Value={quoteattr(stated(content))}/>',
        _information("names", dict(content.names)),
        _information("region_names", dict(content.region_names)),
        *([_information("periodic", content.periodic)] if content.periodic else []),
        *grids,
        "</Domain>",
        "</Xdmf>",
        "",
    ]
    return "\n".join(xml).encode(), buffer.getvalue()


class _Written:
    """Arrays put into an HDF5 file, and the XML that refers to them."""

    def __init__(self, file: Any, name: str) -> None:
        self._file, self._name = file, name

    def item(self, tag: str, path: str, values: Array, attributes: str) -> str:
        kind = "Int" if values.dtype.kind in "iub" else "Float"
        # In a row of the file as in the mesh: 32-bit numbers of vertices become 64-bit, as DOLFINx
        # asks for.
        stored = values.astype(np.int64) if kind == "Int" else values.astype(np.float64)
        self._file[path] = stored
        dimensions = " ".join(map(str, stored.shape))
        return (
            f"<{tag} {attributes}>"
            f'<DataItem Dimensions="{dimensions}" NumberType="{kind}" Precision="8" Format="HDF">'
            f"{_xml_text(self._name)}:/{path}</DataItem></{tag}>"
        )

    def cells(self, kind: str, path: str, vertices: Array) -> str:
        count, width = vertices.shape
        return self.item(
            "Topology",
            path,
            vertices,
            f'TopologyType="{kind}" NumberOfElements="{count}" NodesPerElement="{width}"',
        )

    def attribute(self, name: str, center: str, values: Array) -> str:
        columns = values.shape[1] if values.ndim == 2 else 1
        kind = "Scalar" if values.ndim == 1 else "Vector" if columns <= 3 else "Matrix"
        kind = "Tensor" if values.shape[1:] == (3, 3) else kind
        return self.item(
            "Attribute",
            f"{center}/{len(self._file.get(center, ()))}",
            values,
            f'Name={quoteattr(name)} AttributeType="{kind}" Center="{center}"',
        )


def _grid(name: str, *parts: str) -> str:
    return "\n".join([f'<Grid Name="{name}" GridType="Uniform">', *parts, "</Grid>"])


def _information(what: str, value: object) -> str:
    return f'<Information Name="{what}" Value={quoteattr(json.dumps(value))}/>'


def _xml_text(text: str) -> str:
    return text.replace("&", "&amp;").replace("<", "&lt;").replace(">", "&gt;")


# ---------------------------------------------------------------------------------------- reading


def decode(data: bytes, folder: Path) -> Content:
    """What a `.xdmf` file in that folder says."""
    domain = _domain(data)
    with XdmfArrays(folder) as arrays:
        grids = [_Grid(element, arrays) for element in _grids(domain)]
    meshes = [g for g in grids if len(g.triangles)]
    if not meshes:
        raise FormatError("has no grid of triangles")
    first = meshes[0]
    content = Content(
        first.points,
        first.triangles,
        regions=np.zeros(len(first.triangles), np.int64),
        edges=first.edges,
        edge_tags=np.zeros(len(first.edges), np.int64),
        names=_names(domain, "names"),
        region_names=_names(domain, "region_names"),
        point_fields=first.point_fields,
        triangle_fields=first.triangle_fields,
        others=first.others,
        periodic=_periodic(domain),
    )
    content.metric = content.point_fields.pop("metric", None)
    if _is_integer(content.triangle_fields.get(_CELLS)):
        content.regions = content.triangle_fields.pop(_CELLS)
    for grid in grids:
        if grid is not first:
            _take_tags(content, grid)
    for information in domain.findall("Information"):
        if information.get("Name") == "counts":
            check_stated(information.get("Value", ""), content)
    return content


def _is_integer(values: Array | None) -> bool:
    return values is not None and values.ndim == 1 and values.dtype.kind in "iu"


def _domain(data: bytes) -> Element:
    root = read_xml(data)
    domain = root.find("Domain")
    if root.tag != "Xdmf" or domain is None:
        raise FormatError("is XML, but not XDMF: it has no <Xdmf> with a <Domain>")
    return domain


def _grids(domain: Element) -> Iterator[Element]:
    for grid in domain.findall("Grid"):
        if grid.get("GridType", "Uniform") != "Uniform":
            kind = grid.get("CollectionType", grid.get("GridType"))
            raise FormatError(
                f"grid {grid.get('Name')!r} is a collection ({kind}), such as a time series; save "
                "one step as a grid of its own"
            )
        yield grid


class _Grid:
    """One grid: its points, cells, and what is given at them.

    Attributes
    ----------
    triangles, edges : (m, 3), (k, 2) array of int
    point_fields, triangle_fields : dict
    tags : (m,) or (k,) array of int, or None
        The one integer attribute of a grid that holds tags.
    """

    def __init__(self, grid: Element, arrays: XdmfArrays) -> None:
        self.name = grid.get("Name", "")
        self.points = self._geometry(grid, arrays)
        kinds, cells = self._topology(grid, arrays)
        self.others = _no_corners(kinds, cells)
        kinds = np.array([_CORNERS.get(kind, kind) for kind in kinds.tolist()], object)
        is_triangle, is_edge = kinds == "triangle", kinds == "polyline"
        self.triangles, self.edges = cells[is_triangle][:, :3], cells[is_edge][:, :2]
        self.point_fields: dict[str, Array] = {}
        self.triangle_fields: dict[str, Array] = {}
        self.tags: Array | None = None
        for attribute in grid.findall("Attribute"):
            name, values = attribute.get("Name", ""), arrays.read(attribute)
            values = values[:, 0] if values.ndim == 2 and values.shape[1] == 1 else values
            if attribute.get("Center", "Node") == "Node":
                self._check(name, values, len(self.points), "points")
                self.point_fields[name] = values
            elif attribute.get("Center") != "Cell":
                warnings.warn(
                    f"field {name!r} is passed over: it is given at {attribute.get('Center')!r}, "
                    "neither at points nor at cells",
                    FormatWarning,
                    stacklevel=7,
                )
            else:
                self._check(name, values, len(kinds), "cells")
                self.triangle_fields[name] = values[is_triangle]
                if _is_integer(values):
                    self.tags = values[is_triangle if is_triangle.any() else is_edge]

    def _check(self, name: str, values: Array, count: int, what: str) -> None:
        if values.ndim < 1 or len(values) != count:
            raise FormatError(
                f"attribute {name!r} of grid {self.name!r} has shape {values.shape} for "
                f"{count} {what}"
            )

    def _geometry(self, grid: Element, arrays: XdmfArrays) -> Array:
        geometry = grid.find("Geometry")
        if geometry is None or not len(geometry):  # by reference: that of the first grid
            return np.empty((0, 2))
        points = arrays.read(geometry)
        if points.ndim != 2 or points.shape[1] not in (2, 3):
            raise FormatError(f"grid {self.name!r}: <Geometry> has shape {points.shape}")
        return points

    def _topology(self, grid: Element, arrays: XdmfArrays) -> tuple[Array, Array]:
        """The kind of each cell, and its nodes in a row of `_MOST_NODES`."""
        topology = grid.find("Topology")
        if topology is None:
            raise FormatError(f"grid {self.name!r} has no <Topology>")
        kind = topology.get("TopologyType", topology.get("Type", "")).lower()
        vertices = arrays.read(topology)
        if vertices.dtype.kind not in "iu":
            raise FormatError(f"grid {self.name!r}: the vertex numbers are not integers")
        if kind == "mixed":
            return _unmixed(vertices.ravel().astype(np.int64))
        if kind == "polyline" and topology.get("NodesPerElement") == "3":  # of DOLFINx
            kind = "edge_3"
        width = _WIDTHS.get(kind, 0)
        if not width:
            refuse_cells({f"cells of type {kind!r}": max(1, len(vertices))})
        if not width or vertices.size % width:
            raise FormatError(f"grid {self.name!r}: {vertices.size} vertices of {kind}s")
        rows = vertices.reshape(-1, width).astype(np.int64)
        cells = np.zeros((len(rows), _MOST_NODES), np.int64)
        cells[:, :width] = rows
        return np.full(len(rows), kind, object), cells


def _unmixed(numbers: Array) -> tuple[Array, Array]:
    """Cells of a mixed topology: each its type, for edges and points its length, its vertices."""
    kinds, rows, i = [], [], 0
    flat = numbers.tolist()
    while i < len(flat):
        kind = _MIXED.get(flat[i])
        if kind is None:
            refuse_cells({f"cells of XDMF type {flat[i]}": 1})
            break
        width = _WIDTHS[kind]
        i += 1
        if kind in ("polyvertex", "polyline"):
            if i >= len(flat) or flat[i] != width:
                raise FormatError(f"a {kind} in a mixed topology does not have {width} vertices")
            i += 1
        row = flat[i : i + width]
        if len(row) < width:
            raise FormatError("the mixed topology is cut short")
        kinds.append(kind)
        rows.append(row + [0] * (_MOST_NODES - width))
        i += width
    return np.array(kinds, dtype=object), np.array(rows, np.int64).reshape(-1, _MOST_NODES)


def _no_corners(kinds: Array, cells: Array) -> Array:
    """Nodes of cells of second order that are no corners."""
    triangles = np.isin(kinds, ("triangle_6", "tri_6"))
    return np.concatenate([cells[triangles][:, 3:6].ravel(), cells[kinds == "edge_3"][:, 2]])


def _take_tags(content: Content, grid: _Grid) -> None:
    """Regions or edges with tags from a grid that has them; cells are told by their vertices."""
    if grid.tags is None:
        if grid.name in (_CELLS, _FACETS):
            raise FormatError(f"grid {grid.name!r} has no tags: is the file complete?")
        return
    if len(grid.triangles):
        check_vertices("triangle", grid.triangles, len(content.points))
        content.regions = _matched(content.triangles, grid.triangles, grid.tags)
    elif len(grid.edges):
        content.edges, content.edge_tags = grid.edges, grid.tags
        content.others = np.concatenate([content.others, grid.others])


def _matched(triangles: Array, tagged: Array, tags: Array) -> Array:
    """The tag of each triangle, 0 where it has none."""
    ours = np.sort(tagged, axis=1)
    known = np.sort(triangles, axis=1)
    both = np.concatenate([known, ours])
    _, group = np.unique(both, axis=0, return_inverse=True)
    group = group.ravel()
    number_of = np.full(group.max() + 1, -1)
    number_of[group[: len(known)]] = np.arange(len(known))
    found = number_of[group[len(known) :]]
    if (found < 0).any():
        i = int(np.argmin(found))
        raise FormatError(f"the tagged triangle {tagged[i].tolist()} is not one of the mesh")
    out = np.zeros(len(triangles), np.int64)
    out[found] = tags
    return out


def _periodic(domain: Element) -> Rows:
    for information in domain.findall("Information"):
        if information.get("Name") == "periodic":
            return checked_rows(read_json(information.get("Value", "")))
    return []


def _names(domain: Element, what: str) -> dict[str, int]:
    for information in domain.findall("Information"):
        if information.get("Name") != what:
            continue
        try:
            names = read_json(information.get("Value", ""))
            return {str(name): int(number) for name, number in names.items()}
        except (FormatError, ValueError, TypeError, AttributeError, OverflowError):
            raise FormatError(f"the <Information> {what!r} does not hold names") from None
    return {}
