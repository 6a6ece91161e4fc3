"""The errors that this package raises on purpose; each message names the item and the remedy."""

from __future__ import annotations

from metrics.errors import AdaptmeshError, MetricError

__all__ = [
    "AdaptmeshError",
    "BudgetError",
    "DomainError",
    "FormatError",
    "FormatWarning",
    "MetricError",
    "TransferError",
]


class DomainError(AdaptmeshError, ValueError):
    """A domain that cannot be meshed as it is: where it is wrong, and what to do."""


class BudgetError(AdaptmeshError):
    """The mesh asked for would be larger than allowed; the message holds the prediction."""


class FormatError(AdaptmeshError, OSError):
    """A file that cannot be read or written: which one, where, and why."""


class FormatWarning(UserWarning):
    """What of a file, or of features, is passed over in reading, or cannot be kept in writing."""


class TransferError(AdaptmeshError, ValueError):
    """A field that cannot be carried to another mesh: wrong length, not finite, or too far away."""
