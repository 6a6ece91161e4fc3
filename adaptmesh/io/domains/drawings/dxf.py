"""DXF: drawings of CAD programs, read by ezdxf.

Lines, arcs, circles, ellipses, polylines (with bulges) and splines of the model space become
curves with the name of their layer; blocks are taken apart. Filled areas (HATCH, MPOLYGON,
SOLID, TRACE) are regions named by their layer if nothing else is drawn; else they are passed over
with a word, as they lie in the lines that are drawn. Annotation (text, dimensions, ...) and lone
points are no outlines and are passed over; any other entity is refused, as is what does not lie in
a plane z = constant. Layers that are off or frozen count as not drawn.
"""

from __future__ import annotations

import warnings
from collections.abc import Iterable, Iterator
from pathlib import Path
from typing import Any

import numpy as np

from adaptmesh.curves import Arc, BSpline, Circle, Curve, EllipticArc, Line
from adaptmesh.curves.checks import checked_point
from adaptmesh.errors import AdaptmeshError, FormatError, FormatWarning
from adaptmesh.files.located import located, refusing
from adaptmesh.files.whole import read_bytes
from adaptmesh.types import Floats

from .drawing import Drawing

_ANNOTATION = """
TEXT MTEXT ATTRIB ATTDEF DIMENSION ARC_DIMENSION LARGE_RADIAL_DIMENSION LEADER MLEADER MULTILEADER
TOLERANCE WIPEOUT IMAGE VIEWPORT POINT XLINE RAY LIGHT SUN ACAD_TABLE UNDERLAY
PDFUNDERLAY DWFUNDERLAY DGNUNDERLAY OLE2FRAME ACAD_PROXY_ENTITY
"""

PASSED_OVER = frozenset(_ANNOTATION.split())
"""Kinds of entities that are no outlines."""

MOST_COPIES = 100_000
"""Entities and vertices that references to blocks may draw beyond those of the file itself."""
_MOST_NESTED = 50


def read_dxf(path: Path) -> Drawing:
    """The curves of the model space of a DXF file, each with the name of its layer."""
    ezdxf = _import_ezdxf()
    drawing = Drawing(path)
    with refusing(f"{path} is damaged, or no DXF file"), located(path):
        for entity in _entities(ezdxf, path):
            with located(_words(entity), AdaptmeshError), refusing("is damaged"):
                curves = list(_curves(entity))
                if entity.dxftype() in _FILLS:
                    drawing.fills.append((entity.dxf.layer, curves))
                    continue
                for curve in curves:
                    drawing.add(curve, entity.dxf.layer)
    if drawing.fills and drawing.curves:
        warnings.warn(
            f"{path}: {len(drawing.fills)} filled areas ({', '.join(_FILLS)}) are passed over: "
            "lines are drawn, too, and are what bounds the domain",
            FormatWarning,
            stacklevel=4,
        )
    return drawing


def _entities(ezdxf: Any, path: Path) -> Iterator[Any]:
    """What is drawn in the model space, blocks taken apart."""
    if not read_bytes(path).rstrip(b"\0\r\n ").endswith(b"EOF"):  # ezdxf takes what there is
        raise FormatError("does not end with EOF: it is cut short, or no DXF file")
    document = ezdxf.readfile(path)
    hidden = {layer.dxf.name for layer in document.layers if layer.is_off() or layer.is_frozen()}
    _Blocks(document).refuse_many_copies()
    for entity in _taken_apart(document.modelspace()):
        if entity.dxf.layer not in hidden:
            yield entity


def _taken_apart(entities: Iterable[Any]) -> Iterator[Any]:
    """What entities draw, blocks taken apart and annotation left out."""
    for entity in entities:
        kind = entity.dxftype()
        if kind == "INSERT":
            several = entity.mcount > 1
            yield from _taken_apart(entity.multi_insert() if several else entity.virtual_entities())
        elif kind == "MLINE":
            yield from _taken_apart(entity.virtual_entities())
        elif kind not in PASSED_OVER:
            yield entity


class _Blocks:
    """How much is drawn when references to blocks are taken apart."""

    def __init__(self, document: Any) -> None:
        self._document = document
        self._weights: dict[str, int] = {}  # by block, of all that it draws

    def refuse_many_copies(self) -> None:
        """Raise if blocks of blocks of ... draw far more than the file holds."""
        own = sum(map(_weight, self._document.entitydb.values()))
        if self._weight(self._document.modelspace(), 0) > MOST_COPIES + own:
            raise FormatError(
                f"its blocks draw more than {MOST_COPIES} copies of what it holds: it is made to "
                "fill the memory, or should be split"
            )

    def _weight(self, entities: Iterable[Any], depth: int) -> int:
        total = 0
        for entity in entities:
            total += _weight(entity)
            if entity.dxftype() == "INSERT":
                total += self._of_insert(entity, depth + 1)
        return total

    def _of_insert(self, insert: Any, depth: int) -> int:
        name = insert.dxf.name
        if name not in self._weights:
            with located(_words(insert)):
                self._weights[name] = self._weight(self._block(name, depth), depth)
        rows, columns = (insert.dxf.get(f"{of}_count", 1) for of in ("row", "column"))
        return max(1, abs(int(rows * columns))) * (1 + self._weights[name])

    def _block(self, name: str, depth: int) -> Any:
        block = self._document.blocks.get(name)
        if block is None:
            raise FormatError(f"block {name!r} is not in the file")
        if block.block.is_xref:
            raise FormatError(f"block {name!r} is another file: bind it")
        if depth > _MOST_NESTED:
            raise FormatError(f"blocks nested more than {_MOST_NESTED} deep, or in themselves")
        return block


def _weight(entity: Any) -> int:
    """One, or the number of vertices."""
    kind = entity.dxftype()
    if kind == "LWPOLYLINE":
        return 1 + len(entity)
    if kind == "POLYLINE":
        return 1 + len(entity.vertices)
    return 1 + len(entity.control_points) if kind == "SPLINE" else 1


def _words(entity: Any) -> str:
    handle = entity.dxf.get("handle")
    return (
        f"{entity.dxftype()} {'' if handle is None else handle + ' '}on layer {entity.dxf.layer!r}"
    )


def _curves(entity: Any) -> Iterator[Curve]:
    from ezdxf.upright import upright

    reader = _READERS.get(entity.dxftype())
    if reader is None:
        known = ", ".join(_READERS)
        raise FormatError(f"cannot be read; entities that can are {known}: explode or remove it")
    upright_copy = entity.copy()
    upright(upright_copy)  # drawn from below: the same lines with the normal (0, 0, 1)
    normal = upright_copy.dxf.get("extrusion", (0, 0, 1))
    if not np.allclose(tuple(normal), (0, 0, 1)):
        raise FormatError(f"lies in a tilted plane, with the normal {tuple(normal)}")
    yield from reader(upright_copy)


def _line(entity: Any) -> Iterator[Curve]:
    a, b = _flat([entity.dxf.start, entity.dxf.end])
    if (a != b).any():
        yield Line(a, b)


def _arc(entity: Any) -> Iterator[Curve]:
    (centre,) = _flat([entity.dxf.center])
    start, end = np.radians([entity.dxf.start_angle, entity.dxf.end_angle])
    yield Arc(centre, entity.dxf.radius, start, _after(start, end))


def _circle(entity: Any) -> Iterator[Curve]:
    (centre,) = _flat([entity.dxf.center])
    yield Circle(centre, entity.dxf.radius)


def _ellipse(entity: Any) -> Iterator[Curve]:
    centre, axis = _flat([entity.dxf.center, entity.dxf.major_axis])
    a = float(np.hypot(*axis))
    start, end = entity.dxf.start_param, _after(entity.dxf.start_param, entity.dxf.end_param)
    rotation = float(np.arctan2(axis[1], axis[0]))
    yield EllipticArc(centre, (a, a * entity.dxf.ratio), rotation, start, end)


def _after(start: float, end: float) -> float:
    """The end angle as the first one above the start; DXF's arcs run anticlockwise."""
    turn = (end - start) % (2 * np.pi)
    return float(start + (turn if turn > 1e-12 else 2 * np.pi))


def _lwpolyline(entity: Any) -> Iterator[Curve]:
    rows = np.array([(x, y, bulge) for x, y, _, _, bulge in entity.get_points()], float)
    yield from _bulged(rows, entity.closed)


def _polyline(entity: Any) -> Iterator[Curve]:
    if not entity.is_2d_polyline and not entity.is_3d_polyline:
        raise FormatError("is a mesh, not a polyline")
    vertices = list(entity.vertices)
    points = _flat([v.dxf.location for v in vertices])
    bulges = [v.dxf.get("bulge", 0.0) for v in vertices]
    yield from _bulged(np.column_stack([points, bulges]), entity.is_closed)


def _bulged(rows: Floats, closed: bool) -> Iterator[Curve]:
    """Lines and arcs from vertex to vertex; a bulge is the tangent of a quarter of the turn."""
    following = np.roll(rows, -1, axis=0)
    for (x0, y0, bulge), (x1, y1, _) in list(zip(rows, following, strict=True))[
        : None if closed else -1
    ]:
        a, b = (checked_point(p, "a vertex") for p in ((x0, y0), (x1, y1)))
        if (a == b).all():
            continue
        if bulge == 0:
            yield Line(a, b)
            continue
        # The top of the arc: from the middle of the chord, to its right, by bulge times half of it.
        half = (b - a) / 2
        with np.errstate(over="ignore", invalid="ignore"):
            top = (a + b) / 2 + bulge * np.array([half[1], -half[0]])
        yield Arc.through(a, checked_point(top, "an arc"), b)


def _spline(entity: Any) -> Iterator[Curve]:
    tool = entity.construction_tool()
    control = _flat(tool.control_points)
    weights = np.array(tool.weights(), float) if len(tool.weights()) else None
    yield BSpline(control, tool.degree, np.array(tool.knots(), float), weights)


def _solid(entity: Any) -> Iterator[Curve]:
    """A filled triangle or quadrilateral, whose last two corners are exchanged."""
    dxf = entity.dxf
    corners = [dxf.vtx0, dxf.vtx1, dxf.get("vtx3", dxf.vtx2), dxf.vtx2]
    ring = _flat(corners)
    yield from _bulged(np.column_stack([ring, np.zeros(4)]), True)


def _hatch(entity: Any) -> Iterator[Curve]:
    """The borders of a filled area."""
    for path in entity.paths:
        if hasattr(path, "vertices"):
            rows = np.array([(x, y, bulge) for x, y, bulge in path.vertices], float)
            yield from _bulged(rows.reshape(-1, 3), True)
            continue
        for edge in path.edges:
            kind = type(edge).__name__
            if kind not in _EDGES:
                raise FormatError(f"has a border of the kind {kind}, which cannot be read")
            yield from _EDGES[kind](edge)


def _line_edge(edge: Any) -> Iterator[Curve]:
    a, b = _flat([edge.start, edge.end])
    if (a != b).any():
        yield Line(a, b)


def _arc_edge(edge: Any) -> Iterator[Curve]:
    (centre,) = _flat([edge.center])
    start, end = np.radians([edge.start_angle, edge.end_angle])
    yield Arc(centre, edge.radius, start, _after(start, end))


def _ellipse_edge(edge: Any) -> Iterator[Curve]:
    centre, axis = _flat([edge.center, edge.major_axis])
    a = float(np.hypot(*axis))
    rotation = float(np.arctan2(axis[1], axis[0]))
    start = float(edge.start_param)
    yield EllipticArc(
        centre, (a, a * edge.ratio), rotation, start, _after(start, float(edge.end_param))
    )


def _spline_edge(edge: Any) -> Iterator[Curve]:
    tool = edge.construction_tool()
    weights = np.array(tool.weights(), float) if len(tool.weights()) else None
    yield BSpline(_flat(tool.control_points), tool.degree, np.array(tool.knots(), float), weights)


_EDGES = {
    "LineEdge": _line_edge,
    "ArcEdge": _arc_edge,
    "EllipseEdge": _ellipse_edge,
    "SplineEdge": _spline_edge,
}


def _flat(points: Any) -> Floats:
    """x and y of points in one plane z = constant."""
    xyz = np.array([tuple(p) + (0.0,) * (3 - len(tuple(p))) for p in points], float).reshape(-1, 3)
    if np.ptp(xyz[:, 2]) > 0:
        raise FormatError("does not lie in a plane z = constant")
    return xyz[:, :2]


_READERS = {
    "LINE": _line,
    "ARC": _arc,
    "CIRCLE": _circle,
    "ELLIPSE": _ellipse,
    "LWPOLYLINE": _lwpolyline,
    "POLYLINE": _polyline,
    "SPLINE": _spline,
    "HATCH": _hatch,
    "MPOLYGON": _hatch,
    "SOLID": _solid,
    "TRACE": _solid,
}
_FILLS = ("HATCH", "MPOLYGON", "SOLID", "TRACE")


def _import_ezdxf() -> Any:
    try:
        import ezdxf
    except ImportError:
        raise FormatError('DXF is read by ezdxf: pip install "adaptmesh-metric[files]"') from None
    return ezdxf
