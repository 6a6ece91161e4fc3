"""The curves of a loop one after the other, listed in any order and direction."""

from __future__ import annotations

from collections import deque
from collections.abc import Sequence

import numpy as np

from adaptmesh.domain.sides.joining import places_of
from adaptmesh.io.domains.drawings.drawing import JOINED
from adaptmesh.types import Floats

from .expressions import NotReadError


def walk_of(lines: Sequence[Floats]) -> tuple[list[tuple[int, bool]], Floats | None]:
    """Lines one after the other, each with whether backwards, and where they are not closed."""
    ends = np.array([line[end] for line in lines for end in (0, -1)])
    node = places_of(ends, JOINED * float(np.ptp(np.concatenate(lines), axis=0).max()))
    at: dict[int, deque[int]] = {}
    for end, place in enumerate(node.tolist()):
        at.setdefault(place, deque()).append(end)
    walk: list[tuple[int, bool]] = []
    is_walked = [False] * len(lines)
    onward: int | None = 0  # 2k and 2k + 1 are the ends of line k
    while onward is not None:
        last = onward ^ 1
        walk.append((onward // 2, onward % 2 == 1))
        is_walked[onward // 2] = True
        onward = _next_end(at[node[last]], is_walked)
    is_closed = node[last] == node[0] and all(is_walked)
    return walk, None if is_closed else ends[last]


def _next_end(ends: deque[int], is_walked: Sequence[bool]) -> int | None:
    """The first of the ends at a place whose line is not walked yet; walked ones are dropped."""
    while ends and is_walked[ends[0] // 2]:
        ends.popleft()
    return ends[0] if ends else None


def not_closed(surface: int, loop: int, place: Floats) -> NotReadError:
    """The error; Gmsh takes loops of several closed lines."""
    x, y = place.tolist()
    return NotReadError(
        f"curve loop {loop} of surface {surface} is not one closed line: no other curve of it goes "
        f"on from ({x:g}, {y:g})"
    )
