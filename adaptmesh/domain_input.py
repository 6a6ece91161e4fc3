"""What a domain is made of, checked: points, segments, names, holes and regions."""

from __future__ import annotations

import itertools
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass
from typing import Any, TypeVar

import numpy as np
from numpy.typing import ArrayLike, NDArray

from .errors import DomainError
from .value import FrozenMapping

Floats = NDArray[np.float64]
Ints = NDArray[np.int32]

Label = str | int
"""A name, or a number that has none."""
Value = TypeVar("Value")
ByLabel = Mapping[str, Value] | Mapping[int, Value] | Mapping[Label, Value]

LARGEST = 1e75  # coordinate: its fourth power is still a double
OR_REPAIR = "or let adaptmesh.repair do it"


@dataclass(frozen=True, eq=False)
class Inside:
    """What is inside the boundaries: holes, and regions with their seeds."""

    nesting: bool
    holes: Floats
    region_names: Mapping[str, int]
    seeds: Floats
    seed_regions: Ints

    @classmethod
    def checked(
        cls,
        holes: ArrayLike | str,
        regions: ByLabel[ArrayLike] | None,
        given: Mapping[str, int] | None,
    ) -> Inside:
        """From the arguments of `Domain`."""
        nesting = isinstance(holes, str)
        if nesting and holes != "nesting":
            raise DomainError(f"holes={holes!r}: give points inside the holes, or 'nesting'")
        places = checked_points(() if nesting else holes, "hole", least=0)
        return cls(nesting, places, *checked_regions(regions or {}, given or {}))


def read_only(array: NDArray[Any]) -> NDArray[Any]:
    array.flags.writeable = False
    return array


def checked_points(points: ArrayLike, what: str, least: int = 3) -> Floats:
    """Coordinates (n, 2) that areas can be computed of, or a `DomainError`."""
    try:
        if np.iscomplexobj(points):
            raise TypeError("they are complex")
        out = np.array(points, dtype=np.float64, order="C")
    except (TypeError, ValueError) as error:
        raise DomainError(f"{what}s must be an (n, 2) array of numbers: {error}") from None
    if out.size == 0:
        out = out.reshape(0, 2)
    if out.ndim != 2 or out.shape[1] != 2:
        raise DomainError(f"{what}s must be an (n, 2) array, not one of shape {out.shape}")
    if len(out) < least:
        raise DomainError(f"{len(out)} {what}s: at least {least} are needed")
    bad = np.flatnonzero(~np.isfinite(out).all(axis=1))
    if len(bad):
        x, y = out[bad[0]]
        raise DomainError(f"{what} {bad[0]} is ({x}, {y}): coordinates must be finite")
    bad = np.flatnonzero((np.abs(out) > LARGEST).any(axis=1))
    if len(bad):
        x, y = out[bad[0]]
        raise DomainError(
            f"{what} {bad[0]} is ({x:g}, {y:g}): areas and squares of coordinates beyond "
            f"{LARGEST:g} overflow; choose another unit of length"
        )
    return read_only(out)


def checked_pairs(segments: ArrayLike, n_points: int) -> Ints:
    """Pairs of point numbers, (k, 2), or a `DomainError`."""
    raw = np.asarray(segments)
    if raw.size == 0:
        raise DomainError("no segments: say which points the boundary joins, e.g. Domain.polygon")
    if raw.ndim != 2 or raw.shape[1] != 2:
        raise DomainError(f"segments must be a (k, 2) array, not one of shape {raw.shape}")
    if not np.issubdtype(raw.dtype, np.integer):
        raise DomainError(f"segments must be integers, pairs of point numbers, not {raw.dtype}")
    bad = np.flatnonzero(((raw < 0) | (raw >= n_points)).any(axis=1))
    if len(bad):
        i = bad[0]
        raise DomainError(
            f"segment {i} joins points {raw[i, 0]} and {raw[i, 1]}, but the points are numbered "
            f"0 to {n_points - 1}"
        )
    return read_only(np.array(raw, dtype=np.int32, order="C"))


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


def check_is_mapping(labels: object, what: str) -> None:
    """Refuse what gives nothing for each name."""
    if not isinstance(labels, Mapping):
        raise DomainError(f"{what} must be a mapping of names, not {type(labels).__name__}")


def checked_regions(
    regions: ByLabel[ArrayLike], given: Mapping[str, int]
) -> tuple[Mapping[str, int], Floats, Ints]:
    """The number of each name, the seeds (s, 2), and the region of each, or a `DomainError`."""
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
    names: ByLabel[Iterable[int]],
    n: int,
    what: str = "segment",
    given: Mapping[str, int] | None = None,
) -> tuple[Mapping[str, int], Ints]:
    """The tag of each name and of each of n segments (or curves), or a `DomainError`."""
    check_is_mapping(names, "names")
    tag_of, numbers = numbered(names, given or {}, "tag")
    tags = np.zeros(n, np.int32)
    for tag, (name, segments) in zip(numbers, names.items(), strict=True):
        for i in segments:
            if not isinstance(i, (int, np.integer)) or not 0 <= i < n:
                raise DomainError(
                    f"name {name!r} is given to {what} {i!r}, but the {what}s are numbered "
                    f"0 to {n - 1}"
                )
            if tags[i] not in (0, tag):
                other = name_of_number(tag_of, tags)[int(tags[i])]
                raise DomainError(f"{what} {i} is named both {other!r} and {name!r}: choose one")
            tags[i] = tag
    return tag_of, read_only(tags)


def numbered(
    labels: Iterable[Label], given: Mapping[str, int], what: str
) -> tuple[Mapping[str, int], list[int]]:
    """The number of each name, and of each label in order.

    A number stands for itself, and has no name; a name has the number that is given for it, or else
    the least one from 1 on that nothing has yet.
    """
    labels = [_checked_label(k, what) for k in labels]
    taken = {*given.values(), *(k for k in labels if isinstance(k, int))}
    for number in taken:
        if not isinstance(number, (int, np.integer)) or not -(2**31) <= number < 2**31:
            raise DomainError(f"{what} {number!r}: a whole number of 32 bits is wanted")
    free = (number for number in itertools.count(1) if number not in taken)
    names: dict[str, int] = {}
    numbers = []
    for label in labels:
        if isinstance(label, str):
            names[label] = int(given[label]) if label in given else next(free)
        numbers.append(names[label] if isinstance(label, str) else label)
    names.update({name: int(number) for name, number in given.items()})
    return FrozenMapping(names), numbers


def _checked_label(label: object, what: str) -> Label:
    if isinstance(label, (int, np.integer)):
        return int(label)
    if not isinstance(label, str) or not label:
        raise DomainError(f"the name {label!r}: a text or, for a bare {what}, a number is wanted")
    return str(label)


def name_of_number(
    names: Mapping[str, int], numbers: NDArray[np.signedinteger]
) -> dict[int, Label]:
    """How messages call each number: by its name, or if it has none as it is."""
    nameless: dict[int, Label] = {number: number for number in np.unique(numbers).tolist()}
    return {**nameless, **{number: name for name, number in names.items()}}


def labelled(tags: NDArray[np.signedinteger]) -> dict[Label, list[int]]:
    """The items with each number but 0, as `Domain` takes them, to go with names and numbers."""
    found = np.unique(tags[tags != 0]).tolist()
    return {tag: np.flatnonzero(tags == tag).tolist() for tag in found}


def rings_of(geometry: Mapping[str, Any]) -> list[ArrayLike]:
    """All rings of a GeoJSON-like Polygon or MultiPolygon."""
    kind = geometry.get("type")
    if kind == "Polygon":
        polygons = [geometry["coordinates"]]
    elif kind == "MultiPolygon":
        polygons = geometry["coordinates"]
    else:
        raise DomainError(f"a domain is made of a Polygon or MultiPolygon, not of a {kind}")
    rings = [np.asarray(ring, float) for polygon in polygons for ring in polygon]
    heights = np.concatenate([ring[:, 2:].ravel() for ring in rings] or [np.empty(0)])
    if len(heights) and heights.min() < heights.max():
        low, high = heights.min(), heights.max()
        raise DomainError(
            f"points of this {kind} lie at heights from {low:g} to {high:g}, and a domain is "
            f"plane: leave the heights out (shapely.force_2d), {OR_REPAIR}"
        )
    return [ring[:, :2] for ring in rings]


def joined_rings(rings: Sequence[ArrayLike]) -> tuple[Floats, Ints]:
    """Points and segments of closed rings; rings that share a point share its number."""
    points, segments, n = [], [], 0
    for k, ring in enumerate(rings):
        p = checked_points(ring, f"ring {k}: point", least=0)
        if len(p) and (p[0] == p[-1]).all():
            p = p[:-1]
        if len(p) < 3:
            raise DomainError(f"ring {k} has {len(p)} different points: at least 3 are needed")
        number = n + np.arange(len(p))
        points.append(p)
        segments.append(np.stack([number, np.roll(number, -1)], axis=1))
        n += len(p)
    joined = np.concatenate(points) if points else np.empty((0, 2))
    unique, first, inverse = np.unique(joined, axis=0, return_index=True, return_inverse=True)
    if len(unique) == len(joined):
        return joined, np.concatenate(segments) if segments else np.empty((0, 2), int)
    order = np.argsort(first)  # np.unique sorts; keep the order in which the points were given
    number_of = np.empty(len(unique), int)
    number_of[order] = np.arange(len(unique))
    return unique[order], number_of[inverse.ravel()][np.concatenate(segments)]
