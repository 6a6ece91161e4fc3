"""From a domain and a metric to a mesh."""

from __future__ import annotations

import operator
from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

import metrics
from metrics import ControlSpace

from . import _core
from .boundary import Outline, cut_outline
from .domain import Domain
from .edge_lengths import measure_edges
from .errors import BudgetError
from .mesh import Mesh
from .prediction import check_is_domain, predict

Floats = NDArray[np.float64]
Ints = NDArray[np.int32]
Progress = Callable[[str, float], None]

# A sample with this many times the density sqrt(det M) of all corners of its triangle was missed.
FAR_FINER = 2.0

# The points of the domain are triangulated for the Euclidean plane; under a slanted and strongly
# anisotropic metric it can take many passes of swaps until that is metric Delaunay. Most need two.
OUTLINE_SWAPS = 200

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

    long_edge: float = 1.45
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


@dataclass(frozen=True)
class Settling:
    """How the last edges and triangles are mended, each change being measured before it is made.

    Attributes
    ----------
    steps : tuple of float
        One round for each: how far vertices are tried to be moved, as a share of the way to the
        rim of their triangles.
    least_quality : float
        Triangles of lesser quality are worked on, besides edges that are not unit.
    most_places, most_places_share : int, float
        If there are more places to work on than the one plus this share of the vertices, nothing is
        done: then the metric is beyond what straight edges can follow, and they are no exceptions.
    lifts : int
        Rounds in which the worst triangles are made better, at the most.
    lift_below : float
        Those of lesser quality.
    most_lifted, most_lifted_share : int, float
        And no more of them at a time than the one plus this share of the vertices.
    """

    steps: tuple[float, ...] = (0.3, 0.15, 0.3, 0.15, 0.3, 0.15)
    least_quality: float = 0.6
    most_places: int = 1000
    most_places_share: float = 0.125
    lifts: int = 6
    lift_below: float = 0.8
    most_lifted: int = 20
    most_lifted_share: float = 0.004


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
    check_is_domain(domain)
    if placement not in PLACEMENTS:
        raise ValueError(f"placement={placement!r} is none of {', '.join(map(repr, PLACEMENTS))}")
    report = progress or (lambda stage, fraction: None)
    field = metrics.as_control_space(metric)

    report("predicting the size", 0.0)
    samples = Samples(field)
    budget = Budget(max_vertices, predict(domain, samples))
    budget.check_prediction()
    report("cutting the boundary", 0.02)
    outline = cut_outline(domain, field, budget.max_vertices)
    mesher = triangulate_outline(domain, outline)
    report("placing points", 0.05)
    if placement == "front":
        place_ahead_of_front(mesher, field, FrontPlacement(), budget, report)
    place_along_edges(mesher, field, EdgePlacement(), budget, report)
    if insert_what_was_missed(mesher, samples):
        place_along_edges(mesher, field, EdgePlacement(), budget, report)
    optimise(mesher, field, Optimisation(), budget, report)
    report("settling", 0.97)
    settle(mesher, field, Settling(), budget)
    mesher.compact()
    report("done", 1.0)
    return finished_mesh(domain, mesher, domain.region_of_label(mesher.labels()))


@dataclass(frozen=True)
class Budget:
    """How many vertices a mesh may have, and is expected to have."""

    max_vertices: int
    expected: int

    def __post_init__(self) -> None:
        try:
            most = operator.index(self.max_vertices)
        except TypeError:
            raise TypeError(f"max_vertices must be an integer, not {self.max_vertices!r}") from None
        if most < 3:
            raise ValueError(f"max_vertices={most}: the smallest mesh has 3 vertices")
        object.__setattr__(self, "max_vertices", min(most, _core.MAX_VERTICES))

    def check_prediction(self) -> None:
        """Refuse what is expected to be too large."""
        if self.expected > self.max_vertices:
            raise BudgetError(
                f"the mesh would have about {self.expected:.3g} vertices, but max_vertices is "
                f"{self.max_vertices:,}: ask for larger sizes, or allow more"
            )

    def check(self, n_vertices: int) -> None:
        """Stop what has become too large although it was not expected to."""
        if n_vertices > self.max_vertices:
            raise BudgetError(
                f"the mesh needs more than max_vertices = {self.max_vertices:,} vertices (about "
                f"{self.expected:,} were predicted): ask for larger sizes, or allow more"
            )

    def progress(self, n_vertices: int) -> float:
        """How much of the work of placing points is behind us, as a share of all work."""
        return min(0.7, 0.05 + 0.65 * n_vertices / max(self.expected, 1))


def triangulate_outline(domain: Domain, outline: Outline) -> _core.Mesher:
    """The constrained triangulation of the outline's points, then of its cuts: metric Delaunay.

    A cut of a curve is off the chord that it divides, and can be hidden from it by triangles that
    lie between. A span with such a cut is triangulated with all its cuts in another attempt.
    """
    while True:
        mesher = _core.Mesher(
            outline.points,
            outline.tensors,
            outline.segments,
            domain.holes,
            domain.seeds,
            domain.nesting,
        )
        mesher.swap(most_passes=OUTLINE_SWAPS)
        complete = mesher.cut_outline(
            outline.pieces,
            outline.piece_segments,
            outline.cuts,
            outline.cut_tensors,
            outline.piece,
        )
        hidden = outline.is_span & ~complete
        if not hidden.any():
            return mesher
        outline = outline.divided(hidden)


def place_ahead_of_front(
    mesher: _core.Mesher,
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
    mesher: _core.Mesher,
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
    mesher: _core.Mesher,
    field: ControlSpace,
    options: Optimisation,
    budget: Budget,
    report: Progress,
) -> None:
    """Smooth and swap everywhere, then work on what is not yet unit."""
    bands = [options.wide] * options.wide_rounds + [options.narrow] * options.narrow_rounds
    steps = options.smoothings + len(bands)
    mesher.swap()
    for k in range(options.smoothings):
        report("smoothing", 0.7 + 0.27 * k / steps)
        mesher.smooth()
        refresh(mesher, field)
        mesher.swap()
    for k, band in enumerate(bands):
        report("improving", 0.7 + 0.27 * (options.smoothings + k) / steps)
        measure_fresh_edges(mesher, field, uncut_below=np.inf)
        changes = mesher.collapse_short_edges() + mesher.split_long_edges()
        budget.check(mesher.vertex_count)
        refresh(mesher, field)
        mesher.swap()
        changes += mesher.search_active(*band, options.step)
        if not changes:
            break
        refresh(mesher, field)
        mesher.swap()
    mesher.swap_worst(options.swap_below)


def settle(mesher: _core.Mesher, field: ControlSpace, options: Settling, budget: Budget) -> None:
    """Change what is still off where the change, measured with the exact metric, is better."""
    measure_fresh_edges(mesher, field, uncut_below=np.inf)
    settler = mesher.settler(options.least_quality)
    for step in options.steps:
        places = mesher.find_sites(settler)
        most = options.most_places + options.most_places_share * mesher.vertex_count
        if places > most:
            return
        if not places or not settle_sites(mesher, settler, field, step):
            break
        budget.check(mesher.vertex_count)
    for _ in range(options.lifts):
        most_lifted = int(options.most_lifted + options.most_lifted_share * mesher.vertex_count)
        places = mesher.find_worst(settler, options.lift_below, most_lifted)
        if not places or not settle_sites(mesher, settler, field):
            return


def settle_sites(
    mesher: _core.Mesher, settler: _core.Settler, field: ControlSpace, step: float = 0.0
) -> int:
    """Measure the sites that were found, and what might take their place; how many changed."""
    measure_edges(settler.sampler, field)
    mesher.set_kernels(settler, field(mesher.propose(settler, step)))
    measure_edges(settler.sampler, field)
    return mesher.accept(settler)


def finished_mesh(domain: Domain, mesher: _core.Mesher, regions: Ints) -> Mesh:
    edges, segment = mesher.constrained_edges()
    return Mesh(
        points=mesher.points(),
        triangles=mesher.triangles(),
        regions=regions,
        edges=edges,
        edge_tags=domain.segment_tags[segment],
        names=domain.names,
        region_names=domain.region_names,
        domain=domain,
    )
