"""Shapefiles of geographic information systems, read by pyshp: ``.shp``, with names in ``.dbf``.

The attribute ``name``, in any case, names the region of each polygon; without a ``.dbf`` beside the
``.shp`` none has a name. Measures at the points are passed over.
"""

from __future__ import annotations

import struct
from io import BytesIO
from pathlib import Path
from typing import Any

from .errors import DomainError, FormatError
from .io.files import read_bytes
from .io.located import refusing
from .raw import Shape

_HEADER = 100  # bytes; at 24 the length of the file, in units of 2 bytes


def read_shapefile(path: Path) -> list[Shape]:
    """The polygons of a shapefile, unchecked; a `FormatError` names the file."""
    pyshp = _import_pyshp()
    files = _contents(path)
    with (
        refusing(
            f"{path} is damaged, or no shapefile", pyshp.ShapefileException, pyshp.GeoJSON_Error
        ),
        pyshp.Reader(**files) as reader,
    ):
        read = [
            (None, ())
            if shape.shapeType == pyshp.NULL
            else (shape.__geo_interface__, getattr(shape, "z", ()))
            for shape in reader.iterShapes()
        ]
        names = _names(reader) if "dbf" in files else []
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
