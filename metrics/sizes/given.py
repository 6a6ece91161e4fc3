"""What users give: numbers checked by name, functions called and their results checked."""

from __future__ import annotations

from collections.abc import Callable
from numbers import Real
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from metrics.checks import as_numbers
from metrics.errors import AdaptmeshError, MetricError
from metrics.types import Floats

__all__ = ["chosen", "evaluated", "h_limit", "number", "positive"]


def number(name: str, value: Any, *, least: float = -np.inf) -> float:
    """A finite real number, not below `least`."""
    if not isinstance(value, Real) or isinstance(value, (bool, np.bool_)):
        raise MetricError(f"{name} must be a number, not {value!r}")
    out = float(value)
    if not np.isfinite(out) or out < least:
        bound = "" if least == -np.inf else f" and not below {least:g}"
        raise MetricError(f"{name} must be finite{bound}, not {value!r}")
    return out


def positive(name: str, value: Any) -> float:
    """A finite number above 0."""
    if number(name, value) <= 0:
        raise MetricError(f"{name} must be positive, not {value!r}")
    return float(value)


def h_limit(h_max: Any, name: str, smallest: float) -> float:
    """The largest size, which may be infinite; not below the one called `name`."""
    if h_max == np.inf:
        return np.inf
    if positive("h_max", h_max) < smallest:
        raise MetricError(f"h_max = {h_max!r} is smaller than {name} = {smallest!r}")
    return float(h_max)


def chosen(name: str, value: Any, choices: tuple[str, ...]) -> Any:
    """One of some words."""
    if not isinstance(value, str) or value not in choices:
        raise MetricError(f"{name} must be one of {', '.join(map(repr, choices))}, not {value!r}")
    return value


def evaluated(
    function: Callable[[Floats], ArrayLike], points: Floats, columns: tuple[int, ...], what: str
) -> Floats:
    """A user's function of points (n, 2): finite numbers (n, *columns), or an error with `what`."""
    try:
        result = function(points.copy())
    except AdaptmeshError:
        raise
    except Exception as error:
        raise MetricError(
            f"{what} raised {type(error).__name__} when called with points of shape "
            f"{points.shape}: {error}"
        ) from error
    out = np.ascontiguousarray(as_numbers(result, what), np.float64)
    wanted = (len(points), *columns)
    if out.shape != wanted:
        raise MetricError(f"{what} must return an array of shape {wanted}, not {out.shape}")
    finite = np.isfinite(out).all(axis=tuple(range(1, out.ndim)))
    if not finite.all():
        i = int(np.argmin(finite))
        x, y = points[i].tolist()
        raise MetricError(f"{what} at point {i} ({x!r}, {y!r}) is not finite: {out[i].tolist()}")
    return out
