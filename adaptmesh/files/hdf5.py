"""Arrays of an HDF5 file nobody has checked: what is in that file itself, and no more than allowed.

HDF5 can keep an array in another file (external storage, virtual datasets), lead to another file
(external links), claim one far larger than the file (what was never written reads as zeros), and
compress blocks without bound. All that is looked at before the first number is read.
"""

from __future__ import annotations

import io
import math
import re
from pathlib import PurePosixPath
from typing import Any

import numpy as np

from adaptmesh.errors import FormatError
from adaptmesh.types import Array

from .bounded import Allowance, refuse_longer
from .located import refusing

_MOST_LINKS = 16
_DEFLATE = 1
_FILTERS = {_DEFLATE: "z", 2: "s", 3: "c", 32000: "l"}
"""Gzip, shuffling, checksums, and LZF, which makes nothing more than 100 times larger."""
_PIPELINE = re.compile("[sc]*[zl]?c*")
_CHECKSUM = 4  # bytes
_BLOCK_BYTES = 1 << 30
"""What blocks may take one after the other; those at the end of an array are larger than it."""
_IN_ONE_FILE = "put its arrays into the file itself (`h5repack` does it for most)"


class Hdf5File:
    """Reads arrays by their path.

    Parameters
    ----------
    data : bytes
        The content of the file.
    name : str
        How messages call it.
    """

    def __init__(self, data: bytes, name: str) -> None:
        self._name = name
        self._allowance = Allowance(len(data))
        self._blocks = Allowance(len(data), _BLOCK_BYTES)
        with refusing(f"{name} beside it is damaged, or no HDF5 file"):
            self._file = import_h5py().File(io.BytesIO(data), "r")

    def close(self) -> None:
        self._file.close()

    def read(self, path: str) -> Array:
        """The numbers of a dataset."""
        with refusing(f"{path!r} cannot be read from {self._name}"):
            found = self._found(path)
            if found is None or not hasattr(found, "shape"):
                raise FormatError(f"{self._name} does not have {path!r}")
            self._check(path, found)
            values: Array = np.asarray(found[()])
        return values

    def check_all(self) -> None:
        """Raise for anything that leads to another file or is larger than it may be."""
        h5py = import_h5py()
        with refusing(f"{self._name} is damaged"):
            groups, seen = [self._file], {h5py.h5o.get_info(self._file.id).addr}
            while groups:
                group = groups.pop()
                for name in group:
                    link = group.get(name, getlink=True)
                    if isinstance(link, h5py.ExternalLink):
                        raise FormatError(
                            f"{name!r} in {self._name} leads to another file: {_IN_ONE_FILE}"
                        )
                    if not isinstance(link, h5py.HardLink):
                        continue
                    found = group[name]
                    place = h5py.h5o.get_info(found.id).addr
                    if place in seen:
                        continue
                    seen.add(place)
                    if isinstance(found, h5py.Group):
                        groups.append(found)
                    elif isinstance(found, h5py.Dataset):
                        self._check_storage(name, found)

    def _found(self, path: str) -> Any:
        """The object at a path, by links within the file only."""
        h5py = import_h5py()
        left, followed = [part for part in PurePosixPath(path).parts if part != "/"][::-1], 0
        at: list[Any] = [self._file]  # the groups from the root down to where we are
        while left:
            part = left.pop()
            if not isinstance(at[-1], h5py.Group):
                return None
            link = at[-1].get(part, getlink=True)
            if link is None:
                return None
            if isinstance(link, h5py.HardLink):
                at.append(at[-1][part])
                continue
            followed += 1
            if not isinstance(link, h5py.SoftLink) or followed > _MOST_LINKS:
                raise FormatError(f"{path!r} in {self._name} leads to another file: {_IN_ONE_FILE}")
            if link.path.startswith("/"):
                del at[1:]
            left += [p for p in PurePosixPath(link.path).parts if p != "/"][::-1]
        return at[-1]

    def _check(self, path: str, found: Any) -> None:
        if found.dtype.kind not in "iufb":
            raise FormatError(f"{path!r} in {self._name} holds {found.dtype}, not numbers")
        self._check_storage(path, found)

    def _check_storage(self, path: str, found: Any) -> None:
        if found.is_virtual or found.external:
            raise FormatError(f"{path!r} in {self._name} is kept in another file: {_IN_ONE_FILE}")
        self._allowance.take(math.prod(found.shape), found.dtype.itemsize)
        if found.chunks:
            self._check_blocks(found)

    def _check_blocks(self, found: Any) -> None:
        """That no block is larger than it should be, or compressed in a way that may hide it."""
        settings = found.id.get_create_plist()
        filters = [settings.get_filter(k)[0] for k in range(settings.get_nfilters())]
        if not _PIPELINE.fullmatch("".join(_FILTERS.get(number, "?") for number in filters)):
            raise FormatError(
                f"is compressed by the filters {filters} of HDF5; save it with gzip, or without"
            )
        # An item of variable length is a place of 16 bytes.
        itemsize = 16 if found.dtype.kind == "O" else found.dtype.itemsize
        size = math.prod(found.chunks) * itemsize
        for k in range(found.id.get_num_chunks()):
            self._blocks.take(size)
            if _DEFLATE in filters:
                offset = found.id.get_chunk_info(k).chunk_offset
                skipped, block = found.id.read_direct_chunk(offset)
                if not skipped & 1 << filters.index(_DEFLATE):
                    refuse_longer(block, size + _CHECKSUM)


def import_h5py() -> Any:
    try:
        import h5py
    except ImportError:
        raise FormatError("XDMF keeps its arrays in HDF5: pip install h5py") from None
    return h5py
