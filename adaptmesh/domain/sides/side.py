"""The sides of a domain: its lines from corner to corner, straight or curved, with a parameter.

::

      A ------------ B ~~~~~~~~~~~ C          A straight side is a segment, or what is between two
        side 0, u in   side 1: a path of      points on it; its parameter u is the share of its
        [0, 1]         curves, u in [0, n]    length. A curved side is a path, see `paths`.

Each side has a direction of its own, a straight one from its left end (the lower one, if it is
upright): whatever is worked out along it is the same in all meshes, however the domain was given.
Where two sides are periodic, each point of the one has an image on the other.
"""

from __future__ import annotations

from dataclasses import dataclass, field
from functools import cached_property
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from adaptmesh.curves import Curve
from adaptmesh.domain.inputs import rows_of_each
from adaptmesh.geometry.products import angles_between
from adaptmesh.types import Bools, Floats, Index, Ints
from adaptmesh.value import Value

from .motion import Motion
from .paths import Path, derivatives_on, points_on


class SidePoints(NamedTuple):
    """Points of sides, in order along each side, the sides in order.

    Attributes
    ----------
    side : (k,) array of int
    u : (k,) array
        Parameters.
    """

    side: Index
    u: Floats

    @classmethod
    def none(cls) -> SidePoints:
        return cls(np.empty(0, np.intp), np.empty(0))

    def where(self, chosen: Bools | Index) -> SidePoints:
        """Some of the points (k,)."""
        return SidePoints(self.side[chosen], self.u[chosen])

    def joined(self, other: SidePoints) -> SidePoints:
        """These points and others, each once."""
        side, u = np.concatenate([self.side, other.side]), np.concatenate([self.u, other.u])
        order = np.lexsort((u, side))
        side, u = side[order], u[order]
        is_new = np.ones(len(u), bool)
        is_new[1:] = (np.diff(side) != 0) | (np.diff(u) != 0)
        return SidePoints(side[is_new], u[is_new])

    def counts(self, n_sides: int) -> NDArray[np.intp]:
        """How many points each of n sides has."""
        return np.bincount(self.side, minlength=n_sides)

    def on(self, side: int) -> Floats:
        """The parameters on one side."""
        return self.u[slice(*np.searchsorted(self.side, [side, side + 1]))]

    def rank_in(self, others: SidePoints, strictly: bool = False) -> Index:
        """How many of others, in order, do not come after each point; or come before it."""
        n = len(others.u)
        side, u = np.concatenate([others.side, self.side]), np.concatenate([others.u, self.u])
        is_other = np.arange(len(u)) < n
        order = np.lexsort((is_other if strictly else ~is_other, u, side))
        out = np.empty(len(u), np.intp)
        out[order] = np.cumsum(is_other[order])
        return out[n:]

    def is_in(self, others: SidePoints) -> Bools:
        """Which points are among others, in order."""
        last = self.rank_in(others) - 1
        out = last >= 0
        last = last[out]
        out[out] = (others.side[last] == self.side[out]) & (others.u[last] == self.u[out])
        return out

    def within(self, parts: SideParts) -> Index:
        """The part that each point lies inside of, (k,), -1 for none."""
        number = np.lexsort((parts.u[:, 0], parts.side))
        parts = parts.where(number)
        last = self.rank_in(SidePoints(parts.side, parts.u[:, 0]), strictly=True) - 1
        out = np.full(len(last), -1)
        some = np.flatnonzero(last >= 0)
        part = last[some]
        inside = (parts.side[part] == self.side[some]) & (self.u[some] < parts.u[part, 1])
        out[some[inside]] = number[part[inside]]
        return out


class SideParts(NamedTuple):
    """Parts of sides that do not overlap.

    Attributes
    ----------
    side : (p,) array of int
    u : (p, 2) array
        The parameters of the ends of each.
    """

    side: Index
    u: Floats

    def where(self, chosen: Bools | Index) -> SideParts:
        """Some of the parts."""
        return SideParts(self.side[chosen], self.u[chosen])


@dataclass(frozen=True)
class Image:
    """The side that is the image of another.

    Attributes
    ----------
    side : int
    motion : Motion
        From the other one to it.
    is_reversed : bool
        Whether the image of the first end is the second end.
    names : (str, str)
        The two boundaries that are periodic.
    """

    side: int
    motion: Motion
    is_reversed: bool
    names: tuple[str, str]


@dataclass(frozen=True, eq=False)
class Sides(Value):
    """All sides of a domain: first the straight ones, then the curved ones.

    Attributes
    ----------
    corners : (n, 2) array
        The points of the domain that are vertices of every mesh.
    ends : (s, 2) array of int
        The corners where each side begins and ends.
    paths : tuple of Path
        The curved sides.
    loose : (m, 2) array
        Points beside the sides that say what is where: seeds of holes and of regions.
    curves : tuple of Curve
        Those that the domain was made of, if it was.
    straight_curves : (s - p,) array of int32
        The curve that each straight side is a part of; -1 for none.

    The others are empty while a domain is made of curves:

    inscribed : tuple of arrays
        For each path parameters, with both ends, between which it turns by little.
    segments : (s,) array of int32
        A segment of the domain that lies on each side.
    tags : (s,) array of int32
        The number of the name of each.
    is_frozen : (s,) array of bool
        Which are not to be cut.
    images : dict of int to Image
        For each side that is periodic with another one.
    """

    corners: Floats
    ends: Index
    paths: tuple[Path, ...]
    loose: Floats
    curves: tuple[Curve, ...]
    straight_curves: Ints
    inscribed: tuple[Floats, ...] = ()
    segments: Ints = field(default_factory=lambda: np.empty(0, np.int32))
    tags: Ints = field(default_factory=lambda: np.empty(0, np.int32))
    is_frozen: Bools = field(default_factory=lambda: np.empty(0, bool))
    images: dict[int, Image] = field(default_factory=dict)

    def __len__(self) -> int:
        return len(self.ends)

    @property
    def n_straight(self) -> int:
        return len(self.ends) - len(self.paths)

    @cached_property
    def is_straight(self) -> Bools:
        """Which sides are straight, (s,)."""
        return np.arange(len(self)) < self.n_straight

    @cached_property
    def lengths(self) -> Floats:
        """The parameter of the second end of each, (s,); that of the first is 0."""
        return np.concatenate([np.ones(self.n_straight), [path.length for path in self.paths]])

    def whole(self) -> SideParts:
        """Each side as a part of itself."""
        return SideParts(
            np.arange(len(self)), np.stack([np.zeros(len(self)), self.lengths], axis=1)
        )

    def path(self, side: int) -> Path:
        """A curved side."""
        return self.paths[side - self.n_straight]

    def point(self, side: Index, u: Floats) -> Floats:
        """Points (k, 2) at the parameters u (k,) of sides (k,)."""
        straight = self.is_straight[side]
        a, b = (self.corners[self.ends[side, i]] for i in (0, 1))
        out: Floats = np.where(u[:, None] == 1, b, a + u[:, None] * (b - a))
        curved = ~straight
        if curved.any():
            out[curved] = points_on(self.paths, side[curved] - self.n_straight, u[curved])
        return out

    def derivative(self, side: Index, u: Floats) -> Floats:
        """Derivatives (k, 2) by u at the parameters u (k,) of sides (k,)."""
        a, b = (self.corners[self.ends[side, i]] for i in (0, 1))
        out: Floats = b - a
        curved = ~self.is_straight[side]
        if curved.any():
            out[curved] = derivatives_on(self.paths, side[curved] - self.n_straight, u[curved])
        return out

    def turn(self, side: Index, u: Floats) -> Floats:
        """By what angle sides (k,) have turned from their beginnings to u (k,), in radians.

        From the inscribed chords, about: a chord has the direction of the curve at its middle.
        """
        out = np.zeros(len(side))
        for s, mine in rows_of_each(side).items():
            if s >= self.n_straight:
                middles, turned = self._turning[s - self.n_straight]
                out[mine] = np.interp(u[mine], middles, turned)
        return out

    @cached_property
    def _turning(self) -> list[tuple[Floats, Floats]]:
        """Middles of the inscribed chords of each path, and the turns from the first of them."""
        out = []
        for path, u in zip(self.paths, self.inscribed, strict=True):
            turns = turns_between(np.diff(path.point(u), axis=0))
            out.append((0.5 * (u[1:] + u[:-1]), np.concatenate([[0.0], np.cumsum(turns)])))
        return out

    def image(self, side: int, u: Floats) -> Floats:
        """The parameters of the images of points of a periodic side; ends go to ends."""
        image, length = self.images[side], self.lengths[side]
        if self.is_straight[side]:
            return 1 - u if image.is_reversed else u
        out = self.path(image.side).nearest(image.motion(self.path(side).point(u)))
        far = self.lengths[image.side]
        begin, end = (far, 0.0) if image.is_reversed else (0.0, far)
        return np.where(u == 0, begin, np.where(u == length, end, out))


def turns_between(vectors: Floats) -> Floats:
    """Angles between successive vectors (k, 2), (k - 1,)."""
    return angles_between(vectors[:-1], vectors[1:])


def in_canonical_direction(points: Floats, pairs: Index) -> Index:
    """Pairs of points (k, 2), the left one first, or the lower one of two above each other."""
    p, q = points[pairs[:, 0]], points[pairs[:, 1]]
    turned = (p[:, 0] > q[:, 0]) | ((p[:, 0] == q[:, 0]) & (p[:, 1] > q[:, 1]))
    return np.where(turned[:, None], pairs[:, ::-1], pairs)
