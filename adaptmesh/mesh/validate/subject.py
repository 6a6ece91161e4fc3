"""What every check looks at, and what it answers."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from functools import cached_property
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from adaptmesh._core import orient2d, sweep_border
from adaptmesh.mesh.data import MeshData
from adaptmesh.topology import HalfEdges
from adaptmesh.types import Bools, Floats, Index, Ints

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

    mesh: MeshData

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
    def sides(self) -> HalfEdges:
        """The sides of the triangles, edge by edge."""
        return HalfEdges.of(self.mesh.triangles, len(self.mesh.points))

    @cached_property
    def border_sweep(self) -> tuple[tuple[int, int], Ints]:
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
