"""The curves of a drawing, and their names."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from adaptmesh.curves import Curve, EllipticArc, Polyline
from adaptmesh.domain.domain import Domain
from adaptmesh.domain.inputs import Holes, refuse_holes
from adaptmesh.domain.outline import Outline
from adaptmesh.domain.sides.coincident_curves import curves_once
from adaptmesh.domain.sides.skeleton import extent_of
from adaptmesh.domain.sides.surfaces import joined_lines, seeds_of
from adaptmesh.errors import DomainError
from adaptmesh.geometry.distance import first_of_equal

_SAMPLES = np.linspace(0, 1, 33)  # on each curve around a filled area

JOINED = 1e-6
"""Ends of curves within this share of the extent are one: drawings hold rounded numbers."""


@dataclass
class Drawing:
    """Curves in the order of the file, and the numbers of those of each name.

    Filled areas have a name, and the curves around them and around holes in them.
    """

    path: Path
    curves: list[Curve] = field(default_factory=list)
    names: dict[str, list[int]] = field(default_factory=dict)
    fills: list[tuple[str, list[Curve]]] = field(default_factory=list)

    def add(self, curve: Curve, name: str | None) -> None:
        if name:
            self.names.setdefault(name, []).append(len(self.curves))
        self.curves.append(curve)

    @property
    def is_straight(self) -> bool:
        """Whether it holds straight lines only."""
        is_filled = self.fills and not self.curves
        return not is_filled and all(isinstance(curve, Polyline) for curve in self.curves)

    @property
    def join_tolerance(self) -> float:
        """Ends that are nearer than this are one, in units of the coordinates."""
        return JOINED * extent_of(self.curves)

    def domain(self, holes: Holes = None) -> Domain:
        """What the curves enclose, but for the holes, see `Domain`.

        If there are filled areas only, these are what is meshed.
        """
        if self.fills and not self.curves:
            refuse_holes(holes, "filled areas")
            return filled_domain(self.fills)
        self._check_not_empty()
        return Domain.from_curves(
            self.curves, names=self.names, holes=holes, join_tolerance=self.join_tolerance
        )

    def outline(self) -> Outline:
        """The same of straight lines, as points and segments that nobody has checked."""
        self._check_not_empty()
        lines = [curve.points for curve in self.curves if isinstance(curve, Polyline)]
        stop = np.cumsum([len(points) for points in lines])
        points = np.concatenate(lines)
        number = np.arange(len(points))
        starts = np.delete(number, stop - 1)  # a line's last point starts no segment
        owner = np.repeat(np.arange(len(lines)), [len(points) - 1 for points in lines])
        first = first_of_equal(points)
        kept = np.flatnonzero(first == number)
        segments = np.searchsorted(kept, first[np.stack([starts, starts + 1], axis=1)])
        names = {
            name: np.flatnonzero(np.isin(owner, curves)).tolist()
            for name, curves in self.names.items()
        }
        return Outline(points[kept], segments, names=names)

    def _check_not_empty(self) -> None:
        if not self.curves:
            raise DomainError("it draws no lines: there is nothing to mesh")


def filled_domain(fills: Sequence[tuple[str, list[Curve]]]) -> Domain:
    """Filled areas, each a region with its name; borders that two share are one line."""
    import shapely

    curves = [curve for _, around in fills for curve in around]
    owner = np.repeat(np.arange(len(fills)), [len(around) for _, around in fills])
    tolerance = JOINED * extent_of(curves)
    kept, number = curves_once(curves, tolerance)
    faces: dict[int, Any] = {}
    groups: dict[str, list[int]] = {}
    lines = joined_lines([curves[k].point(_SAMPLES) for k in kept], tolerance)
    for k, (name, _) in enumerate(fills):
        mine = sorted({number[j] for j in np.flatnonzero(owner == k).tolist()})
        faces[k] = shapely.build_area(shapely.MultiLineString([lines[j] for j in mine]))
        if faces[k].is_empty:
            raise DomainError(f"the border of filled area {k} ({name!r}) is not closed")
        groups.setdefault(name, []).append(k)
    holes, regions = seeds_of(faces, groups)
    first = {j: int(owner[k]) for k, j in reversed(list(enumerate(number)))}
    names: dict[str, list[int]] = {}
    for j in range(len(kept)):
        names.setdefault(fills[first[j]][0], []).append(j)
    return Domain.from_curves(
        [curves[k] for k in kept],
        names=names,
        holes=holes,
        regions=regions,
        join_tolerance=tolerance,
    )


def affine_arc(
    centre: NDArray[np.float64],
    first: NDArray[np.float64],
    second: NDArray[np.float64],
    start: float,
    turn: float,
) -> EllipticArc:
    """The arc centre + cos(s) first + sin(s) second, s from `start` on by `turn`.

    `first` and `second` are conjugate radii, the image of the axes of a circle. By the singular
    values of the two as columns, [first, second] = U diag(a, b) V', the axes of the ellipse are
    the columns of U, and the angle is turned by V.
    """
    axes, radii, turned = np.linalg.svd(np.stack([first, second], axis=1))
    if np.linalg.det(axes) < 0:  # the axes as a rotation, the mirror image in the angles
        axes[:, 1] *= -1
        turned[1] *= -1
    rotation = float(np.arctan2(axes[1, 0], axes[0, 0]))
    x, y = turned @ [np.cos(start), np.sin(start)]
    begins = float(np.arctan2(y, x))
    ends = begins + turn * float(np.sign(np.linalg.det(turned)))
    return EllipticArc(centre, radii, rotation, begins, ends)
