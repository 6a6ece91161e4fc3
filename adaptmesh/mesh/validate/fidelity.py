"""Are the points, segments and curves of the domain in its mesh, and nothing else?

Polylines of edges are followed from corner to corner (`mesh.polylines`); distances only say whether
a vertex of one lies on the side that it stands for.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from adaptmesh.types import Bools, Floats, Index, Int64s

from .domain_subject import DomainSubject
from .subject import Finding, finding


def points_present(s: DomainSubject) -> Finding:
    """Every point of the domain is a point of the mesh."""
    corners = s.domain_sides.corners

    def show(i: int) -> str:
        x, y = corners[i].tolist()
        return f"point {number[i]} of the domain ({x!r}, {y!r})"

    number = np.flatnonzero(s.domain.curved.is_vertex)
    bad = np.flatnonzero(s.vertices < 0)
    return finding(bad, f"{len(corners)} points", "points of the domain are missing", show)


def segments_present(s: DomainSubject) -> Finding:
    """Every segment is a row of constrained edges from its first point to its last."""
    return _sides_present(s, "segments", s.domain_sides.is_straight)


def curves_present(s: DomainSubject) -> Finding:
    """Every curve, from corner to corner, is a row of constrained edges."""
    return _sides_present(s, "curves", ~s.domain_sides.is_straight)


def _sides_present(s: DomainSubject, what: str, chosen: Bools) -> Finding:
    def show(side: int) -> str:
        return f"{s.side_text(side)} is no row of constrained edges"

    bad = s.missing[chosen[s.missing]]
    good = f"{np.count_nonzero(chosen)} {what}"
    return finding(bad, good, f"{what} of the domain are missing", show)


def edges_on_segments(s: DomainSubject) -> Finding:
    """Every constrained edge belongs to the row of a segment or a curve."""
    stray = np.zeros(len(s.mesh.edges), bool)
    for polyline in s.polylines.others:
        stray[polyline.edges] = True

    def show(e: int) -> str:
        return f"constrained edge {s.at(*s.mesh.edges[e])}"

    wrong = "constrained edges are on no segment or curve of the domain"
    return finding(np.flatnonzero(stray & ~s.is_on_missing_side), "", wrong, show)


class Inner(NamedTuple):
    """The vertices of polylines but their ends, in order: their sides and numbers, (k,)."""

    side: Index
    vertex: Int64s

    @classmethod
    def of(cls, s: DomainSubject, chosen: Bools) -> Inner:
        """Those of some of the sides."""
        rows = [(k, p.inner) for k, p in enumerate(s.polylines.of_side) if p and chosen[k]]
        side = np.repeat([k for k, _ in rows], [len(v) for _, v in rows]).astype(np.int64)
        return cls(side, np.concatenate([np.empty(0, np.int64), *(v for _, v in rows)]))


def vertices_on_segments(s: DomainSubject) -> Finding:
    """The vertices of the row of a segment lie on it, one after the other."""
    return _vertices_on_sides(s, "segments", s.domain_sides.is_straight)


def vertices_on_curves(s: DomainSubject) -> Finding:
    """The vertices of the row of a curve lie on it, one after the other."""
    return _vertices_on_sides(s, "curves", ~s.domain_sides.is_straight)


def _vertices_on_sides(s: DomainSubject, what: str, chosen: Bools) -> Finding:
    inner = Inner.of(s, chosen)
    u, off = s.project(*inner)
    beside = off > s.tolerance
    early = ~beside & _out_of_order(s, inner.side, np.where(beside, np.nan, u))

    def show(k: int) -> str:
        text = s.side_text(int(inner.side[k]))
        if beside[k]:
            return f"point {s.at(inner.vertex[k])} is {off[k]:.3g} off {text}"
        return f"point {s.at(inner.vertex[k])} is not between its neighbours on {text}"

    good = f"{len(inner.side)} points, to {s.tolerance:.2g}"
    wrong = f"points are not where they belong on {what}"
    return finding(np.flatnonzero(beside | early), good, wrong, show)


def _out_of_order(s: DomainSubject, side: Index, u: Floats) -> Bools:
    """Which inner vertices do not come after those before them, or not before the end."""
    bad: Bools = (u < 0) | (u > s.domain_sides.lengths[side])
    known = np.flatnonzero(~np.isnan(u) & ~bad)
    side, u = side[known], u[known]
    straight = s.domain_sides.is_straight[side[1:]]
    back = np.where(straight, u[1:] < u[:-1], u[1:] <= u[:-1])
    bad[known[1:][(side[1:] == side[:-1]) & back]] = True
    return bad


def tags_of_domain(s: DomainSubject) -> Finding:
    """The edges of a row have the tag of their segment or curve."""
    rows = [(k, p.edges) for k, p in enumerate(s.polylines.of_side) if p]
    edge = np.concatenate([np.empty(0, np.int64), *(edges for _, edges in rows)])
    side = np.repeat([k for k, _ in rows], [len(edges) for _, edges in rows]).astype(np.int64)
    order = np.argsort(edge)
    edge, side = edge[order], side[order]
    expected = s.domain_sides.tags[side]
    found = s.mesh.edge_tags[edge]

    def show(k: int) -> str:
        text = f"constrained edge {edge[k]}, {s.at(*s.mesh.edges[edge[k]])}"
        return f"{text}: tag {found[k]}, but {s.side_text(int(side[k]))} has {expected[k]}"

    wrong = "constrained edges have another tag than their segment or curve"
    return finding(np.flatnonzero(found != expected), f"{len(edge)} edges", wrong, show)


def frozen_undivided(s: DomainSubject) -> Finding:
    """Every frozen segment is one edge; see `Domain.with_frozen`."""
    divided = np.array([p is not None and len(p.edges) > 1 for p in s.polylines.of_side], bool)
    bad = np.flatnonzero(divided & s.domain_sides.is_frozen)
    good = f"{np.count_nonzero(s.domain_sides.is_frozen)} frozen segments"
    return finding(bad, good, "frozen segments are divided", s.side_text)


def area_of_domain(s: DomainSubject) -> Finding:
    """The triangles have the area of the domain, to what its points and rounding allow."""
    a, b = (s.domain.points[i] for i in s.domain.segments.T)
    p = s.mesh.points[s.mesh.triangles]
    u, v = (np.hypot(*(p[:, i] - p[:, 0]).T) for i in (1, 2))
    tolerance = s.tolerance * float(np.hypot(*(b - a).T).sum())
    tolerance += 8 * float(np.finfo(float).eps) * float((u * v).sum())
    found, expected = float(s.mesh.areas.sum()), s.domain.area
    note = f"{found!r}, of the domain {expected!r}, to {tolerance:.2g}"
    return Finding(int(not abs(found - expected) <= tolerance), note)
