"""The constrained edges of a mesh, in rows along the pieces of its domain; cut anew where off unit.

::

    A---o---o-----o--o---o---B      a piece of the domain from A to B, and a mesh's row along it
            [-----------]           a stretch with an edge that is not unit, and its neighbours,
    A---o---o---n---n---o---B       cut into equal parts
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any, TypeVar

import numpy as np
from numpy.typing import NDArray
from scipy.sparse import coo_array
from scipy.sparse.csgraph import connected_components

from metrics import ControlSpace

from . import _core
from .domain import Domain
from .edge_lengths import measure_edges, sampler_of, straight_lengths
from .invariants.subject import edge_keys
from .mesh import Mesh
from .periodic import frozen_pieces

Floats = NDArray[np.float64]
Ints = NDArray[np.int32]
T = TypeVar("T", bound=np.generic)

UNIT = (float(np.sqrt(0.5)) * (1 - 1e-9), float(np.sqrt(2)) * (1 + 1e-9))

# A stretch that cannot be cut into parts this near to unit takes in a neighbour, so many times.
GOOD = (0.8, 1.25)
MOST_NEIGHBOURS = 4


@dataclass(frozen=True)
class Chains:
    """Rows of vertices along the pieces of a domain.

    Attributes
    ----------
    vertices : (c,) array of int32
        All rows, one after the other, each from the first end of its piece to the second.
    places : (c,) array of float
        How far along its piece each is, from 0 to 1.
    first : (p + 1,) array of int32
        Where the row of each piece begins.
    """

    vertices: Ints
    places: Floats
    first: Ints

    @property
    def edge_starts(self) -> Ints:
        """The number in `vertices` of the first end of every edge of the rows."""
        is_start = np.ones(len(self.vertices), bool)
        is_start[self.first[1:] - 1] = False
        return np.flatnonzero(is_start).astype(np.int32)

    @property
    def edges(self) -> Ints:
        """All edges of the rows, (e, 2)."""
        at = self.edge_starts
        return np.stack([self.vertices[at], self.vertices[at + 1]], axis=1)

    @property
    def edge_pieces(self) -> Ints:
        """The piece that each edge lies on, (e,)."""
        return np.repeat(np.arange(len(self.first) - 1, dtype=np.int32), np.diff(self.first) - 1)


def find_chains(mesh: Mesh, domain: Domain) -> Chains | None:
    """The rows of a mesh along the pieces of its domain.

    None if its constrained edges are not along these pieces, or if there is more to a row than its
    own length: on curves, and where two boundaries correspond.
    """
    if domain.curved.runs or domain.periodic:
        return None
    corner = vertices_at(mesh, domain.points)
    if (corner < 0).any() or not len(mesh.edges) or _regions_leak(mesh):
        return None
    number = np.full(len(mesh.points), -1)
    number[corner] = np.arange(len(corner))
    ends = number[mesh.edges]

    # Edges that share a vertex other than the points of the domain belong to one row.
    n, e = len(mesh.points), len(mesh.edges)
    edge, side = np.nonzero(ends < 0)
    shared = mesh.edges[edge, side]
    graph = coo_array((np.ones(len(edge)), (edge, e + shared)), shape=(e + n, e + n))
    row = connected_components(graph, directed=False)[1][:e]
    edge, side = np.nonzero(ends >= 0)
    order = np.argsort(row[edge], kind="stable")
    rows, corners = row[edge][order], ends[edge, side][order]
    if len(rows) != 2 * len(domain.pieces) or (rows[::2] != rows[1::2]).any():
        return None
    piece_keys = _keys(domain.pieces, len(corner))
    keys = edge_keys(corners[::2], corners[1::2], len(corner))
    sorter = np.argsort(piece_keys)
    found = np.minimum(np.searchsorted(piece_keys, keys, sorter=sorter), len(sorter) - 1)
    piece = sorter[found]
    if (piece_keys[piece] != keys).any() or len(np.unique(piece)) != len(domain.pieces):
        return None
    piece_of_row = np.full(row.max() + 1, -1)
    piece_of_row[rows[::2]] = piece
    return _in_order(mesh, domain, corner, piece_of_row[row])


def _in_order(mesh: Mesh, domain: Domain, corner: Ints, pieces: Ints) -> Chains | None:
    """Rows from the piece of each constrained edge: vertices sorted by their place along it."""
    pairs = np.unique(np.stack([np.repeat(pieces, 2), mesh.edges.ravel()], axis=1), axis=0)
    piece, vertex = pairs.T
    start, end = domain.points[domain.pieces[piece, 0]], domain.points[domain.pieces[piece, 1]]
    along = end - start
    places = np.sum((mesh.points[vertex] - start) * along, axis=1) / np.sum(along**2, axis=1)
    order = np.lexsort([places, piece])
    first = np.searchsorted(piece[order], np.arange(len(domain.pieces) + 1))
    chains = Chains(vertex[order].astype(np.int32), places[order], first.astype(np.int32))
    n = len(mesh.points)
    ours, theirs = _keys(chains.edges, n), _keys(mesh.edges, n)
    return chains if np.array_equal(np.sort(ours), np.sort(theirs)) else None


def vertices_at(mesh: Mesh, points: Floats) -> Ints:
    """The vertex of a mesh at each of these points (k, 2), bit for bit; -1 where there is none."""
    everything = np.concatenate([mesh.points, points]) + 0.0  # -0.0 becomes 0.0
    _, group = np.unique(everything, axis=0, return_inverse=True)
    group = group.ravel()
    vertex = np.full(group.max() + 1, -1, np.int32)
    vertex[group[: len(mesh.points)]] = np.arange(len(mesh.points))
    out: Ints = vertex[group[len(mesh.points) :]]
    return out


def _regions_leak(mesh: Mesh) -> bool:
    """Whether two regions meet without a constrained edge between them."""
    if (mesh.regions == mesh.regions[0]).all():
        return False
    t = mesh.triangles
    keys = np.stack([edge_keys(t[:, i], t[:, i - 1], len(mesh.points)) for i in range(3)], axis=1)
    order = np.argsort(keys, axis=None, kind="stable")
    keys, regions = keys.ravel()[order], np.repeat(mesh.regions, 3)[order]
    differ = (keys[1:] == keys[:-1]) & (regions[1:] != regions[:-1])
    return not np.isin(keys[1:][differ], _keys(mesh.edges, len(mesh.points))).all()


def recut(mesher: _core.Mesher, chains: Chains, domain: Domain, field: ControlSpace) -> Chains:
    """Cut the rows anew where their edges are not unit; what cannot be cut stays as it is."""
    points = mesher.points()[chains.vertices]
    at = chains.edge_starts
    lengths = straight_lengths(points, np.stack([at, at + 1], axis=1), field)
    stretches = _stretches(chains, lengths, frozen_pieces(domain))
    if not len(stretches):
        return chains
    begin, end = stretches.T
    sampler = sampler_of(points, field(points), stretches)
    measure_edges(sampler, field)
    cuts, owner = sampler.cut()
    vector = (points[end] - points[begin])[owner]
    share = np.sum((cuts - points[begin[owner]]) * vector, axis=1) / np.sum(vector**2, axis=1)
    low, high = chains.places[begin[owner]], chains.places[end[owner]]

    piece = np.searchsorted(chains.first, begin, side="right") - 1
    inside = np.concatenate([np.arange(b, e + 1) for b, e in stretches])
    vertices, places, first = mesher.recut(
        _offsets(end - begin + 1),
        chains.vertices[inside],
        chains.places[inside],
        _offsets(np.bincount(owner, minlength=len(stretches))),
        cuts,
        field(cuts),
        low + share * (high - low),
        domain.piece_segments[piece],
    )
    grown = np.bincount(piece, np.diff(first) - (end - begin + 1), len(chains.first) - 1)
    return Chains(
        _replaced(chains.vertices, stretches, np.split(vertices, first[1:-1])),
        _replaced(chains.places, stretches, np.split(places, first[1:-1])),
        (chains.first + _offsets(grown)).astype(np.int32),
    )


def _stretches(chains: Chains, lengths: Floats, is_frozen: NDArray[np.bool_]) -> Ints:
    """What to cut anew, (s, 2): numbers in `vertices` of the first and the last vertex of each."""
    first_edge = chains.first - np.arange(len(chains.first))
    pieces = chains.edge_pieces
    out, done = [], 0
    for edge in np.flatnonzero((lengths < UNIT[0]) | (lengths > UNIT[1])).tolist():
        if edge < done:
            continue
        piece = int(pieces[edge])
        if is_frozen[piece]:
            continue
        least, most = max(int(first_edge[piece]), done), int(first_edge[piece + 1])
        a, b = _stretch_around(edge, least, most, lengths)
        done = b
        parts, part = unit_parts(lengths[a:b].sum())
        if parts != b - a or np.ptp(lengths[a:b]) > 0.02 * part:
            out.append((a + piece, b + piece))
    return np.array(out, np.int32).reshape(-1, 2)


def _stretch_around(edge: int, least: int, most: int, lengths: Floats) -> tuple[int, int]:
    """Edges [a, b) within [least, most) around one that is not unit, that cut into good parts."""

    def badness(a: int, b: int) -> float:
        _, part = unit_parts(lengths[a:b].sum())
        return float(abs(np.log(part)))

    a, b = edge, edge + 1
    for _ in range(MOST_NEIGHBOURS):
        while b < most and not UNIT[0] <= lengths[b] <= UNIT[1]:
            b += 1
        if GOOD[0] <= unit_parts(lengths[a:b].sum())[1] <= GOOD[1]:
            break
        wider = [(a - 1, b)] * (a > least) + [(a, b + 1)] * (b < most)
        if not wider:
            break
        a, b = min(wider, key=lambda w: badness(*w))
    return a, b


def unit_parts(length: float) -> tuple[int, float]:
    """How many parts bring a length nearest to unit, and how long they are then."""
    parts = max(1, int(0.5 * (1 + np.sqrt(1 + 4 * (length * (1 - 1e-9)) ** 2))))
    return parts, length / parts


def _keys(edges: Ints, n_points: int) -> NDArray[np.int64]:
    return edge_keys(edges[:, 0], edges[:, 1], n_points)


def _offsets(counts: NDArray[Any]) -> Ints:
    return np.concatenate([[0], np.cumsum(counts)]).astype(np.int32)


def _replaced(row: NDArray[T], stretches: Ints, by: list[NDArray[T]]) -> NDArray[T]:
    """A row with each stretch [begin, end], sorted, replaced by another from and to the same.

    One may begin where another ends: the last of each is left to what follows.
    """
    by = [part[:-1] for part in by]
    cuts = [0, *stretches.ravel().tolist(), len(row)]
    kept = [row[i:j] for i, j in zip(cuts[::2], cuts[1::2], strict=True)]
    parts = [part for pair in zip(kept, by, strict=False) for part in pair]
    return np.concatenate([*parts, kept[-1]])
