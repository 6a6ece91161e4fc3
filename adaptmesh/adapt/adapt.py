"""A mesh and a metric on it: the domain of the mesh, meshed again, or the mesh edited."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import replace
from typing import Any

import metrics
from adaptmesh.boundary.vertex_limit import Progress, VertexLimit
from adaptmesh.domain.domain import Domain
from adaptmesh.generate.generate import MAX_VERTICES, generate, graded_within_budget
from adaptmesh.generate.prediction import predict_with_samples
from adaptmesh.mesh.boundary_polylines import vertices_at
from adaptmesh.mesh.cleaned import with_edges_once
from adaptmesh.mesh.control_space import control_space_on
from adaptmesh.mesh.data import check_is_mesh
from adaptmesh.mesh.mesh import Mesh
from metrics import ControlSpace

from .edit import Edited, edited
from .freeze import frozen_domain
from .sub_polylines import is_off

TOLERANCE = 0.02
"""The share of unit edges of an edited mesh is smaller than that of a new one by no more than this.

A new mesh is made to compare if a larger share of the edges are not unit, constrained ones aside:
the domain can force these to be short."""


def adapt(
    mesh: Mesh,
    metric: Any,
    *,
    gradation: float | None = None,
    keep: bool = False,
    frozen: Iterable[str] = (),
    straight_tolerance: float | None = None,
    placement: str = "front",
    max_vertices: int = MAX_VERTICES,
    progress: Progress | None = None,
) -> Mesh:
    """Fit a mesh to a metric, given at its vertices or as a function.

    The domain, its names and its regions are kept. The old mesh carries a metric at its vertices
    (P1, log-Euclidean) while the new one is made.

    Parameters
    ----------
    mesh : Mesh
        If it has no `Mesh.domain` (it was read from a file), `Mesh.to_domain` finds it.
    metric : array_like, number, callable, or control space
        Values at the vertices: sizes (n,), packed metrics (n, 3) = (m11, m12, m22), or tensors
        (n, 2, 2); or anything else that `generate` takes.
    gradation : float, optional
        As in `generate`: sizes grow by at most this factor from one unit edge to the next.
    keep : bool, optional
        False: the domain is meshed again, and no vertex but its corners is kept. True: the mesh is
        edited where it does not fit the metric, around edges that are not unit, and all else stays
        as it is: for time steps, where the metric changes little or in few places. `Mesh.kept` of
        the new mesh says which vertices were kept. New vertices of the boundary lie on
        the curves of the domain, and periodic boundaries stay alike. The domain is meshed again all
        the same if most of the vertices would have to go, if the constrained edges of the mesh
        are not along the lines of the domain, or if more than 2 % of the edges within the domain
        are not unit in the end, and a new mesh has more unit edges by 2 %.
    frozen : sequence of str, optional
        Names of boundaries and lines whose edges stay as the mesh has them, to fit a neighbour;
        those that are periodic with them stay, too.
    straight_tolerance : float, optional
        For a mesh without a domain: how far the vertices of its border may be off a straight line
        on which they are no corners. If not given, by the digits of the coordinates, see
        `Mesh.to_domain`. How many corners were found, and why, is in ``domain.corners_found`` of
        the result, and `measure` prints it.
    placement, max_vertices, progress
        As in `generate`; `placement` is of no account where the mesh is edited.

    Returns
    -------
    Mesh
    """
    check_is_mesh(mesh)
    mesh = with_edges_once(mesh)
    if mesh.domain is not None and straight_tolerance is not None:
        raise ValueError(
            "straight_tolerance finds the domain of a mesh; this mesh has one: leave it out"
        )
    domain = mesh.domain or mesh.to_domain(straight_tolerance=straight_tolerance)
    field = control_space_on(mesh, metric)
    if gradation is not None:
        field = graded_within_budget(domain, field, gradation, max_vertices)
    meshed = frozen_domain(domain, mesh, frozen) if frozen else domain

    def again() -> Mesh:
        return generate(
            meshed, field, placement=placement, max_vertices=max_vertices, progress=progress
        )

    edit = _edited(mesh, meshed, field, max_vertices, progress) if keep else None
    if edit is None:
        new = again()
    elif edit.share <= TOLERANCE:
        new = edit.mesh
    else:
        new = _more_unit(edit.mesh, again(), field)
    return replace(new, domain=domain, kept=vertices_at(mesh, new.points) if keep else None)


def _edited(
    mesh: Mesh, domain: Domain, field: ControlSpace, max_vertices: int, progress: Progress | None
) -> Edited | None:
    prediction = predict_with_samples(domain, field)
    limit = VertexLimit(max_vertices, prediction.count)
    limit.check_prediction()
    return edited(mesh, domain, field, prediction, limit, progress or (lambda stage, f: None))


def _more_unit(edited: Mesh, again: Mesh, field: ControlSpace) -> Mesh:
    """The edited mesh, unless the new one has a larger share of unit edges, by `TOLERANCE`."""

    def unit(mesh: Mesh) -> float:
        lengths = metrics.edge_lengths(mesh.points, mesh.unique_edges, field)
        return 1 - float(is_off(lengths).mean())

    return edited if unit(edited) >= unit(again) - TOLERANCE else again
