"""Surfaces of a script that overlap, cross, or touch along divided sides, made into a domain."""

from __future__ import annotations

from collections.abc import Mapping

from adaptmesh.arrangement import Repair, Repairs, used_tolerance
from adaptmesh.domain.domain import Domain
from adaptmesh.domain.inputs import Holes, refuse_holes
from adaptmesh.domain.surfaces import joined_lines, seeds_of_cells
from adaptmesh.io.domains.geo import PlaneModel, samples_of
from adaptmesh.types import Floats

from .segments import repaired_domain_of_segments


def repaired_domain_of_surfaces(
    model: PlaneModel, tolerance: float | None, holes: Holes
) -> tuple[Domain, Repairs]:
    """A domain of what a script describes, and what was done for it; see `adaptmesh.repair`.

    What surfaces share is the first one's. Curves have to fit, if one of them is not straight.
    """
    if not model.curves:
        return model.domain(holes), Repairs((), 0.0)
    used = model.join_tolerance if tolerance is None else tolerance
    shared = model.overlaps()
    if not model.is_straight and not shared:
        domain = model.domain(holes)
        return domain, Repairs((), used_tolerance(domain.points, tolerance))
    regions: Mapping[str, list[Floats]] = {}
    if model.faces:
        refuse_holes(holes, "surfaces")
        lines = joined_lines([samples_of(curve) for curve in model.curves], model.join_tolerance)
        holes, regions = seeds_of_cells(lines, model.faces, model.regions, used)
    log = [_overlap(model, *pair) for pair in shared]
    if not model.is_straight:
        domain = model.domain_with(holes, regions)
        return domain, Repairs(tuple(log), used_tolerance(domain.points, tolerance))
    domain, repairs = repaired_domain_of_segments(model.outline_with(holes, regions), used)
    return domain, Repairs((*log, *repairs), repairs.tolerance, repairs.displacement)


def _overlap(model: PlaneModel, a: int, b: int, area: float) -> Repair:
    place = model.faces[a].intersection(model.faces[b]).representative_point()
    what = f"surfaces {a} and {b} share an area of {area:.3g}; {a} keeps it"
    return Repair("overlapping surfaces", place.coords[0], what)
