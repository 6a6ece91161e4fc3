"""Rigid motions of the plane, which carry one periodic boundary to the other."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike

from adaptmesh.checks import checked_number
from adaptmesh.errors import DomainError
from adaptmesh.types import Floats
from adaptmesh.value import Value


@dataclass(frozen=True, eq=False)
class Motion(Value):
    """A rigid motion of the plane: x to turn x + shift."""

    turn: Floats
    shift: Floats

    @classmethod
    def translation(cls, shift: ArrayLike) -> Motion:
        return cls(np.eye(2), _vector(shift, "translation"))

    @classmethod
    def rotation(cls, degrees: float, centre: ArrayLike) -> Motion:
        """Anticlockwise about a centre."""
        degrees = checked_number(degrees, "rotation")
        c, s = np.cos(np.radians(degrees)), np.sin(np.radians(degrees))
        turn = np.array([[c, -s], [s, c]])
        at = _vector(centre, "centre")
        return cls(turn, at - turn @ at)

    def inverse(self) -> Motion:
        return Motion(self.turn.T, -self.turn.T @ self.shift)

    def __call__(self, points: Floats) -> Floats:
        return points @ self.turn.T + self.shift


def chosen_motion(
    translation: ArrayLike | None, rotation: float | None, centre: ArrayLike
) -> Motion | None:
    """The motion that is given by a translation or a rotation; None if neither is."""
    if translation is not None and rotation is not None:
        raise DomainError("give a translation or a rotation, not both")
    if translation is not None:
        return Motion.translation(translation)
    return None if rotation is None else Motion.rotation(rotation, centre)


def _vector(value: ArrayLike, what: str) -> Floats:
    try:
        out = np.array(value, np.float64)
    except (TypeError, ValueError):
        out = np.full(2, np.nan)
    if out.shape != (2,) or not np.isfinite(out).all():
        raise DomainError(f"{what}={value!r}: expected two finite numbers")
    return out
