"""Scripts opened by Gmsh itself, for all of its language: curves, surfaces and physical groups.

Gmsh works in a process of its own (`gmsh_program`), on a script that reaches no other file
(`gmsh_script`), with bounds on time and memory.
"""

from __future__ import annotations

import importlib.util
import re
import tempfile
import warnings
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np

from adaptmesh.curves import Arc, BSpline, Curve, Line
from adaptmesh.domain.sides.skeleton import extent_of
from adaptmesh.domain.sides.surfaces import joined_lines
from adaptmesh.errors import FormatError, FormatWarning
from adaptmesh.files.own_process import ask_program
from adaptmesh.io.domains.drawings.drawing import JOINED, affine_arc
from adaptmesh.types import Floats

from .gmsh_script import MENTIONED, SafeScript, included_name, safe_script
from .groups import names_of_groups
from .plane_model import CurvesByNumber, PlaneModel, samples_of

SECONDS = 60
"""Of processor time that a script may take in Gmsh."""

MEMORY = 4 << 30
"""Bytes of address space that Gmsh may take."""

SAME_RADIUS = 1e-6
"""The ends of an arc are on its circle, to this share of its size, or a warning says so."""

FLAT = 1e-9
"""Share of the extent by which heights of a plane domain may differ."""


def is_installed() -> bool:
    """Whether the package gmsh can be imported."""
    return importlib.util.find_spec("gmsh") is not None


def read_by_gmsh(path: Path) -> PlaneModel:
    """Curves and surfaces of a script, as Gmsh understands it; a `FormatError` if it does not."""
    script = safe_script(path)
    said = _opened(path, script)
    left_out = {word: line for word, line in script.left_out.items() if word in MENTIONED}
    if left_out:
        words = ", ".join(f"{word} (line {line})" for word, line in left_out.items())
        warnings.warn(
            f"{path}: passed over {words}: what says nothing about the domain",
            FormatWarning,
            stacklevel=2,
        )
    return _Model.of(path, said).plane()


def _opened(path: Path, script: SafeScript) -> dict[str, Any]:
    """What the program says about a script."""
    with tempfile.TemporaryDirectory() as folder:
        file = Path(folder) / "script.geo"
        file.write_text(script.text, encoding="utf-8", newline="\n")
        for number, (_, text) in enumerate(script.included):
            copy = Path(folder) / included_name(number)
            copy.write_text(text, encoding="utf-8", newline="\n")
        said = ask_program(
            Path(__file__).with_name("gmsh_program.py"),
            [file, SECONDS, MEMORY],
            Path(folder),
            2 * SECONDS,
            who=f"{path}: Gmsh",
            late="read it",
            no_answer=f"the script may take more than {SECONDS} s or {MEMORY >> 30} GB, or be too "
            "large for Gmsh",
        )
    if said["error"]:
        raise FormatError(f"{path}: {_with_own_names(said['error'], path, script)}")
    return said


def _with_own_names(text: str, path: Path, script: SafeScript) -> str:
    """What Gmsh says of copies, said of the files themselves."""
    own = {"script.geo": path.name}
    own |= {included_name(k): file.name for k, (file, _) in enumerate(script.included)}
    copies = re.compile(r"(?:[^'\s]*[/\\])?(script|included\d+)\.geo\b")
    return copies.sub(lambda m: own.get(f"{m[1]}.geo", m[0]), text)


@dataclass
class _Model:
    """What Gmsh has made of a script, by tag."""

    path: Path
    points: dict[int, Floats]
    curves: dict[int, Curve]
    surfaces: dict[int, dict[str, list[int]]]
    groups: list[tuple[int, int, str, list[int]]]

    @classmethod
    def of(cls, path: Path, said: Mapping[str, Any]) -> _Model:
        if said["volumes"]:
            raise FormatError(
                f"{path}: it has {said['volumes']} volumes; a domain is plane: leave out what "
                "makes them (extrusions of surfaces, boxes, ...)"
            )
        _check_flat(path, said)
        model = cls(
            path,
            {int(tag): np.array(p[:2]) for tag, p in said["points"].items()},
            {int(tag): _curve(path, int(tag), c) for tag, c in said["curves"].items()},
            {int(tag): surface for tag, surface in said["surfaces"].items()},
            [(dim, tag, name or str(tag), entities) for dim, tag, name, entities in said["groups"]],
        )
        off = [tag for tag, c in said["curves"].items() if c.get("off", 0) > SAME_RADIUS]
        if off:
            warnings.warn(
                f"{path}: the ends of circles {', '.join(off)} are not equally far from their "
                "centres: arcs through both ends are taken",
                FormatWarning,
                stacklevel=4,
            )
        if said["periodic"]:
            listed = ", ".join(f"{a} and {b}" for a, b in said["periodic"])
            warnings.warn(
                f"{path}: curves {listed} are periodic there; say so of the domain with "
                "Domain.with_periodic",
                FormatWarning,
                stacklevel=4,
            )
        return model

    def plane(self) -> PlaneModel:
        if not self.curves:
            raise FormatError(f"{self.path}: it has no curves: there is nothing to mesh")
        inside = {t for s in self.surfaces.values() for t in s["curves_inside"]}
        bounding = {t for s in self.surfaces.values() for t in s["curves"]}
        used = sorted(inside | bounding) if self.surfaces else sorted(self.curves)
        curves = CurvesByNumber({t: [self.curves[t]] for t in used})
        lines = joined_lines(
            [samples_of(c) for c in curves.curves], JOINED * extent_of(curves.curves)
        )
        faces = {
            tag: self._face(tag, [lines[k] for k in sorted(curves.at(s["curves"]))])
            for tag, s in self.surfaces.items()
        }
        points = {t for s in self.surfaces.values() for t in s["points_inside"]}
        return PlaneModel(
            curves.curves,
            curves.named(self.path, self._groups(1)),
            self._tags(1),
            faces,
            names_of_groups(self.path, self._groups(2), "surfaces"),
            self._tags(2),
            [self.points[t] for t in sorted(points)],
        )

    def _groups(self, dimension: int) -> list[tuple[str, list[int]]]:
        return [(name, members) for dim, _, name, members in self.groups if dim == dimension]

    def _tags(self, dimension: int) -> dict[str, int]:
        return {name: tag for dim, tag, name, _ in self.groups if dim == dimension}

    def _face(self, tag: int, lines: list[Floats]) -> Any:
        """A surface as a polygon of samples: what an odd number of its boundaries encloses."""
        import shapely

        if not lines:
            raise FormatError(f"{self.path}: surface {tag} has no boundary")
        ends, count = np.unique([p[k] for p in lines for k in (0, -1)], axis=0, return_counts=True)
        if (count % 2).any():
            x, y = ends[count % 2 == 1][0].tolist()
            raise FormatError(
                f"{self.path}: the boundary of surface {tag} is not closed: a curve ends at "
                f"({x:g}, {y:g})"
            )
        face = shapely.build_area(shapely.MultiLineString(lines))
        if face.is_empty:
            raise FormatError(f"{self.path}: the boundary of surface {tag} is not closed")
        return face


def _check_flat(path: Path, said: Mapping[str, Any]) -> None:
    """Refuse what does not lie in one plane z = constant; loose points do not matter."""
    surfaces = list(said["surfaces"].values())
    used = {t for s in surfaces for kind in ("curves", "curves_inside") for t in s[kind]}
    rows = [[t, said["points"][str(t)]] for s in surfaces for t in s["points_inside"]]
    for tag, curve in said["curves"].items():
        places = curve.get("points") or curve.get("control") or []
        if int(tag) in used or not surfaces:
            rows += [[f"of curve {tag}", p] for p in places]
    if not rows:
        return
    xyz = np.array([p for _, p in rows])
    extent = float(np.ptp(xyz, axis=0).max())
    off = np.abs(xyz[:, 2] - xyz[0, 2])
    if off.max() > FLAT * extent:
        what, (x, y, z) = rows[int(off.argmax())]
        raise FormatError(
            f"{path}: it is not plane: point {what} is ({x:g}, {y:g}, {z:g}); all have to lie at "
            "one height z"
        )


def _curve(path: Path, tag: int, said: Mapping[str, Any]) -> Curve:
    kind = said["kind"]
    if kind == "line":
        a, b = np.array(said["points"])[:, :2]
        return Line(a, b)
    if kind == "ellipse":
        return _arc(said)
    if kind == "cubics":
        knots = np.concatenate([[0, 0], np.repeat(said["knots"], 2), [1, 1]])
        return BSpline(np.array(said["control"])[:, :2], 3, knots)
    raise FormatError(f"{path}: curve {tag} is a {kind}, without geometry; it cannot be read")


def _arc(said: Mapping[str, Any]) -> Curve:
    """An arc of a circle through three of its points, one of an ellipse by conjugate radii."""
    first, second = (np.array(said[k])[:2] for k in ("first", "second"))
    a, b = np.hypot(*first), np.hypot(*second)
    near = SAME_RADIUS if "off" in said else 1e-12  # short arcs of circles hardly tell their radii
    is_circle = abs(a - b) <= near * a and abs(first @ second) <= near * a * b
    if (is_circle or said.get("off", 0) > SAME_RADIUS) and said["turn"] < 2 * np.pi:
        return Arc.through(*np.array(said["points"])[:, :2])
    return affine_arc(np.array(said["centre"])[:2], first, second, 0.0, said["turn"])
