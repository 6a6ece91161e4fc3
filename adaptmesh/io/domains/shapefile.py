"""Shapefiles of geographic information systems, read by pyshp: ``.shp``, with names in ``.dbf``.

The attribute ``name``, in any case, names the region of each polygon; without a ``.dbf`` beside the
``.shp`` none has a name. It is in the encoding that the ``.cpg`` or the header of the ``.dbf``
names, else, and where that cannot be, in one of `adaptmesh.files.encodings`. Measures at the
points are passed over.
"""

from __future__ import annotations

import codecs
import contextlib
import struct
from io import BytesIO
from pathlib import Path
from typing import Any

from adaptmesh.domain.polygons.shape import Shape
from adaptmesh.errors import DomainError, FormatError
from adaptmesh.files.located import located, refusing
from adaptmesh.files.whole import read_bytes, text_of

_LANGUAGES = {
    b"\x01": "cp437", b"\x02": "cp850", b"\x03": "cp1252", b"\x13": "cp932", b"\x4d": "cp936",
    b"\x4e": "cp949", b"\x4f": "cp950", b"\x57": "cp1252", b"\x64": "cp852", b"\x65": "cp866",
    b"\x66": "cp865", b"\xc8": "cp1250", b"\xc9": "cp1251", b"\xca": "cp1254", b"\xcb": "cp1253",
}  # fmt: skip
"""Encodings by the language driver in the header of a ``.dbf``."""

_HEADER = 100  # bytes; at 24 the length of the file, in units of 2 bytes


def read_shapefile(path: Path) -> list[Shape]:
    """The polygons of a shapefile, unchecked; a `FormatError` names the file."""
    pyshp = _import_pyshp()
    files = _contents(path)
    with located(path.with_suffix(".cpg")):
        encoding = _encoding(files.pop("cpg", None), files.get("dbf"))
    with (
        refusing(f"{path} is damaged, or no shapefile"),
        pyshp.Reader(**files, encoding="latin-1") as reader,
    ):
        read = [
            (None, ())
            if shape.shapeType == pyshp.NULL
            else (shape.__geo_interface__, getattr(shape, "z", ()))
            for shape in reader.iterShapes()
        ]
        with located(path.with_suffix(".dbf")):
            names = _names(reader, encoding) if "dbf" in files else []
    if not read:
        raise DomainError("it has no shapes: there is nothing to mesh")
    if names and len(names) != len(read):
        raise FormatError(
            f"{path} has {len(read)} shapes, and the .dbf beside it {len(names)} records: "
            "they do not belong together"
        )
    names = names or [None] * len(read)
    return [
        Shape.of_geojson(geometry, i, name).with_heights(z)
        for i, ((geometry, z), name) in enumerate(zip(read, names, strict=True))
    ]


def _names(reader: Any, encoding: str | None) -> list[str | None]:
    """The attribute ``name`` of each record; nothing if there is none.

    As Latin-1 every byte is a character, so that the bytes of a name are known.
    """
    fields = [field[0] for field in reader.fields]
    field = next((f for f in fields if f.lower() == "name"), None)
    if field is None:
        return []
    values = [record[field] for record in reader.iterRecords()]
    return [None if value in (None, "") else _name(value, encoding) for value in values]


def _name(value: object, encoding: str | None) -> str:
    if not isinstance(value, str):
        return str(value)
    data = value.encode("latin-1")
    if encoding is not None:
        with contextlib.suppress(UnicodeError, LookupError):
            return data.decode(encoding)
    return text_of(data)


def _encoding(cpg: BytesIO | None, dbf: BytesIO | None) -> str | None:
    """The encoding that the ``.cpg`` names, or the ``.dbf`` in its header; None if neither does."""
    words = text_of(cpg.getvalue()).split() if cpg is not None else []
    said = words[-1] if words else ""
    if said.isdecimal():  # a code page of Windows or DOS, or 88591 for ISO 8859-1
        said = f"iso8859-{said[4:]}" if said.startswith("8859") and said[4:] else f"cp{said}"
    if not said and dbf is not None:
        said = _LANGUAGES.get(dbf.getvalue()[29:30], "")
    try:
        return codecs.lookup(said).name if said else None
    except LookupError:
        return None


def _contents(path: Path) -> dict[str, BytesIO]:
    """What the file and those beside it hold.

    Of files on disk pyshp reads as much as they say they have, which may be more than there is
    memory for.
    """
    data = read_bytes(path)
    if len(data) < _HEADER or struct.unpack(">i", data[:4]) != (9994,):
        raise FormatError(f"{path} does not start with the header of a shapefile")
    length = 2 * struct.unpack(">i", data[24:28])[0]
    if length != len(data):
        raise FormatError(
            f"{path} has {len(data)} bytes, not {length} as it says itself: is the file complete?"
        )
    files = {"shp": BytesIO(data)}
    for kind in ("shx", "dbf", "cpg"):
        beside = [path.with_suffix(f".{suffix}") for suffix in (kind, kind.upper())]
        there = next((file for file in beside if file.exists()), None)
        if there is not None:
            files[kind] = BytesIO(read_bytes(there))
    return files


def _import_pyshp() -> Any:
    try:
        import shapefile
    except ImportError:
        raise FormatError(
            'shapefiles are read by pyshp: pip install "adaptmesh-metric[files]"'
        ) from None
    return shapefile
