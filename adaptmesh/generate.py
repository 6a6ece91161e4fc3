"""From a domain and a metric to a mesh."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

import numpy as np

import metrics
from metrics import ControlSpace
from numpy.typing import NDArray

from . import _core
from .boundary import Outline, cut_segments, measure_edges
from .domain import Domain
from .errors import BudgetError, DomainError
from .mesh import Mesh

Floats = NDArray[np.float64]
Progress = Callable[[str, float], None]

# A sample with this many times the density sqrt(det M) of all corners of its triangle was missed.
FAR_FINER = 2.0

PLACEMENTS = ("front", "edges")


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

    long_edge: float = 1.5
    spacing: float = 0.75


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
    trials : int
        How often the place of a point is found anew with the metric at the place before.
    """

    accept: float = 1.35
    spacing: float = 0.8
    target: float = 1.0
    trials: int = 2


@dataclass(frozen=True)
class Optimisation:
    """How the filled mesh is improved.

    Attributes
    ----------
    smoothings : int
        Passes of smoothing over all vertices.
    wide_rounds, narrow_rounds : int
        Rounds of collapse, split, swap and search where edges are not nearly, and then where they
        are hardly unit.
    wide, narrow : (shortest, longest, least quality)
        What these rounds leave alone: vertices that touch only such edges and triangles.
    step : float
        First step of the search, in metric length.
    swap_below : float
        At last, edges beside triangles of lesser quality are swapped for shape.
    """

    smoothings: int = 2
    wide_rounds: int = 2
    narrow_rounds: int = 4
    wide: tuple[float, float, float] = (0.8, 1.25, 0.6)
    narrow: tuple[float, float, float] = (0.74, 1.36, 0.5)
    step: float = 0.12
    swap_below: float = 0.5


def generate(
    domain: Domain,
    metric: Any,
    *,
    placement: str = "front",
    max_vertices: int = 5_000_000,
    progress: Progress | None = None,
) -> Mesh:
    """Mesh a domain so that all edges have unit length in a metric.

    Parameters
    ----------
    domain : Domain
    metric : number, callable, or control space
        A size h; or a function of an (n, 2) array of points that returns sizes (n,), packed metrics
        (n, 3) = (m11, m12, m22) or tensors (n, 2, 2); or anything made by `metrics`.
    placement : {"front", "edges"}
        How points are placed. ``"front"``: so as to make unit triangles, layer after layer from the
        constraints inwards, and along edges where that leaves gaps. ``"edges"``: only along edges
        longer than unit, at equal metric shares (Borouchaki and George).
    max_vertices : int
        The largest mesh allowed. More is refused before anything is built, with the prediction.
    progress : callable, optional
        Called as ``progress(stage, fraction)`` with the name of the stage at work and how much of
        all the work is done, from 0 to 1. An exception from it ends the work.

    Returns
    -------
    Mesh

    Raises
    ------
    MetricError
        The metric is not finite, not positive definite, or has the wrong shape somewhere.
    BudgetError
        The mesh would have more than `max_vertices` vertices.
    """
    if not isinstance(domain, Domain):
        raise DomainError(f"a Domain is wanted, not {type(domain).__name__}: see adaptmesh.Domain")
    if placement not in PLACEMENTS:
        raise ValueError(f"placement={placement!r} is none of {', '.join(map(repr, PLACEMENTS))}")
    report = progress or (lambda stage, fraction: None)
    field = metrics.as_control_space(metric)

    report("predicting the size", 0.0)
    samples = Samples(field)
    expected = _check_budget(domain, samples, max_vertices)
    report("cutting the boundary", 0.02)
    outline = cut_segments(domain, field, max_vertices)
    mesher = triangulate_outline(domain, outline)
    report("placing points", 0.05)
    if placement == "front":
        place_ahead_of_front(mesher, field, FrontPlacement(), max_vertices, expected, report)
    place_along_edges(mesher, field, EdgePlacement(), max_vertices, expected, report)
    if insert_what_was_missed(mesher, samples):
        place_along_edges(mesher, field, EdgePlacement(), max_vertices, expected, report)
    optimise(mesher, field, Optimisation(), report)
    report("done", 1.0)
    return finished_mesh(domain, outline, mesher)


def predict(domain: Domain, metric: Any) -> int:
    """The number of vertices that a mesh of the domain will have, before it is made.

    (2/sqrt 3) C + B/2 + 1, what a hexagonal lattice of unit edges would have: C is the complexity,
    the integral of sqrt(det M), and B the metric length of the boundary. To about 5 %, except for
    meshes of a few triangles; features far below their surroundings may hide from it.
    """
    field = metrics.as_control_space(metric)
    complexity = metrics.complexity(domain.points, domain.triangles, field).value
    boundary = metrics.edge_lengths(domain.points, domain.segments[domain.boundary], field).sum()
    return max(len(domain.points), int(2 / np.sqrt(3) * complexity + boundary / 2) + 1)


def _check_budget(domain: Domain, field: ControlSpace, max_vertices: int) -> int:
    expected = predict(domain, field)
    if expected > max_vertices:
        raise BudgetError(
            f"the mesh would have about {expected:.3g} vertices, but max_vertices is "
            f"{max_vertices:,}: ask for larger sizes, or allow more"
        )
    return expected


def triangulate_outline(domain: Domain, outline: Outline) -> _core.Mesher:
    """The constrained Delaunay triangulation of the cut boundary, without the outside."""
    return _core.Mesher(
        outline.points,
        outline.tensors,
        outline.held_by,
        outline.pieces,
        domain.holes,
        domain.seeds,
        domain.nesting,
    )


def place_ahead_of_front(
    mesher: _core.Mesher,
    field: ControlSpace,
    options: FrontPlacement,
    max_vertices: int,
    expected: int,
    report: Progress,
) -> None:
    """Build unit triangles layer by layer, until the front has met itself everywhere."""
    front = mesher.front(options.accept, options.spacing, options.target)
    while mesher.advance(front):
        for _ in range(options.trials):
            front.refine(field(front.wanted()))
        mesher.insert_ahead(front, field(front.wanted()))
        _check_size(mesher, max_vertices, expected)
        report("placing points", min(0.7, 0.05 + 0.65 * mesher.vertex_count / max(expected, 1)))


def place_along_edges(
    mesher: _core.Mesher,
    field: ControlSpace,
    options: EdgePlacement,
    max_vertices: int,
    expected: int,
    report: Progress,
) -> None:
    """Cut long edges, sweep after sweep, until none is left that takes a point.

    The points of a sweep are put in with the metric interpolated along their edge; then the metric
    is evaluated exactly at all of them at once.
    """
    while True:
        before = mesher.vertex_count
        edges = measure_fresh_edges(mesher, field, options.long_edge)
        mesher.insert_along_edges(edges, options.long_edge, options.spacing, max_vertices)
        if mesher.vertex_count == before:
            return
        _check_size(mesher, max_vertices, expected)
        refresh(mesher, field)
        report("placing points", min(0.7, 0.05 + 0.65 * mesher.vertex_count / max(expected, 1)))


def _check_size(mesher: _core.Mesher, max_vertices: int, expected: int) -> None:
    if mesher.vertex_count >= max_vertices:
        raise BudgetError(
            f"the mesh has reached max_vertices = {max_vertices:,} and is not yet fine enough "
            f"(about {expected:,} vertices were predicted): ask for larger sizes, or allow more"
        )


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


def insert_what_was_missed(mesher: _core.Mesher, samples: Samples) -> int:
    """Put points where the prediction saw the metric far finer than the mesh knows it.

    A layer thinner than an edge can pass between all the places where edges were measured; the
    quadrature of the complexity has looked elsewhere, and closely where the metric is large.
    """
    return mesher.insert_where_finer(*samples.taken(), FAR_FINER, EdgePlacement().spacing)


def refresh(mesher: _core.Mesher, field: ControlSpace) -> None:
    """Evaluate the metric where vertices are new or have moved."""
    mesher.set_stale_metrics(field(mesher.stale_points()))


def measure_fresh_edges(
    mesher: _core.Mesher, field: ControlSpace, uncut_below: float
) -> _core.EdgesToMeasure:
    """Measure the edges that have changed, and let the mesher know where its lengths are off."""
    edges = mesher.fresh_edges(uncut_below)
    measure_edges(edges.sampler, field)
    mesher.correct_lengths(edges)
    return edges


def optimise(
    mesher: _core.Mesher, field: ControlSpace, options: Optimisation, report: Progress
) -> None:
    """Smooth and swap everywhere, then work on what is not yet unit."""
    bands = [options.wide] * options.wide_rounds + [options.narrow] * options.narrow_rounds
    steps = options.smoothings + len(bands)
    mesher.swap()
    for k in range(options.smoothings):
        report("smoothing", 0.7 + 0.3 * k / steps)
        mesher.smooth()
        refresh(mesher, field)
        mesher.swap()
    for k, band in enumerate(bands):
        report("improving", 0.7 + 0.3 * (options.smoothings + k) / steps)
        measure_fresh_edges(mesher, field, uncut_below=np.inf)
        changes = mesher.collapse_short_edges() + mesher.split_long_edges()
        refresh(mesher, field)
        mesher.swap()
        changes += mesher.search_active(*band, options.step)
        if not changes:
            break
        refresh(mesher, field)
        mesher.swap()
    mesher.swap_worst(options.swap_below)
    mesher.compact()


def finished_mesh(domain: Domain, outline: Outline, mesher: _core.Mesher) -> Mesh:
    edges, piece_segment = mesher.constrained_edges()
    return Mesh(
        points=mesher.points(),
        triangles=mesher.triangles(),
        regions=domain.region_of_label(mesher.labels()),
        edges=edges,
        edge_tags=domain.segment_tags[outline.segment[piece_segment]],
        names=domain.names,
        region_names=domain.region_names,
        domain=domain,
    )
