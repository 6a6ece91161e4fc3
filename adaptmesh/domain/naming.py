"""Sides chosen by where they are: by a function of places, by the nearest point, by direction.

Sides are the segments of a domain, its curves, or the constrained edges of a mesh. What is chosen
gets a name, in ``names=`` of a `Domain` or an `Outline`, or later by `with_names`::

    Domain.polygon(shape, names={"inlet": lambda x: x[:, 0] < 1e-9, "lid": facing((0, 1))})
"""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections.abc import Callable, Iterable, Mapping
from dataclasses import dataclass
from functools import cached_property
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import ArrayLike

from adaptmesh.checks import check_is_mapping, checked_points
from adaptmesh.errors import DomainError
from adaptmesh.types import Bools, Floats, Ints

from .inputs import ByLabel, Label

if TYPE_CHECKING:
    import shapely
from adaptmesh.value import Value

LOOKS = (np.arange(9) + 0.5) / 9
"""Where along each side, from 0 to 1, a condition is looked at: not at its ends, which other sides
share."""

SAME = 1e-9
"""Sides are equally near a point if their distances differ by at most this share of the extent."""


@dataclass(frozen=True, eq=False)
class SideSamples:
    """Sides by samples of them, and what can be asked of these.

    Attributes
    ----------
    ends : (k, 2, 2) array
    places : (k, s, 2) array
        Places on each, between its ends.
    outward : (k, s, 2) array
        Unit normals there, away from the domain; NaN for sides that do not bound it.
    describe : callable
        What to call a side in a message, by number.
    """

    ends: Floats
    places: Floats
    outward: Floats
    describe: Callable[[int], str]

    def __len__(self) -> int:
        return len(self.ends)

    @property
    def paths(self) -> Floats:
        """Each side as a polyline, (k, s + 2, 2)."""
        return np.concatenate([self.ends[:, :1], self.places, self.ends[:, 1:]], axis=1)

    @cached_property
    def extent(self) -> float:
        """The longer side of the box around the paths."""
        return float(np.ptp(self.paths.reshape(-1, 2), axis=0).max())

    @cached_property
    def tree(self) -> shapely.STRtree:
        """A search tree of the paths."""
        import shapely

        return shapely.STRtree(shapely.linestrings(self.paths))

    def whole(self, holds: Bools, name: Label) -> Bools:
        """Which sides a condition (k, s) holds on; a `DomainError` if on a part of one only."""
        some, every = holds.any(axis=1), np.asarray(holds.all(axis=1))
        half = np.flatnonzero(some & ~every)
        if len(half):
            i = int(half[0])
            (x, y), (u, v) = self.places[i, holds[i].argmax()], self.places[i, holds[i].argmin()]
            raise DomainError(
                f"what name {name!r} is given to holds on a part of {self.describe(i)} only, at "
                f"({x:.10g}, {y:.10g}) but not at ({u:.10g}, {v:.10g}): divide it, or choose "
                "otherwise"
            )
        return every


def straight_sides(ends: Floats, outward: Floats, describe: Callable[[int], str]) -> SideSamples:
    """Sides that are straight, from their ends (k, 2, 2) and normals (k, 2)."""
    places = ends[:, None, 0] + LOOKS[:, None] * (ends[:, None, 1] - ends[:, None, 0])
    return SideSamples(ends, places, np.repeat(outward[:, None], len(LOOKS), axis=1), describe)


class Selector(Value, ABC):
    """A way to choose sides."""

    @abstractmethod
    def choose(self, sides: SideSamples, name: Label) -> Bools:
        """Which sides get the name, (k,)."""


@dataclass(frozen=True, eq=False)
class Where(Selector):
    """Sides on which a condition holds, a function of places (n, 2) that returns bool (n,)."""

    condition: Callable[[Floats], Any]

    def choose(self, sides: SideSamples, name: Label) -> Bools:
        """See `Selector`."""
        flat = np.ascontiguousarray(sides.places.reshape(-1, 2))
        holds = np.asarray(self.condition(flat.copy()))
        if holds.shape != (len(flat),) or holds.dtype != bool:
            raise DomainError(
                f"the function for name {name!r} returned an array of shape {holds.shape} and type "
                f"{holds.dtype}; expected bool, ({len(flat)},): one for each of the points (n, 2) "
                "it is given, x[:, 0] and x[:, 1]"
            )
        return sides.whole(holds.reshape(len(sides), -1), name)


@dataclass(frozen=True, eq=False)
class Nearest(Selector):
    """The side that is nearest to each of some points; see `nearest`."""

    points: Floats

    def choose(self, sides: SideSamples, name: Label) -> Bools:
        """See `Selector`."""
        import shapely

        out = np.zeros(len(sides), bool)
        for x, y in self.points.tolist():
            place = shapely.Point(x, y)
            nearest_of_all = sides.tree.geometries[sides.tree.nearest(place)]
            reach = float(shapely.distance(nearest_of_all, place)) + SAME * sides.extent
            near = np.sort(sides.tree.query(place, predicate="dwithin", distance=reach))
            if len(near) > 1:
                a, b = (sides.describe(int(i)) for i in near[:2])
                raise DomainError(
                    f"name {name!r}: {a} and {b} are equally near to ({x:.10g}, {y:.10g}); choose "
                    "a point beside the middle of a side"
                )
            out[near] = True
        return out


@dataclass(frozen=True, eq=False)
class Facing(Selector):
    """Sides whose outward normal has about a direction; see `facing`."""

    direction: tuple[float, float]
    within: float

    def choose(self, sides: SideSamples, name: Label) -> Bools:
        """See `Selector`."""
        across = sides.outward @ np.array([-self.direction[1], self.direction[0]])
        angle = np.degrees(np.arctan2(np.abs(across), sides.outward @ np.array(self.direction)))
        holds: Bools = angle <= self.within  # not where it is NaN
        return sides.whole(holds, name)


def nearest(*points: ArrayLike) -> Selector:
    """The sides that are nearest to these points (x, y), one for each, as a value of ``names=``.

    Raises
    ------
    DomainError
        A point is not finite, or, when sides are chosen, two of them are equally near to it.

    Examples
    --------
    >>> import adaptmesh as am
    >>> ring = [(0, 0), (1, 0), (1, 1), (0, 1)]
    >>> square = am.Domain.polygon(ring, names={"left": am.nearest((0, 0.5))})
    >>> square.segment_tags.tolist()
    [0, 0, 0, 1]
    """
    return Nearest(checked_points(np.atleast_2d(np.asarray(points)), "point", least=1))


def facing(direction: ArrayLike, within: float = 30.0) -> Selector:
    """The sides of the border that face a direction, as a value of ``names=``.

    Sides of holes belong to the border, too, and face into their hole: where that is not meant,
    choose by a function of points or by `nearest`.

    Parameters
    ----------
    direction : (dx, dy)
    within : float
        In degrees: the outward normal differs from the direction by at most this, all along.

    Examples
    --------
    >>> import adaptmesh as am
    >>> ring = [(0, 0), (1, 0), (1, 1), (0, 1)]
    >>> square = am.Domain.polygon(ring, names={"top": am.facing((0, 1))})
    >>> square.segment_tags.tolist()
    [0, 0, 1, 0]
    """
    d = np.asarray(direction, dtype=np.float64)
    if d.shape != (2,) or not np.isfinite(d).all() or not d.any():
        raise DomainError(f"direction={direction!r}: expected two finite numbers, not both 0")
    if not 0 <= within < 180:
        raise DomainError(f"within={within!r}: expected an angle in degrees, from 0 to below 180")
    x, y = (d / np.hypot(*d)).tolist()
    return Facing((x, y), float(within))


Chosen = Iterable[int] | Callable[[Floats], Any] | Selector
"""What gets a name: numbers, a function of places, `nearest` or `facing`."""


def split_names(
    names: ByLabel[Chosen] | None,
) -> tuple[dict[Label, Iterable[int]], dict[Label, Selector]]:
    """Names with numbers, none for those that choose; and those that choose."""
    names = {} if names is None else names
    check_is_mapping(names, "names")
    given: dict[Label, Iterable[int]] = {}
    selectors: dict[Label, Selector] = {}
    for name, chosen in names.items():
        if isinstance(chosen, Selector):
            selectors[name] = chosen
        elif callable(chosen):
            selectors[name] = Where(chosen)
        given[name] = () if name in selectors else chosen  # type: ignore[assignment]
    return given, selectors


def chosen_tags(
    tags: Ints, selectors: Mapping[Label, Selector], names: Mapping[str, int], sides: SideSamples
) -> Ints:
    """Tags of sides (k,), after names were given to those that selectors choose.

    Parameters
    ----------
    tags : (k,) array
        From what was named by number; such a name is not taken away.
    selectors, names : mapping
        The tag of each name.
    """
    out = tags.astype(np.int32)
    for name, selector in selectors.items():
        tag = names[name] if isinstance(name, str) else int(name)
        chosen = selector.choose(sides, name)
        if not chosen.any():
            low, high = sides.ends.min(axis=(0, 1)), sides.ends.max(axis=(0, 1))
            raise DomainError(
                f"name {name!r} is given to nothing: it chooses none of {len(sides)} sides; they "
                f"lie between ({low[0]:.10g}, {low[1]:.10g}) and ({high[0]:.10g}, {high[1]:.10g})"
            )
        taken = np.flatnonzero(chosen & (out != 0) & (out != tag))
        if len(taken):
            i = int(taken[0])
            other = next((k for k, t in names.items() if t == out[i]), int(out[i]))
            raise DomainError(
                f"{sides.describe(i)} is named both {other!r} and {name!r}: choose one"
            )
        out[chosen] = tag
    return out
