"""The points of a domain of curves: pairs of them remember the curves that they are chords of.

``domain.points[domain.segments[mask]]`` is what one writes to measure distances from some sides. Of
a domain with curves these are chords, which may be off the curves by far more than the sizes asked
for. So pairs of points, chosen by number, hand on the curves themselves to what measures distances
(`metrics.Geometry` and all that takes a geometry), by the method `cubic_pieces`, as `Domain.sides`
does. All else that is done with the points, or with the pairs, gives plain arrays.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np

from adaptmesh.topology import edge_keys
from adaptmesh.types import Array, Bools, Floats, Int64s

from .cubic_pieces import CubicPieces, cubic_pieces
from .data import DomainData

_Base = np.ndarray[Any, np.dtype[np.float64]]


class _Plain(_Base):
    """An array whose results are plain arrays."""

    def __array_ufunc__(self, ufunc: Any, method: str, *inputs: Any, **options: Any) -> Any:
        outputs = options.get("out")
        if outputs is not None:
            options["out"] = tuple(map(_plain, outputs))
        result = getattr(ufunc, method)(*map(_plain, inputs), **options)
        return result if outputs is None else (outputs[0] if len(outputs) == 1 else outputs)

    def __reduce__(self) -> Any:
        return _plain(self).__reduce__()

    def __reduce_ex__(self, protocol: Any) -> Any:
        return _plain(self).__reduce_ex__(protocol)


class CurvePoints(_Plain):
    """The points (n, 2) of a domain of curves, see the module."""

    _domain: DomainData | None = None

    @classmethod
    def of(cls, domain: DomainData, points: Floats) -> CurvePoints:
        """The points of a domain, as they are stored in it."""
        out = points.view(cls)
        out._domain = domain
        return out

    def __getitem__(self, index: Any) -> Any:
        found = _plain(self)[index]
        pairs = None if self._domain is None else _pairs(index)
        if pairs is None or found.shape != (*pairs.shape, 2):
            return found
        return Chords.of(self._domain, pairs.astype(np.int64) % len(self), found)


class Chords(_Plain):
    """Pairs of points of a domain of curves, (k, 2, 2), or one (2, 2).

    Rows of it are such pairs again, and so are pairs of one domain that are joined by
    `numpy.concatenate` or `numpy.stack`. They remember their curves as long as the coordinates are
    not changed.
    """

    _domain: DomainData | None = None
    _pairs: Int64s

    @classmethod
    def of(cls, domain: DomainData | None, pairs: Int64s, places: Floats) -> Chords:
        """The places of pairs of points, given by their numbers (k, 2) or (2,)."""
        out = places.view(cls)
        out._domain, out._pairs = domain, pairs
        return out

    def __array_finalize__(self, source: Any) -> None:
        if isinstance(source, Chords) and source._domain and source.shape == self.shape:
            self._domain, self._pairs = source._domain, source._pairs

    def __getitem__(self, index: Any) -> Any:
        found = _plain(self)[index]
        if self._domain is None or self.ndim != 3 or isinstance(index, tuple):
            return found
        pairs = self._pairs[index]
        is_row = (
            found.shape == (*pairs.shape, 2) and pairs.ndim in (1, 2) and pairs.shape[-1:] == (2,)
        )
        return Chords.of(self._domain, pairs, found) if is_row else found

    def __array_function__(self, function: Any, types: Any, args: Any, options: Any) -> Any:
        result = super().__array_function__(function, types, args, options)
        if function in (np.concatenate, np.vstack, np.stack) and isinstance(args[0], (list, tuple)):
            parts = [part for part in args[0] if isinstance(part, Chords) and part._domain]
            if len(parts) == len(args[0]) and len({id(part._domain) for part in parts}) == 1:
                pairs = function([part._pairs for part in parts])
                if result.shape == (*pairs.shape, 2) and pairs.shape[1:] == (2,):
                    return Chords.of(parts[0]._domain, pairs, _plain(result))
        return result

    @property
    def cubic_pieces(self) -> Callable[[], CubicPieces]:
        """A function that returns the curves, and straight lines between what is on none."""
        domain = self._domain
        if domain is None or not np.array_equal(_plain(self), _plain(domain.points)[self._pairs]):
            raise AttributeError("cubic_pieces: these are no longer chords of a domain")
        pairs, places = self._pairs.reshape(-1, 2), _plain(self).reshape(-1, 2, 2)
        return lambda: _pieces_of(domain, pairs, places)


def _plain(array: Any) -> Any:
    """The same data as a plain array; what is none of ours as it is."""
    return array.view(np.ndarray) if isinstance(array, _Plain) else array


def _pairs(index: Any) -> Array | None:
    """The numbers of points, if an index is one of pairs of these, (k, 2) or (2,); else None."""
    if isinstance(index, tuple) and len(index) == 2 and _is_everything(index[1]):
        index = index[0]
    if not isinstance(index, (list, np.ndarray)):
        return None
    numbers = np.asarray(index)
    is_pairs = numbers.ndim in (1, 2) and numbers.shape[-1] == 2 and numbers.dtype.kind in "iu"
    return numbers if is_pairs else None


def _is_everything(index: Any) -> bool:
    return index is Ellipsis or (isinstance(index, slice) and index == slice(None))


def _pieces_of(domain: DomainData, pairs: Int64s, places: Floats) -> CubicPieces:
    """The curves between pairs of points (k, 2), and straight lines where there are none."""
    segment, is_reversed = _segments_between(domain, pairs)
    on_curve = (segment >= 0) & (domain.curved.segment_paths[segment] >= 0)
    chosen = np.zeros(len(domain.segments), bool)
    chosen[segment[on_curve]] = True
    turned = np.zeros(len(domain.segments), bool)
    turned[segment[on_curve & is_reversed]] = True
    curves = cubic_pieces(domain, chosen)
    turn = turned[curves.segments][:, None, None]
    ends = places[~on_curve]
    return CubicPieces(
        np.concatenate([ends, np.where(turn, curves.ends[:, ::-1], curves.ends)]),
        np.concatenate(
            [
                np.repeat(np.diff(ends, axis=1), 2, axis=1),
                np.where(turn, -curves.derivatives[:, ::-1], curves.derivatives),
            ]
        ),
        np.concatenate([segment[~on_curve], curves.segments]),
        np.concatenate([np.zeros(len(ends)), curves.heights]),
    )


def _segments_between(domain: DomainData, pairs: Int64s) -> tuple[Int64s, Bools]:
    """The segment of each pair of points, -1 for none, and whether it goes the other way."""
    n = len(domain.points)
    keys = edge_keys(domain.segments, n)
    order = np.argsort(keys)
    asked = edge_keys(pairs, n)
    at = np.minimum(np.searchsorted(keys, asked, sorter=order), len(keys) - 1)
    segment = np.where(keys[order[at]] == asked, order[at], -1)
    return segment, domain.segments[segment, 0] != pairs[:, 0]
