"""From what a .geo script defines to a domain.

The curves are those of Gmsh: a Circle or Ellipse runs the shorter way around, a Spline is that of
Catmull and Rom (each tangent parallel to the line between the two neighbours), a BSpline is
uniform and cubic, clamped if it is open. Plane surfaces are what is meshed; what they leave out is
outside, and without any it is all that curves enclose, but for holes, as in `Domain`. Physical
curves give names, physical surfaces regions.
"""

from __future__ import annotations

import itertools
import os
import warnings
from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import numpy as np

from adaptmesh.curves import Arc, Bezier, BSpline, Curve, EllipticArc, Line
from adaptmesh.errors import DomainError, FormatError, FormatWarning
from adaptmesh.files.whole import read_text
from adaptmesh.types import Floats

from . import by_gmsh
from .closed_loops import not_closed, walk_of
from .expressions import NotReadError
from .groups import names_of_groups
from .plane_model import CurvesByNumber, PlaneModel, samples_of
from .script import CURVES, Definition, Script, script_of

SAME_RADIUS = 1e-6
"""The ends of a Circle have the same distance from its centre, to this share."""

SIMILAR_RADIUS = 0.1
"""If not, to this share: an arc through both is taken, with a warning."""

_HALF = 4e-15  # radians by which half a turn may be off by rounding


def read_geo(path: str | os.PathLike[str]) -> PlaneModel:
    """Read curves and surfaces from a Gmsh script.

    Parameters
    ----------
    path : str or path

    Returns
    -------
    PlaneModel
        Physical groups keep their numbers as tags; those without a name get it as their name, too.
        Curves that bound no surface, and are in none, are left out if there are surfaces.

    Raises
    ------
    FormatError
        With the line: a statement that is not understood or describes no plane domain, a number
        that is not defined, a point with z other than 0.
    DomainError
        A surface whose curves cross.
    """
    path = Path(path)
    text = read_text(path)
    try:
        return _Model.of(script_of(text)).plane(path)
    except NotReadError as error:
        return _by_gmsh(path, error)
    except FormatError as error:
        raise FormatError(f"{path}, {error}") from None


def _by_gmsh(path: Path, error: FormatError) -> PlaneModel:
    """The same as Gmsh has it, if it is installed; else the error says that it would help."""
    if not by_gmsh.is_installed():
        raise FormatError(
            f"{path}, {error}. What this reader does not know is opened by Gmsh, if it is there: "
            'pip install "adaptmesh-metric[gmsh]"'
        ) from None
    try:
        return by_gmsh.read_by_gmsh(path)
    except FormatError as of_gmsh:
        raise FormatError(f"{path}, {error}. By Gmsh: {of_gmsh}") from None


@dataclass
class _Model:
    """Entities by number."""

    points: dict[int, Floats] = field(default_factory=dict)
    curves: dict[int, list[Curve]] = field(default_factory=dict)
    loops: dict[int, list[int]] = field(default_factory=dict)
    surfaces: dict[int, list[int]] = field(default_factory=dict)
    curve_names: dict[str, list[int]] = field(default_factory=dict)
    surface_names: dict[str, list[int]] = field(default_factory=dict)
    curve_tags: dict[str, int] = field(default_factory=dict)
    surface_tags: dict[str, int] = field(default_factory=dict)
    inner_curves: list[int] = field(default_factory=list)
    inner_points: list[int] = field(default_factory=list)
    heights: dict[float, Definition] = field(default_factory=dict)

    @classmethod
    def of(cls, script: Script) -> _Model:
        model = cls()
        for definition in script.definitions:
            model._take(definition)
        for kind, numbers in script.embedded:
            (model.inner_points if kind == "Point" else model.inner_curves).extend(numbers)
        return model

    # -- definitions

    def _take(self, d: Definition) -> None:
        if d.kind == "Point":
            self.points[d.number] = _point(d)
            self.heights.setdefault(d.values[2], d)
        elif d.kind in CURVES and not (d.kind == "Circle" and len(d.values) > 3):
            self.curves[d.number] = _curve(d, self._points_of(d))
        elif d.kind == "Circle":
            self.curves[d.number] = [_whole_circle(d)]
        elif d.kind == "Curve Loop":
            self.loops[d.number] = self._known(d, self.curves, "curve")
        elif d.kind == "Plane Surface":
            self.surfaces[d.number] = self._known(d, self.loops, "curve loop")
        elif d.kind == "Rectangle":
            self._rectangle(d)
        elif d.kind == "Disk":
            self._disk(d)
        elif d.kind == "Physical Curve":
            numbers = self._known(d, self.curves, "curve")
            self._name(self.curve_names, self.curve_tags, d, numbers)
        elif d.kind == "Physical Surface":
            numbers = self._known(d, self.surfaces, "surface")
            self._name(self.surface_names, self.surface_tags, d, numbers)
        elif d.kind != "Physical Point":
            raise NotReadError(f"line {d.line}: {d.kind} cannot be read")

    def _points_of(self, d: Definition) -> Floats:
        return np.array([self.points[k] for k in self._known(d, self.points, "point")])

    @staticmethod
    def _known(d: Definition, among: Iterable[int], what: str) -> list[int]:
        """Numbers of entities that are defined, whatever their orientation."""
        numbers = [abs(int(v)) for v in d.values]
        for number in numbers:
            if number not in among:
                raise FormatError(
                    f"line {d.line}: {d.kind} {d.number} uses {what} {number}, which "
                    "is not defined before"
                )
        if not numbers:
            raise FormatError(f"line {d.line}: {d.kind} {d.number} is empty")
        return numbers

    @staticmethod
    def _name(
        names: dict[str, list[int]], tags: dict[str, int], d: Definition, numbers: list[int]
    ) -> None:
        name = d.name or str(d.number)
        names.setdefault(name, []).extend(numbers)
        tags.setdefault(name, d.number)

    def _rectangle(self, d: Definition) -> None:
        if len(d.values) not in (5, 6) or d.values[2] != 0 or (len(d.values) == 6 and d.values[5]):
            raise NotReadError(f"line {d.line}: a Rectangle is {{x, y, 0, width, height}}")
        x, y, _, w, h = d.values[:5]
        corners = [(x, y), (x + w, y), (x + w, y + h), (x, y + h)]
        self._surface(d, [Line(corners[k], corners[(k + 1) % 4]) for k in range(4)])

    def _disk(self, d: Definition) -> None:
        if len(d.values) not in (4, 5) or d.values[2] != 0:
            raise NotReadError(f"line {d.line}: a Disk is {{x, y, 0, r}} or {{x, y, 0, rx, ry}}")
        radii = (d.values[3], d.values[-1])
        self._surface(d, [EllipticArc(d.values[:2], radii)])

    def _surface(self, d: Definition, sides: Sequence[Curve]) -> None:
        """A surface with sides of its own, numbered on from those there are."""
        first = 1 + max(self.curves, default=0)
        numbers = list(range(first, first + len(sides)))
        self.curves.update((k, [side]) for k, side in zip(numbers, sides, strict=True))
        loop = 1 + max(self.loops, default=0)
        self.loops[loop] = numbers
        self.surfaces[d.number] = [loop]

    # -- what they are together

    def plane(self, path: Path) -> PlaneModel:
        self._check_flat()
        used = self._used()
        for k in self.inner_curves:
            if k not in self.curves:
                raise FormatError(f"curve {k} in a surface is not defined")
        curves = CurvesByNumber({k: self.curves[k] for k in used})
        return PlaneModel(
            curves.curves,
            curves.named(path, self.curve_names.items()),
            self.curve_tags,
            {number: self._face(number) for number in self.surfaces},
            names_of_groups(path, self.surface_names.items(), "surfaces"),
            self.surface_tags,
            [self.points[k] for k in self.inner_points if k in self.points],
        )

    def _check_flat(self) -> None:
        """All points lie at one height z, whatever it is."""
        if len(self.heights) > 1:
            a, b = list(self.heights.values())[:2]
            raise NotReadError(
                f"line {b.line}: Point {b.number} has z = {b.values[2]:g} and Point {a.number} has "
                f"z = {a.values[2]:g}; a domain lies at one height"
            )

    def _used(self) -> list[int]:
        if not self.surfaces:
            return list(self.curves)
        loops = {loop for surface in self.surfaces.values() for loop in surface}
        used = {k for loop in loops for k in self.loops[loop]} | set(self.inner_curves)
        return sorted(used)

    def _face(self, number: int) -> Any:
        """A surface as a polygon of samples: its first loop without the others."""
        import shapely

        rings = [self._ring(number, loop) for loop in self.surfaces[number]]
        face = shapely.Polygon(rings[0].exterior)
        try:
            for hole in rings[1:]:
                face = face.difference(hole)
        except shapely.errors.GEOSException as error:
            raise DomainError(f"a curve loop crosses itself or another: {error}") from None
        return face

    def _ring(self, surface: int, loop: int) -> Any:
        """A curve loop as a polygon; its curves may be listed in any order and direction."""
        import shapely

        curves = [curve for k in self.loops[loop] for curve in self.curves[k]]
        lines = [samples_of(curve) for curve in curves]
        walk, stop = walk_of(lines)
        if stop is not None:
            raise not_closed(surface, loop, stop)
        return shapely.Polygon(np.concatenate([lines[k][:: -1 if back else 1] for k, back in walk]))


def _point(d: Definition) -> Floats:
    if len(d.values) < 3:
        raise FormatError(f"line {d.line}: Point {d.number} has {len(d.values)} coordinates, not 3")
    return np.array(d.values[:2])


# --------------------------------------------------------------------------------------- curves


def _curve(d: Definition, points: Floats) -> list[Curve]:
    try:
        return _CURVES[d.kind](points, d)
    except DomainError as error:  # of no length, ...
        raise FormatError(f"line {d.line}: {d.kind} {d.number}: {error}") from None


def _line(p: Floats, d: Definition) -> list[Curve]:
    if len(p) < 2:
        raise FormatError(f"line {d.line}: Line {d.number} has one point")
    return [Line(a, b) for a, b in itertools.pairwise(p)]


def _circle(p: Floats, d: Definition) -> list[Curve]:
    _expect(len(p) == 3, d, "{start, centre, end}")
    start, centre, end = p
    radius, other = np.hypot(*(start - centre)), np.hypot(*(end - centre))
    angles = _shorter_way(start - centre, end - centre)
    if abs(radius - other) <= SAME_RADIUS * radius:
        return [Arc(centre, radius, *angles)]
    if not abs(radius - other) <= SIMILAR_RADIUS * radius:
        raise FormatError(
            f"line {d.line}: the ends of Circle {d.number} are {radius:g} and {other:g} from its "
            "centre"
        )
    warnings.warn(
        f"line {d.line}: the ends of Circle {d.number} are {radius:g} and {other:g} from its "
        "centre: an arc through both is taken",
        FormatWarning,
        stacklevel=2,
    )
    middle = sum(angles) / 2
    return [Arc.through(start, centre + radius * np.array([np.cos(middle), np.sin(middle)]), end)]


def _whole_circle(d: Definition) -> Curve:
    """OpenCASCADE's {x, y, z, r} or {x, y, z, r, angle, angle}."""
    _expect(len(d.values) in (4, 6) and d.values[2] == 0, d, "{x, y, 0, r [, angle, angle]}")
    angles = d.values[4:] or (0.0, 2 * np.pi)
    return Arc(d.values[:2], d.values[3], *angles)


def _ellipse(p: Floats, d: Definition) -> list[Curve]:
    """{start, centre, point on the major axis, end}: the half axes from both ends."""
    _expect(len(p) in (3, 4), d, "{start, centre, point on the major axis, end}")
    start, centre, major, end = p if len(p) == 4 else p[[0, 1, 0, 2]]
    axis = major - centre
    rotation = float(np.arctan2(axis[1], axis[0]))
    c, s = np.cos(rotation), np.sin(rotation)
    along = np.array([[c, s], [-s, c]])
    a, b = along @ (start - centre), along @ (end - centre)
    # x²/A² + y²/B² = 1 for both ends.
    inverse, *_ = np.linalg.lstsq(np.array([a**2, b**2]), np.ones(2), rcond=1e-10)
    if not (inverse > 0).all():
        raise FormatError(f"line {d.line}: no Ellipse {d.number} goes through its two ends")
    radii = inverse**-0.5
    return [EllipticArc(centre, radii, rotation, *_shorter_way(a / radii, b / radii))]


def _shorter_way(start: Floats, end: Floats) -> tuple[float, float]:
    """Angles of both ends; half a turn is anticlockwise, as in Gmsh."""
    first, last = np.arctan2(start[1], start[0]), np.arctan2(end[1], end[0])
    turn = (last - first + np.pi) % (2 * np.pi) - np.pi
    if np.pi + turn < _HALF:
        turn += 2 * np.pi
    return float(first), float(first + turn)


def _spline(p: Floats, d: Definition) -> list[Curve]:
    """Catmull and Rom: cubic pieces with continuous tangents, as a spline with double knots."""
    _expect(len(p) > 1, d, "two points or more")
    closed = (p[0] == p[-1]).all()
    slopes = np.empty_like(p)
    slopes[1:-1] = (p[2:] - p[:-2]) / 2
    slopes[0], slopes[-1] = p[1] - p[0], p[-1] - p[-2]
    if closed:
        slopes[0] = slopes[-1] = (p[1] - p[-2]) / 2
    control = np.stack([p[:-1] + slopes[:-1] / 3, p[1:] - slopes[1:] / 3], axis=1).reshape(-1, 2)
    knots = np.concatenate([[0, 0], np.repeat(np.arange(len(p)), 2), [len(p) - 1] * 2])
    return [BSpline(np.vstack([p[0], control, p[-1]]), 3, knots)]


def _bspline(p: Floats, d: Definition) -> list[Curve]:
    _expect(len(p) > 2, d, "three points or more")
    if (p[0] == p[-1]).all():
        return [BSpline(np.roll(p[:-1], 1, axis=0), 3, closed=True)]
    return [BSpline(p, min(3, len(p) - 1))]


def _bezier(p: Floats, d: Definition) -> list[Curve]:
    _expect(len(p) > 1, d, "two points or more")
    return [Bezier(p)]


def _expect(holds: bool, d: Definition, what: str) -> None:
    if not holds:
        raise FormatError(f"line {d.line}: {d.kind} {d.number} is {what}, not of {len(d.values)}")


_CURVES: dict[str, Callable[[Floats, Definition], list[Curve]]] = {
    "Line": _line,
    "Circle": _circle,
    "Ellipse": _ellipse,
    "Spline": _spline,
    "BSpline": _bspline,
    "Bezier": _bezier,
}
