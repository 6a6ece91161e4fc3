"""What a domain is made of, checked: segments, names, holes, regions and rings."""

from __future__ import annotations

import itertools
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass
from typing import Any, TypeVar

import numpy as np
from numpy.typing import ArrayLike, NDArray

from adaptmesh.checks import check_is_mapping, checked_pairs, checked_points, read_only
from adaptmesh.errors import DomainError
from adaptmesh.types import Floats, Index, Int64s, Ints
from adaptmesh.value import FrozenMapping

Label = str | int
"""A name, or a number that has none."""
Value = TypeVar("Value")
ByLabel = Mapping[str, Value] | Mapping[int, Value] | Mapping[Label, Value]

Holes = ArrayLike | str | None
"""Points in the holes, "nesting", or None if they are to be found; see `Domain`."""

OR_REPAIR = "or let adaptmesh.repair do it"


@dataclass(frozen=True, eq=False)
class Inside:
    """What is inside the boundaries: holes, and regions with their seeds.

    Holes are found by nesting or given by points; `certain` if those found have to be certain.
    """

    nesting: bool
    certain: bool
    holes: Floats
    region_names: Mapping[str, int]
    seeds: Floats
    seed_regions: Ints

    @classmethod
    def checked(
        cls,
        holes: ArrayLike | str | None,
        regions: ByLabel[ArrayLike] | None,
        given: Mapping[str, int] | None,
    ) -> Inside:
        """From the arguments of `Domain`."""
        if isinstance(holes, str) and holes != "nesting":
            raise DomainError(f"holes={holes!r}: give points inside the holes, or 'nesting'")
        given_holes = () if holes is None or isinstance(holes, str) else holes
        nesting = given_holes is not holes
        places = checked_points(given_holes, "hole", least=0)
        return cls(nesting, holes is None, places, *checked_regions(regions, given))


def refuse_holes(holes: Holes, given: str) -> None:
    """Raise a `DomainError` if holes are given for a file that says itself what they are."""
    if holes is not None:
        raise DomainError(
            f"holes={holes!r}: there are {given}, which say what is inside; leave holes out"
        )


def checked_segments(segments: ArrayLike, points: Floats) -> Ints:
    """Pairs of different points, (k, 2), or a `DomainError`."""
    out = checked_pairs(segments, len(points))
    bad = np.flatnonzero((points[out[:, 0]] == points[out[:, 1]]).all(axis=1))
    if len(bad):
        i = bad[0]
        x, y = points[out[i, 0]]
        raise DomainError(
            f"segment {i} has no length: its ends are both ({x:g}, {y:g}); remove it, {OR_REPAIR}"
        )
    return out


def checked_regions(
    regions: ByLabel[ArrayLike] | None, given: Mapping[str, int] | None
) -> tuple[Mapping[str, int], Floats, Ints]:
    """The number of each name, the seeds (s, 2), and the region of each, or a `DomainError`."""
    regions = {} if regions is None else regions
    check_is_mapping(regions, "regions")
    names, numbers = numbered(regions, given, "region")
    seeds, owners = [], []
    for number, (name, where) in zip(numbers, regions.items(), strict=True):
        points = checked_points(np.atleast_2d(np.asarray(where)), f"region {name!r} point", least=1)
        seeds.append(points)
        owners += [number] * len(points)
    all_seeds = np.concatenate(seeds) if seeds else np.empty((0, 2))
    return names, read_only(all_seeds), read_only(np.array(owners, np.int32))


def checked_names(
    names: ByLabel[Iterable[int]] | None,
    n: int,
    what: str = "segment",
    given: Mapping[str, int] | None = None,
) -> tuple[Mapping[str, int], Ints]:
    """The tag of each name and of each of n segments (or curves), or a `DomainError`."""
    names = {} if names is None else names
    check_is_mapping(names, "names")
    tag_of, numbers = numbered(names, given, "tag")
    tags = np.zeros(n, np.int32)
    for tag, (name, segments) in zip(numbers, names.items(), strict=True):
        for i in _checked_numbers(segments, name, what):
            is_number = isinstance(i, (int, np.integer)) and not isinstance(i, bool)
            if not is_number or not 0 <= i < n:
                raise DomainError(
                    f"name {name!r} is given to {what} {i!r}, but the {what}s are numbered "
                    f"0 to {n - 1}"
                )
            if tags[i] not in (0, tag):
                other = name_of_number(tag_of, tags)[int(tags[i])]
                raise DomainError(f"{what} {i} is named both {other!r} and {name!r}: choose one")
            tags[i] = tag
    return tag_of, read_only(tags)


def _checked_numbers(numbers: object, name: object, what: str) -> Iterable[Any]:
    """What a name is given to, if it is a sequence, or a `DomainError`."""
    if not isinstance(numbers, Iterable):
        raise DomainError(
            f"name {name!r} is given to {numbers!r}: expected a sequence of numbers of {what}s, or "
            "a function of points"
        )
    return numbers


def numbered(
    labels: Iterable[Label], given: Mapping[str, int] | None, what: str
) -> tuple[Mapping[str, int], list[int]]:
    """The number of each name, and of each label in order.

    A number stands for itself, and has no name; a name has the number that is given for it, or else
    the least one from 1 on that nothing has yet.
    """
    given = {} if given is None else given
    check_is_mapping(given, f"{what}s by name")
    labels = [_checked_label(k, what) for k in labels]
    taken = {*given.values(), *(k for k in labels if isinstance(k, int))}
    for number in taken:
        if not isinstance(number, (int, np.integer)) or not -(2**31) <= number < 2**31:
            raise DomainError(f"{what} {number!r}: expected a whole number of 32 bits")
    free = (number for number in itertools.count(1) if number not in taken)
    names: dict[str, int] = {}
    numbers = []
    for label in labels:
        if isinstance(label, str):
            names[label] = int(given[label]) if label in given else next(free)
            if not names[label]:
                raise DomainError(
                    f"{what} 0 for {label!r}: 0 is the {what} of all that has no name, which would "
                    "be named, too; give another number"
                )
        numbers.append(names[label] if isinstance(label, str) else label)
    names.update({name: int(number) for name, number in given.items()})
    return FrozenMapping(names), numbers


def _checked_label(label: object, what: str) -> Label:
    if isinstance(label, (int, np.integer)):
        return int(label)
    if not isinstance(label, str) or not label:
        raise DomainError(f"the name {label!r}: expected a text or, for a bare {what}, a number")
    return str(label)


def name_of_number(
    names: Mapping[str, int], numbers: NDArray[np.signedinteger]
) -> dict[int, Label]:
    """How messages call each number: by its name, or if it has none as it is."""
    nameless: dict[int, Label] = {number: number for number in np.unique(numbers).tolist()}
    return {**nameless, **{number: name for name, number in names.items()}}


def labelled(tags: NDArray[np.signedinteger]) -> dict[Label, list[int]]:
    """The items with each number but 0, as `Domain` takes them, to go with names and numbers."""
    return {number: rows.tolist() for number, rows in rows_of_each(tags).items() if number}


def rows_of_each(numbers: Index) -> dict[int, NDArray[np.intp]]:
    """The rows with each number, ascending, in the order of the numbers."""
    order = np.argsort(numbers, kind="stable")
    ordered = numbers[order]
    first = np.flatnonzero(ordered[1:] != ordered[:-1]) + 1
    groups = np.split(order, first) if len(order) else []
    return {int(numbers[rows[0]]): rows for rows in groups}


@dataclass(frozen=True, eq=False)
class JoinedRings:
    """Closed rings as points and segments.

    Attributes
    ----------
    points : (n, 2) array
        All different: rings that share a point share its number.
    segments : (k, 2) array
        In order, ring by ring; none without length.
    ring : (k,) array
        The ring of each segment.
    given : (k,) array
        The number of each segment, where a point repeated in a row starts one, too.
    n_given : int
        How many there are then.
    """

    points: Floats
    segments: Int64s
    ring: Int64s
    given: Int64s
    n_given: int


def joined_rings(rings: Sequence[ArrayLike]) -> JoinedRings:
    """Points and segments of closed rings.

    A ring may end where it starts, or not; points repeated in a row count once.
    """
    points, segments, ring_of, given, n, n_given = [], [], [], [], 0, 0
    for k, ring in enumerate(rings):
        p = checked_points(ring, f"ring {k}: point", least=0)
        if len(p) and (p[0] == p[-1]).all():
            p = p[:-1]
        new = np.flatnonzero((p != np.roll(p, -1, axis=0)).any(axis=1))
        different = len(np.unique(p, axis=0))
        if different < 3:
            raise DomainError(f"ring {k} has {different} different points: at least 3 are needed")
        number = n + np.arange(len(new))
        points.append(p[new])
        segments.append(np.stack([number, np.roll(number, -1)], axis=1))
        ring_of.append(np.full(len(new), k))
        given.append(n_given + new)
        n += len(new)
        n_given += len(p)
    joined = np.concatenate(points)
    pairs = np.concatenate(segments)
    unique, first, inverse = np.unique(joined, axis=0, return_index=True, return_inverse=True)
    if len(unique) < len(joined):
        order = np.argsort(first)  # np.unique sorts; keep the order in which points were given
        number_of = np.empty(len(unique), int)
        number_of[order] = np.arange(len(unique))
        joined, pairs = unique[order], number_of[inverse.ravel()][pairs]
    return JoinedRings(joined, pairs, np.concatenate(ring_of), np.concatenate(given), n_given)
