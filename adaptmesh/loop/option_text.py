"""What a loop was asked for, as text: the same for the same wish, however it was written."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import fields, is_dataclass
from typing import Any

import numpy as np


def option_as_text(option: Any) -> str:
    """An option in one form: 300 is 300.0, a list is a tuple, and mappings have no order."""
    if isinstance(option, (int, float, np.number)):
        return f"{float(option):.17g}"
    if isinstance(option, Mapping):
        return _joined({name: option[name] for name in sorted(option)})
    if is_dataclass(option):
        return _joined({field.name: getattr(option, field.name) for field in fields(option)})
    if isinstance(option, Sequence) and not isinstance(option, str):
        return ", ".join(map(option_as_text, option))
    return str(option)


def _joined(options: Mapping[str, Any]) -> str:
    return ", ".join(f"{name}={option_as_text(value)}" for name, value in options.items())
