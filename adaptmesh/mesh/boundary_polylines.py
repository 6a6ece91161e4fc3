"""The constrained edges of a mesh, in rows along the lines of its domain.

::

    A---o---o-----o--o---o---B      a line of the domain from A to B, and a mesh's row along it
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import NamedTuple

import numpy as np

from adaptmesh.domain.projection import places_on_runs, tolerance_of
from adaptmesh.domain.side import Lines
from adaptmesh.topology import components, edge_keys
from adaptmesh.types import Floats, Index, Ints

from .data import MeshData


@dataclass(frozen=True)
class Chains:
    """Rows of vertices along lines.

    Attributes
    ----------
    vertices : (c,) array of int32
        All rows, one after the other, each from the first end of its line to the second.
    places : (c,) array of float
        Where along its line each is; see `Lines`.
    first : (l + 1,) array of int32
        Where the row of each line begins.
    """

    vertices: Ints
    places: Floats
    first: Ints

    @property
    def lines(self) -> Ints:
        """The line of each vertex of the rows, (c,)."""
        return np.repeat(np.arange(len(self.first) - 1, dtype=np.int32), np.diff(self.first))

    @property
    def edges(self) -> Ints:
        """All edges of the rows, (e, 2)."""
        at = self._starts
        return np.stack([self.vertices[at], self.vertices[at + 1]], axis=1)

    @property
    def edge_lines(self) -> Ints:
        """The line that each edge lies on, (e,)."""
        return self.lines[self._starts]

    @property
    def _starts(self) -> Index:
        """The number in `vertices` of the first end of every edge of the rows."""
        is_start = np.ones(len(self.vertices), bool)
        is_start[self.first[1:] - 1] = False
        return np.flatnonzero(is_start)


class Inner(NamedTuple):
    """The vertices of constrained edges that are no corners.

    Attributes
    ----------
    vertices, rows : (k,) arrays of int
        Their numbers in the mesh, and the row of each.
    points : (k, 2) array
    run, u, which : (p,) arrays
        Places of runs that they lie on: the run, its parameter, and which of them it is.
    """

    vertices: Index
    rows: Index
    points: Floats
    run: Index
    u: Floats
    which: Index


def find_chains(mesh: MeshData, lines: Lines) -> Chains | None:
    """The rows of a mesh along lines; None if its constrained edges are not along these."""
    corner = vertices_at(mesh, lines.corners)
    if (corner < 0).any() or not len(mesh.edges) or _regions_leak(mesh):
        return None
    number = np.full(len(mesh.points), -1)
    number[corner] = np.arange(len(corner))
    row = _rows(mesh.edges, number)

    edge, side = np.nonzero(number[mesh.edges] >= 0)
    order = np.argsort(row[edge], kind="stable")
    rows, corners = row[edge][order], number[mesh.edges[edge, side]][order]
    if not np.array_equal(rows, np.repeat(np.arange(len(lines)), 2)):
        return None  # there are too many rows, or some without two ends
    inner = _inner(mesh, number, row, lines)
    line = _lines_of_rows(corners.reshape(-1, 2), inner, lines)
    places = None if line is None else _places(inner, line[inner.rows], lines)
    if line is None or places is None:
        return None
    return _in_order(mesh, corner, inner.vertices, line[inner.rows], places, lines)


def vertices_at(mesh: MeshData, points: Floats) -> Ints:
    """The vertex of a mesh at each of these points (k, 2), bit for bit; -1 where there is none."""
    everything = np.concatenate([mesh.points, points]) + 0.0  # -0.0 becomes 0.0
    _, group = np.unique(everything, axis=0, return_inverse=True)
    group = group.ravel()
    vertex = np.full(group.max() + 1, -1, np.int32)
    vertex[group[: len(mesh.points)]] = np.arange(len(mesh.points))
    return vertex[group[len(mesh.points) :]]


def _regions_leak(mesh: MeshData) -> bool:
    """Whether two regions meet without a constrained edge between them."""
    if (mesh.regions == mesh.regions[0]).all():
        return False
    t = mesh.triangles
    keys = np.stack([edge_keys(t[:, [i, i - 1]], len(mesh.points)) for i in range(3)], axis=1)
    order = np.argsort(keys, axis=None, kind="stable")
    keys, regions = keys.ravel()[order], np.repeat(mesh.regions, 3)[order]
    differ = (keys[1:] == keys[:-1]) & (regions[1:] != regions[:-1])
    return not np.isin(keys[1:][differ], edge_keys(mesh.edges, len(mesh.points))).all()


def _rows(edges: Ints, number: Index) -> Index:
    """The row of each edge, (e,): edges that share a vertex that is no corner are in one."""
    n, e = len(number), len(edges)
    edge, side = np.nonzero(number[edges] < 0)
    shared = edges[edge, side]
    label = components(e + n, np.stack([edge, e + shared], axis=1))[:e]
    return np.unique(label, return_inverse=True)[1].ravel()


def _inner(mesh: MeshData, number: Index, row: Index, lines: Lines) -> Inner:
    edge, side = np.nonzero(number[mesh.edges] < 0)
    vertices, first = np.unique(mesh.edges[edge, side], return_index=True)
    points = mesh.points[vertices]
    none = np.empty(0, np.intp)
    on_runs: tuple[Index, Floats, Index] = none, np.empty(0), none
    if lines.domain.curved.runs:
        on_runs = places_on_runs(lines.domain, points, tolerance_of(lines.domain))
    return Inner(vertices, row[edge[first]], points, *on_runs)


def _lines_of_rows(corners: Index, inner: Inner, lines: Lines) -> Index | None:
    """The line of each row, (r,), from the corners at its ends (r, 2).

    Several lines may join the same two corners, or begin and end at one; but no two straight ones.
    """
    keys, line_keys = (
        edge_keys(corners, len(lines.corners)),
        edge_keys(lines.ends, len(lines.corners)),
    )
    order, line_order = np.argsort(keys, kind="stable"), np.argsort(line_keys, kind="stable")
    if not np.array_equal(keys[order], line_keys[line_order]):
        return None
    out = np.empty(len(keys), np.intp)
    out[order] = line_order
    _, first, count = np.unique(keys[order], return_index=True, return_counts=True)
    for i, n in zip(first[count > 1].tolist(), count[count > 1].tolist(), strict=True):
        chosen = _told_apart(order[i : i + n], line_order[i : i + n], inner, lines)
        if chosen is None:
            return None
        out[order[i : i + n]] = chosen
    return out


def _told_apart(rows: Index, candidates: Index, inner: Inner, lines: Lines) -> list[int] | None:
    """The line of each of some rows that end at the same corners.

    It is the run that an inner vertex lies on, or else the straight line; a row without an inner
    vertex gets what is left.
    """
    left = candidates.tolist()
    out = []
    for row in rows.tolist():
        mine = np.flatnonzero(inner.rows == row)
        on = (lines.n_straight + inner.run[inner.which == mine[0]]).tolist() if len(mine) else []
        fitting = [k for k in left if k in on] or [k for k in left if k < lines.n_straight]
        out.append(fitting[0] if len(mine) and fitting else -1)
        left = [k for k in left if k != out[-1]]
    if out.count(-1) != len(left) or len(left) > 1:
        return None
    return [k if k >= 0 else left[0] for k in out]


def _places(inner: Inner, line: Index, lines: Lines) -> Floats | None:
    """Where along its line each inner vertex is, (k,); None if one of them is not on it."""
    out = np.full(len(line), np.nan)
    straight = line < lines.n_straight
    a, b = (lines.corners[lines.ends[line[straight], i]] for i in (0, 1))
    along, off = b - a, inner.points[straight] - a
    out[straight] = (off * along).sum(axis=1) / (along**2).sum(axis=1)
    beside = np.abs(off[:, 0] * along[:, 1] - off[:, 1] * along[:, 0])
    if (beside > tolerance_of(lines.domain) * np.hypot(*along.T)).any():
        return None
    right = line[inner.which] == lines.n_straight + inner.run
    out[inner.which[right]] = inner.u[right]
    return None if np.isnan(out).any() else out


def _in_order(
    mesh: MeshData, corner: Index, inner: Index, line: Index, places: Floats, lines: Lines
) -> Chains | None:
    """Rows of the corners at the ends of each line, and the inner vertices by their places."""
    every = np.arange(len(lines))
    line = np.concatenate([every, every, line])
    vertex = np.concatenate([corner[lines.ends[:, 0]], corner[lines.ends[:, 1]], inner])
    places = np.concatenate([np.zeros(len(lines)), lines.lengths, places])
    order = np.lexsort([places, line])
    first = np.searchsorted(line[order], np.arange(len(lines) + 1)).astype(np.int32)
    chains = Chains(vertex[order].astype(np.int32), places[order], first)
    ours, theirs = (
        np.sort(edge_keys(edges, len(mesh.points))) for edges in (chains.edges, mesh.edges)
    )
    return chains if np.array_equal(ours, theirs) else None
