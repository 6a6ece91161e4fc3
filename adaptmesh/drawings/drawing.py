"""What a drawing holds of interest: curves, and the names they bear."""

from __future__ import annotations

from dataclasses import dataclass, field
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from ..curves import Curve, EllipticArc
from ..domain import Domain
from ..errors import DomainError

JOINED = 1e-6
"""Ends of curves within this share of the extent are one: drawings hold rounded numbers."""


@dataclass
class Drawing:
    """Curves in the order of the file, and the numbers of those that bear each name."""

    path: Path
    curves: list[Curve] = field(default_factory=list)
    names: dict[str, list[int]] = field(default_factory=dict)

    def add(self, curve: Curve, name: str | None) -> None:
        if name:
            self.names.setdefault(name, []).append(len(self.curves))
        self.curves.append(curve)

    def domain(self) -> Domain:
        """What the curves enclose: inside is what an odd number of boundaries encloses."""
        if not self.curves:
            raise DomainError("it draws no lines: there is nothing to mesh")
        points = np.concatenate([c.point(np.linspace(0, 1, 9)) for c in self.curves])
        tolerance = JOINED * float(np.ptp(points, axis=0).max())
        return Domain.from_curves(self.curves, names=self.names, join_tolerance=tolerance)


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
