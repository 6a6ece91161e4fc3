"""WKT, well-known text: polygons as they stand in databases and scripts, one after another.

A text holds geometries, each on as many lines as it likes, perhaps with an ``SRID=4326;`` before it
(which is passed over). It has no place for names.
"""

from __future__ import annotations

import re
from collections.abc import Iterator
from pathlib import Path

import numpy as np

from adaptmesh.domain.polygons.shape import Shape
from adaptmesh.errors import DomainError, FormatError
from adaptmesh.files.bounded import MOST_NESTED
from adaptmesh.files.located import located
from adaptmesh.files.whole import read_text

_BLANKS = re.compile(r"\s*(?:SRID=\d+;\s*)?", re.IGNORECASE)
# POLYGON, perhaps with Z, M or ZM; words and not blanks are counted, so that it takes linear time
_OPENING = re.compile(r"([a-z]+(?:\s+(?!EMPTY\b)[a-z]+)?)(?:\s*\(|\s+EMPTY\b)", re.IGNORECASE)
_BRACKET = re.compile(r"[()]")


def read_wkt(path: Path) -> list[Shape]:
    """The polygons of a file, unchecked; a `FormatError` names the file and the line."""
    import shapely

    shapes: list[Shape] = []
    for line, geometry in _geometries(read_text(path), path):
        try:
            with np.errstate(invalid="ignore", over="ignore"):  # not finite: refused later
                read = shapely.from_wkt(geometry)
        except (shapely.errors.ShapelyError, NotImplementedError) as error:
            raise FormatError(f"{path}, line {line}: {error}") from None
        is_collection = read.geom_type == "GeometryCollection"
        for part in read.geoms if is_collection else [read]:
            shapes.append(Shape.of_shapely(part, len(shapes)))
    if not shapes:
        raise DomainError("it holds no geometry: there is nothing to mesh")
    return shapes


def _geometries(text: str, path: Path) -> Iterator[tuple[int, str]]:
    """Each geometry, a word with all that its brackets enclose, and the line where it begins."""
    at, line, last = 0, 1, 0
    while (start := _end(_BLANKS.match(text, at))) < len(text):
        line, last = line + text.count("\n", last, start), start
        opening = _OPENING.match(text, start)
        if opening is None:
            found = text[start : start + 24].split()[0]
            raise FormatError(f"{path}, line {line}: expected POLYGON or the like, got {found!r}")
        with located(f"{path}, line {line}"):
            at = _closing(text, opening.end()) if opening[0].endswith("(") else opening.end()
        if at < 0:
            raise FormatError(
                f"{path}, line {line}: the brackets of this {opening[1]} are not closed: is the "
                "file complete?"
            )
        yield line, text[start:at]


def _end(match: re.Match[str] | None) -> int:
    return match.end() if match else 0


def _closing(text: str, at: int) -> int:
    """The place after the bracket that closes the one before `at`; -1 if there is none."""
    depth = 1
    for bracket in _BRACKET.finditer(text, at):
        depth += 1 if bracket[0] == "(" else -1
        if depth == 0:
            return bracket.end()
        if depth > MOST_NESTED:  # shapely takes a frame of the stack for each
            raise FormatError(f"brackets are nested more than {MOST_NESTED} levels deep")
    return -1
