"""The arrays, and the neighbourhood of each triangle, edge and point."""

from __future__ import annotations

from collections.abc import Callable
from functools import partial

import numpy as np

from adaptmesh.topology import edge_keys
from adaptmesh.types import Index

from .subject import SHOWN, Finding, Subject, finding


def not_empty(s: Subject) -> Finding:
    """There are triangles."""
    m = len(s.mesh.triangles)
    return Finding(int(m == 0), f"{m} triangles")


def finite_points(s: Subject) -> Finding:
    """No coordinate is infinite or not a number."""
    bad = np.flatnonzero(~np.isfinite(s.mesh.points).all(axis=1))
    return finding(bad, "", "points are not finite", lambda v: f"point {s.at(v)}")


def indices_in_range(s: Subject) -> Finding:
    """Triangles, constrained edges and what is required or kept name what exists."""
    mesh = s.mesh
    n, k = len(mesh.points), len(mesh.edges)
    bad = [
        *_outside(mesh.triangles, n, "triangle", "points"),
        *_outside(mesh.edges, n, "constrained edge", "points"),
        *_outside(mesh.required_points[:, None], n, "required point", "points"),
        *_outside(mesh.required_edges[:, None], k, "required edge", "constrained edges"),
    ]
    wrong = "rows name points or edges that do not exist"
    return finding(np.arange(len(bad)), f"{n} points", wrong, lambda i: bad[i]())


def _outside(rows: Index, n: int, what: str, of: str) -> list[Callable[[], str]]:
    """The rows with a number outside of 0 to n - 1, each ready to be described."""

    def show(row: int) -> str:
        numbers = ", ".join(map(str, rows[row].tolist()))
        return f"{what} {row}: [{numbers}], with {n} {of}"

    bad = np.flatnonzero(((rows < 0) | (rows >= n)).any(axis=1))
    return [partial(show, int(row)) for row in bad]


def positive_triangles(s: Subject) -> Finding:
    """Every triangle is counter-clockwise and not flat, by exact signs."""
    signs = s.orient(*s.mesh.triangles.T)

    def show(t: int) -> str:
        kind = "flat" if signs[t] == 0 else "clockwise"
        return f"triangle {t} is {kind}: {s.at(*s.mesh.triangles[t])}"

    bad = np.flatnonzero(signs <= 0)
    return finding(bad, "exact signs", "triangles are flat or clockwise", show)


def distinct_points(s: Subject) -> Finding:
    """No two points have the same coordinates."""
    order = np.lexsort(s.mesh.points.T)
    p = s.mesh.points[order]
    same = (p[1:] == p[:-1]).all(axis=1)

    def show(k: int) -> str:
        first, second = sorted((int(order[k]), int(order[k + 1])))
        return f"point {first} and point {s.at(second)}"

    return finding(np.flatnonzero(same), "", "points lie on another one", show)


def two_triangles_an_edge(s: Subject) -> Finding:
    """No edge is the side of three triangles or more."""

    def show(e: int) -> str:
        start, count = s.sides.first[e], s.sides.count[e]
        owners = np.sort(s.sides.triangle[start : start + count])[:SHOWN].tolist()
        return f"edge {s.edge(e)}: {count} triangles, {owners}"

    bad = np.flatnonzero(s.sides.count > 2)
    good = f"{len(s.sides.first)} edges"
    return finding(bad, good, "edges have more than two triangles", show)


def same_orientation(s: Subject) -> Finding:
    """The two triangles of an edge run along it in opposite directions."""
    tail, head = s.sides.tail, s.sides.head
    same = (tail[1:] == tail[:-1]) & (head[1:] == head[:-1])

    def show(k: int) -> str:
        both = np.sort(s.sides.triangle[k : k + 2]).tolist()
        return f"edge {s.at(tail[k], head[k])}: triangles {both}"

    wrong = "pairs of triangles run along their edge in the same direction"
    return finding(np.flatnonzero(same), "", wrong, show)


def points_used(s: Subject) -> Finding:
    """Every point belongs to a triangle."""
    bad = np.flatnonzero(~s.used)
    return finding(bad, "", "points have no triangle", lambda v: f"point {s.at(v)}")


def constrained_are_edges(s: Subject) -> Finding:
    """Every constrained edge is the side of a triangle, and listed once."""
    keys = edge_keys(s.mesh.edges, len(s.mesh.points))
    order = np.argsort(keys, kind="stable")
    again = np.zeros(len(keys), bool)
    again[order[1:]] = keys[order[1:]] == keys[order[:-1]]
    missing = s.sides.missing(keys)

    def show(e: int) -> str:
        why = "is no side of a triangle" if missing[e] else "is listed twice"
        return f"constrained edge {e} {why}: {s.at(*s.mesh.edges[e])}"

    wrong = "constrained edges are no side of a triangle, or listed twice"
    return finding(np.flatnonzero(missing | again), f"{len(keys)} of them", wrong, show)


def border_is_constrained(s: Subject) -> Finding:
    """The sides with a single triangle are constrained edges."""
    border = s.sides.border
    constrained = np.sort(edge_keys(s.mesh.edges, len(s.mesh.points)))
    keys = s.sides.keys[border]
    place = np.searchsorted(constrained, keys)
    bad = border[np.append(constrained, -1)[place] != keys]

    def show(e: int) -> str:
        return f"side {s.edge(e)} of triangle {s.sides.triangle[s.sides.first[e]]}"

    good = f"{len(border)} edges of the border"
    return finding(bad, good, "edges of the border are not constrained", show)


def tags(s: Subject) -> Finding:
    """No number is negative that the domain does not give.

    One without a name is allowed: files carry bare numbers. Those of FreeFEM and Medit may be
    negative, so that without a domain all are.
    """
    mesh = s.mesh
    tagged = np.concatenate([mesh.edge_tags, mesh.regions])
    k = len(mesh.edge_tags)
    bad = (tagged < 0) & (mesh.domain is not None)
    if mesh.domain is not None:
        known = (mesh.domain.segment_tags, mesh.domain.seed_regions)
        bad[:k] &= ~np.isin(mesh.edge_tags, known[0])
        bad[k:] &= ~np.isin(mesh.regions, known[1])

    def show(i: int) -> str:
        if i < k:
            return f"constrained edge {s.at(*mesh.edges[i])}: tag {tagged[i]}"
        return f"triangle {i - k}: region {tagged[i]}"

    wrong = "constrained edges or triangles have a negative number"
    return finding(np.flatnonzero(bad), "", wrong, show)


def names(s: Subject) -> Finding:
    """Names are text, each stands for a number of its own, and none for 0.

    Those of the domain are as it has them.
    """
    mesh, domain = s.mesh, s.mesh.domain
    known = ({}, {}) if domain is None else (domain.names, domain.region_names)
    tables = (("tag", mesh.names, known[0]), ("region", mesh.region_names, known[1]))
    bad = []
    for what, table, of_domain in tables:
        owner: dict[int, str] = {}
        for name, number in table.items():
            if of_domain.get(name) == number:
                continue
            if not isinstance(name, str) or not name:
                bad.append(f"{name!r} for {what} {number}: a name is a text")
            elif not isinstance(number, (int, np.integer)):
                bad.append(f"{name!r}: {what} {number!r} is no whole number")
            elif number == 0:
                bad.append(f"{name!r}: {what} 0 stands for what has no name")
            elif number in owner:
                bad.append(f"{owner[number]!r} and {name!r} are both {what} {number}")
            else:
                owner[number] = name
    count = len(mesh.names) + len(mesh.region_names)
    wrong = "names are ambiguous"
    return finding(np.arange(len(bad)), f"{count} names", wrong, bad.__getitem__)


def kept_once(s: Subject) -> Finding:
    """No two vertices are the same one of the mesh before."""
    kept = s.mesh.kept
    if kept is None:
        return Finding(0)
    order = np.argsort(kept, kind="stable")
    again = np.append(False, kept[order[1:]] == kept[order[:-1]])
    bad = np.sort(order[(again & (kept[order] >= 0)) | (kept[order] < -1)])

    def show(v: int) -> str:
        return f"point {s.at(v)}: kept from {kept[v]}"

    return finding(bad, "", "points are kept from no vertex, or from one twice", show)
