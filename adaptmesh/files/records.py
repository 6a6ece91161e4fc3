"""Rows of numbers in a file, as words or as bytes; one way to walk and to write both.

    text    1 0.5 0.25 7            words between blanks
    binary  01 00 00 00 00 ...      the same columns packed, in the byte order of the file

A column is a pair ``(code, width)``: ``("f8", 2)`` is two doubles, ``("i4", 1)`` one integer.
Integers come out as int64 and reals as float64 whatever the file holds. Counts are compared with
what is left of the file before any memory is taken, so a corrupt count cannot exhaust it.
"""

from __future__ import annotations

from itertools import chain
from typing import Any, Protocol

import numpy as np
from numpy.typing import ArrayLike

from adaptmesh.errors import FormatError
from adaptmesh.types import Array

Column = tuple[str, int]

_LONGEST_NUMBER = 64
_LONGEST_ROW = 1 << 30  # bytes


class Cursor(Protocol):
    """A place in a file from which rows of numbers are taken."""

    def rows(self, count: int, *columns: Column) -> list[Array]:
        """Take `count` rows; one array ``(count, width)`` for each column."""

    def left_over(self) -> bool:
        """Whether anything but blanks is left."""


class TextCursor:
    """Walk over the words of a text."""

    def __init__(self, text: bytes) -> None:
        self._words = text.split()
        self._at = 0

    def word(self) -> bytes | None:
        """Take the next word; None at the end."""
        if self._at == len(self._words):
            return None
        self._at += 1
        return self._words[self._at - 1]

    def skip_numbers(self) -> None:
        """Go to the next word that starts with a letter."""
        while self._at < len(self._words) and not self._words[self._at][:1].isalpha():
            self._at += 1

    def rows(self, count: int, *columns: Column) -> list[Array]:
        width = sum(w for _, w in columns)
        left = len(self._words) - self._at
        if count < 0 or count * width > left:
            raise FormatError(f"cut short: {count} rows of {width} numbers, {left} words left")
        words = self._words[self._at : self._at + count * width]
        self._at += count * width
        table = _word_array(words).reshape(count, width)
        out, first = [], 0
        for code, w in columns:
            out.append(_parsed(table[:, first : first + w], code))
            first += w
        return out

    def rest(self, code: str) -> Array:
        """Take all numbers that are left, (n,)."""
        return self.rows(len(self._words) - self._at, (code, 1))[0][:, 0]

    def left_over(self) -> bool:
        return self._at < len(self._words)


class BinaryCursor:
    """Walk over bytes; `order` is ``"<"`` or ``">"``."""

    def __init__(self, data: bytes, order: str = "<") -> None:
        self.data = data
        self.order = order
        self.at = 0

    def rows(self, count: int, *columns: Column) -> list[Array]:
        size = sum(int(code[1:]) * width for code, width in columns)
        if size > _LONGEST_ROW:
            raise FormatError(f"rows of {size} bytes: a count is wrong")
        record = np.dtype(
            [(str(i), self.order + code, (w,)) for i, (code, w) in enumerate(columns)]
        )
        left = len(self.data) - self.at
        if count < 0 or count * record.itemsize > left:
            raise FormatError(f"cut short: {count} rows of {record.itemsize} bytes, {left} left")
        table = np.frombuffer(self.data, record, count, self.at)
        self.at += count * record.itemsize
        return [_widened(table[str(i)]) for i in range(len(columns))]

    def left_over(self) -> bool:
        return bool(self.data[self.at :].strip())


def one(cursor: Cursor, code: str = "i4") -> int:
    """Take one integer."""
    return int(cursor.rows(1, (code, 1))[0][0, 0])


def table(binary: bool, *columns: tuple[str, ArrayLike]) -> bytes:
    """Rows of numbers, the inverse of `Cursor.rows`: columns are ``(code, (n,) or (n, w))``.

    Text has the shortest digits that give the same double back (at most 17).
    """
    arrays = [(code, np.asarray(a)) for code, a in columns]
    arrays = [(code, a if a.ndim == 2 else a[:, None]) for code, a in arrays]
    count = len(arrays[0][1])
    if binary:
        out = np.empty(count, [(str(i), "<" + c, a.shape[1:]) for i, (c, a) in enumerate(arrays)])
        for i, (_, a) in enumerate(arrays):
            out[str(i)] = a
        return out.tobytes()
    line = " ".join(" ".join(["%r" if c[0] == "f" else "%d"] * a.shape[1]) for c, a in arrays)
    lists = chain.from_iterable(a.T.tolist() for _, a in arrays)
    return "".join(map((line + "\n").__mod__, zip(*lists, strict=True))).encode()


def _word_array(words: list[bytes]) -> Array:
    longest = max(words, key=len, default=b"0")
    if len(longest) > _LONGEST_NUMBER:
        raise FormatError(f"expected a number, got {longest[:24]!r}...")
    return np.array(words, dtype=f"S{len(longest)}")


def _parsed(words: Array, code: str) -> Array:
    kind = np.float64 if code[0] == "f" else np.int64
    try:
        return words.astype(kind)
    except (ValueError, OverflowError):
        pass
    wrong = next(word for word in words.ravel() if not _parses(word, kind))
    what = "a number" if code[0] == "f" else "an integer"
    raise FormatError(f"expected {what}, got {bytes(wrong)!r}")


def _parses(word: Any, kind: type) -> bool:
    try:
        np.asarray(word).astype(kind)
    except (ValueError, OverflowError):
        return False
    return True


def _widened(column: Array) -> Array:
    if column.dtype.kind == "f":
        return column.astype(np.float64)
    if column.dtype.kind == "u" and np.any(column > np.uint64(np.iinfo(np.int64).max)):
        raise FormatError(f"the number {int(column.max())} is far too large: the file is corrupt")
    return column.astype(np.int64)
