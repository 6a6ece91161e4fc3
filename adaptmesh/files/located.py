"""Errors in files: where they are, and what comes of exceptions that are not ours."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager

from adaptmesh.errors import AdaptmeshError, FormatError


@contextmanager
def located(place: object, kind: type[AdaptmeshError] = FormatError) -> Iterator[None]:
    """Put the place in front of the message of an error of that kind raised within."""
    try:
        yield
    except kind as error:
        raise type(error)(f"{place}: {error}") from None


@contextmanager
def refusing(what: object) -> Iterator[None]:
    """Make a `FormatError` of whatever a library raises on a damaged file."""
    try:
        yield
    except (AdaptmeshError, Warning):
        raise
    except Exception as error:
        raise FormatError(f"{what}: {error}") from None


@contextmanager
def only_our_errors(path: object) -> Iterator[None]:
    """Make a `FormatError` of whatever no reader has foreseen in a file.

    The last line of defence, around every function that reads a file: the exception becomes the
    ``__cause__``, by which tests find that a reader has to be mended.
    """
    try:
        yield
    except (AdaptmeshError, Warning):
        raise
    except Exception as error:
        kind = type(error).__name__
        raise FormatError(
            f"{path}: is damaged, or not what its suffix says: {kind}: {error}"
        ) from error
