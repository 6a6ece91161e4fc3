"""Options that are numbers or functions: refused by name where they are not."""

from __future__ import annotations

from numbers import Real
from typing import Any


def expect_number(name: str, value: Any) -> None:
    """A `TypeError` for what is no real number."""
    if not isinstance(value, Real) or isinstance(value, bool):
        raise TypeError(f"{name}={value!r}: a number is wanted")


def expect_whole(name: str, value: Any, least: int) -> None:
    """Also a `ValueError` for what is not whole, or less than the least."""
    expect_number(name, value)
    if not value >= least or value != int(value):
        raise ValueError(f"{name}={value!r}: a whole number from {least} on is wanted")


def expect_function(name: str, value: Any) -> None:
    """A `TypeError` for what cannot be called; None stands for one that need not be given."""
    if value is not None and not callable(value):
        raise TypeError(f"{name} must be a function, not {type(value).__name__}")
