"""Do the triangles fill the domain and its regions, and do they bear its names?

The domain's own triangulation says what lies on both sides of each line of it. A mesh has, along
the whole row of a line, the same there: no triangle on a side that is outside or in a hole, one of
the right region on any other. What no constrained edge parts is one region. All of it is topology,
without a tolerance.
"""

from __future__ import annotations

from collections.abc import Mapping
from typing import NamedTuple

import numpy as np

from adaptmesh.topology import OUTSIDE, parts_between, regions_beside, triangles_beside
from adaptmesh.types import Int64s

from .domain_subject import DomainSubject
from .subject import Finding, finding


class BesideEdges(NamedTuple):
    """The edges of rows from both sides, one after the other.

    Attributes
    ----------
    edge : (k,) array of int
        Numbers of constrained edges.
    triangle : (k,) array of int
        What lies on this side in the mesh, -1 for nothing.
    expected : (k,) array of int
        The region that the domain has there, `OUTSIDE` for none.
    """

    edge: Int64s
    triangle: Int64s
    expected: Int64s


def beside_edges(s: DomainSubject) -> BesideEdges:
    """What lies beside the edges of rows."""
    rows = [(k, p) for k, p in enumerate(s.polylines.of_side) if p]
    none = np.empty(0, np.int64)
    edge = np.concatenate([none, *(p.edges for _, p in rows)])
    tails = np.concatenate([none, *(p.vertices[:-1] for _, p in rows)])
    heads = np.concatenate([none, *(p.vertices[1:] for _, p in rows)])
    side = np.repeat([k for k, _ in rows], [len(p.edges) for _, p in rows]).astype(np.int64)
    pairs = np.stack([tails, heads], axis=1).astype(np.int32)
    beside = triangles_beside(s.mesh.triangles, pairs, len(s.mesh.points))
    expected = regions_beside_sides(s)[side]
    return BesideEdges(np.tile(edge, 2), np.concatenate(beside), expected.T.ravel())


def regions_beside_sides(s: DomainSubject) -> Int64s:
    """The regions on the left and the right of each side in the domain, (s, 2)."""
    domain, sides = s.domain, s.domain_sides
    vertices = np.flatnonzero(domain.curved.is_vertex)
    straight = vertices[sides.ends[: sides.n_straight]]
    chords = domain.segments[sides.segments[sides.n_straight :]]
    ends = np.concatenate([straight, chords])
    return regions_beside(domain.triangles, domain.triangle_regions, ends, len(domain.points))


def fills_domain(s: DomainSubject) -> Finding:
    """Along the boundary there are triangles on the inner side only; along inner lines on both."""
    sides = beside_edges(s)
    outside = sides.expected == OUTSIDE
    bad = np.flatnonzero(outside == (sides.triangle >= 0))

    def show(k: int) -> str:
        place = f"constrained edge {s.at(*s.mesh.edges[sides.edge[k]])}"
        if outside[k]:
            triangle = int(sides.triangle[k])
            return f"{place}: triangle {triangle} lies outside of the domain or in a hole"
        return f"{place}: no triangle on a side where the domain is"

    return finding(bad, "", "edges have triangles on a side where none belong, or none", show)


def regions_of_domain(s: DomainSubject) -> Finding:
    """Every triangle has the number of the region of the domain that it lies in."""
    sides = beside_edges(s)
    known = (sides.expected != OUTSIDE) & (sides.triangle >= 0)
    part = parts_between(s.mesh.triangles, s.mesh.edges, len(s.mesh.points))
    expected = np.full(part.max() + 1, OUTSIDE, np.int64)
    expected[part[sides.triangle[known]]] = sides.expected[known]
    expected = expected[part]
    bad = np.flatnonzero((s.mesh.regions != expected) & (expected != OUTSIDE))

    def show(t: int) -> str:
        found = s.mesh.regions[t]
        corners = s.at(*s.mesh.triangles[t])
        return f"triangle {t}, {corners}: region {found}, in the domain {expected[t]}"

    good = f"{len(np.unique(s.mesh.regions))} regions"
    return finding(bad, good, "triangles have another region than the domain there", show)


def names_of_domain(s: DomainSubject) -> Finding:
    """Names of boundaries and lines are those of the domain, with the same tags."""
    return _same_names(s.mesh.names, s.domain.names, "tag")


def region_names_of_domain(s: DomainSubject) -> Finding:
    """Names of regions are those of the domain, with the same numbers."""
    return _same_names(s.mesh.region_names, s.domain.region_names, "region")


def _same_names(found: Mapping[str, int], expected: Mapping[str, int], what: str) -> Finding:
    bad = [
        f"{name!r}: {what} {found.get(name, 'missing')}, in the domain {expected.get(name, 'none')}"
        for name in dict.fromkeys([*expected, *found])
        if found.get(name) != expected.get(name)
    ]
    wrong = "names are missing, unknown to the domain, or have another number there"
    return finding(np.arange(len(bad)), f"{len(expected)} names", wrong, bad.__getitem__)
