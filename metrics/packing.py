"""Tensors as packed arrays: sizes and matrices converted, and everything checked."""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike

import metrics._core as _core

from .checks import as_numbers
from .errors import MetricError
from .types import Floats

ORDERS = {"packed": [0, 1, 2], "voigt": [0, 2, 1]}


def pack(
    values: ArrayLike,
    *,
    order: str = "packed",
    points: Floats | None = None,
    what: str = "the metric",
) -> Floats:
    """Sizes, packed tensors or matrices as checked packed tensors.

    Parameters
    ----------
    values : (n,), (n, 3) or (n, 2, 2) array_like
        Sizes h (the tensor is ``eye(2) / h**2``), packed tensors, or symmetric matrices.
    order : {"packed", "voigt"}, optional
        Of the columns of an (n, 3) array: m11, m12, m22, as everywhere in this package; or, as
        mechanics has it, xx, yy, xy: m11, m22, m12. Nothing is guessed from the values.
    points : (n, 2) array of float, optional
        Where the values are; only for the error messages.
    what : str, optional
        What the values are called in error messages.

    Returns
    -------
    (n, 3) array of float
        A new array.

    Raises
    ------
    MetricError
        For another shape or entries that are not real numbers; and, naming the first offending
        item, for a size that is not positive, a matrix that is not symmetric (to 1e-10 of its
        trace; 1e-5 in single precision) or not positive definite, or numbers that are not finite
        or beyond 1e±75 in size.
    """
    if order not in ORDERS:
        raise ValueError(f"order={order!r}: expected one of {', '.join(map(repr, ORDERS))}")
    if isinstance(values, np.ma.MaskedArray):  # np.asarray would unmask what is masked
        values = np.ma.filled(values.astype(np.float64), np.nan)
    raw = as_numbers(values, what)
    count = None if points is None else len(points)
    if not _is_packable(raw.shape, count):
        raise MetricError(_wrong_shape(what, raw.shape, count))
    asymmetry = 1e-10 if raw.dtype.itemsize >= 8 else 1e-5
    with np.errstate(over="ignore"):  # a long double beyond the range becomes inf, and is refused
        array = np.ascontiguousarray(raw, np.float64)
    if array.ndim == 1:
        tensors, first = _core.check_sizes(array)
    elif array.ndim == 2:
        if order != "packed":
            array = np.ascontiguousarray(array[:, ORDERS[order]])
        tensors, first = _core.check_tensors(array)
    else:
        tensors, first = _core.check_matrices(array, asymmetry)
    if first >= 0:
        place = f"item {first}"
        if points is not None:
            x, y = points[first].tolist()
            place = f"point {first} ({x!r}, {y!r})"
        raise MetricError(f"{what} at {place} {_flaw(array[first], asymmetry)}")
    return tensors


def unpack(tensors: ArrayLike) -> Floats:
    """Packed tensors (n, 3) as symmetric matrices (n, 2, 2); they need not be definite."""
    return np.ascontiguousarray(as_packed(tensors)[:, [0, 1, 1, 2]]).reshape(-1, 2, 2)


def as_packed(tensors: ArrayLike) -> Floats:
    """Packed symmetric tensors (n, 3) as they are, of any signs."""
    array = np.ascontiguousarray(as_numbers(tensors, "tensors"), np.float64)
    if array.ndim != 2 or array.shape[1] != 3:
        raise MetricError(f"packed tensors must have the shape (n, 3), not {array.shape}")
    return array


def _is_packable(shape: tuple[int, ...], count: int | None) -> bool:
    if not shape or (count is not None and shape[0] != count):
        return False
    return shape[1:] in ((), (3,), (2, 2))


def _wrong_shape(what: str, shape: tuple[int, ...], count: int | None) -> str:
    n = "n" if count is None else count
    message = (
        f"{what} has the shape {shape}; it must be ({n},) for sizes h, ({n}, 3) for tensors "
        f"(m11, m12, m22), or ({n}, 2, 2) for symmetric matrices"
    )
    if shape == ():
        return message + ": one value for each point, for example np.full(len(x), h)"
    if shape[1:] == (1,):
        return message + ": for sizes drop the last axis, values[:, 0]"
    if len(shape) > 1 and shape[-1] == count:
        return message + ": the points come first, transpose it"
    return message


def _flaw(value: Floats, asymmetry: float) -> str:
    """What is wrong with a size (), a packed tensor (3,) or a matrix (2, 2), and what to do."""
    shown = value.tolist()
    if not np.isfinite(value).all():
        return f"is not finite: {shown}"
    if value.ndim == 0:
        if value <= 0:
            return f"is not positive: h = {shown}; a size must be > 0"
        return f"is out of range: h = {shown}; a size must be within 1e-75 ... 1e75"
    m11, m12, m21, m22 = value[[0, 1, 1, 2]] if value.ndim == 1 else value.ravel()
    if abs(m12 - m21) > asymmetry * (abs(m11) + abs(m22)):
        return f"is not symmetric: {shown}; return (M + M.T) / 2"
    low, high = np.linalg.eigvalsh([[m11, m12], [m12, m22]]).tolist()
    if low > 1e-15 * high:
        return f"is out of range: {shown}; its sizes must be within 1e-75 ... 1e75"
    if low > -1e-15 * high:
        return (
            f"is singular to double precision: {shown} has the eigenvalues {low:.6g} and "
            f"{high:.6g}; keep the ratio of sizes below 1e7"
        )
    remedy = "raise them to at least 1 / h_max**2"
    if value.ndim == 1 and m11 > 0 and m12 > 0 and m22**2 < m11 * m12:
        remedy += "; or, if it is in the order xx, yy, xy, pack it with order='voigt'"
    return (
        f"is not positive definite: {shown} has the eigenvalues {low:.6g} and {high:.6g}; {remedy}"
    )
