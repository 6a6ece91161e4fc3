"""The figures of a report on a mesh, without the ways to show them."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any, NamedTuple

import numpy as np

from adaptmesh.types import Floats
from adaptmesh.value import Value

from .reasons import Reason

Point = tuple[float, float]


class Histogram(NamedTuple):
    """How many values lie between consecutive edges; each bin holds its lower edge."""

    edges: tuple[float, ...]
    counts: tuple[int, ...]

    @classmethod
    def of(cls, values: Floats, edges: Floats) -> Histogram:
        """Count values; the last bin holds its upper edge too."""
        counts = np.histogram(values, edges)[0]
        return cls(tuple(edges.tolist()), tuple(counts.tolist()))


class WorstEdge(NamedTuple):
    """An edge far from unit."""

    length: float
    vertices: tuple[int, int]
    start: Point
    end: Point
    reason: Reason


class WorstTriangle(NamedTuple):
    """A triangle far from equilateral in the metric."""

    quality: float
    triangle: int
    corners: tuple[Point, Point, Point]
    reason: Reason


@dataclass(frozen=True, eq=False)
class Figures(Value):
    """The figures of a `Report`, where each is explained."""

    length_rule: str
    n_points: int
    n_triangles: int
    n_edges: int
    unit_fraction: float
    short_fraction: float
    long_fraction: float
    efficiency_index: float
    efficiency_index_frey_george: float
    length_min: float
    length_mean: float
    length_max: float
    length_quantiles: Mapping[float, float]
    quality_min: float
    quality_p1: float
    quality_mean: float
    complexity: float
    ideal_triangles: float
    count_ratio: float
    length_histogram: Histogram
    quality_histogram: Histogram
    worst_edges: tuple[WorstEdge, ...]
    worst_triangles: tuple[WorstTriangle, ...]
    border: str

    def as_dict(self) -> dict[str, Any]:
        """Everything in dicts, lists, numbers and strings, ready for JSON; infinity is None."""
        return {name: _plain(value) for name, value in vars(self).items()}


def _plain(value: Any) -> Any:
    """A value without numpy types, tuples and infinities."""
    if isinstance(value, Mapping):
        return {str(key): _plain(item) for key, item in value.items()}
    if hasattr(value, "_asdict"):
        return _plain(value._asdict())
    if isinstance(value, tuple):
        return [_plain(item) for item in value]
    return None if value == float("inf") else value
