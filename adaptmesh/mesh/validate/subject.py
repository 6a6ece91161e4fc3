"""What every check looks at, and what it answers."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from functools import cached_property
from typing import TYPE_CHECKING, NamedTuple

import numpy as np
from numpy.typing import NDArray

from adaptmesh._core import orient2d, sweep_border
from adaptmesh.types import Bools, Floats, Index, Int64s

if TYPE_CHECKING:
    from adaptmesh.mesh.mesh import Mesh

SHOWN = 5  # offenders named for each check


class Finding(NamedTuple):
    """How many items break an invariant, in words, and the first few of them."""

    broken: int
    note: str = ""
    offenders: tuple[str, ...] = ()


def finding(bad: Index, good: str, wrong: str, show: Callable[[int], str]) -> Finding:
    """A finding from the numbers of the items that break it; `show` describes one of them."""
    if len(bad) == 0:
        return Finding(0, good)
    return Finding(len(bad), f"{len(bad)} {wrong}", tuple(show(int(i)) for i in bad[:SHOWN]))


@dataclass(frozen=True)
class Subject:
    """A mesh under examination, and what several checks derive from it."""

    mesh: Mesh

    @cached_property
    def exponent(self) -> int:
        """The coordinates are less than two to this power; at most 0 if some are subnormal.

        Dividing those by a power of two would round them, and change signs of areas.
        """
        p = self.mesh.points
        exponent = int(np.frexp(np.abs(p).max())[1])
        is_exact = bool((np.ldexp(np.ldexp(p, -exponent), exponent) == p).all())
        return exponent if is_exact else min(exponent, 0)

    def scale(self, points: Floats) -> Floats:
        """Points times the power of two that brings those of the mesh to about one.

        The signs of all areas stay the same, and nothing overflows.
        """
        return np.ldexp(points, -self.exponent)

    @cached_property
    def points(self) -> Floats:
        """The points of the mesh, scaled."""
        return self.scale(self.mesh.points)

    @cached_property
    def sides(self) -> Sides:
        """The sides of the triangles, edge by edge."""
        return Sides.of(self.mesh)

    @cached_property
    def border_sweep(self) -> tuple[tuple[int, int], NDArray[np.int32]]:
        """Two border edges that cross, or (-1, -1), and the triangles on the left of each."""
        ends = self.sides.ends(self.sides.border).astype(np.int32)
        return sweep_border(self.points, ends)

    def orient(self, a: Index, b: Index, c: Index) -> NDArray[np.int8]:
        """Exact signs of the areas of the triangles (a, b, c), given by point numbers."""
        p = self.points
        return np.asarray(orient2d(p[a], p[b], p[c]))

    @cached_property
    def used(self) -> Bools:
        """Which points belong to a triangle."""
        out = np.zeros(len(self.mesh.points), bool)
        out[self.mesh.triangles.ravel()] = True
        return out

    def at(self, *vertices: int) -> str:
        """Some points in words: number and exact coordinates."""
        xy = self.mesh.points
        return ", ".join(f"{v} ({float(xy[v, 0])!r}, {float(xy[v, 1])!r})" for v in vertices)

    def edge(self, e: int) -> str:
        """An edge of the triangles in words."""
        return self.at(*self.sides.ends(np.array([e]))[0])


@dataclass(frozen=True)
class Sides:
    """The directed sides of the triangles, sorted so that those of one edge stand together.

    ``tail``, ``head`` and ``triangle`` describe the sorted sides; edge ``e`` owns ``count[e]`` of
    them from ``first[e]`` on; ``keys`` are the sorted keys of the edges, see `edge_keys`.
    """

    tail: Int64s
    head: Int64s
    triangle: Int64s
    first: Int64s
    count: Int64s
    keys: Int64s

    @classmethod
    def of(cls, mesh: Mesh) -> Sides:
        t = mesh.triangles.astype(np.int64)
        tail, head = t.T.ravel(), t[:, [1, 2, 0]].T.ravel()
        # the direction is the last bit of the key: equal sides of an edge stand together too
        keys = 2 * edge_keys(tail, head, len(mesh.points)) + (tail > head)
        order = np.argsort(keys)
        edges = keys[order] >> 1
        first = np.flatnonzero(np.concatenate([[True], edges[1:] != edges[:-1]]))
        count = np.diff(np.append(first, len(edges)))
        return cls(tail[order], head[order], order % len(t), first, count, edges[first])

    @cached_property
    def border(self) -> Int64s:
        """Numbers of the edges with a single triangle; it lies on their left."""
        return np.flatnonzero(self.count == 1)

    def missing(self, keys: Int64s) -> Bools:
        """Which of these keys belong to no edge."""
        place = np.minimum(np.searchsorted(self.keys, keys), len(self.keys) - 1)
        return self.keys[place] != keys

    def ends(self, edges: Index) -> Int64s:
        """Tail and head of some edges, (k, 2), as the first triangle of each runs along it."""
        return np.stack([self.tail[self.first[edges]], self.head[self.first[edges]]], axis=1)


def edge_keys(a: Index, b: Index, n: int) -> Int64s:
    """One number for each pair out of n points, whatever their order."""
    return np.minimum(a, b).astype(np.int64) * n + np.maximum(a, b)
