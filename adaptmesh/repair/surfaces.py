"""Repair of the surfaces of a script that overlap, cross, or touch along divided sides."""

from __future__ import annotations

from collections.abc import Mapping

from adaptmesh.arrangement.noding import resolve_tolerance
from adaptmesh.arrangement.record import Repair, Repairs
from adaptmesh.domain.domain import Domain
from adaptmesh.domain.inputs import Holes, refuse_holes
from adaptmesh.domain.sides.surfaces import joined_lines, seeds_of_cells
from adaptmesh.io.domains.geo import PlaneModel, samples_of
from adaptmesh.types import Floats

from .segments import repair_segments


def repair_surfaces(
    model: PlaneModel, tolerance: float | None, holes: Holes
) -> tuple[Domain, Repairs]:
    """Make a domain of a script, and record the repairs; see `adaptmesh.repair`.

    The first of two overlapping surfaces keeps the overlap. If a curve is not straight, all curves
    have to fit as they are.
    """
    if not model.curves:
        return model.domain(holes), Repairs((), 0.0)
    used = model.join_tolerance if tolerance is None else tolerance
    shared = model.overlaps()
    if not model.is_straight and not shared:
        domain = model.domain(holes)
        return domain, Repairs((), resolve_tolerance(domain.points, tolerance))
    regions: Mapping[str, list[Floats]] = {}
    if model.faces:
        refuse_holes(holes, "surfaces")
        lines = joined_lines([samples_of(curve) for curve in model.curves], model.join_tolerance)
        holes, regions = seeds_of_cells(lines, model.faces, model.regions, used)
    log = [_record_overlap(model, *pair) for pair in shared]
    if not model.is_straight:
        domain = model.domain_with(holes, regions)
        return domain, Repairs(tuple(log), resolve_tolerance(domain.points, tolerance))
    domain, repairs = repair_segments(model.outline_with(holes, regions), used)
    return domain, Repairs((*log, *repairs), repairs.tolerance, repairs.displacement)


def _record_overlap(model: PlaneModel, a: int, b: int, area: float) -> Repair:
    place = model.faces[a].intersection(model.faces[b]).representative_point()
    what = f"surfaces {a} and {b} share an area of {area:.3g}; {a} keeps it"
    return Repair("overlapping surfaces", place.coords[0], what)
