"""Do the triangles cover what their border encloses, once and only once?

No search for overlapping triangles is needed. Positive triangles contain a point of the plane as
many times as their border winds around it, and that number changes only across the border, there
by one. So a plane sweep over the border edges decides it (core/validate/border_sweep.hpp): no two
cross, and on the left of each lies one triangle, on the right none. Every decision is exact.
"""

from __future__ import annotations

import numpy as np

from adaptmesh.geometry.products import cross
from adaptmesh.topology import components
from adaptmesh.types import Floats, Index

from .subject import Finding, Subject, finding


def single_turn(s: Subject) -> Finding:
    """The triangles of an inner point turn around it once.

    Positive triangles make a whole number of turns, so that the sum of their angles, to rounding,
    is enough; two turns are a fold.
    """
    n = len(s.mesh.points)
    turns = np.bincount(s.mesh.triangles.T.ravel(), corner_angles(s), minlength=n) / (2 * np.pi)
    inner = s.used.copy()
    inner[s.sides.ends(s.sides.border)] = False

    def show(v: int) -> str:
        return f"point {s.at(v)}: {turns[v]:.6g} turns"

    bad = np.flatnonzero(inner & (turns > 1.5))
    return finding(bad, f"{np.count_nonzero(inner)} inner points", "points are folded over", show)


def corner_angles(s: Subject) -> Floats:
    """The angles of all triangles, which are positive, at their three vertices, (3m,)."""
    p = s.points[s.mesh.triangles]
    angles = []
    for i in range(3):
        u, v = p[:, (i + 1) % 3] - p[:, i], p[:, (i + 2) % 3] - p[:, i]
        u /= np.abs(u).max(axis=1, keepdims=True)  # so that no product underflows
        v /= np.abs(v).max(axis=1, keepdims=True)
        turned = np.maximum(cross(u, v), 0.0)  # 0: by rounding
        angles.append(np.arctan2(turned, (u * v).sum(axis=1)))
    return np.concatenate(angles)


def simple_border(s: Subject) -> Finding:
    """The border does not cross itself, and no point of it hangs on another edge of it."""
    (e, f), _ = s.border_sweep
    if e < 0:
        return Finding(0, f"{len(s.sides.border)} edges of the border")
    ends = s.sides.ends(s.sides.border)
    pair = f"edges {s.at(*ends[e])} and {s.at(*ends[f])}"
    return Finding(1, "edges of the border cross or overlap, these and perhaps others", (pair,))


def covered_once(s: Subject) -> Finding:
    """One triangle lies on the left of every border edge, and none on its right."""
    _, layers = s.border_sweep
    border = s.sides.border

    def show(k: int) -> str:
        here = f"edge {s.edge(border[k])} of triangle {s.sides.triangle[s.sides.first[border[k]]]}"
        return f"{here}: {layers[k]} triangles lie over each other there"

    with np.errstate(over="ignore", invalid="ignore"):
        area = float(s.mesh.areas.sum())
    ends = s.sides.ends(border)
    pieces = _count_components(len(s.points), ends) - (len(s.points) - len(np.unique(ends)))
    wrong = "edges of the border lie over or under other triangles"
    good = f"area {area:.12g}; pieces of border: {pieces}"
    return finding(np.flatnonzero(layers != 1), good, wrong, show)


def euler(s: Subject) -> Finding:
    """Points - edges + triangles is what the connected pieces and the holes say.

    Every piece that hangs together by points counts one, every hole takes one away. The border is a
    planar graph with 1 + (its pieces) - (its points) + (its edges) faces: the outside, the holes,
    and one for each piece of the mesh that hangs together by edges.
    """
    sides = s.sides
    inner = sides.first[sides.count == 2]
    across = np.stack([sides.triangle[inner], sides.triangle[inner + 1]], axis=1)
    ends = sides.ends(np.arange(len(sides.first)))
    border = ends[sides.border]
    n, border_points = np.count_nonzero(s.used), len(np.unique(border))
    spare = len(s.points) - n  # points without a triangle are components of their own
    by_points = _count_components(len(s.points), ends) - spare
    by_edges = _count_components(len(s.mesh.triangles), across)
    border_pieces = _count_components(len(s.points), border) - (len(s.points) - border_points)
    holes = border_pieces - border_points + len(border) - by_edges
    found, expected = n - len(ends) + len(s.mesh.triangles), by_points - holes
    note = f"{n} - {len(ends)} + {len(s.mesh.triangles)} = {found}"
    if found == expected:
        return Finding(0, f"{note}; {by_points} pieces, {holes} holes")
    return Finding(1, f"{note}, but {by_points} pieces with {holes} holes make {expected}")


def _count_components(n: int, links: Index) -> int:
    """How many connected components n items have with these links."""
    return int(components(n, links).max(initial=-1)) + 1
