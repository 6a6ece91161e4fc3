"""Periodic boundaries: two that a translation or a rotation makes one.

::

        first          second      Each side of the first boundary has one on the second for its
      a .------->------. a'        image. Both get the same vertices, see `boundary.discretise`.
        |    motion    |
      b '------->------' b'
"""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import dataclass, replace

import numpy as np

from adaptmesh.checks import checked_number
from adaptmesh.errors import DomainError
from adaptmesh.types import Floats, Index
from adaptmesh.value import Value

from .motion import Motion
from .side import Image, Sides

TOLERANCE = 1e-9
"""Share of the extent of the domain by which images may miss what they are to meet."""


@dataclass(frozen=True, eq=False)
class PeriodicPair(Value):
    """Two boundaries by name, and what of the one is carried to what of the other.

    Attributes
    ----------
    first, second : str
    motion : Motion
        From the first to the second.
    sides : (k, 2) array of int
        Sides of the domain and their images, by number in `Domain.all_sides`.
    tolerance : float
        How far images may be off.
    """

    first: str
    second: str
    motion: Motion
    sides: Index
    tolerance: float


@dataclass(frozen=True, eq=False)
class PeriodicSides(Value):
    """Two boundaries by name, and the motion that carries the first to the second."""

    first: str
    second: str
    motion: Motion


def used_tolerance(points: Floats, tolerance: float | None) -> float:
    """How far images of points of the domain may be off, if it is given or not."""
    if tolerance is None:
        return TOLERANCE * float(np.ptp(points, axis=0).max())
    number = checked_number(tolerance, "tolerance")
    if number < 0:
        raise DomainError(f"tolerance={tolerance!r}: expected a distance, not less than 0")
    return number


def pair_motion(
    sides: Sides, numbers: tuple[Index, Index], names: tuple[str, str], motion: Motion | None
) -> Motion:
    """The motion that is given; if none is, the translation from one boundary to the other.

    It is that of the boxes around their sides, whatever points divide the straight ones.
    """
    if names[0] == names[1]:
        raise DomainError(f"{names[0]!r} cannot be periodic with itself: give two names")
    for name, mine in zip(names, numbers, strict=True):
        if not len(mine):
            raise DomainError(f"no segment is named {name!r}: what should be periodic?")
    if motion is not None:
        return motion
    shapes = (_shapes(sides, mine).reshape(-1, 2) for mine in numbers)
    (low, high), (to_low, to_high) = ((p.min(axis=0), p.max(axis=0)) for p in shapes)
    return Motion.translation(0.5 * ((to_low - low) + (to_high - high)))


def periodic_pair(
    sides: Sides,
    numbers: tuple[Index, Index],
    names: tuple[str, str],
    motion: Motion,
    tolerance: float,
) -> PeriodicPair:
    """Find which sides belong together.

    Parameters
    ----------
    sides : Sides
    numbers : two arrays of int
        The sides of each boundary.
    names : two of str
    motion : Motion
    tolerance : float

    Raises
    ------
    DomainError
        It names the first place that has no image.
    """
    pairs = []
    for straight in (True, False):
        first, second = (mine[sides.is_straight[mine] == straight] for mine in numbers)
        shapes = _shapes(sides, first), _shapes(sides, second)
        pairs.append(np.stack([first, second[_partners(shapes, motion, tolerance, names)]], axis=1))
    return PeriodicPair(*names, motion, np.concatenate(pairs), tolerance)


def _shapes(sides: Sides, numbers: Index) -> Floats:
    """The ends of sides, and their middles between them, (k, 3, 2)."""
    u = np.multiply.outer(sides.lengths[numbers], [0.0, 0.5, 1.0])
    return sides.point(np.repeat(numbers, 3), u.ravel()).reshape(-1, 3, 2)


def _partners(
    shapes: Sequence[Floats], motion: Motion, tolerance: float, names: tuple[str, str]
) -> Index:
    """For each of the first shapes (k, p, 2) the number of the second that is its image.

    Points may come in either order: that of a shape and the reverse.
    """
    from scipy.spatial import KDTree

    first, second = shapes
    _refuse_without_image(first, second, motion, tolerance, names)
    _refuse_without_image(second, first, motion.inverse(), tolerance, names[::-1])
    if not len(first):
        return np.empty(0, np.intp)
    either = np.concatenate([second, second[:, ::-1]]).reshape(2 * len(second), -1)
    images = motion(first.reshape(-1, 2)).reshape(len(first), -1)
    nearest = KDTree(either).query(images, p=np.inf)[1] % len(second)
    if len(np.unique(nearest)) < len(nearest):
        raise DomainError(f"two parts of {names[0]!r} are carried to the same part of {names[1]!r}")
    return nearest


def _refuse_without_image(
    first: Floats, second: Floats, motion: Motion, tolerance: float, names: tuple[str, str]
) -> None:
    """Raise a `DomainError` if one of the first shapes is carried to none of the second."""
    from scipy.spatial import KDTree

    if not len(first):
        return
    off = np.full(len(first), np.inf)
    images = motion(first.reshape(-1, 2)).reshape(first.shape)
    if len(second):
        either = np.concatenate([second, second[:, ::-1]]).reshape(2 * len(second), -1)
        off = KDTree(either).query(images.reshape(len(first), -1), p=np.inf)[0]
    if off.max() > tolerance:
        k = int(np.flatnonzero(off > tolerance)[0])
        ends = [f"({x:.10g}, {y:.10g})" for x, y in (*first[k, [0, -1]], *images[k, [0, -1]])]
        raise DomainError(
            f"what goes from {ends[0]} to {ends[1]} on {names[0]!r} would be carried to {ends[2]} "
            f"and {ends[3]}, but nothing on {names[1]!r} has its ends there within {tolerance:g}: "
            "check the motion, and that both sides have the same corners"
        )


def with_images(sides: Sides, pairs: Iterable[PeriodicPair]) -> Sides:
    """The sides with the images of periodic ones; those of frozen sides are frozen, too."""
    images: dict[int, Image] = {}
    is_frozen = sides.is_frozen.copy()
    for pair in pairs:
        is_frozen[pair.sides] |= is_frozen[pair.sides].any(axis=1, keepdims=True)
        names = (pair.first, pair.second)
        for i, j in pair.sides.tolist():
            is_reversed = _is_reversed(sides, i, j, pair.motion)
            images[i] = Image(j, pair.motion, is_reversed, names)
            images[j] = Image(i, pair.motion.inverse(), is_reversed, names)
    return replace(sides, images=images, is_frozen=is_frozen)


def _is_reversed(sides: Sides, first: int, second: int, motion: Motion) -> bool:
    """Whether the image of a side runs from the second end of another one to its first."""
    if sides.is_straight[first]:
        begin, end = sides.corners[sides.ends[second]]
        image = motion(sides.corners[sides.ends[first, :1]])[0]
        return bool(np.abs(end - image).max() < np.abs(begin - image).max())
    path = sides.path(first)
    looks = path.point(np.array([0.25, 0.5]) * path.length)
    near, far = sides.path(second).nearest(motion(looks))
    return bool(near > far)


def with_partners(pairs: Iterable[PeriodicPair], names: Iterable[str]) -> list[str]:
    """Names of boundaries, each once, and of those that are periodic with them."""
    out = dict.fromkeys(names)
    for pair in pairs:
        if {pair.first, pair.second} & out.keys():
            out |= {pair.first: None, pair.second: None}
    return list(out)
