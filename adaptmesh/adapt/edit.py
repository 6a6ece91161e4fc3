"""Editing a mesh where it does not fit a metric, and nowhere else.

1. Load: the mesh as it is becomes one that can be edited; the metric is evaluated at its vertices.
2. Outline: edges along the boundary are cut again where they are not unit.
3. Zone: what touches an edge that is not unit, and its neighbours, is removed; all else is held.
4. Fill: as in `generate`, ahead of a front (which passes what it finds good) and along edges; the
   new vertices are smoothed. Edges can be too long where there was no vertex to remove: the mesh is
   filled there all the same.
5. The mesh is checked: one that overlaps itself, or did before, is made again from its domain.

Removing what is off and filling the gaps makes a better mesh than collapsing and splitting edges:
after many steps it still has the count and the quality of a fresh one.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from adaptmesh._core import FIXED, FREE, MetricMesh
from adaptmesh.boundary.vertex_limit import Progress, VertexLimit
from adaptmesh.domain.domain import Domain
from adaptmesh.domain.sides.side import Sides
from adaptmesh.errors import DomainError
from adaptmesh.generate.generate import finished_mesh
from adaptmesh.generate.prediction import Prediction
from adaptmesh.mesh.boundary_polylines import BoundaryPolylines, find_polylines, vertices_at
from adaptmesh.mesh.mesh import Mesh
from adaptmesh.mesh.validate.covering import covered_once, simple_border
from adaptmesh.mesh.validate.local import positive_triangles
from adaptmesh.mesh.validate.subject import Subject
from adaptmesh.types import Ints
from metrics import ControlSpace

from .plan_boundary import Boundary
from .recut_boundary import recut
from .select_zone import Misfits, find_misfits

TURNS = 3
"""How often zones are made and filled: what one leaves needs another zone."""

MOST_REMOVED = 0.75
"""If more than this share of the vertices that can be removed were, a new mesh is made instead."""


class Edited(NamedTuple):
    """An edited mesh, and the share of its edges that are not unit, constrained ones aside."""

    mesh: Mesh
    share: float


def edited(
    mesh: Mesh,
    domain: Domain,
    field: ControlSpace,
    samples: Prediction,
    limit: VertexLimit,
    report: Progress,
) -> Edited | None:
    """The mesh, edited to fit a metric; None if a new one had better be made."""
    report("loading the mesh", 0.02)
    sides = domain.all_sides
    polylines = find_polylines(mesh, domain)
    if polylines is None:
        return None
    held = holders(mesh, sides, polylines)
    core = load(mesh, domain, held, field)

    def boundary_of(polylines: BoundaryPolylines) -> Boundary:
        points = core.points()[polylines.vertices]
        return Boundary(sides, polylines, points, field, limit.max_vertices)

    outline_fits = False
    for turn in range(TURNS):
        if not outline_fits:
            before = polylines
            polylines = recut(core, boundary_of(before))
            outline_fits = polylines is before
        misfits = measured_misfits(core, field)
        removable = core.hold_all_but(misfits.zone)
        if not removable and not misfits.has_long_edges:
            break
        if turn == 0 and removable > MOST_REMOVED * np.sum(held == FREE):
            return None
        monitor = limit.monitor(within(report, turn / TURNS, 1 / TURNS))
        with limit.explained():
            core.refill(samples.points, samples.tensors, field, monitor)
    if boundary_of(polylines).is_far_from_new():
        return None
    share = measured_misfits(core, field).share
    arrays = core.finished(polylines.edges, sides.segments[polylines.edge_sides])
    new = finished_mesh(domain, arrays, regions=arrays[2])
    if not _is_plane(new):
        return None
    report("done", 1.0)
    return Edited(new, share)


def measured_misfits(core: MetricMesh, field: ControlSpace) -> Misfits:
    """Measure what has changed, and find what does not fit."""
    core.measure(field)
    return find_misfits(core, field)


def _is_plane(mesh: Mesh) -> bool:
    """Whether the mesh covers the plane once, where it does; exactly.

    The outline is edited by what can be seen from inside. Across a slit, or in the bend of a curve,
    its new edges can meet others, or pass over them.
    """
    subject = Subject(mesh)
    looks = (positive_triangles, simple_border, covered_once)
    return not any(look(subject).broken for look in looks)


def within(report: Progress, start: float, share: float) -> Progress:
    """Reports a part of the work as that part of the whole."""
    return lambda stage, fraction: report(stage, start + share * fraction)


def holders(mesh: Mesh, sides: Sides, polylines: BoundaryPolylines) -> Ints:
    """What holds each vertex, (n,): nothing, its segment, or that it is a corner of the domain."""
    held = np.full(len(mesh.points), FREE, np.int32)
    held[polylines.vertices] = sides.segments[polylines.sides]
    held[vertices_at(mesh, sides.corners)] = FIXED
    return held


def load(mesh: Mesh, domain: Domain, held: Ints, metric: ControlSpace) -> MetricMesh:
    """The mesh in the hands of the core; labels are regions."""
    try:
        return MetricMesh(
            mesh.points,
            metric(mesh.points),
            mesh.triangles,
            regions_in_domain(mesh, domain),
            mesh.edges,
            held,
        )
    except ValueError as error:
        raise DomainError(f"the mesh cannot be adapted: {error}") from error


def regions_in_domain(mesh: Mesh, domain: Domain) -> Ints:
    """The regions of the triangles as the domain numbers them, by name if they have one."""
    number = np.zeros(max(int(mesh.regions.max()), 0) + 1, np.int32)
    unnamed = np.setdiff1d(domain.seed_regions, list(domain.region_names.values()))
    unnamed = unnamed[(unnamed > 0) & (unnamed < len(number))]
    number[unnamed] = unnamed
    for name, old in mesh.region_names.items():
        if 0 <= old < len(number):
            number[old] = domain.region_names.get(name, 0)
    return number[mesh.regions]
