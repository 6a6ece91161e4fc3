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


class Sides(NamedTuple):
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


def sides_of_rows(s: DomainSubject) -> Sides:
    """What lies beside the edges of rows."""
    rows = [(line, row) for line, row in enumerate(s.rows) if row is not None]
    none = np.empty(0, np.int64)
    edge = np.concatenate([none, *(row.edges for _, row in rows)])
    tails = np.concatenate([none, *(row.vertices[:-1] for _, row in rows)])
    heads = np.concatenate([none, *(row.vertices[1:] for _, row in rows)])
    line = np.repeat([k for k, _ in rows], [len(row.edges) for _, row in rows]).astype(np.int64)
    pairs = np.stack([tails, heads], axis=1).astype(np.int32)
    beside = triangles_beside(s.mesh.triangles, pairs, len(s.mesh.points))
    expected = regions_beside_lines(s)[line]
    return Sides(np.tile(edge, 2), np.concatenate(beside), expected.T.ravel())


def regions_beside_lines(s: DomainSubject) -> Int64s:
    """The regions on the left and the right of each line in the domain, (l, 2)."""
    domain, lines = s.domain, s.lines
    straight = domain.curved.segment_runs[domain.piece_segments] < 0
    chords = domain.segments[lines.segments[lines.n_straight :]]
    ends = np.concatenate([domain.pieces[straight], chords])
    return regions_beside(domain.triangles, domain.triangle_regions, ends, len(domain.points))


def fills_domain(s: DomainSubject) -> Finding:
    """Along the boundary there are triangles on the inner side only; along inner lines on both."""
    sides = sides_of_rows(s)
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
    sides = sides_of_rows(s)
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
