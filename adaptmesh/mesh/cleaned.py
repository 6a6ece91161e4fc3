"""What a mesh of another program may have too much of: loose points, double vertices and edges."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace
from typing import NamedTuple

import numpy as np

from adaptmesh._core import orient2d
from adaptmesh.domain.inputs import name_of_number
from adaptmesh.errors import DomainError
from adaptmesh.geometry.distance import near_points
from adaptmesh.topology import unique_edges
from adaptmesh.types import Index, Int64s

from .data import M, MeshData


class OnceEach(NamedTuple):
    """Edges, each listed once.

    Attributes
    ----------
    rows : (e,) array
        The first row of each edge, ascending.
    tags : (e,) array
        The tag that any row of it has; 0 if none has one.
    edge : (k,) array
        The edge of each row.
    """

    rows: Int64s
    tags: Int64s
    edge: Int64s


def edges_once(
    edges: Index,
    tags: Index,
    names: Mapping[str, int],
    error: type[Exception],
) -> OnceEach:
    """List each edge once, if all its rows say the same.

    Parameters
    ----------
    edges : (k, 2) array
        In any direction.
    tags : (k,) array
        0 for a row that says nothing.
    names : mapping of str to int
        Of tags, for the message.
    error : type
        What is raised, with both rows, if an edge has two tags.
    """
    _, edge, _ = unique_edges(np.asarray(edges, np.int64))
    _, rows, order = np.unique(edge, return_index=True, return_inverse=True)
    rank = np.empty(len(rows), np.int64)
    rank[np.argsort(rows)] = np.arange(len(rows))
    edge, rows = rank[order.reshape(-1)], np.sort(rows)
    tagged = np.flatnonzero(tags)[::-1]
    first = np.full(len(rows), -1)
    first[edge[tagged]] = tagged  # of the tagged rows of an edge the first is written last
    out = np.where(first >= 0, np.append(tags, 0)[first], 0)
    other = np.flatnonzero((tags != 0) & (tags != out[edge]))
    if len(other):
        j = int(other[0])
        i = int(first[edge[j]])
        name_of = name_of_number(names, np.asarray(tags))
        raise error(
            f"edges {i} and {j} are the same, {edges[j].tolist()}, but one has the tag "
            f"{name_of[int(tags[i])]!r} and the other {name_of[int(tags[j])]!r}: remove one"
        )
    return OnceEach(rows, out, edge)


def with_edges_once(mesh: M) -> M:
    """The mesh with each constrained edge listed once, or a `DomainError` if it has two tags."""
    once = edges_once(mesh.edges, mesh.edge_tags, mesh.names, DomainError)
    if len(once.rows) == len(mesh.edges):
        return mesh
    return replace(
        mesh,
        edges=mesh.edges[once.rows],
        edge_tags=once.tags.astype(np.int32),
        required_edges=np.unique(once.edge[mesh.required_edges]).astype(np.int32),
    )


def cleaned_mesh(mesh: M, merge: float | None) -> M:
    """As `Mesh.cleaned`."""
    if merge is not None and not 0 <= merge < np.inf:
        raise ValueError(f"merge={merge!r}: expected a distance of at least 0")
    n = len(mesh.points)
    for what, cells in (("triangle", mesh.triangles), ("edge", mesh.edges)):
        bad = np.flatnonzero(((cells < 0) | (cells >= n)).any(axis=1))
        if len(bad):
            raise DomainError(
                f"{what} {bad[0]} has vertices {cells[bad[0]].tolist()}, but the points are "
                f"numbered 0 to {n - 1}"
            )
    vertex = np.arange(n)
    if merge is not None:
        for v, kept in near_points(mesh.points, merge):
            vertex[v] = kept
        vertex = vertex[vertex]  # equal to one that is near another
    triangles, edges = vertex[mesh.triangles], vertex[mesh.edges]
    _refuse_collapsed(mesh, triangles, merge)
    used = np.unique(triangles)
    number = np.full(n, -1)
    number[used] = np.arange(len(used))
    loose = np.flatnonzero((number[edges] < 0).any(axis=1))
    if len(loose):
        raise DomainError(
            f"edge {loose[0]}, {mesh.edges[loose[0]].tolist()}, ends at a point of no triangle: "
            "remove it"
        )
    required = number[vertex[mesh.required_points]]
    if (required < 0).any():
        i = int(mesh.required_points[required < 0][0])
        raise DomainError(f"point {i} is required, but in no triangle: mesh around it")
    new = replace(
        mesh,
        points=mesh.points[used],
        triangles=number[triangles].astype(np.int32),
        edges=number[edges].astype(np.int32),
        required_points=np.unique(required).astype(np.int32),
        kept=used.astype(np.int32),
    )
    return with_edges_once(new)


def _refuse_collapsed(mesh: MeshData, triangles: Int64s, merge: float | None) -> None:
    """Refuse to merge vertices of one triangle, or so that a triangle is turned over."""
    if merge is None:
        return
    twice = (triangles == np.roll(triangles, 1, axis=1)).any(axis=1)
    a, b, c = (np.ascontiguousarray(mesh.points[v]) for v in triangles.T)
    bad = np.flatnonzero(twice | (orient2d(a, b, c) <= 0))
    if len(bad):
        i = int(bad[0])
        place = tuple(mesh.points[mesh.triangles[i]].mean(axis=0).tolist())
        raise DomainError(
            f"triangle {i} at {place} has no area, or is clockwise, if vertices nearer than "
            f"{merge:g} are made one: merge less"
        )
