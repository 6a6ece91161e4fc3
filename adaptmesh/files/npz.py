"""Arrays by name in a zip archive, ``.npz`` of NumPy, that nobody has checked.

`numpy.load` takes the shape in the header of an array, and the archive's word on its length, for
granted; here both are compared with the bytes that are there, and the header is matched, not
evaluated. Source: NEP 1, "A Simple File Format for NumPy Arrays".
"""

from __future__ import annotations

import io
import math
import re
import zipfile
from typing import Literal

import numpy as np

from adaptmesh.errors import FormatError
from adaptmesh.types import Array

from .bounded import Allowance
from .located import located, refusing

_ENCRYPTED = 0x1
_METHODS = (zipfile.ZIP_STORED, zipfile.ZIP_DEFLATED)
_SUFFIX = ".npy"
_MOST_DIMENSIONS = 8
_START = re.compile(rb"\x93NUMPY(?:\x01\0(..)|[\x02\x03]\0(....))", re.DOTALL)
_HEADER = re.compile(
    rb"\{'descr': '([<>|=]?[biufcU]\d{1,9})', 'fortran_order': (True|False), "
    rb"'shape': \(((?:\d{1,18},? ?)*)\), ?\} *\n"
)


def read_npz(data: bytes) -> dict[str, Array]:
    """The arrays of an archive, of numbers or texts, by name.

    Raises
    ------
    FormatError
        It is damaged, or its arrays are larger than what is there.
    """
    allowance = Allowance(len(data))
    with refusing("is no zip archive, or damaged"), zipfile.ZipFile(io.BytesIO(data)) as archive:
        return {
            info.filename.removesuffix(_SUFFIX): _array(_content(archive, info, allowance), info)
            for info in archive.infolist()
        }


def _content(archive: zipfile.ZipFile, info: zipfile.ZipInfo, allowance: Allowance) -> bytes:
    with located(info.filename[:80]):
        if info.flag_bits & _ENCRYPTED or info.compress_type not in _METHODS:
            raise FormatError("is encrypted, or compressed by another method than deflate")
        allowance.take(info.file_size)
        with archive.open(info) as file:
            # With a size: without, all that a block holds is unpacked at once. At its end the
            # checksum is compared.
            out = file.read(info.file_size + 1)
        if len(out) != info.file_size:
            raise FormatError(f"has {len(out)} bytes, not {info.file_size} as it says")
        return out


def _array(content: bytes, info: zipfile.ZipInfo) -> Array:
    with located(info.filename[:80]):
        start = _START.match(content)
        if start is None:
            raise FormatError("does not start as an array of NumPy does")
        begin = start.end() + int.from_bytes(start[1] or start[2], "little")
        header = _HEADER.fullmatch(content, start.end(), begin)
        if header is None:
            raise FormatError("has the header of no array of numbers")
        dtype = np.dtype(header[1].decode())
        shape = tuple(int(n) for n in re.findall(rb"\d+", header[3]))
        size = math.prod(shape) * dtype.itemsize
        if len(shape) > _MOST_DIMENSIONS or not dtype.itemsize or size != len(content) - begin:
            raise FormatError(f"has {len(content) - begin} bytes for {dtype} of shape {shape}")
        values = np.frombuffer(content, dtype, math.prod(shape), begin)
        order: Literal["F", "C"] = "F" if header[2] == b"True" else "C"
        return values.reshape(shape, order=order).copy(order=order)
