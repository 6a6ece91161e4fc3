"""The .poly format of Triangle (Shewchuk): points, segments, holes, regions.

https://www.cs.cmu.edu/~quake/triangle.poly.html ::

    <points> 2 <attributes> <0 or 1 marker>
    <number> <x> <y> [attributes] [marker]        ... each point; numbers start at 0 or 1
    <segments> <0 or 1 marker>
    <number> <point> <point> [marker]             ... each segment
    <holes>
    <number> <x> <y>                              ... each hole
    <regions>                                     ... optional
    <number> <x> <y> <attribute> [greatest area]  ... each region

Everything after ``#`` is a comment. If the number of points is 0 they are in the .node file beside.
"""

from __future__ import annotations

import math
import os
import re
from collections.abc import Iterable, Iterator
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from .errors import FormatError
from .io.files import read_text
from .raw import Outline

Floats = NDArray[np.float64]
Integers = NDArray[np.int64]


class _Lines:
    """The lines of a file that say something, as words, with errors that name the line."""

    def __init__(self, path: Path) -> None:
        self.path = path
        stripped = (line.partition("#")[0].split() for line in read_text(path).splitlines())
        self._numbered: Iterator[tuple[int, list[str]]] = (
            (number, words) for number, words in enumerate(stripped, 1) if words
        )
        self._line = 0

    def next(self, what: str, least: int) -> list[float]:
        """The numbers of the next line, at least `least` of them."""
        words = self.next_or_none()
        if words is None:
            raise FormatError(f"{self.path} ends where {what} should be: is the file complete?")
        if len(words) < least:
            raise self.error(f"{what} needs at least {least} numbers, not {' '.join(words)!r}")
        try:
            numbers = [float(word) for word in words]
        except ValueError:
            numbers = [math.nan]
        if not all(map(math.isfinite, numbers)):
            raise self.error(f"{what} should be finite numbers, not {' '.join(words)!r}")
        return numbers

    def next_or_none(self) -> list[str] | None:
        self._line, words = next(self._numbered, (self._line, None))
        return words

    def count(self, what: str) -> tuple[int, list[float]]:
        """A header: how many there are, and the rest of the line."""
        first, *rest = self.next(f"the number of {what}", 1)
        if first < 0 or first != int(first):
            raise self.error(f"{first:g} is not a number of {what}")
        return int(first), rest

    def error(self, message: str) -> FormatError:
        return FormatError(f"{self.path}, line {self._line}: {message}")


def read_poly(path: str | os.PathLike[str]) -> Outline:
    """Read points and segments in Triangle's .poly format.

    Parameters
    ----------
    path : str or path
        The file; if it says that it has no points they are read from the .node file beside it.

    Returns
    -------
    Outline
        What the file says, unchecked. Segments with a marker other than 0 bear its decimal form as
        their name (``"2"``), and have it as their tag; so do regions with their attribute. Area
        limits of regions are not used: sizes are the business of the metric.

    Raises
    ------
    FormatError
        With the line, where the file is truncated or holds something else than it should.
    """
    path = Path(path)
    lines = _Lines(path)
    count, rest = lines.count("points")
    if count:
        points, first = _points(lines, count, rest)
    else:
        nodes = _Lines(path.with_suffix(".node"))
        points, first = _points(nodes, *nodes.count("points"))
    segments, names = _segments(lines, first, len(points))
    n_holes, _ = lines.count("holes")
    holes = [tuple(lines.next(f"hole {i}", 3)[1:3]) for i in range(n_holes)]
    regions = _regions(lines)
    return Outline(points, segments, holes, regions, names, _tags(names), _tags(regions))


def _points(lines: _Lines, count: int, header: list[float]) -> tuple[Floats, int]:
    """The points, and the number of the first one."""
    if header and header[0] != 2:
        raise lines.error(f"the points have {header[0]:g} coordinates; a domain has 2")
    points = np.empty((count, 2))
    first = 0
    for i in range(count):
        number, *xy = lines.next(f"point {i} of {count}", 3)
        if i == 0:
            first = int(number)
        if number != first + i or first not in (0, 1):
            raise lines.error(
                f"the points are not numbered 0, 1, 2, ... or 1, 2, 3, ...: {number:g}"
            )
        points[i] = xy[:2]
    return points, first


def _segments(lines: _Lines, first: int, n_points: int) -> tuple[Integers, dict[str, list[int]]]:
    """The segments, and the numbers of those that have a marker."""
    count, header = lines.count("segments")
    has_marker = bool(header and header[0])
    segments = np.empty((count, 2), np.int64)
    names: dict[str, list[int]] = {}
    for i in range(count):
        _, a, b, *marker = lines.next(f"segment {i} of {count}", 4 if has_marker else 3)
        for end in (a, b):
            if end != int(end) or not first <= end < first + n_points:
                raise lines.error(
                    f"segment {i} ends in point {end:g}; there are points {first} to "
                    f"{first + n_points - 1}"
                )
        segments[i] = int(a) - first, int(b) - first
        if has_marker and marker[0] != 0:
            names.setdefault(f"{marker[0]:g}", []).append(i)
    return segments, names


def _tags(names: Iterable[str]) -> dict[str, int]:
    """The number of each name that is a whole number."""
    return {name: int(name) for name in names if re.fullmatch(r"-?\d+", name)}


def _regions(lines: _Lines) -> dict[str, list[tuple[float, float]]]:
    """Seeds of each region attribute; the section may be absent."""
    words = lines.next_or_none()
    if words is None:
        return {}
    if not words[0].isdecimal():
        raise lines.error(f"the number of regions should be here, not {' '.join(words)!r}")
    regions: dict[str, list[tuple[float, float]]] = {}
    count = int(words[0])
    for i in range(count):
        _, x, y, attribute, *_ = lines.next(f"region {i} of {count}", 4)
        regions.setdefault(f"{attribute:g}", []).append((x, y))
    return regions
