"""Errors in files: where they are, and those of libraries that do not look before they read."""

from __future__ import annotations

import struct
from collections.abc import Iterator
from contextlib import contextmanager

from ..errors import AdaptmeshError, FormatError

_OF_DAMAGE = (
    ValueError, TypeError, LookupError, AttributeError, ArithmeticError, RuntimeError, OSError,
    struct.error,
)  # fmt: skip
"""What libraries raise where a damaged file is not what they take it for."""


@contextmanager
def located(place: object, kind: type[AdaptmeshError] = FormatError) -> Iterator[None]:
    """Put the place in front of the message of an error of that kind raised within."""
    try:
        yield
    except kind as error:
        raise type(error)(f"{place}: {error}") from None


@contextmanager
def refusing(what: object, *errors: type[Exception]) -> Iterator[None]:
    """Make a `FormatError` of what a library raises on a damaged file, and of `errors`."""
    try:
        yield
    except AdaptmeshError:
        raise
    except _OF_DAMAGE + errors as error:
        raise FormatError(f"{what}: {error}") from None
