"""From a domain and a metric to a mesh."""

from __future__ import annotations

from numbers import Real
from typing import Any

import numpy as np

import metrics
from adaptmesh._core import BoundaryCuts, InputError, Monitor, Placement
from adaptmesh._core import generate as generate_in_core
from adaptmesh.boundary.discretise import cut_boundary
from adaptmesh.boundary.vertex_limit import Progress, VertexLimit
from adaptmesh.domain.background import register_mesher
from adaptmesh.domain.domain import Domain
from adaptmesh.domain.messages import fault_text
from adaptmesh.errors import DomainError, MetricError
from adaptmesh.mesh.mesh import Mesh
from adaptmesh.types import Floats, Ints
from metrics import ControlSpace

from .prediction import Prediction, check_is_domain, predict, predict_with_samples

MeshArrays = tuple[Floats, Ints, Ints, Ints, Ints]
"""Points, triangles, the label of each, constrained edges, the segment of each."""

PLACEMENTS = {"front": Placement.front, "edges": Placement.edges}

MAX_VERTICES = 5_000_000
"""Default of the largest number of vertices allowed."""


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
        Largest growth of sizes from one unit edge to the next, a factor above 1, usually 1.5.
        Beside jumps and steep slopes of the metric, sizes are reduced, so that triangles can have
        a good shape. The mesh is then that of ``metric.graded(domain, gradation)``, see
        `metrics.ControlSpace.graded`, which makes two more meshes. By default the metric is not
        changed.
    placement : {"front", "edges"}
        How points are placed. ``"front"``: as apexes of unit triangles, layer by layer from the
        constraints inwards, and along edges in the remaining gaps. ``"edges"``: only along edges
        longer than unit, at equal metric distances (Borouchaki and George).
    max_vertices : int
        Largest number of vertices allowed. A larger mesh is refused before meshing, with the
        predicted number.
    progress : callable, optional
        Called as ``progress(stage, fraction)`` with the name of the stage and the fraction of the
        whole work done, from 0 to 1. An exception that it raises ends the work.

    Returns
    -------
    Mesh

    Raises
    ------
    MetricError
        If the metric is not finite, not positive definite, or of the wrong shape at a point.
    BudgetError
        If the mesh would have more than `max_vertices` vertices.
    """
    check_is_domain(domain)
    if not isinstance(placement, str) or placement not in PLACEMENTS:
        raise ValueError(
            f"placement: expected one of {', '.join(map(repr, PLACEMENTS))}, got {placement!r}"
        )
    report = progress or (lambda stage, fraction: None)
    field = metrics.as_control_space(metric)
    field(
        domain.points
    )  # so that an error names a corner of the domain rather than a point near it
    if gradation is not None:
        report("grading the sizes", 0.0)
        field = graded_within_budget(domain, field, gradation, max_vertices)

    report("predicting the size", 0.0)
    prediction = predict_with_samples(domain, field)
    limit = VertexLimit(max_vertices, prediction.count)
    limit.check_prediction()
    report("cutting the boundary", 0.02)
    boundary = cut_boundary(domain, field, limit.max_vertices)
    with limit.explained():
        arrays = _mesh_interior(
            domain, boundary, prediction, PLACEMENTS[placement], field, limit.monitor(report)
        )
    report("done", 1.0)
    return finished_mesh(domain, arrays, domain.region_of_label(arrays[2]))


def graded_within_budget(
    domain: Domain, field: ControlSpace, gradation: float, max_vertices: int = MAX_VERTICES
) -> ControlSpace:
    """Grade a field over a domain; refuse it first if its mesh would be too large.

    Grading makes meshes, too, and only reduces sizes, so the field is checked before.
    """
    if not (isinstance(gradation, Real) and 1 < gradation < np.inf):
        raise MetricError(
            f"gradation={gradation!r}: expected a finite factor above 1 from one unit edge to the "
            "next; 1.5 is usual"
        )
    VertexLimit(max_vertices, predict(domain, field)).check_prediction()
    return field.graded(domain, gradation)


def _mesh_interior(
    domain: Domain,
    boundary: BoundaryCuts,
    samples: Prediction,
    placement: Placement,
    field: ControlSpace,
    monitor: Monitor,
) -> MeshArrays:
    """The stages after the boundary is cut: see core/mesher/generate.hpp."""
    try:
        return generate_in_core(
            boundary,
            domain.holes,
            domain.seeds,
            domain.nesting,
            samples.points,
            samples.tensors,
            placement,
            field,
            monitor,
        )
    except InputError as fault:
        raise DomainError(fault_text(domain, *fault.args)) from None


def finished_mesh(domain: Domain, arrays: MeshArrays, regions: Ints) -> Mesh:
    """Make a `Mesh` of the arrays of the core, with the names of its domain."""
    points, triangles, _, edges, segments = arrays
    return Mesh(
        points=points,
        triangles=triangles,
        regions=regions,
        edges=edges,
        edge_tags=domain.segment_tags[segments],
        names=domain.names,
        region_names=domain.region_names,
        domain=domain,
    )


register_mesher(generate)  # for `background_mesh`, which is below
