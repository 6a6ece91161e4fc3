"""Field points: ahead of a front, along long edges, and where both have missed something."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from adaptmesh._core import Mesher
from adaptmesh.boundary.edge_lengths import measure_fresh_edges, refresh
from adaptmesh.boundary.vertex_limit import Budget, Progress
from adaptmesh.types import Floats
from metrics import ControlSpace

PLACEMENTS = ("front", "edges")

# A sample with this many times the density sqrt(det M) of all corners of its triangle was missed.
FAR_FINER = 2.0


@dataclass(frozen=True)
class FrontPlacement:
    """How points are put ahead of the front.

    Attributes
    ----------
    accept : float
        A triangle ahead of the front whose other sides are no longer than this is kept as it is.
    spacing : float
        A point nearer than this to a vertex is refused, in metric length.
    target : float
        Length of the sides to be made; the front corrects it by up to 7 % so that the number of
        triangles it makes is what their metric area is worth.
    settled : float
        A point that would move less than this, in metric length, when its place is found anew with
        the metric there, stays.
    trials : int
        How often the metric is evaluated for the place of a point, at most.
    """

    accept: float = 1.35
    spacing: float = 0.8
    target: float = 1.0
    settled: float = 0.01
    trials: int = 3


@dataclass(frozen=True)
class EdgePlacement:
    """How field points are put along edges.

    Attributes
    ----------
    long_edge : float
        Metric length from which an edge is cut.
    spacing : float
        A field point nearer than this to a vertex is refused, in metric length.
    """

    long_edge: float = 1.45
    spacing: float = 0.75


def place_ahead_of_front(
    mesher: Mesher,
    field: ControlSpace,
    options: FrontPlacement,
    budget: Budget,
    report: Progress,
) -> None:
    """Build unit triangles layer by layer, until the front has met itself everywhere."""
    front = mesher.front(
        options.accept, options.spacing, options.target, options.settled, options.trials
    )
    while mesher.advance(front):
        while len(wanted := front.wanted()):
            front.feed(field(wanted))
        mesher.insert_ahead(front)
        budget.check(mesher.vertex_count)
        report("placing points", budget.progress(mesher.vertex_count))


def place_along_edges(
    mesher: Mesher,
    field: ControlSpace,
    options: EdgePlacement,
    budget: Budget,
    report: Progress,
) -> None:
    """Cut long edges, sweep after sweep, until none is left that takes a point.

    The points of a sweep are put in with the metric interpolated along their edge; then the metric
    is evaluated exactly at all of them at once.
    """
    while True:
        edges = measure_fresh_edges(mesher, field, options.long_edge)
        inserted = mesher.insert_along_edges(
            edges, options.long_edge, options.spacing, budget.max_vertices
        )
        if inserted < 0:
            budget.check(budget.max_vertices + 1)
        if not inserted:
            return
        budget.check(mesher.vertex_count)
        refresh(mesher, field)
        report("placing points", budget.progress(mesher.vertex_count))


class Samples(ControlSpace):
    """A control space that remembers where it was asked, and what it answered."""

    def __init__(self, field: ControlSpace) -> None:
        self._field = field
        self._points: list[Floats] = []
        self._tensors: list[Floats] = []

    def values(self, points: Floats) -> Floats:
        tensors = self._field(points)
        self._points.append(points)
        self._tensors.append(tensors)
        return tensors

    def taken(self) -> tuple[Floats, Floats]:
        """All points asked for, (n, 2), and the tensors there, (n, 3)."""
        return np.concatenate(self._points), np.concatenate(self._tensors)


def insert_what_was_missed(mesher: Mesher, samples: Samples) -> int:
    """Put points where the prediction saw the metric far finer than the mesh knows it.

    A layer thinner than an edge can pass between all the places where edges were measured; the
    quadrature of the complexity has looked elsewhere, and closely where the metric is large.
    """
    return mesher.insert_where_finer(*samples.taken(), FAR_FINER, EdgePlacement().spacing)
