"""Where in a file an error is."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager

from ..errors import FormatError


@contextmanager
def located(place: object) -> Iterator[None]:
    """Put the place in front of the message of a `FormatError` raised within."""
    try:
        yield
    except FormatError as error:
        raise FormatError(f"{place}: {error}") from None
