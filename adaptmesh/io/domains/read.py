"""Domains from files: polygons, outlines, drawings, scripts, and the domains of meshes."""

from __future__ import annotations

import os
from importlib import import_module
from pathlib import Path
from typing import TypeAlias

from adaptmesh.domain.domain import Domain
from adaptmesh.domain.inputs import Holes, refuse_holes
from adaptmesh.domain.outline import Outline
from adaptmesh.domain.polygons.polygon_input import without_empty
from adaptmesh.domain.polygons.shape import Shape
from adaptmesh.domain.polygons.shared_borders import given_of_shapes
from adaptmesh.errors import DomainError, FormatError
from adaptmesh.files.located import located, only_our_errors
from adaptmesh.io.domains.drawings.drawing import Drawing
from adaptmesh.io.domains.geo.plane_model import PlaneModel
from adaptmesh.io.formats import FORMATS, OUTLINES, mesh_suffix
from adaptmesh.io.read import read_mesh_or_outline

Raw: TypeAlias = Domain | Outline | Drawing | PlaneModel | list[Shape]


def read_domain(path: str | os.PathLike[str], *, holes: Holes = None) -> Domain:
    """Read what to mesh from a file.

    ================== ==========================================================================
    suffix             what becomes of it
    ================== ==========================================================================
    .geojson .json     Each Polygon or MultiPolygon is a region, named by the property ``name`` of
                       its feature; polygons may share borders, which become interfaces, named
                       ``"a|b"`` after the regions beside them; other borders of a region have its
                       name. Coordinates are taken as they are, in the plane: project longitudes
                       and latitudes first.
    .wkt               As GeoJSON, without names.
    .shp               A shapefile (needs pyshp): as GeoJSON, the attribute ``name`` being in the
                       ``.dbf`` beside it.
    .svg               Paths and shapes (needs svgelements): lines, arcs and Bézier curves, with the
                       id of their shape for a name; y turned over.
    .dxf               Lines, arcs, ellipses, polylines and splines (needs ezdxf), with their layer
                       for a name.
    .geo               A Gmsh script: points, curves, plane surfaces, physical groups.
    .g .gmesh          A geometry of BAMG: straight and curved edges, their references as tags, and
                       subdomains as regions.
    .poly              Triangle's format, with holes; boundary markers other than 0 become names
                       of edges, and the attributes of region seeds become names of regions.
    anything else      A mesh that `adaptmesh.read` can read: its domain. Of files with edges and
                       no triangles, such as geometries of JIGSAW, what the edges enclose.
    ================== ==========================================================================

    Parameters
    ----------
    path : str or path
        The file.
    holes : sequence of (x, y), or "nesting", optional
        As in `Domain`, for drawings of lines and .geo scripts without surfaces: ``[]`` if there are
        no holes, whatever lies in what. Other files say themselves what is inside.

    Returns
    -------
    Domain

    Raises
    ------
    FormatError
        If the file is missing, truncated, or not what its suffix says.
    DomainError
        If it holds no polygon, something else than polygons, or anything that `repair` would have
        to mend; the message names the feature, the place and the remedy.

    See Also
    --------
    repair : takes the path of a file that is not clean.
    """
    raw = read_raw(path)
    with only_our_errors(path), located(path, DomainError):
        if isinstance(raw, (Drawing, PlaneModel)):
            return raw.domain(holes)
        refuse_holes(holes, "a mesh, polygons or points in holes")
        if isinstance(raw, Domain):
            return raw
        if isinstance(raw, Outline):
            return raw.domain()
        return Domain.of_given(given_of_shapes(without_empty(raw, f"{path}: ")))


def read_raw(path: str | os.PathLike[str]) -> Raw:
    """What is in a file that `read_domain` can read, before it is checked."""
    path = Path(path)
    suffix = path.suffix.lower()
    with only_our_errors(path), located(path, DomainError):
        if suffix not in OUTLINES:
            return _domain_of_mesh_file(path)
        module, function = OUTLINES[suffix].split(":")
        reader = getattr(import_module(f"adaptmesh.io.domains.{module}"), function)
        return reader(path)


def _domain_of_mesh_file(path: Path) -> Domain | Outline:
    if mesh_suffix(path) is None:
        raise FormatError(
            f"the extension {path.suffix!r} is not known; known are those of outlines, "
            f"{', '.join(OUTLINES)}, and of meshes, {', '.join(FORMATS)}"
        )
    found = read_mesh_or_outline(path)
    if isinstance(found, Outline):
        return found
    return found.to_domain() if found.domain is None else found.domain
