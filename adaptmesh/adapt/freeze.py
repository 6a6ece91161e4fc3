"""Boundaries of a mesh that are kept as they are while the rest is meshed anew."""

from __future__ import annotations

from collections.abc import Iterable

import numpy as np

from adaptmesh.curves import Curve, Line
from adaptmesh.domain.data import with_fields
from adaptmesh.domain.domain import Domain
from adaptmesh.domain.periodic_corners import with_pairs
from adaptmesh.domain.sides.periodic import with_partners
from adaptmesh.mesh.mesh import Mesh
from adaptmesh.types import Bools, Floats


def frozen_domain(domain: Domain, mesh: Mesh, names: Iterable[str]) -> Domain:
    """The domain with the edges that a mesh of it has on these boundaries for segments, frozen.

    Every name and region keeps its number. What is periodic with a frozen boundary is frozen too,
    and what was frozen before stays so.
    """
    if isinstance(names, str):
        raise TypeError(f"frozen={names!r}: give a list of names, [{names!r}]")
    names = with_partners(domain.periodic, names)
    numbers = [domain.tag_named(name) for name in names]
    edges = {name: mesh.points[mesh.edges_named(name)] for name in names}
    rest = ~np.isin(domain.segment_tags, numbers)
    build = _of_curves if domain.curved.curves else _of_segments
    out = build(domain, edges, rest).with_frozen(*names)
    out = with_fields(out, corners_found=domain.corners_found)
    return with_pairs(out, domain.periodic)


def _of_segments(domain: Domain, edges: dict[str, Floats], rest: Bools) -> Domain:
    ends = [domain.points[domain.segments[rest]], *edges.values()]
    isolated = np.setdiff1d(np.arange(len(domain.points)), domain.segments)
    places = np.concatenate([*(e.reshape(-1, 2) for e in ends), domain.points[isolated]])
    points, number = np.unique(places, axis=0, return_inverse=True)
    segments = number.ravel()[: 2 * sum(map(len, ends))].reshape(-1, 2)
    tags = np.concatenate(
        [domain.segment_tags[rest], *(np.full(len(e), domain.names[n]) for n, e in edges.items())]
    )
    return Domain(
        points,
        segments,  # the rest first
        holes="nesting" if domain.nesting else domain.holes,
        regions=_regions(domain),
        names={name: np.flatnonzero(tags == tag).tolist() for name, tag in domain.names.items()},
    ).with_frozen(segments=np.flatnonzero(domain.segment_is_frozen[rest]))


def _of_curves(domain: Domain, edges: dict[str, Floats], rest: Bools) -> Domain:
    curved = domain.curved
    kept = np.unique(curved.segment_curves[rest])
    tag_of = dict(zip(curved.segment_curves.tolist(), domain.segment_tags.tolist(), strict=True))
    # First what is frozen: where ends are joined, the first one says where.
    curves: list[Curve] = [Line(a, b) for ends in edges.values() for a, b in ends]
    curves += [curved.curves[i] for i in kept]
    tags = [domain.names[name] for name, ends in edges.items() for _ in ends]
    tags += [tag_of[i] for i in kept.tolist()]
    out = Domain.from_curves(
        curves,
        names={n: np.flatnonzero(np.array(tags) == t).tolist() for n, t in domain.names.items()},
        holes="nesting" if domain.nesting else domain.holes,
        regions=_regions(domain),
        points=domain.points[curved.is_vertex],
        corner_angle=curved.corner_angle,
        join_tolerance=curved.join_tolerance,
    )
    still = np.isin(kept, curved.segment_curves[domain.segment_is_frozen])
    still_frozen = len(curves) - len(kept) + np.flatnonzero(still)
    return out.with_frozen(
        segments=np.flatnonzero(np.isin(out.curved.segment_curves, still_frozen))
    )


def _regions(domain: Domain) -> dict[str, Floats]:
    return {
        name: domain.seeds[domain.seed_regions == number]
        for name, number in domain.region_names.items()
    }
