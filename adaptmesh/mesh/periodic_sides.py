"""Periodic boundaries in files: two names and the motion from the one to the other.

No format of others has a place for boundaries by name, so that each has them as a list of ours::

    [["left", "right", [1, 0, 0, 1, 2, 0]]]     the turn by row, and the shift
"""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import numpy as np

from adaptmesh.domain.sides.motion import Motion
from adaptmesh.domain.sides.periodic import PeriodicSides
from adaptmesh.errors import FormatError

from .data import MeshData

Rows = list[tuple[str, str, list[float]]]

_RIGID = 1e-9  # by which the turn of a motion may differ from a rotation


def periodic_rows(mesh: MeshData) -> Rows:
    """The periodic boundaries of a mesh, of its domain or from a file, as a list."""
    pairs = mesh.periodic if mesh.domain is None else mesh.domain.periodic
    return [
        (p.first, p.second, [*p.motion.turn.ravel().tolist(), *p.motion.shift.tolist()])
        for p in pairs
    ]


def checked_rows(value: Any) -> Rows:
    """What a file says, if it is such a list; else a `FormatError`."""
    if not isinstance(value, list) or not all(map(_is_row, value)):
        raise FormatError("the periodic boundaries are not what adaptmesh writes: it is damaged")
    return [(first, second, [float(x) for x in numbers]) for first, second, numbers in value]


def _is_row(row: Any) -> bool:
    return (
        isinstance(row, list)
        and len(row) == 3
        and isinstance(row[0], str)
        and isinstance(row[1], str)
        and isinstance(row[2], list)
        and len(row[2]) == 6
        and all(type(x) in (int, float) for x in row[2])
    )


def periodic_sides(rows: Rows, names: Mapping[str, int]) -> tuple[PeriodicSides, ...]:
    """The periodic boundaries of a mesh with these names."""
    out = []
    for first, second, numbers in rows:
        for name in (first, second):
            if name not in names:
                raise FormatError(f"a periodic boundary is called {name!r}, but nothing is")
        turn, shift = np.array(numbers[:4]).reshape(2, 2), np.array(numbers[4:])
        with np.errstate(all="ignore"):
            is_rigid = np.abs(turn @ turn.T - np.eye(2)).max() <= _RIGID
        if not is_rigid or not np.isfinite(shift).all():
            raise FormatError(f"{first!r} and {second!r} are periodic by no rigid motion")
        out.append(PeriodicSides(first, second, Motion(turn, shift)))
    return tuple(out)
