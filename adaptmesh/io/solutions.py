"""Values at the vertices of a mesh in files of their own: Medit's solutions, metrics of BAMG."""

from __future__ import annotations

import os
from pathlib import Path

import numpy as np
from numpy.typing import ArrayLike, NDArray

from adaptmesh.errors import FormatError
from adaptmesh.files.located import located, only_our_errors
from adaptmesh.files.whole import read_bytes, replace_files
from adaptmesh.io.meshes.mtr import decode as decode_mtr
from adaptmesh.io.meshes.sol import AT_VERTICES, SCALAR, TENSOR, Solution, decode, encode

from .outgoing import solution_values

SOLUTION_SUFFIXES = (".sol", ".solb", ".mtr")


def read_sol(path: str | os.PathLike[str]) -> NDArray[np.float64]:
    """Read the values at the vertices in a Medit solution, or in a metric of BAMG.

    Parameters
    ----------
    path : str or path-like
        ``.sol`` is text, ``.solb`` binary; ``.mtr`` is BAMG's.

    Returns
    -------
    (n,), (n, 2) or (n, 3) array of float
        Scalars, vectors, or symmetric tensors as packed metrics (m11, m12, m22). Several fields in
        one file come side by side, (n, c).

    Raises
    ------
    FormatError
        The file is missing or damaged.
    """
    return _solution(Path(path)).values


def read_sizes_or_metrics(path: Path) -> NDArray[np.float64]:
    """The sizes (n,) or packed metrics (n, 3) in a solution; other fields are refused."""
    found = _solution(path)
    if found.types not in ([SCALAR], [TENSOR]):
        listed = ", ".join(map(str, found.types))
        raise FormatError(
            f"{path}: expected one field, of type 1 (sizes) or 3 (metrics), got types {listed}"
        )
    if found.place != AT_VERTICES:
        raise FormatError(f"{path}: expected {AT_VERTICES}, got {found.place}")
    return found.values


def _solution(path: Path) -> Solution:
    suffix = path.suffix.lower()
    if suffix not in SOLUTION_SUFFIXES:
        raise FormatError(f"{path}: a solution is .sol, .solb or .mtr, not {path.suffix!r}")
    with only_our_errors(path):
        data = read_bytes(path)
        with located(path):
            if suffix != ".mtr":
                return decode(data, binary=suffix == ".solb")
            values = decode_mtr(data)
            return Solution(values, [SCALAR if values.ndim == 1 else TENSOR], AT_VERTICES)


def write_sol(path: str | os.PathLike[str], values: ArrayLike) -> None:
    """Write a Medit solution at vertices, ``.sol`` or ``.solb``.

    Parameters
    ----------
    path : str or path-like
        ``.sol`` is text, ``.solb`` binary.
    values : (n,), (n, 2), (n, 3) or (n, 2, 2) array of float
        Scalars (a size h for Mmg), vectors, or symmetric tensors (packed as m11, m12, m22).

    Raises
    ------
    FormatError
        An array of another shape, or the file cannot be written.
    """
    path = Path(path)
    if path.suffix.lower() not in (".sol", ".solb"):
        raise FormatError(f"{path}: a solution is .sol or .solb, not {path.suffix!r}")
    binary = path.suffix.lower() == ".solb"
    with located(path):
        array = solution_values(values)
    tensor = array.ndim == 2 and array.shape[1] == 3
    replace_files({path: encode(array, tensor=tensor, place=AT_VERTICES, binary=binary)})
