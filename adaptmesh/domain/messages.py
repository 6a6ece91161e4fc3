"""What is wrong with a domain that the core refuses: where, and what to do."""

from __future__ import annotations

from adaptmesh._core import InputFault as Fault

from .data import DomainData
from .inputs import OR_REPAIR


def fault_text(domain: DomainData, kind: Fault, i: int, j: int, x: float, y: float) -> str:
    """What is wrong, where, and what to do, from a fault that the core found."""
    place = f"({x:.17g}, {y:.17g})"
    if kind in (
        Fault.crossing_segments,
        Fault.overlapping_segments,
        Fault.lines_too_near,
    ):
        a, b = segment_text(domain, i), segment_text(domain, j)
        if kind == Fault.lines_too_near:
            return (
                f"{a} and {b} come so near each other at {place} that vertices on them cannot be "
                "told apart (coordinates are rounded): move them apart, make them one, or move the "
                "origin near them"
            )
        if kind == Fault.crossing_segments:
            return f"{a} and {b} cross at {place}: put a point there and divide both, {OR_REPAIR}"
        return (
            f"{a} and {b} overlap near {place}: keep one, divided at the points on it, {OR_REPAIR}"
        )
    segment = {
        Fault.open_hole: j,
        Fault.uncertain_hole: j,
        Fault.degenerate_segment: i,
    }.get(kind)
    line = "" if segment is None else line_text(domain, segment)
    messages = {
        Fault.all_collinear: "all points lie on one line: there is nothing to mesh",
        Fault.duplicate_points: f"points {i} and {j} are the same, {place}: keep one of them, "
        f"{OR_REPAIR}",
        Fault.open_boundary: "the boundary is not closed: the outside leaks in"
        + (f" past point {i} {place}, where a boundary ends" if i >= 0 else "")
        + "; close it, or check `holes`; adaptmesh.repair closes gaps below its tolerance",
        Fault.open_hole: f"{line} is in a hole, where nothing is meshed, near point "
        f"{i} {place}: on both sides of it is a hole or the outside; say holes=[] if there are "
        f"no holes, or give a point in each; or remove it there, {OR_REPAIR}",
        Fault.uncertain_hole: f"whether what {line} ends at, at point {i} {place}, is "
        "a hole is uncertain: say holes=[] if it is not, holes='nesting' if it is, or give a point "
        "in each hole",
        Fault.hole_outside: f"hole {i} at {place} is not inside the domain: move or remove it",
        Fault.hole_on_segment: f"hole {i} at {place} lies on a segment: move it into the hole",
        Fault.region_seed_outside: f"the point of {seed_text(domain, i)} at {place} is not inside "
        "the domain: move or remove it, or check `holes` (holes=[] if there are none)",
        Fault.region_seed_on_segment: f"the point of {seed_text(domain, i)} at {place} lies on a "
        "segment: move it into the region",
        Fault.two_seeds_one_region: f"{seed_text(domain, i)} and {seed_text(domain, j)} are the "
        "same part of the domain: remove one, or separate them by segments",
        Fault.point_outside: f"point {i} at {place} is on no segment and outside the domain, or in "
        f"a hole: remove it, {OR_REPAIR}",
        Fault.empty_domain: "nothing is left inside: every part of the domain is a hole",
        Fault.too_few_points: f"expected at least 3 points, got {i}",
        Fault.too_many_points: f"{i} points are more than can be numbered with 32 bits: divide the "
        "domain",
        Fault.not_finite: f"point {i} at {place} is not finite: remove it or give it coordinates",
        Fault.segment_out_of_range: f"segment {i} names point {j}, but the points are numbered 0 "
        f"to {len(domain.points) - 1}",
        Fault.degenerate_segment: f"{line} begins and ends at the same point, {j} at "
        f"{place}: remove it, {OR_REPAIR}",
    }
    return messages[kind]


def segment_text(domain: DomainData, i: int) -> str:
    (x0, y0), (x1, y1) = domain.points[domain.segments[i]].tolist()
    what = domain.curved.describe(i) if domain.curved.curves else f"segment {i}"
    return f"{what} from ({x0:g}, {y0:g}) to ({x1:g}, {y1:g})"


def line_text(domain: DomainData, i: int) -> str:
    """A segment with its name."""
    tag = int(domain.segment_tags[i])
    names = [name for name, number in domain.names.items() if number == tag]
    return segment_text(domain, i) + (f", named {names[0]!r}," if tag and names else "")


def seed_text(domain: DomainData, i: int) -> str:
    number = int(domain.seed_regions[i]) if 0 <= i < len(domain.seed_regions) else 0
    names = [name for name, region in domain.region_names.items() if region == number]
    return f"region {names[0]!r}" if names else f"region seed {i}"
