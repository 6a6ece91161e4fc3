"""The arrays of XDMF: numbers in the XML itself, or in HDF5 files beside it."""

from __future__ import annotations

import io
from pathlib import Path, PurePosixPath
from typing import TYPE_CHECKING, Any

import numpy as np

from ..errors import FormatError
from .content import Array
from .files import read_bytes
from .located import refusing

if TYPE_CHECKING:
    from xml.etree.ElementTree import Element

_LARGEST = 1 << 31  # entries of an array: a damaged header asks for no more memory than that


class XdmfArrays:
    """Reads what `<DataItem>`s hold: numbers in the XML, or in HDF5 files in the same folder."""

    def __init__(self, folder: Path) -> None:
        self._folder = folder
        self._files: dict[str, Any] = {}

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
        if not name or len(PurePosixPath(name).parts) != 1:
            raise FormatError(f"{where} refers to {reference.strip()!r}, not to a file beside it")
        file = self._file(name)
        with refusing(f"{where} refers to {path!r}, which cannot be read from {name}"):
            found = file.get(path)
            if found is None or not hasattr(found, "shape"):
                raise FormatError(f"{where} refers to {path!r}, which {name} does not have")
            if found.size > _LARGEST:
                raise FormatError(f"{where} has {found.size:.3g} entries: {name} is damaged")
            values: Array = np.asarray(found[()])
        return values

    def _file(self, name: str) -> Any:
        if name not in self._files:
            data, h5py = io.BytesIO(read_bytes(self._folder / name)), import_h5py()
            with refusing(f"{name} beside it is damaged, or no HDF5 file"):
                self._files[name] = h5py.File(data, "r")
        return self._files[name]


def _inline(where: str, item: Element) -> Array:
    try:
        shape = tuple(map(int, item.get("Dimensions", "").split()))
        number = item.get("NumberType", "Float").lower()
        dtype = np.int64 if number in ("int", "uint", "short", "char", "uchar") else np.float64
        return np.array((item.text or "").split(), dtype).reshape(shape)
    except (ValueError, OverflowError) as error:
        raise FormatError(f"{where}: its numbers do not fit its dimensions: {error}") from None


def import_h5py() -> Any:
    try:
        import h5py
    except ImportError:
        raise FormatError("XDMF keeps its arrays in HDF5: pip install h5py") from None
    return h5py
