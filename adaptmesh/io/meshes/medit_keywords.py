"""The frame of Medit files, meshes and solutions alike: keywords, each with counts and rows.

    text    Keyword count rows ... End       with comments from # to the end of the line
    binary  1 version | number place [count rows] | ...      `place` is that of the next keyword

Source: libMeshb 7, <https://github.com/LoicMarechal/libMeshb>.
"""

from __future__ import annotations

import re
from typing import Protocol

from adaptmesh.errors import FormatError
from adaptmesh.files.records import BinaryCursor, Cursor, TextCursor, one, table
from adaptmesh.files.whole import text_of

NUMBERS = {
    "Dimension": 3, "Vertices": 4, "Edges": 5, "Triangles": 6, "Quadrilaterals": 7,
    "Tetrahedra": 8, "Prisms": 9, "Hexahedra": 10, "Corners": 13,
    "RequiredVertices": 15, "RequiredEdges": 16, "TrianglesP2": 24, "EdgesP2": 25,
    "Pyramids": 49, "End": 54, "SolAtVertices": 62, "SolAtTriangles": 64, "ReferenceStrings": 199,
}  # fmt: skip
"""The number of each keyword that we know, in binary files."""
_NAMES = {number: name for name, number in NUMBERS.items()}
OURS = "# adaptmesh\n"
"""The comment that begins those of our own meshes."""
_LONGEST_OF_VERSION_2 = 2_000_000_000
Keyword = tuple[str, list[int], bytes]
"""A keyword to be written: name, counts, rows."""


# ---------------------------------------------------------------------------------------- reading


class MeditFile(Protocol):
    """A walk from keyword to keyword."""

    real: str
    integer: str
    lacks_end: bool

    @property
    def cursor(self) -> Cursor:
        """Where the numbers of the keyword are taken."""

    def next_keyword(self) -> str:
        """Go to the next keyword."""

    def skip(self) -> None:
        """Pass over the rows of a keyword that does not matter."""


def opened(data: bytes, *, binary: bool) -> MeditFile:
    """The walk over a text or a binary file."""
    return BinaryFile(data) if binary else TextFile(data)


def dimension(file: MeditFile) -> int:
    """Take the dimension, 2 or 3."""
    number = one(file.cursor, "i4")
    if number not in (2, 3):
        raise FormatError(f"{number} is neither 2 nor 3")
    return number


def count(file: MeditFile) -> int:
    """Take a number of rows."""
    return one(file.cursor, file.integer)


class TextFile:
    """Keywords of a text."""

    real, integer = "f8", "i8"

    def __init__(self, data: bytes) -> None:
        # BAMG and others leave it out. What ends within a line, or in our own files, is cut short.
        self.lacks_end = False
        self._may_lack_end = data.endswith((b"\n", b"\r")) and OURS.encode() not in data
        text = re.sub(r"\"[^\"\n]*\"|#[^\n]*", "", text_of(data))
        self.cursor = TextCursor(text.encode())
        if self.cursor.word() != b"MeshVersionFormatted":
            raise FormatError("does not start with MeshVersionFormatted: it is no Medit file")
        one(self.cursor)

    def next_keyword(self) -> str:
        word = self.cursor.word()
        if word is None:
            if not self._may_lack_end:
                raise FormatError(
                    "has no End: it is cut short (if it is whole, add the line 'End')"
                )
            self.lacks_end = True
            return "End"
        if not word.isalnum() or word.isdigit():
            raise FormatError(f"expected a keyword, got {word[:24]!r}: a count may be wrong")
        return word.decode()

    def skip(self) -> None:
        self.cursor.skip_numbers()


class BinaryFile:
    """Keywords of a binary file.

    The version tells how wide numbers are: 1 has single precision, from 3 on places have 8 bytes,
    from 4 on integers too.
    """

    def __init__(self, data: bytes) -> None:
        orders = {b"\x01\0\0\0": "<", b"\0\0\0\x01": ">"}
        if data[:4] not in orders:
            raise FormatError("does not start with the number 1: it is no binary Medit file")
        self.lacks_end = False
        self.cursor = BinaryCursor(data, orders[data[:4]])
        self.cursor.at = 4
        version = one(self.cursor)
        if not 1 <= version <= 4:
            raise FormatError(f"is of version {version}; 1 to 4 can be read")
        self.real = "f4" if version == 1 else "f8"
        self.integer = "i8" if version == 4 else "i4"
        self._place = "i8" if version >= 3 else "i4"
        self._next = self.cursor.at

    def next_keyword(self) -> str:
        if not self.cursor.at <= self._next < len(self.cursor.data):
            raise FormatError("has no End where the next keyword should be: it is cut short")
        self.cursor.at = self._next
        number = one(self.cursor)
        keyword = _NAMES.get(number, str(number))
        if keyword != "End":
            self._next = one(self.cursor, self._place)
        return keyword

    def skip(self) -> None:
        """Nothing to do: the place of the next keyword is known."""


# ---------------------------------------------------------------------------------------- writing


def text_file(keywords: list[Keyword], comments: str = "") -> bytes:
    """A text file; the first count has its own line."""
    parts = [f"MeshVersionFormatted 2\nDimension 2\n{comments}".encode()]
    for name, (first, *others), rows in keywords:
        more = " ".join(map(str, others)) + "\n" if others else ""
        parts += [f"\n{name}\n{first}\n{more}".encode(), rows]
    return b"".join([*parts, b"\nEnd\n"])


def binary_file(keywords: list[Keyword]) -> bytes:
    """A binary file; of version 2, or 3 if it is longer than that can tell."""
    size = sum(len(rows) for _, _, rows in keywords)
    version, place = (2, "i4") if size < _LONGEST_OF_VERSION_2 else (3, "i8")
    out = bytearray(table(True, ("i4", [[1, version]])))
    for name, counts, rows in [("Dimension", [2], b""), *keywords]:
        body = table(True, ("i4", [counts])) + rows
        after = len(out) + 4 + int(place[1]) + len(body)
        out += table(True, ("i4", [NUMBERS[name]]), (place, [after])) + body
    out += table(True, ("i4", [NUMBERS["End"]]), (place, [0]))
    return bytes(out)
