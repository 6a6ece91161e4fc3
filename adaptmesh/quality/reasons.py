"""Why an edge is not unit, or a triangle is bad: criteria that are measured, in order.

A unit edge is from 1/√2 to √2 long; the flattest triangle of unit sides (√2, √2, 1/√2) has an angle
of 29°. The reasons name what prevents that.
"""

from __future__ import annotations

from collections.abc import Sequence
from enum import Enum
from functools import cached_property
from typing import NamedTuple

import numpy as np

import metrics
from adaptmesh.mesh.mesh import Mesh
from adaptmesh.text import place_text
from adaptmesh.types import Bools, Floats
from metrics import ControlSpace
from metrics.measure.exact import edge_lengths
from metrics.topology import mesh_edges

__all__ = ["Cause", "Reason", "Reasons"]


SAMPLES = 33  # along an edge
HALVINGS = 12  # of the interval between two samples in which a jump is looked for
JUMP = 1.5  # sizes that change by this factor over a 4096th of a sample's distance have jumped
TURNED = 2.0  # sizes that change by this factor within an edge are not resolved
SHARPEST_UNIT = 2 * np.arcsin(0.25)  # 29°, the smallest angle of a triangle of unit sides
SHORTEST = 2**-0.5


class Cause(str, Enum):
    """Why something could not be met."""

    CONSTRAINT = "short constraint"
    SHARP_ANGLE = "sharp angle"
    CROWDED = "crowded constraints"
    JUMP = "metric jump"
    UNRESOLVED = "unresolved metric"
    UNKNOWN = "no reason found"
    MET = "as asked"


class Reason(NamedTuple):
    """Why something could not be met, and the measurement that says so."""

    cause: Cause
    detail: str

    def __str__(self) -> str:
        return f"{self.cause.value}: {self.detail}"


class Reasons:
    """Finds reasons for edges and triangles of one mesh in one metric."""

    def __init__(self, mesh: Mesh, field: ControlSpace) -> None:
        self._mesh, self._field = mesh, field

    @cached_property
    def _constrained(self) -> set[tuple[int, int]]:
        """The edges on constraints and on the border; found when a first reason is asked for."""
        all_edges, sides = mesh_edges(self._mesh.triangles)
        border = all_edges[np.bincount(sides.ravel(), minlength=len(all_edges)) == 1]
        return {_key(a, b) for a, b in [*self._mesh.edges.tolist(), *border.tolist()]}

    @cached_property
    def _held(self) -> Bools:
        """Which vertices are on these."""
        held = np.zeros(len(self._mesh.points), dtype=bool)
        held[np.array(list(self._constrained), dtype=np.intp).ravel()] = True
        return held

    def of_edge(self, a: int, b: int) -> Reason:
        """Why the edge between two vertices is not unit."""
        return (
            self._constraint([(a, b)])
            or self._crowded((a, b))
            or self._jump([(a, b)])
            or self._unresolved([(a, b)])
            or UNKNOWN
        )

    def of_triangle(self, vertices: Sequence[int]) -> Reason:
        """Why the triangle of these vertices is bad."""
        a, b, c = vertices
        sides = [(b, c), (c, a), (a, b)]
        return (
            self._sharp_angle(vertices)
            or self._constraint(sides)
            or self._jump(sides)
            or self._unresolved(sides)
            or self._crowded(vertices)
            or UNKNOWN
        )

    def _length(self, a: int, b: int) -> float:
        edge = np.array([[a, b]])
        return float(edge_lengths(self._mesh.points, edge, self._field)[0])

    def _constraint(self, edges: list[tuple[int, int]]) -> Reason | None:
        """A piece of a segment that is shorter than unit: nothing may be left out of it."""
        for a, b in edges:
            if _key(a, b) in self._constrained and (length := self._length(a, b)) < SHORTEST:
                return Reason(
                    Cause.CONSTRAINT,
                    f"the segment from {self._at(a, b)} to {self._at(b, a)} is {length:.3g} units "
                    "long",
                )
        return None

    def _crowded(self, vertices: Sequence[int]) -> Reason | None:
        """All corners are on constraints, which are nearer to each other than a unit or two."""
        if not self._held[list(vertices)].all():
            return None
        lengths = [self._length(a, b) for a in vertices for b in vertices if a < b]
        return Reason(
            Cause.CROWDED,
            f"all its corners are on constraints, {min(lengths):.3g} units from each other",
        )

    def _sharp_angle(self, vertices: Sequence[int]) -> Reason | None:
        """Two sides are constraints, with an angle no triangle of unit sides has."""
        for i in range(3):
            v, p, q = vertices[i], vertices[i - 2], vertices[i - 1]
            if _key(v, p) in self._constrained and _key(v, q) in self._constrained:
                x = self._mesh.points
                m = self._field(x[[v]])
                u, w = x[p] - x[v], x[q] - x[v]
                angle = _angle(metrics.tensor.unpack(m)[0], u, w)
                if angle < SHARPEST_UNIT:
                    return Reason(
                        Cause.SHARP_ANGLE,
                        f"at {self._at(v, p)} the constraints meet at {np.degrees(angle):.3g}° "
                        "in the metric",
                    )
        return None

    def _logs(self, a: int, b: int, t: Floats) -> Floats:
        x = self._mesh.points
        return metrics.tensor.log(self._field((1 - t)[:, None] * x[a] + t[:, None] * x[b]))

    def _jump(self, edges: list[tuple[int, int]]) -> Reason | None:
        """However short a piece of the edge, the metric at its two ends differs."""
        for a, b in edges:
            t = np.linspace(0, 1, SAMPLES)
            logs = self._logs(a, b, t)
            i = int(np.argmax(_changes(logs[1:], logs[:-1])))
            low, high, at_low, at_high = t[i], t[i + 1], logs[[i]], logs[[i + 1]]
            for _ in range(HALVINGS):
                middle = (low + high) / 2
                at_middle = self._logs(a, b, np.array([middle]))
                if _changes(at_low, at_middle) > _changes(at_middle, at_high):
                    high, at_high = middle, at_middle
                else:
                    low, at_low = middle, at_middle
            factor = float(np.exp(_changes(at_low, at_high)[0]))
            if factor > JUMP:
                ends = self._mesh.points[[a, b]]
                place = place_text((1 - low) * ends[0] + low * ends[1], _extent(ends))
                return Reason(Cause.JUMP, f"sizes jump by a factor of {factor:.3g} at {place}")
        return None

    def _unresolved(self, edges: list[tuple[int, int]]) -> Reason | None:
        """The metric changes, or turns, far within the edge."""
        largest = 0.0
        for a, b in edges:
            logs = self._logs(a, b, np.linspace(0, 1, SAMPLES))
            largest = max(largest, float(_changes(logs, logs[[SAMPLES // 2]]).max()))
        if np.exp(largest) < TURNED:
            return None
        return Reason(Cause.UNRESOLVED, f"within an edge sizes change by {np.exp(largest):.3g}")

    def _at(self, v: int, other: int) -> str:
        """The place of a vertex, told from another."""
        return place_text(self._mesh.points[v], _extent(self._mesh.points[[v, other]]))


MET = Reason(Cause.MET, "there is nothing to explain")
UNKNOWN = Reason(Cause.UNKNOWN, "nothing in the domain or the metric stands against it")


def _extent(points: Floats) -> float:
    return float(np.ptp(points, axis=0).max())


def _key(a: int, b: int) -> tuple[int, int]:
    return (int(a), int(b)) if a < b else (int(b), int(a))


def _changes(logs: Floats, others: Floats) -> Floats:
    """Logarithms of the largest ratio of sizes, to first order, between two rows of log-metrics."""
    d = logs - others
    mean, deviation = (d[:, 0] + d[:, 2]) / 2, np.hypot((d[:, 0] - d[:, 2]) / 2, d[:, 1])
    return 0.5 * (np.abs(mean) + deviation)


def _angle(m: Floats, u: Floats, w: Floats) -> float:
    """The angle between two vectors in a constant metric."""
    area = np.sqrt(np.linalg.det(m)) * abs(u[0] * w[1] - u[1] * w[0])
    return float(np.arctan2(area, u @ m @ w))
