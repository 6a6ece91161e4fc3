"""What Triangle's .node, .ele and .poly have in common: counts, numbered rows, comments.

https://www.cs.cmu.edu/~quake/triangle.node.html, and there .ele and .poly. Every row has a line,
whose further words do not matter; everything after ``#`` is a comment. In comments of ours::

    # adaptmesh                  first; the last line is then "# end", or the file was cut short
    # counts {...}               what all files together hold, see `counts.py`, in .ele
    # field 1 "u"                a field by its number of columns, in the order of attributes
    # edge_tags 3 "inlet"        the name of a tag, in .poly
    # regions 7 "steel"          and of a region, in .poly and .ele
    # periodic 1 [...]           periodic boundaries, in .ele
"""

from __future__ import annotations

import re
from pathlib import Path
from typing import NamedTuple

import numpy as np

from adaptmesh.errors import FormatError
from adaptmesh.files.bounded import read_json, signed_number
from adaptmesh.files.located import located
from adaptmesh.files.whole import read_text
from adaptmesh.mesh.periodic_sides import Rows, checked_rows
from adaptmesh.types import Array

OURS, END, COUNTS = "adaptmesh", "end", "counts"
_COMMENT = re.compile(r"#[^\n]*")
_LARGEST = 2.0**53  # whole numbers up to here are exact


class Table:
    """The lines of a file that say something, taken from the front, and its comments."""

    def __init__(self, path: Path) -> None:
        self.path = path
        text = read_text(path)
        self._comments = [c[1:].split(maxsplit=2) for c in _COMMENT.findall(text)]
        if [OURS] in self._comments and self._comments[-1] != [END]:
            raise FormatError(f"{path} does not end with '# {END}': the file is cut short")
        words = map(str.split, _COMMENT.sub("", text).split("\n"))
        self._lines = [(number, line) for number, line in enumerate(words, 1) if line]
        self._used = 0

    @property
    def counts(self) -> str:
        """What a comment of ours says that the files hold, or nothing."""
        found = [" ".join(words[1:]) for words in self._comments if words[:1] == [COUNTS]]
        return found[0] if found and [OURS] in self._comments else ""

    def finish(self) -> None:
        """Raise if there is more to take."""
        if self:
            self._used += 1
            raise self.error("there are more lines than the counts say: is a count wrong?")

    def __bool__(self) -> bool:
        """Whether there is more to take."""
        return self._used < len(self._lines)

    def header(self, what: str, *defaults: int) -> tuple[int, ...]:
        """The number of rows that follow, and further whole numbers, with what stands for each."""
        if not self:
            raise self._ended(f"the number of {what}")
        words = self._lines[self._used][1][: 1 + len(defaults)]
        self._used += 1
        numbers = [float(word) if _is_number(word) else np.nan for word in words]
        for word, number in zip(words, numbers, strict=True):
            if not 0 <= number < _LARGEST or number != int(number):
                raise self.error(f"{word} is not a number of {what}")
        return (*map(int, numbers), *defaults[len(numbers) - 1 :])

    def rows(self, what: str, count: int, width: int, finite: int | None = None) -> Array:
        """The next rows, (count, width), the first columns of which, or all, are finite."""
        lines = [words for _, words in self._lines[self._used : self._used + count]]
        self._used += len(lines)
        if len(lines) < count:
            raise self._ended(f"{what} {len(lines)} of {count}")

        def wrong(row: int, expected: str) -> FormatError:
            found = " ".join(lines[row])
            return self.error(f"{what} {row} of {count} {expected}, not {found!r}", row - count)

        for row, words in enumerate(lines):
            if len(words) < width:
                raise wrong(row, f"needs at least {width} numbers")
        try:
            flat = [word for words in lines for word in words[:width]]
            values = np.array(flat, np.float64).reshape(count, width)
            good = np.isfinite(values[:, :finite]).all(axis=1)
        except ValueError:
            good = np.array([all(map(_is_number, words[:width])) for words in lines])
        if not good.all():
            raise wrong(int(np.argmin(good)), "should be finite numbers")
        return values

    def whole(self, what: str, values: Array) -> Array:
        """Whole numbers from the rows that were taken last."""
        good = (np.abs(values) < _LARGEST) & (values == np.round(values))
        if not good.all():
            row = int(np.argwhere(~good)[0, 0])
            raise self.error(
                f"{what} {row} has a number that is not whole: {values[row]}", row - len(values)
            )
        return values.astype(np.int64)

    def _ended(self, what: str) -> FormatError:
        return FormatError(f"{self.path} ends where {what} should be: is the file complete?")

    def error(self, message: str, row: int = -1) -> FormatError:
        """An error in a row, counted back from the last one that was taken."""
        return FormatError(f"{self.path}, line {self._lines[self._used + row][0]}: {message}")

    def fields(self, values: Array, skip: int = 0) -> dict[str, Array]:
        """Attributes by the names in comments, or as attribute_0, attribute_1, ..."""
        out: dict[str, Array] = {}
        at = skip
        for name, width in self._said("field"):
            if not 0 < width <= values.shape[1] - at:
                raise FormatError(f"{self.path}: the comment on field {name!r} fits no attributes")
            columns = values[:, at : at + width]
            out[name] = columns[:, 0] if width == 1 else columns
            at += width
        for k in range(at, values.shape[1]):
            out[f"attribute_{k - skip}"] = values[:, k]
        return out

    def names(self, kind: str) -> dict[str, int]:
        """Numbers by name."""
        return dict(self._said(kind))

    def periodic(self) -> Rows:
        """Periodic boundaries, see `adaptmesh.mesh.periodic_sides`."""
        found = [words[2] for words in self._comments if words[:1] == ["periodic"] and words[2:]]
        with located(self.path):
            return [row for text in found for row in checked_rows(read_json(text))]

    def _said(self, kind: str) -> list[tuple[str, int]]:
        """Names and numbers in comments of ours of that kind."""
        found = [words for words in self._comments if len(words) == 3 and words[0] == kind]
        try:
            return [(str(read_json(name)), signed_number(number)) for _, number, name in found]
        except FormatError:
            raise FormatError(f"{self.path}: a comment on {kind} has no number and name") from None


def _is_number(word: str) -> bool:
    try:
        float(word)
    except ValueError:
        return False
    return True


class Points(NamedTuple):
    """Points (n, 2), the number of the first, and attributes (n, a)."""

    places: Array
    first: int
    attributes: Array


def read_points(table: Table) -> Points:
    """The points of a .node or .poly file; in the latter none if they are in the former."""
    count, dimension, attributes, markers = table.header("points", 2, 0, 0)
    if dimension != 2 or markers not in (0, 1):
        raise table.error(
            f"the points have {dimension} coordinates and {markers} markers, not 2, and 0 or 1"
        )
    rows = table.rows("point", count, 3 + attributes + markers, finite=3)
    first = 1 if count and rows[0, 0] == 1 else 0
    bad = np.flatnonzero(rows[:, 0] != first + np.arange(count))
    if len(bad):
        row = int(bad[0])
        raise table.error(
            f"the points are not numbered 0, 1, 2, ... or 1, 2, 3, ...: {rows[row, 0]:g}",
            row - count,
        )
    return Points(rows[:, 1:3], first, rows[:, 3 : 3 + attributes])


def read_segments(table: Table, first: int, n_points: int) -> tuple[Array, Array]:
    """Point numbers from 0, (k, 2), and markers, (k,), of the segments of a .poly file."""
    count, markers = table.header("segments", 0)
    rows = table.whole("segment", table.rows("segment", count, 3 + min(markers, 1)))
    ends = rows[:, 1:3] - first
    bad = np.argwhere((ends < 0) | (ends >= n_points))
    if len(bad):
        row, end = bad[0].tolist()
        raise table.error(
            f"segment {row} ends in point {rows[row, 1 + end]}; there are points {first} to "
            f"{first + n_points - 1}",
            row - count,
        )
    return ends, rows[:, 3] if markers else np.zeros(count, np.int64)
