"""Frozen objects that are equal if their contents are, and stay frozen when copied or unpickled."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import is_dataclass
from functools import cached_property
from typing import Any, TypeVar

import numpy as np

K = TypeVar("K")
V = TypeVar("V")


class FrozenMapping(Mapping[K, V]):
    """A read-only copy of a mapping; unlike ``types.MappingProxyType`` it can be pickled."""

    __slots__ = ("_items",)

    def __init__(self, items: Mapping[K, V] = {}) -> None:
        self._items: dict[K, V] = dict(items)

    def __getitem__(self, key: K) -> V:
        return self._items[key]

    def __iter__(self) -> Iterator[K]:
        return iter(self._items)

    def __len__(self) -> int:
        return len(self._items)

    def __or__(self, other: Mapping[K, V]) -> dict[K, V]:
        return {**self, **other}

    def __repr__(self) -> str:
        return repr(self._items)


class Value:
    """Base of frozen objects: compared, hashed, copied and pickled by their contents.

    Cached properties are not contents: they are computed again in a copy. Arrays are read-only in
    a copy, as in the original.
    """

    def __eq__(self, other: object) -> bool:
        if self is other:
            return True
        return same(self, other) if type(self) is type(other) else NotImplemented

    def __hash__(self) -> int:
        parts = [v.shape if isinstance(v, np.ndarray) else type(v) for v in contents(self).values()]
        return hash((type(self), *parts))

    def __getstate__(self) -> dict[str, Any]:
        return contents(self)

    def __setstate__(self, state: dict[str, Any]) -> None:
        for value in state.values():
            if isinstance(value, np.ndarray):
                value.flags.writeable = False
        self.__dict__.update(state)


def contents(value: object) -> dict[str, Any]:
    """The attributes of an object without those that are cached properties."""
    cls = type(value)
    return {
        name: item
        for name, item in vars(value).items()
        if not isinstance(getattr(cls, name, None), cached_property)
    }


def same(a: Any, b: Any) -> bool:
    """Whether two objects have the same contents; NaN is the same as NaN."""
    if a is b:
        return True
    if isinstance(a, np.ndarray) and isinstance(b, np.ndarray):
        return _same_arrays(a, b)
    if isinstance(a, Mapping) and isinstance(b, Mapping):
        return a.keys() == b.keys() and all(same(a[key], b[key]) for key in a)
    if type(a) is not type(b):
        return False
    if isinstance(a, (tuple, list)):
        return len(a) == len(b) and all(map(same, a, b))
    if isinstance(a, (float, np.floating)):
        return bool(a == b or (a != a and b != b))
    if isinstance(a, Value) or is_dataclass(a):
        return same(contents(a), contents(b))
    return bool(a == b)


def _same_arrays(a: np.ndarray[Any, Any], b: np.ndarray[Any, Any]) -> bool:
    if a.shape != b.shape or a.dtype != b.dtype:
        return False
    return np.array_equal(a, b, equal_nan=a.dtype.kind in "fc")
