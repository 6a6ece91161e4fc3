"""The arrays of XDMF: numbers in the XML itself, or in HDF5 files beside it."""

from __future__ import annotations

import math
from pathlib import Path, PureWindowsPath
from typing import TYPE_CHECKING

from adaptmesh.errors import FormatError
from adaptmesh.files.bounded import whole_number
from adaptmesh.files.hdf5 import Hdf5File
from adaptmesh.files.located import located
from adaptmesh.files.records import TextCursor
from adaptmesh.files.whole import read_bytes
from adaptmesh.types import Array

if TYPE_CHECKING:
    from xml.etree.ElementTree import Element


class XdmfArrays:
    """Reads what `<DataItem>`s hold: numbers in the XML, or in HDF5 files in the same folder."""

    def __init__(self, folder: Path) -> None:
        self._folder = folder
        self._files: dict[str, Hdf5File] = {}

    def __enter__(self) -> XdmfArrays:
        return self

    def __exit__(self, *_: object) -> None:
        for file in self._files.values():
            file.close()

    def read(self, parent: Element) -> Array:
        item = parent.find("DataItem")
        where = f"<{parent.tag} Name={parent.get('Name', '')!r}>"
        if item is None:
            raise FormatError(f"{where} has no <DataItem>")
        form = item.get("Format", "XML").upper()
        if form == "HDF":
            return self._stored(where, item.text or "")
        if form == "XML":
            return _inline(where, item)
        raise FormatError(f"{where}: its <DataItem> is in format {form}; HDF and XML can be read")

    def _stored(self, where: str, reference: str) -> Array:
        name, _, path = reference.strip().rpartition(":")
        if not _is_file_name(name):
            raise FormatError(f"{where} refers to {reference.strip()!r}, not to a file beside it")
        if name not in self._files:
            self._files[name] = Hdf5File(read_bytes(self._folder / name), name)
        with located(where):
            return self._files[name].read(path)


def _is_file_name(name: str) -> bool:
    """Whether it is the name of a file alone, on any system."""
    return name not in ("", ".", "..") and PureWindowsPath(name).name == name


def _inline(where: str, item: Element) -> Array:
    with located(where):
        number = item.get("NumberType", "Float").lower()
        code = "i8" if number in ("int", "uint", "short", "char", "uchar") else "f8"
        shape = [whole_number(n, "a dimension") for n in item.get("Dimensions", "").split()]
        values = TextCursor((item.text or "").encode()).rest(code)
        if len(values) != math.prod(shape):
            raise FormatError(f"{len(values)} numbers do not fit the dimensions {tuple(shape)}")
        return values.reshape(shape)
