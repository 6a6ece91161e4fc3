"""The frame of legacy VTK files: a header, lines of words, and numbers as text or bytes."""

from __future__ import annotations

import re

import numpy as np

from adaptmesh.errors import FormatError
from adaptmesh.files.bounded import whole_number
from adaptmesh.files.records import BinaryCursor, TextCursor
from adaptmesh.files.whole import text_of, without_mark
from adaptmesh.types import Array

KINDS = {
    "char": "i1", "signed_char": "i1", "unsigned_char": "u1", "short": "i2", "unsigned_short": "u2",
    "int": "i4", "unsigned_int": "u4", "long": "i8", "unsigned_long": "u8", "long_long": "i8",
    "unsigned_long_long": "u8", "vtkidtype": "i4", "float": "f4", "double": "f8",
    **{f"vtktypeint{8 * size}": f"i{size}" for size in (1, 2, 4, 8)},
    **{f"vtktypeuint{8 * size}": f"u{size}" for size in (1, 2, 4, 8)},
}  # fmt: skip
"""Types of numbers by their name in lower case, with those that binary files hold."""

_NOT_BLANK = re.compile(rb"\S")
_EMPTY_LINE = re.compile(rb"\n[ \t]*\r?\n")
_HEADER = re.compile(  # numbers and words of bounded length: a match takes linear time
    rb"# vtk DataFile Version {1,9}\d{1,3}\.\d{1,3}[^\n]*\n([^\n]*)\n"
    rb"\s*(ASCII|BINARY)\s+DATASET\s+(\w{1,40})[^\n]*\n",
    re.IGNORECASE,
)


class LegacyFile:
    """A walk over a file, from its first section on."""

    def __init__(self, data: bytes) -> None:
        data = without_mark(data)
        header = _HEADER.match(data)
        if header is None:
            raise FormatError("has not the header of a legacy VTK file")
        self.title = header[1].decode("ascii", "replace").strip()
        self.is_text = header[2].upper() == b"ASCII"
        self.dataset = header[3].decode("ascii", "replace").upper()
        self._data = data
        self._at = header.end()

    def line(self) -> list[str] | None:
        """The words of the next line that is not blank; None at the end."""
        start = self._start()
        if start == len(self._data):
            return None
        stop = self._data.find(b"\n", start)
        self._at = len(self._data) if stop < 0 else stop + 1
        words = self._data[start : self._at].split()  # of bytes: fewer characters are blanks
        return text_of(b" ".join(words)).split(" ")

    def has_next(self, keyword: str) -> bool:
        """Whether the next line starts with that word."""
        start = self._start()
        return self._data[start : start + len(keyword)].upper() == keyword.encode()

    def _start(self) -> int:
        found = _NOT_BLANK.search(self._data, self._at)
        return found.start() if found else len(self._data)

    @staticmethod
    def word(words: list[str] | None, place: int) -> str:
        """A word of a line, if it has as many."""
        if words is None or len(words) <= place:
            found = "the end" if words is None else " ".join(words)[:60]
            raise FormatError(f"expected {place + 1} words, got {found!r}: is it complete?")
        return words[place]

    def whole(self, words: list[str] | None, place: int) -> int:
        """A word of a line as a count."""
        return whole_number(self.word(words, place))

    def numbers(self, kind: str, count: int, columns: int = 1) -> Array:
        """The next numbers, (count,) or (count, columns), reals as float64, others as int64."""
        if not columns:
            raise FormatError("arrays of no columns cannot be read")
        if kind.lower() == "bit" and not self.is_text:
            packed = self._bytes("u1", (count * columns + 7) // 8)
            values = np.unpackbits(packed.astype(np.uint8), count=count * columns).astype(np.int64)
        else:
            code = "i1" if kind.lower() == "bit" else KINDS.get(kind.lower())
            if code is None:
                raise FormatError(f"type {kind[:24]!r} is not known")
            take = self._words if self.is_text else self._bytes
            values = take(code, count * columns)
        return values if columns == 1 else values.reshape(count, columns)

    def _words(self, code: str, count: int) -> Array:
        if 2 * count > len(self._data) - self._at + 1:
            raise FormatError(f"cut short: {count} numbers do not fit into what is left")
        found = self._next_words(count)
        return TextCursor(b" ".join(found)).rows(count, (code, 1))[0][:, 0]

    def _next_words(self, count: int) -> list[bytes]:
        """Take as many words; all that are left if there are fewer.

        They are looked for in a piece of the file that is doubled until it has them, so that the
        time goes with what is taken and not with what is left.
        """
        size = 32 * (count + 1)
        while True:
            piece = self._data[self._at : self._at + size]
            found = piece.split(None, count)
            if len(found) > count or self._at + size >= len(self._data):
                self._at += len(piece) - (len(found[count]) if len(found) > count else 0)
                return found[:count]
            size *= 2

    def _bytes(self, code: str, count: int) -> Array:
        cursor = BinaryCursor(self._data, ">")
        cursor.at = self._at
        values = cursor.rows(count, (code, 1))[0][:, 0]
        self._at = cursor.at
        return values

    def skip_block(self) -> None:
        """Go to the next empty line."""
        found = _EMPTY_LINE.search(self._data, max(self._at - 1, 0))
        self._at = found.end() if found else len(self._data)

    def skip_strings(self, count: int) -> None:
        """Pass over strings: lines of a text, or each a length and bytes."""
        for _ in range(count):
            if self._at >= len(self._data):
                raise FormatError("cut short: strings are missing")
            if self.is_text:
                stop = self._data.find(b"\n", self._at)
                self._at = len(self._data) if stop < 0 else stop + 1
            else:
                # The first two bits of a length say whether it has 1, 2, 4 or 8 bytes.
                size = 8 >> (self._data[self._at] >> 6)
                head = int.from_bytes(self._data[self._at : self._at + size], "big")
                self._at += size + (head & ((1 << (8 * size - 2)) - 1))
