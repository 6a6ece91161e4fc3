"""An object of JSON from a file that nobody has checked."""

from __future__ import annotations

from dataclasses import fields
from typing import Any

from adaptmesh.errors import FormatError


class Notes:
    """An object of JSON whose values are checked when they are asked for."""

    def __init__(self, content: Any) -> None:
        if not isinstance(content, dict):
            raise FormatError(f"expected an object of JSON, got {content!r:.60}")
        self._content: dict[str, Any] = content

    def __contains__(self, key: str) -> bool:
        return key in self._content

    def is_null(self, key: str) -> bool:
        return self._content.get(key) is None

    def _value(self, key: str, kinds: tuple[type, ...], what: str) -> Any:
        value = self._content.get(key)
        if type(value) not in kinds:
            raise FormatError(f"{key!r} is {value!r:.60}, not {what}")
        return value

    def text(self, key: str) -> str:
        return str(self._value(key, (str,), "a text"))

    def flag(self, key: str) -> bool:
        return bool(self._value(key, (bool,), "true or false"))

    def real(self, key: str) -> float:
        return float(self._value(key, (int, float), "a number"))

    def count(self, key: str) -> int:
        return _count(key, self._content.get(key))

    def counts(self, key: str) -> list[int]:
        return [_count(key, value) for value in self.items(key)]

    def items(self, key: str) -> list[Any]:
        return list(self._value(key, (list,), "a list"))

    def names(self, key: str) -> list[str]:
        """A list of texts, none of them twice."""
        names = self.items(key)
        for k, name in enumerate(names):
            if type(name) is not str or name in names[:k]:
                raise FormatError(f"{key!r} has {name!r:.60}, not a text or there before")
        return names

    def within(self, key: str) -> Notes:
        return Notes(self._value(key, (dict,), "an object"))

    def texts(self, key: str) -> dict[str, str]:
        inner = self.within(key)
        return {name: inner.text(name) for name in inner._content}

    def reals(self, key: str) -> dict[str, float]:
        inner = self.within(key)
        return {name: inner.real(name) for name in inner._content}

    def numbers(self, key: str) -> dict[str, int]:
        inner = self.within(key)
        return {name: int(inner._value(name, (int,), "a whole number")) for name in inner._content}

    def record(self, key: str, kind: type[Any]) -> Any:
        """A dataclass of reals."""
        inner = self.within(key)
        return kind(**{field.name: inner.real(field.name) for field in fields(kind)})


def _count(key: str, value: Any) -> int:
    if type(value) is not int or value < 0:
        raise FormatError(f"{key!r} is {value!r:.60}, not a count")
    return value
