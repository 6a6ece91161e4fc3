"""Arrays of VTK XML files: as text, as base64, or appended, plain or compressed.

    plain       | bytes in all | data ......................... |
    compressed  | blocks, size of a block, size of the last (0: full), size of each compressed |
                | block | block | ...

In base64 each of the two lines of the compressed form is encoded by itself; the plain form is
encoded as one (by VTK) or as two (by some other writers). Source: *VTK User's Guide*, XML file
formats, and vtkXMLDataParser.
"""

from __future__ import annotations

import base64
import binascii
from collections.abc import Mapping
from typing import TYPE_CHECKING, Literal

import numpy as np

from adaptmesh.errors import FormatError
from adaptmesh.files.bounded import Allowance, inflated, whole_number
from adaptmesh.files.located import located
from adaptmesh.files.records import TextCursor
from adaptmesh.types import Array

if TYPE_CHECKING:
    from xml.etree.ElementTree import Element

TYPES: dict[str, np.dtype[np.generic]] = {
    name: np.dtype(name.lower())
    for name in (
        "Float32", "Float64", "Int8", "Int16", "Int32", "Int64",
        "UInt8", "UInt16", "UInt32", "UInt64",
    )
}  # fmt: skip
_COMPRESSORS = {"vtkZLibDataCompressor": "zlib", "vtkLZMADataCompressor": "lzma"}


class VtuArrays:
    """Reads the arrays of one file; `attributes` are those of its root."""

    def __init__(
        self, attributes: Mapping[str, str], appended: bytes, encoding: str, allowance: Allowance
    ) -> None:
        self._order: Literal["<", ">"] = ">" if attributes.get("byte_order") == "BigEndian" else "<"
        header = attributes.get("header_type", "UInt32")
        if header not in ("UInt32", "UInt64"):
            raise FormatError(f"header_type {header!r} is neither UInt32 nor UInt64")
        self._header = TYPES[header].newbyteorder(self._order)
        self._compressor = attributes.get("compressor")
        self._appended = appended
        self._appended_is_raw = encoding == "raw"
        self._allowance = allowance

    def read(self, element: Element) -> Array:
        """Array of one <DataArray> (n,) or (n, c)."""
        with located(f"array {element.get('Name', '?')!r}"):
            kind = element.get("type", "?")
            if kind not in TYPES:
                raise FormatError(f"type {kind!r} is unknown")
            values = self._numbers(element, TYPES[kind])
            columns = whole_number(
                element.get("NumberOfComponents") or "1", "a number of components"
            )
            if not columns or values.size % columns:
                raise FormatError(f"{values.size} numbers are not rows of {columns}")
            return values if columns == 1 else values.reshape(-1, columns)

    def _numbers(self, element: Element, dtype: np.dtype[np.generic]) -> Array:
        text = (element.text or "").encode()
        if element.get("format", "ascii") == "ascii":
            return _from_text(text, dtype)
        if element.get("format") == "appended":
            offset = whole_number(element.get("offset", ""), "an offset")
            if offset > len(self._appended):
                raise FormatError(f"offset {offset} is not in the appended data")
            stream = _Stream(self._appended, raw=self._appended_is_raw, at=offset)
        else:
            stream = _Stream(b"".join(text.split()), raw=False)
        data = self._decompressed(stream) if self._compressor else self._plain(stream)
        if len(data) % dtype.itemsize:
            raise FormatError(f"{len(data)} bytes are not a whole number of {dtype}")
        return np.frombuffer(data, dtype.newbyteorder(self._order)).astype(dtype)

    def _plain(self, stream: _Stream) -> bytes:
        word = self._header.itemsize
        size = int(np.frombuffer(stream.peek(word), self._header)[0])
        self._allowance.take(size)
        if stream.ends_after(word):
            stream.take(word)
            return stream.take(size)
        return stream.take(word + size)[word:]

    def _decompressed(self, stream: _Stream) -> bytes:
        if self._compressor not in _COMPRESSORS:
            raise FormatError(
                f"is compressed by {self._compressor}; save the file with zlib compression or none"
            )
        how = _COMPRESSORS[self._compressor]
        word = self._header.itemsize
        count = int(np.frombuffer(stream.peek(word), self._header)[0])
        if not count:
            return b""
        header = np.frombuffer(stream.take((3 + count) * word), self._header).tolist()
        full, last, sizes = header[1], header[2], header[3:]
        expected = [full] * count
        if last:
            expected[-1] = last
        self._allowance.take(sum(expected))
        blocks, at, out = stream.take(sum(sizes)), 0, []
        for size, length in zip(sizes, expected, strict=True):
            out.append(inflated(blocks[at : at + size], length, how))
            at += size
        return b"".join(out)


class _Stream:
    """Bytes in a row, raw or in base64, each `take` one group of base64 by itself."""

    def __init__(self, data: bytes, *, raw: bool, at: int = 0) -> None:
        self._data = data
        self._raw = raw
        self._at = at

    def peek(self, count: int) -> bytes:
        length = count if self._raw else -(-count // 3) * 4
        if length > len(self._data) - self._at:
            raise FormatError("the data are cut short")
        part = self._data[self._at : self._at + length]
        if self._raw:
            return part
        try:
            out = base64.b64decode(part, validate=True)
        except binascii.Error as error:
            raise FormatError(f"the base64 data are damaged: {error}") from None
        if len(out) < count:
            raise FormatError("the base64 data are cut short")
        return out[:count]

    def take(self, count: int) -> bytes:
        out = self.peek(count)
        self._at += count if self._raw else -(-count // 3) * 4
        return out

    def ends_after(self, count: int) -> bool:
        """Whether the next group of base64 has just `count` bytes, shown by its padding."""
        end = self._at + -(-count // 3) * 4
        return not self._raw and count % 3 != 0 and self._data[end - 1 : end] == b"="


def _from_text(text: bytes, dtype: np.dtype[np.generic]) -> Array:
    count = len(text.split())
    kind = "f8" if dtype.kind == "f" else "i8"
    values = TextCursor(text).rows(count, (kind, 1))[0].ravel()
    with np.errstate(over="ignore"):
        out: Array = values.astype(dtype)
    if dtype.kind != "f" and (out != values).any():
        raise FormatError(f"the number {values[out != values][0]} is not a {dtype}")
    return out
