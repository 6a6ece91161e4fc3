"""Shapefiles of geographic information systems, read by pyshp: ``.shp``, with names in ``.dbf``.

The attribute ``name``, in any case, names the region of each polygon; without a ``.dbf`` beside the
``.shp`` none has a name. Measures at the points are passed over.
"""

from __future__ import annotations

import struct
from pathlib import Path
from typing import Any

from .errors import DomainError, FormatError
from .io.files import read_bytes
from .raw import Shape

_HEADER = 100  # bytes; at 24 the length of the file, in units of 2 bytes
_OF_DAMAGE = (
    struct.error, OSError, ValueError, LookupError, TypeError, AttributeError, ArithmeticError,
)  # fmt: skip
"""What pyshp raises where it does not look before it reads."""


def read_shapefile(path: Path) -> list[Shape]:
    """The polygons of a shapefile, unchecked; a `FormatError` names the file."""
    pyshp = _import_pyshp()
    _refuse_cut_short(path)
    try:
        with pyshp.Reader(str(path)) as reader:
            read = [
                (None, ())
                if shape.shapeType == pyshp.NULL
                else (shape.__geo_interface__, getattr(shape, "z", ()))
                for shape in reader.iterShapes()
            ]
            has_records = any(path.with_suffix(s).exists() for s in (".dbf", ".DBF"))
            names = _names(reader) if has_records else []
    except (pyshp.ShapefileException, pyshp.GeoJSON_Error, *_OF_DAMAGE) as error:
        raise FormatError(f"{path} is damaged, or no shapefile: {error}") from None
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


def _names(reader: Any) -> list[str | None]:
    """The attribute ``name`` of each record; nothing if there is none."""
    fields = [field[0] for field in reader.fields]
    field = next((f for f in fields if f.lower() == "name"), None)
    if field is None:
        return []
    values = [record[field] for record in reader.iterRecords()]
    return [None if value in (None, "") else str(value) for value in values]


def _refuse_cut_short(path: Path) -> None:
    data = read_bytes(path)
    if len(data) < _HEADER or struct.unpack(">i", data[:4]) != (9994,):
        raise FormatError(f"{path} does not start with the header of a shapefile")
    length = 2 * struct.unpack(">i", data[24:28])[0]
    if length != len(data):
        raise FormatError(
            f"{path} has {len(data)} bytes, not {length} as it says itself: is the file complete?"
        )


def _import_pyshp() -> Any:
    try:
        import shapefile
    except ImportError:
        raise FormatError(
            'shapefiles are read by pyshp: pip install "adaptmesh-metric[files]"'
        ) from None
    return shapefile
