"""From a domain and a metric to a mesh."""

from __future__ import annotations

from numbers import Real
from typing import Any

import numpy as np

import metrics
from adaptmesh._core import Fault, Mesher
from adaptmesh.boundary.discretise import Outline, cut_outline
from adaptmesh.boundary.messages import too_near_text
from adaptmesh.boundary.vertex_limit import Budget, Progress
from adaptmesh.domain.background import register_mesher
from adaptmesh.domain.domain import Domain
from adaptmesh.errors import DomainError, MetricError
from adaptmesh.mesh.mesh import Mesh
from adaptmesh.types import Ints
from metrics import ControlSpace

from .optimisation import Optimisation, Settling, optimise, settle
from .placement import (
    PLACEMENTS,
    EdgePlacement,
    FrontPlacement,
    Samples,
    insert_what_was_missed,
    place_ahead_of_front,
    place_along_edges,
)
from .prediction import check_is_domain, predict

# The points of the domain are triangulated for the Euclidean plane; under a slanted and strongly
# anisotropic metric it can take many passes of swaps until that is metric Delaunay. Most need two.
OUTLINE_SWAPS = 200

MAX_VERTICES = 5_000_000
"""The largest mesh that is made if nothing else is said."""


def generate(
    domain: Domain,
    metric: Any,
    *,
    gradation: float | None = None,
    placement: str = "front",
    max_vertices: int = MAX_VERTICES,
    progress: Progress | None = None,
) -> Mesh:
    """Mesh a domain so that all edges have unit length in a metric.

    Parameters
    ----------
    domain : Domain
    metric : number, callable, or control space
        A size h; or a function of an (n, 2) array of points that returns sizes (n,), packed metrics
        (n, 3) = (m11, m12, m22) or tensors (n, 2, 2); or anything made by `metrics`.
    gradation : float, optional
        Sizes grow by at most this factor from one unit edge to the next, above 1: beside jumps and
        steep slopes of the metric, triangles are made smaller than it asks for, so that they can be
        well shaped. 1.5 is usual. The mesh is then that of ``metric.graded(domain, gradation)``,
        see `metrics.ControlSpace.graded`; two meshes more are made on the way. If not given, the
        metric is taken as it is.
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
    field(domain.points)  # a corner where it is no metric is named itself, not a point near it
    if gradation is not None:
        report("grading the sizes", 0.0)
        field = graded_within_budget(domain, field, gradation, max_vertices)

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


def graded_within_budget(
    domain: Domain, field: ControlSpace, gradation: float, max_vertices: int = MAX_VERTICES
) -> ControlSpace:
    """The field graded over a domain, unless its mesh would be too large even as it is.

    Grading makes meshes, too, and sizes only smaller, so that what is too large is refused before.
    """
    if not (isinstance(gradation, Real) and 1 < gradation < np.inf):
        raise MetricError(
            f"gradation={gradation!r}: expected a finite factor above 1 from one unit edge to the "
            "next; 1.5 is usual"
        )
    Budget(max_vertices, predict(domain, field)).check_prediction()
    return field.graded(domain, gradation)


def triangulate_outline(domain: Domain, outline: Outline) -> Mesher:
    """The constrained triangulation of the outline's points, then of its cuts: metric Delaunay.

    A cut of a curve is off the chord that it divides, and can be hidden from it by triangles that
    lie between; any cut can be rounded onto or beyond what comes very near. `Outline.mended` says
    what is tried then.
    """
    while True:
        try:
            mesher = Mesher(
                outline.points,
                outline.tensors,
                outline.segments,
                domain.holes,
                domain.seeds,
                domain.nesting,
            )
        except Fault as fault:
            raise DomainError(too_near_text(domain, outline, *fault.args)) from None
        mesher.swap(most_passes=OUTLINE_SWAPS)
        made = mesher.cut_outline(
            outline.pieces,
            outline.piece_segments,
            outline.cuts,
            outline.cut_tensors,
            outline.piece,
        )
        mended = outline.mended(made)
        if mended is outline:
            return mesher
        outline = mended


def finished_mesh(domain: Domain, mesher: Mesher, regions: Ints) -> Mesh:
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


register_mesher(generate)  # for `background_mesh`, which is below
