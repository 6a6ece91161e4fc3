"""The rings of polygons as points and segments, and which ring each is of."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from adaptmesh.arrangement.noding import Labels
from adaptmesh.arrangement.record import NOWHERE, Repair, point_text
from adaptmesh.checks import LARGEST
from adaptmesh.errors import DomainError
from adaptmesh.geometry.distance import first_of_equal
from adaptmesh.types import Floats, Int64s

from .shape import Shape

REPEATED = "duplicate points"
"""The kind of a repair of points repeated in a row of a ring: to leave them out changes nothing."""


@dataclass(frozen=True)
class Ring:
    """Where a ring is from.

    Attributes
    ----------
    shape, part, number : int
        The polygon, the part of it (counted over all polygons), and the ring in that; 0 is the
        shell.
    label : str
        How messages call it.
    area : float
        Area within it, where it does not cross itself.
    place : (float, float)
        Its first point.
    """

    shape: int
    part: int
    number: int
    label: str
    area: float
    place: tuple[float, float]


@dataclass(frozen=True)
class Rings:
    """The rings of all polygons, as points and segments.

    Attributes
    ----------
    rings : list of Ring
    points : (n, 2) array
        All different.
    segments : (k, 2) array
        None without length.
    ring : (k,) array
        The ring of each segment.
    number : (k,) array
        Of the first point of each segment in its ring, as given.
    """

    rings: list[Ring]
    points: Floats
    segments: Int64s
    ring: Int64s
    number: Int64s

    def labels(self) -> Labels:
        """How to call the points and segments."""
        order = np.argsort(self.segments[:, 0], kind="stable")  # the first that starts there
        start = self.segments[order, 0]

        def segment(i: int) -> str:
            return f"segment {self.number[i]} of {self.rings[self.ring[i]].label}"

        def point(v: int) -> str:
            i = order[np.searchsorted(start, v)]
            return f"point {self.number[i]} of {self.rings[self.ring[i]].label}"

        return Labels(point, segment)


def rings_of(shapes: Sequence[Shape], log: list[Repair]) -> Rings:
    """Close rings and join points that are equal.

    Parameters
    ----------
    shapes : sequence of Shape
    log : list of Repair
        Gets a record of each ring that was not closed, of each point given twice in a row, of each
        ring with less than three points, and of each polygon that is empty, holds something else,
        or does not lie in a plane.

    Raises
    ------
    DomainError
        If no polygon has an area, or a coordinate is not finite, or too large.
    """
    rings: list[Ring] = []
    points, segments, ring_of, numbers = [np.empty((0, 2))], [], [], []
    n = part_number = 0
    for s, shape in enumerate(shapes):
        if shape.is_empty:
            log.append(Repair("empty polygon", NOWHERE, f"{shape.label} is empty; left out"))
        if shape.others and not shape.is_empty:
            what = f"{shape.label} also holds a {', a '.join(shape.others)}; left out"
            log.append(Repair("not a polygon", _some_point(shape), what))
        if shape.heights is not None:
            log.append(_flattened(shape))
        for k, part in enumerate(shape.parts):
            for r, given in enumerate(part):
                label = ring_label(shape, k, r)
                if not len(given):
                    continue
                _check(given, label)
                p, number = _closed(given, label, shape.closed, log)
                if len(p):
                    x, y = p[0].tolist()
                    rings.append(Ring(s, part_number, r, label, ring_area(p), (x, y)))
                    here = n + np.arange(len(p))
                    points.append(p)
                    segments.append(np.stack([here, np.roll(here, -1)], axis=1))
                    ring_of.append(np.full(len(p), len(rings) - 1))
                    numbers.append(number)
                    n += len(p)
            part_number += 1
    if not rings:
        raise DomainError(f"there is nothing to mesh: {log[-1]}")
    all_points = np.concatenate(points)
    first = first_of_equal(all_points)
    kept = np.flatnonzero(first == np.arange(n))
    joined = np.searchsorted(kept, first[np.concatenate(segments)])
    return Rings(rings, all_points[kept], joined, np.concatenate(ring_of), np.concatenate(numbers))


def _flattened(shape: Shape) -> Repair:
    low, high = shape.heights or (0.0, 0.0)
    what = f"points of {shape.label} lie at heights from {low:g} to {high:g}; x and y kept"
    return Repair("heights", _some_point(shape), what)


def _some_point(shape: Shape) -> tuple[float, float]:
    x, y = next(ring[0].tolist() for part in shape.parts for ring in part if len(ring))
    return x, y


def ring_label(shape: Shape, part: int, ring: int) -> str:
    """How messages call a ring of a polygon."""
    label = shape.label
    if len(shape.parts) > 1:
        label = f"part {part} of {label}"
    return f"hole {ring - 1} of {label}" if ring else label


def _check(points: Floats, label: str) -> None:
    bad = np.flatnonzero(~(np.abs(points) <= LARGEST).all(axis=1))
    if len(bad):
        x, y = points[bad[0]].tolist()
        if np.isfinite([x, y]).all():
            why = f"beyond {LARGEST:g}, where areas overflow: choose another unit of length"
        else:
            why = "not finite: remove it, or give it coordinates"
        raise DomainError(f"point {bad[0]} of {label} is ({x:g}, {y:g}), {why}")


def _closed(
    given: Floats, label: str, must_close: bool, log: list[Repair]
) -> tuple[Floats, Int64s]:
    """The points of a ring, none equal to the next, and their numbers; none if it is no ring."""
    points, number = given, np.arange(len(given))
    if len(points) > 1 and (points[0] == points[-1]).all():
        points, number = points[:-1], number[:-1]
    elif len(points) > 1 and must_close:
        x, y = points[-1].tolist()
        gap = float(np.hypot(*(points[0] - points[-1])))
        what = (
            f"{label} ends {gap:.3g} from its start, {point_text(*points[0])}; closed by a segment"
        )
        log.append(Repair("ring not closed", (x, y), what))
    again = (points == np.roll(points, 1, axis=0)).all(axis=1)
    if len(points) > 1 and again.any():
        for i in np.flatnonzero(again).tolist():
            x, y = points[i].tolist()
            what = f"point {number[i]} of {label} is given twice in a row; once is enough"
            log.append(Repair(REPEATED, (x, y), what))
        points, number = points[~again], number[~again]
    if len(points) < 3:
        x, y = given[0].tolist()
        what = f"{label} has {max(len(points), 1)} different points, and so no area; removed"
        log.append(Repair("ring without area", (x, y), what))
        return points[:0], number[:0]
    return points, number


def ring_area(p: Floats) -> float:
    """Area within a ring that does not cross itself."""
    x, y = (p - p[0]).T
    return float(0.5 * abs(x @ np.roll(y, -1) - y @ np.roll(x, -1)))
