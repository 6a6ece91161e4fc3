"""Geometries of BAMG, `.g` or `.gmesh`: vertices, and edges that are straight or curved. ::

    MeshVersionFormatted 0
    Dimension 2
    AngleOfCornerBound 46       in degrees; 10 if it is not there
    Vertices 4                  x y reference, by row
    Edges 4                     vertex vertex reference
    Corners 1                   vertices where edges meet with an angle
    RequiredVertices 1          vertices
    RequiredEdges 1             edges
    TangentAtEdges 1            edge, its first or second end (1 or 2), direction
    SubDomain 1                 2, edge, side (1: left, -1: right), reference

At a vertex that is no corner (two edges meet there and turn by less than the bound), each edge has
the direction of the line from one neighbour to the other. With such a tangent, made as long as the
edge, an edge is the cubic of Hermite; with one at one end only a parabola. A required vertex is one
of every mesh, on a smooth line, too; a required edge is straight, and one edge of every mesh. Sizes
at the vertices are not used. Lines may follow in any order, and ``End`` may be missing.
"""

from __future__ import annotations

import re
from collections.abc import Callable
from dataclasses import dataclass, field
from pathlib import Path

import numpy as np

from adaptmesh.arrangement.faces import find_faces
from adaptmesh.checks import LARGEST
from adaptmesh.curves import Bezier, Curve, Line
from adaptmesh.domain.domain import Domain
from adaptmesh.domain.inputs import Label, labelled
from adaptmesh.errors import FormatError
from adaptmesh.files.located import located
from adaptmesh.files.records import TextCursor, one
from adaptmesh.files.whole import read_text
from adaptmesh.types import Floats, Int64s

CORNER_ANGLE = 10.0
"""Edges that turn by less, in degrees, are smooth, if the file does not say it otherwise."""

SMOOTH = 1e-3
"""What is left of a turn, in degrees, where two edges have one tangent."""

_SAMPLES = 17  # of a curved edge, for the polygons in which seeds are found


def read_bamg_geometry(path: Path) -> Domain:
    """Read a geometry of BAMG.

    References of edges become tags, those of subdomains the numbers of regions. What subdomains
    leave out is a hole; without any, all that edges enclose is meshed.
    """
    text = read_text(path)
    with located(path):
        return _Geometry.of(text).domain()


@dataclass
class _Geometry:
    """The tables of a file, numbers from 0."""

    corner_angle: float = CORNER_ANGLE
    vertices: Floats = field(default_factory=lambda: np.empty((0, 2)))
    edges: Int64s = field(default_factory=lambda: np.empty((0, 2), np.int64))
    tags: Int64s = field(default_factory=lambda: np.empty(0, np.int64))
    corners: Int64s = field(default_factory=lambda: np.empty(0, np.int64))
    required_vertices: Int64s = field(default_factory=lambda: np.empty(0, np.int64))
    required_edges: Int64s = field(default_factory=lambda: np.empty(0, np.int64))
    tangent_ends: Int64s = field(default_factory=lambda: np.empty((0, 2), np.int64))
    tangents: Floats = field(default_factory=lambda: np.empty((0, 2)))
    subdomains: Int64s = field(default_factory=lambda: np.empty((0, 4), np.int64))

    @classmethod
    def of(cls, text: str) -> _Geometry:
        cursor = TextCursor(re.sub(r"#[^\n]*", "", text).encode())
        if cursor.word() != b"MeshVersionFormatted":
            raise FormatError("does not start with MeshVersionFormatted: it is no BAMG geometry")
        one(cursor)
        geometry = cls()
        while (word := cursor.word()) not in (None, b"End"):
            keyword = str(word, "ascii", "replace")
            with located(keyword):
                if not keyword.isalnum() or keyword.isdigit():
                    raise FormatError("expected a keyword here: a count may be wrong")
                if keyword in _READERS:
                    _READERS[keyword](geometry, cursor)
                elif keyword in ("CrackedEdges", "Triangles"):
                    raise FormatError("cannot be read as part of a geometry; remove them")
                else:
                    cursor.skip_numbers()
        geometry._check()
        return geometry

    def _check(self) -> None:
        n, k = len(self.vertices), len(self.edges)
        if not k:
            raise FormatError("has no Edges: there is nothing to mesh")
        for what, numbers, count, among in (
            ("Edges", self.edges, n, "vertices"),
            ("Corners", self.corners[:, None], n, "vertices"),
            ("RequiredVertices", self.required_vertices[:, None], n, "vertices"),
            ("RequiredEdges", self.required_edges[:, None], k, "edges"),
            ("TangentAtEdges", self.tangent_ends[:, :1], k, "edges"),
            ("TangentAtEdges", self.tangent_ends[:, 1:], 2, "ends of an edge"),
            ("SubDomain", self.subdomains[:, 1:2], k, "edges"),
        ):
            bad = np.argwhere((numbers < 0) | (numbers >= count))
            if len(bad):
                row, column = bad[0]
                raise FormatError(
                    f"{what}: row {row + 1} names {numbers[row, column] + 1}, but there are "
                    f"{among} 1 to {count}"
                )
        for row, (kind, _, side, _) in enumerate(self.subdomains.tolist()):
            if kind != 2 or side not in (1, -1):
                raise FormatError(f"SubDomain: row {row + 1} is not: 2, edge, 1 or -1, reference")

    # -- curves

    def curves(self) -> list[Curve]:
        """Each edge, from its first vertex to its second."""
        out: list[Curve] = []
        p = self.vertices[self.edges]
        for k, ((a, b), (first, second)) in enumerate(zip(p, self._directions(), strict=True)):
            length = float(np.hypot(*(b - a)))
            with located(f"Edges: row {k + 1}"):
                if length == 0:
                    raise FormatError(f"both ends are {tuple(a.tolist())}; remove the edge")
            s, t = (_scaled(d, b - a, length) for d in (first, second))
            if s.any() and t.any():
                out.append(Bezier([a, a + s / 3, b - t / 3, b]))
            elif s.any() or t.any():
                out.append(Bezier([a, a + s / 2 if s.any() else b - t / 2, b]))
            else:
                out.append(Line(a, b))
        return out

    def _directions(self) -> Floats:
        """Direction of each edge at both ends, (k, 2, 2); 0 where it has none."""
        out = np.zeros((len(self.edges), 2, 2))
        smooth = np.bincount(self.edges.ravel(), minlength=len(self.vertices)) == 2
        smooth[self.corners] = False
        by_vertex = np.argsort(self.edges.ravel(), kind="stable")
        start = np.searchsorted(self.edges.ravel()[by_vertex], np.flatnonzero(smooth))
        for one_end, other_end in np.stack([by_vertex[start], by_vertex[start + 1]], axis=1):
            (e, i), (f, j) = divmod(int(one_end), 2), divmod(int(other_end), 2)
            here = self.vertices[self.edges[e, i]]
            before = self.vertices[self.edges[e, 1 - i]]
            after = self.vertices[self.edges[f, 1 - j]]
            if _turn(here - before, after - here) <= self.corner_angle:
                out[e, i] = out[f, j] = after - before
        out[self.tangent_ends[:, 0], self.tangent_ends[:, 1]] = self.tangents
        out[self.required_edges] = 0
        return out

    # -- the domain

    def domain(self) -> Domain:
        curves = self.curves()
        names = labelled(self.tags)
        lone = np.setdiff1d(np.arange(len(self.vertices)), self.edges)
        points = self.vertices[np.union1d(lone, self.required_vertices)]
        everything = Domain.from_curves(
            curves, names=names, holes=(), points=points, corner_angle=SMOOTH
        )
        frozen = np.flatnonzero(np.isin(everything.curved.segment_curves, self.required_edges))
        if not len(self.subdomains):
            return everything.with_frozen(segments=frozen)
        holes, regions = self._seeds(curves)
        return Domain.from_curves(
            curves, names=names, holes=holes, regions=regions, points=points, corner_angle=SMOOTH
        ).with_frozen(segments=frozen)

    def _seeds(self, curves: list[Curve]) -> tuple[Floats, dict[Label, Floats]]:
        """Points in what subdomains leave out, and in each region."""
        t = np.linspace(0, 1, _SAMPLES)
        lines = [c.point(t[[0, -1]] if isinstance(c, Line) else t) for c in curves]
        ends = np.cumsum([len(line) for line in lines])
        points, inverse = np.unique(np.concatenate(lines), axis=0, return_inverse=True)
        number = inverse.reshape(-1)
        starts = np.delete(np.arange(ends[-1]), ends - 1)
        faces = find_faces(points, np.stack([number[starts], number[starts + 1]], axis=1))
        first = np.concatenate([[0], ends[:-1] - np.arange(1, len(ends))])  # of each curve
        region = np.zeros(faces.count, np.int64)
        taken = np.zeros(faces.count, bool)
        for row, (_, edge, side, reference) in enumerate(self.subdomains.tolist()):
            face = (faces.left if side == 1 else faces.right)[first[edge]]
            if face == 0 or taken[face]:
                what = "on the outside" if face == 0 else "the same as another"
                raise FormatError(f"SubDomain: row {row + 1}, beside edge {edge + 1}, is {what}")
            taken[face], region[face] = True, reference
        left_out = ~taken
        left_out[0] = False
        return faces.inner_points[left_out], {
            r: faces.inner_points[taken & (region == r)]
            for r in np.unique(region[region != 0]).tolist()
        }


def _turn(u: Floats, v: Floats) -> float:
    """The angle between two directions, in degrees."""
    return float(np.degrees(abs(np.arctan2(u[0] * v[1] - u[1] * v[0], u @ v))))


def _scaled(direction: Floats, chord: Floats, length: float) -> Floats:
    """A tangent as long as the chord, and to its side; 0 if there is none."""
    size = float(np.hypot(*direction))
    if size == 0:
        return direction
    return direction * ((length if direction @ chord >= 0 else -length) / size)


# ---------------------------------------------------------------------------------------- keywords


def _count(cursor: TextCursor) -> int:
    return one(cursor, "i8")


def _read_dimension(_: _Geometry, cursor: TextCursor) -> None:
    if one(cursor) != 2:
        raise FormatError("a plane geometry has dimension 2")


def _read_angle(geometry: _Geometry, cursor: TextCursor) -> None:
    geometry.corner_angle = float(cursor.rows(1, ("f8", 1))[0][0, 0])


def _read_vertices(geometry: _Geometry, cursor: TextCursor) -> None:
    geometry.vertices = cursor.rows(_count(cursor), ("f8", 2), ("i8", 1))[0]
    _refuse_not_finite(geometry.vertices)


def _refuse_not_finite(rows: Floats) -> None:
    bad = np.flatnonzero(~(np.abs(rows) < LARGEST).all(axis=1))
    if len(bad):
        x, y = rows[bad[0]].tolist()
        raise FormatError(f"row {bad[0] + 1} is ({x:g}, {y:g}), not finite or beyond {LARGEST:g}")


def _read_edges(geometry: _Geometry, cursor: TextCursor) -> None:
    rows = cursor.rows(_count(cursor), ("i8", 3))[0]
    geometry.edges, geometry.tags = rows[:, :2] - 1, rows[:, 2]


def _read_corners(geometry: _Geometry, cursor: TextCursor) -> None:
    geometry.corners = _numbers(cursor)


def _read_required_vertices(geometry: _Geometry, cursor: TextCursor) -> None:
    geometry.required_vertices = _numbers(cursor)


def _read_required_edges(geometry: _Geometry, cursor: TextCursor) -> None:
    geometry.required_edges = _numbers(cursor)


def _numbers(cursor: TextCursor) -> Int64s:
    return cursor.rows(_count(cursor), ("i8", 1))[0][:, 0] - 1


def _read_tangents(geometry: _Geometry, cursor: TextCursor) -> None:
    ends, geometry.tangents = cursor.rows(_count(cursor), ("i8", 2), ("f8", 2))
    geometry.tangent_ends = ends - 1
    _refuse_not_finite(geometry.tangents)


def _read_subdomains(geometry: _Geometry, cursor: TextCursor) -> None:
    geometry.subdomains = cursor.rows(_count(cursor), ("i8", 4))[0] - [0, 1, 0, 0]


def _read_sizes(geometry: _Geometry, cursor: TextCursor) -> None:
    """Sizes are not used, but that there is one for each vertex shows that no line is missing."""
    if len(geometry.vertices):
        cursor.rows(len(geometry.vertices), ("f8", 1))
    else:
        cursor.skip_numbers()


_READERS: dict[str, Callable[[_Geometry, TextCursor], None]] = {
    "Dimension": _read_dimension,
    "AngleOfCornerBound": _read_angle,
    "MaximalAngleOfCorner": _read_angle,
    "Vertices": _read_vertices,
    "hVertices": _read_sizes,
    "Edges": _read_edges,
    "Corners": _read_corners,
    "RequiredVertices": _read_required_vertices,
    "RequiredEdges": _read_required_edges,
    "TangentAtEdges": _read_tangents,
    "SubDomain": _read_subdomains,
    "SubDomainFromGeom": _read_subdomains,
}
