"""Decoding what nobody has checked: no count, length or depth in a file is believed before it fits.

A file of a few kilobytes must not cost gigabytes or minutes. Every reader takes whole numbers,
JSON, XML and compressed bytes through this module, and counts what its arrays hold in an
`Allowance`:

========================  =========================================================================
whole numbers             `LONGEST_INTEGER` digits
JSON, XML                 `MOST_NESTED` levels; of entities and default attributes of a document
                          type, what expands to `EXPANDED_BYTES` or 10 times the file at most
arrays of one file        `UNPACKED_BYTES`, or `UNPACKED_TIMES` times the file if that is more,
                          counted with every use where one block is used again and again
========================  =========================================================================
"""

from __future__ import annotations

import json
import lzma
import zlib
from typing import TYPE_CHECKING, Any
from xml.parsers import expat

import numpy as np

from adaptmesh.errors import FormatError

from .whole import readable_xml

if TYPE_CHECKING:
    from xml.etree.ElementTree import Element

LONGEST_INTEGER = 18
"""Digits of a whole number: what fits into 64 bits."""
MOST_NESTED = 200
"""Levels of lists and objects in JSON, and of elements in XML."""
EXPANDED_BYTES = 1 << 20
EXPANDED_TIMES = 10
UNPACKED_BYTES = 1 << 26
UNPACKED_TIMES = 100
"""Meshes are coordinates, which no compression makes more than about 20 times smaller."""


class Allowance:
    """The bytes that the arrays of one file may take in all.

    Parameters
    ----------
    size : int
        Bytes of the file, or of the files that belong together.
    least : int, optional
        What a small file may take.
    """

    def __init__(self, size: int, least: int = UNPACKED_BYTES) -> None:
        self._total = max(least, UNPACKED_TIMES * size)
        self._left = self._total

    def take(self, count: int, itemsize: int = 1) -> None:
        """Raise if `count` more items of `itemsize` bytes are too many."""
        if count < 0:
            raise FormatError(f"an array of {count} bytes: the file is damaged")
        self._left -= count * itemsize
        if self._left < 0:
            raise FormatError(
                f"its arrays would take more than {self._total >> 20} MiB, and {UNPACKED_TIMES} "
                "times the file: it is damaged, or made to fill the memory. If it is right, save "
                "it uncompressed"
            )


# ----------------------------------------------------------------------------------------- numbers


def whole_number(text: str | bytes, what: str = "a count") -> int:
    """The whole number that a text is, at least 0; blanks around it do not matter."""
    digits = text.strip()
    if not (digits.isascii() and digits.isdigit() and len(digits) <= LONGEST_INTEGER):
        raise FormatError(f"expected {what}, got {_shown(text)}")
    return int(digits)


def signed_number(text: str, what: str = "a whole number") -> int:
    """The whole number that a text is, with or without a sign."""
    sign, digits = (text[:1], text[1:]) if text[:1] in ("-", "+") else ("", text)
    if not digits[:1].isdigit():
        raise FormatError(f"expected {what}, got {_shown(text)}")
    number = whole_number(digits, what)
    return -number if sign == "-" else number


def _shown(text: str | bytes) -> str:
    return repr(text) if len(text) <= 24 else f"{text[:24]!r}..."


# -------------------------------------------------------------------------------------------- JSON


def read_json(text: str | bytes) -> Any:
    """What a JSON text says; integers of more than `LONGEST_INTEGER` digits become floats.

    Raises
    ------
    FormatError
        It is not JSON, with line and column, or nested deeper than `MOST_NESTED`.
    """
    try:
        if isinstance(text, bytes):
            text = text.decode()
        if _levels(text.encode()) > MOST_NESTED:
            raise FormatError(f"is JSON nested more than {MOST_NESTED} levels deep")
        return json.loads(text, parse_int=_json_integer)
    except json.JSONDecodeError as error:
        raise FormatError(
            f"is not valid JSON at line {error.lineno}, column {error.colno} ({error.msg}): is the "
            "file complete?"
        ) from None
    except ValueError as error:  # not a text of Unicode
        raise FormatError(f"is not valid JSON: {error}") from None


def _json_integer(digits: str) -> int | float:
    return int(digits) if len(digits) <= LONGEST_INTEGER else float(digits)


def _levels(data: bytes) -> int:
    """The greatest number of brackets that are open at once, strings left out."""
    if data.count(b"[") + data.count(b"{") <= MOST_NESTED:
        return 0
    # Two characters for two: what is escaped closes no string.
    codes = np.frombuffer(data.replace(rb"\\", b"  ").replace(rb"\"", b"  "), np.uint8)
    codes = codes[np.isin(codes, np.frombuffer(b'"[]{}', np.uint8))]
    outside = np.cumsum(codes == ord('"'), dtype=np.int64) % 2 == 0
    codes = codes[outside & (codes != ord('"'))]
    opens = (codes == ord("[")) | (codes == ord("{"))
    return int(np.cumsum(np.where(opens, 1, -1), dtype=np.int64).max(initial=0))


# --------------------------------------------------------------------------------------------- XML


def read_xml(data: bytes) -> Element:
    """The root of an XML document.

    Nothing outside of the document is read. Entities may stand for short texts, as in drawings of
    Adobe Illustrator, but not for other entities.

    Raises
    ------
    FormatError
        It is not XML, nested deeper than `MOST_NESTED`, or its entities would expand to much more
        than it is.
    """
    from xml.etree import ElementTree

    data = readable_xml(data)
    try:
        _Bounds(data).check()
        return ElementTree.fromstring(data)
    except (ElementTree.ParseError, expat.ExpatError, ValueError, LookupError) as error:
        raise FormatError(f"is cut short or not XML: {error}") from None


class _Bounds:
    """A first walk over a document, which keeps nothing but its depth and declarations."""

    def __init__(self, data: bytes) -> None:
        self._data = data
        self._depth = 0
        self._defaults = 0
        self._most = max(EXPANDED_BYTES, EXPANDED_TIMES * len(data))

    def check(self) -> None:
        parser = expat.ParserCreate()
        parser.StartElementHandler = self._start
        parser.EndElementHandler = self._end
        parser.EntityDeclHandler = self._entity
        parser.AttlistDeclHandler = self._attribute
        parser.Parse(self._data, True)

    def _start(self, *_: object) -> None:
        self._depth += 1
        if self._depth > MOST_NESTED:
            raise FormatError(f"is XML nested more than {MOST_NESTED} levels deep")

    def _end(self, *_: object) -> None:
        self._depth -= 1

    def _entity(self, name: str, parameter: bool, value: str | None, *_: object) -> None:
        if parameter or value is None or "&" in value or "%" in value:
            raise FormatError(
                f"the entity {name[:24]!r} stands for another file or other entities: write out "
                "what it stands for"
            )
        self._refuse_expansion(len(value) * self._data.count(b"&"))

    def _attribute(
        self, element: str, name: str, kind: str, default: str | None, _: object
    ) -> None:
        self._defaults += len(name) + len(default or "")
        self._refuse_expansion(self._defaults * self._data.count(b"<"))

    def _refuse_expansion(self, length: int) -> None:
        if length > self._most:
            raise FormatError("its document type would expand it to much more than it is")


# --------------------------------------------------------------------------------- compressed bytes


def inflated(data: bytes, length: int, how: str = "zlib") -> bytes:
    """The bytes of a compressed block, of which it is known how many they are.

    Parameters
    ----------
    data : bytes
    length : int
        Bytes that are expected, counted in an `Allowance` before.
    how : {"zlib", "lzma", "deflate"}, optional
        With header, or without as in zip archives.
    """
    machine: Any
    if how == "lzma":
        machine = lzma.LZMADecompressor()
    else:
        machine = zlib.decompressobj(-zlib.MAX_WBITS if how == "deflate" else zlib.MAX_WBITS)
    try:
        # One byte more than expected: the end mark is reached, and nothing beyond it is unpacked.
        out: bytes = machine.decompress(data, length + 1)
    except (zlib.error, lzma.LZMAError, EOFError) as error:
        raise FormatError(f"a compressed block is damaged: {error}") from None
    if len(out) != length or not machine.eof:
        raise FormatError("a compressed block has the wrong size: the file is damaged")
    return out


def refuse_longer(data: bytes, most: int) -> None:
    """Raise for a block compressed by zlib that has more bytes than it may."""
    try:
        out = zlib.decompressobj().decompress(data, most + 1)
    except zlib.error as error:
        raise FormatError(f"a compressed block is damaged: {error}") from None
    if len(out) > most:
        raise FormatError("a compressed block is larger than it should be: the file is damaged")
