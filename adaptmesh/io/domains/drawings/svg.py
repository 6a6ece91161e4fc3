"""SVG: paths and shapes of vector graphics, read by svgelements.

Every path, line, polyline, polygon, rectangle, circle and ellipse becomes curves, with all
transformations applied: straight lines, arcs of ellipses and Bézier curves, exactly. In SVG y
points down; here it is turned over, so that what is up in the picture is up. Lengths are in the
units of the picture's pixels. Text and images are no outlines and are passed over, and so is what
only styles or clips.
"""

from __future__ import annotations

from collections.abc import Iterator
from io import BytesIO
from pathlib import Path
from typing import Any

import numpy as np

from adaptmesh.curves import Bezier, Curve, Line
from adaptmesh.curves.checks import checked_point
from adaptmesh.errors import DomainError, FormatError
from adaptmesh.files.bounded import read_xml
from adaptmesh.files.located import located, refusing
from adaptmesh.files.whole import read_bytes, readable_xml
from adaptmesh.types import Floats

from .drawing import Drawing, affine_arc
from .svg_syntax import check_syntax

_ROUNDING = 1e-14  # what arcs leave of a gap that `Z` then closes, as a share of coordinates
_LABEL = "{http://www.inkscape.org/namespaces/inkscape}label"


def read_svg(path: Path) -> Drawing:
    """The curves of an SVG file, named by the label (as Inkscape gives it) or id of their shape."""
    svg = _import_svgelements()
    drawing = Drawing(path)
    with refusing(f"{path} is damaged, or no SVG"), located(path):
        for shape in _shapes(svg, readable_xml(read_bytes(path))):
            name = _name_of(shape)
            with located(f"shape {name or type(shape).__name__!r}", DomainError):
                place = _Placement(shape.transform)
                for segment in shape.segments(transformed=False):
                    curve = _curve(svg, segment, place)
                    if curve is not None:
                        drawing.add(curve, name)
    return drawing


def _shapes(svg: Any, data: bytes) -> Iterator[Any]:
    """What the file draws; all of it is looked at before the first is handed out."""
    check_syntax(read_xml(data))
    root = svg.SVG.parse(BytesIO(data), reify=False)
    if not isinstance(root, svg.SVG):
        raise FormatError("it is XML, but not SVG")
    for element in root.elements():
        if isinstance(element, svg.Shape):
            yield element


def _name_of(shape: Any) -> str | None:
    """Its own label or id; svgelements hands labels of groups down in `values`."""
    attributes = shape.values.get("attributes", {}) if shape.values else {}
    name = attributes.get(_LABEL) or shape.id
    return None if name is None else str(name)


class _Placement:
    """Where points of a shape come to lie: its transformation, and y turned over."""

    def __init__(self, matrix: Any) -> None:
        a, b, c, d, e, f = (
            float(v) for v in (matrix.a, matrix.b, matrix.c, matrix.d, matrix.e, matrix.f)
        )
        self._linear = np.array([[a, c], [-b, -d]])
        self._shift = np.array([e, -f])

    def point(self, p: Any) -> Floats:
        with np.errstate(over="ignore", invalid="ignore"):
            out = self._linear @ [float(p.x), float(p.y)] + self._shift
        return checked_point(out, "a point")

    def vector(self, p: Any, origin: Any) -> Floats:
        return self._linear @ [float(p.x) - float(origin.x), float(p.y) - float(origin.y)]


def _curve(svg: Any, segment: Any, place: _Placement) -> Curve | None:
    """None for a move, and for what has no length."""
    if isinstance(segment, svg.Move) or segment.start is None or segment.end is None:
        return None
    points = [place.point(p) for p in _control_points(svg, segment)]
    if isinstance(segment, svg.Arc):
        if segment.rx == 0 or segment.ry == 0 or segment.sweep == 0:
            return None if (points[0] == points[-1]).all() else Line(points[0], points[-1])
        return affine_arc(
            place.point(segment.center),
            place.vector(segment.prx, segment.center),
            place.vector(segment.pry, segment.center),
            float(segment.get_start_t()),
            float(segment.sweep),
        )
    if np.ptp(points, axis=0).max() <= _ROUNDING * np.abs(points).max():
        return None
    return Line(*points) if len(points) == 2 else Bezier(points)


def _control_points(svg: Any, segment: Any) -> Iterator[Any]:
    yield segment.start
    if isinstance(segment, svg.CubicBezier):
        yield segment.control1
        yield segment.control2
    elif isinstance(segment, svg.QuadraticBezier):
        yield segment.control
    yield segment.end


def _import_svgelements() -> Any:
    try:
        import svgelements
    except ImportError:
        raise FormatError(
            'SVG is read by svgelements: pip install "adaptmesh-metric[files]"'
        ) from None
    return svgelements
