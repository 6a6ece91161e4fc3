"""Arguments and options of the command line, with their checks."""

from __future__ import annotations

import math
from enum import Enum
from pathlib import Path
from typing import Annotated

import typer


class Show(str, Enum):
    """What a picture is coloured by."""

    mesh = "mesh"
    quality = "quality"
    length = "length"
    size = "size"
    region = "region"


def _checked_length(value: float | None) -> float | None:
    if value is not None and not 0 <= value < math.inf:
        raise typer.BadParameter(f"expected a finite number of at least 0, got {value:g}")
    return value


def _checked_gradation(value: float | None) -> float | None:
    if value is not None and not 1 < value < math.inf:
        raise typer.BadParameter(f"expected a finite factor above 1, such as 1.5, got {value:g}")
    return value


def _checked_bounds(
    bounds: tuple[float, float, float, float] | None,
) -> tuple[float, float, float, float] | None:
    if bounds is not None:
        x0, y0, x1, y1 = bounds
        if not (x0 < x1 and y0 < y1 and all(map(math.isfinite, bounds))):
            raise typer.BadParameter("expected X0 Y0 X1 Y1 with X0 < X1 and Y0 < Y1, all finite")
    return bounds


SIZE_HELP = (
    "Requested edge length: a number, or an expression of x and y such as "
    "'0.01 + 0.1*hypot(x, y)'. It is parsed, never executed."
)

MeshFile = Annotated[
    Path,
    typer.Argument(metavar="MESH", exists=True, dir_okay=False, help="Mesh: .vtu .msh .mesh ..."),
]
MeshOrOutline = Annotated[
    Path,
    typer.Argument(
        metavar="MESH",
        exists=True,
        dir_okay=False,
        help="Mesh, or an outline, which is drawn with the numbers of its points and sides.",
    ),
]
OutlineFile = Annotated[
    Path,
    typer.Argument(
        metavar="DOMAIN",
        exists=True,
        dir_okay=False,
        help="What to mesh: polygons (.geojson .wkt .shp), drawings (.svg .dxf), Triangle's .poly, "
        "Gmsh's .geo, BAMG's .g, or a mesh (.msh .mesh .vtu ...) whose domain is meshed again.",
    ),
]
Size = Annotated[str | None, typer.Option("--size", "-s", metavar="EXPR", help=SIZE_HELP)]
Metric = Annotated[
    Path | None,
    typer.Option(
        "--metric",
        "-m",
        metavar="FILE",
        exists=True,
        dir_okay=False,
        help="Sizes or metric tensors: a solution (.sol) at the vertices of the input mesh; a mesh "
        "(.vtu .msh .vtk .xdmf .mesh) with them as a field; or a raster of sizes (.tif).",
    ),
]
MetricField = Annotated[
    str | None,
    typer.Option(
        metavar="NAME",
        help="Field of the mesh given as --metric; by default 'metric' or the only one.",
    ),
]
Output = Annotated[
    Path, typer.Option("--output", "-o", metavar="FILE", dir_okay=False, help="Mesh to write.")
]
Picture = Annotated[
    Path | None, typer.Option("--plot", metavar="PNG", dir_okay=False, help="Picture to write.")
]
MaxVertices = Annotated[
    int | None,
    typer.Option(min=3, metavar="N", help="Refuse, before meshing, to make more than N vertices."),
]


def list_placements(incomplete: str = "") -> list[str]:
    """Return the names of placements, for checks and for the completion of the shell."""
    from adaptmesh.generate.generate import PLACEMENTS

    return [name for name in PLACEMENTS if name.startswith(incomplete)]


def _checked_placement(name: str | None) -> str | None:
    if name is not None and name not in list_placements():
        raise typer.BadParameter(f"expected one of {', '.join(list_placements())}, got {name!r}")
    return name


Placement = Annotated[
    str | None,
    typer.Option(
        metavar="NAME",
        autocompletion=list_placements,
        callback=_checked_placement,
        help="How new points are placed, e.g. 'edges': along long edges.",
    ),
]
Gradation = Annotated[
    float | None,
    typer.Option(
        metavar="FACTOR",
        callback=_checked_gradation,
        help="Largest growth of sizes from one unit edge to the next, e.g. 1.5; sizes that grow "
        "faster are reduced.",
    ),
]
Tolerance = Annotated[
    float | None,
    typer.Option(
        metavar="LENGTH",
        callback=_checked_length,
        help="Points closer than this are merged; by default 1e-9 of the extent.",
    ),
]
Simplify = Annotated[
    float | None,
    typer.Option(
        metavar="SHARE",
        callback=_checked_length,
        help="Remove detail of the outline smaller than this fraction of the size, e.g. 0.1.",
    ),
]
NoHoles = Annotated[
    bool,
    typer.Option(
        "--no-holes",
        help="Mesh all that the lines of a drawing or of a script without surfaces enclose.",
    ),
]
StraightTolerance = Annotated[
    float | None,
    typer.Option(
        metavar="LENGTH",
        callback=_checked_length,
        help="Largest distance of border vertices from a straight side without being corners; "
        "by default from the digits of the coordinates.",
    ),
]
Clean = Annotated[
    bool, typer.Option("--clean", help="Remove points of the mesh that are in no triangle.")
]
Merge = Annotated[
    float | None,
    typer.Option(
        metavar="LENGTH",
        callback=_checked_length,
        help="As --clean, and merge vertices at most this far apart, as on the seams of blocks.",
    ),
]
Frozen = Annotated[
    list[str] | None,
    typer.Option(
        metavar="NAME",
        help="A boundary or line whose edges are kept; may be given several times.",
    ),
]
ReferenceDomain = Annotated[
    Path | None,
    typer.Option(
        "--domain",
        metavar="FILE",
        exists=True,
        dir_okay=False,
        help="Domain to check against: the mesh must have its points, segments, regions and names.",
    ),
]
LineTolerance = Annotated[
    float | None,
    typer.Option(
        "--tolerance",
        metavar="LENGTH",
        callback=_checked_length,
        help="Largest distance of vertices from the lines of the domain; by default rounding.",
    ),
]
Title = Annotated[str | None, typer.Option(metavar="TEXT", help="Heading of the picture.")]
Bounds = Annotated[
    tuple[float, float, float, float] | None,
    typer.Option(metavar="X0 Y0 X1 Y1", callback=_checked_bounds, help="Show only this part."),
]
Json = Annotated[
    bool, typer.Option("--json", help="Print one JSON object at the end instead of text.")
]
Quiet = Annotated[bool, typer.Option("--quiet", "-q", help="Print errors only.")]
