"""Which polygon each face belongs to, and what is odd about that.

A face is in a part of a polygon if the shell winds around it, in either direction, and no hole
does. A ring within a hole is an island, one within that a hole again, and so on. A polygon is all
its parts together. Of several polygons that a face is in, the first one gets it.
"""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from heapq import heappop, heappush

import numpy as np

from adaptmesh.arrangement.faces import Faces
from adaptmesh.arrangement.record import NOWHERE, Repair
from adaptmesh.arrangement.winding import Passes, winding_changes
from adaptmesh.types import Int64s

from .hole_depths import hole_depths
from .rings import Ring
from .shape import Shape


def owners_of_faces(
    faces: Faces,
    edges: Int64s,
    passes: Passes,
    shapes: Sequence[Shape],
    rings: list[Ring],
    log: list[Repair],
) -> Int64s:
    """The polygon that each face belongs to, -1 for none.

    Parameters
    ----------
    faces : Faces
    edges : (e, 2) array
        Between the faces.
    passes : (edge, ring, net) arrays
        Of rings along edges, as `arrangement.winding.sum_passes` returns them.
    shapes : sequence of Shape
    rings : list of Ring
    log : list of Repair
        Gets a record of each area that is there twice, and of each hole that is outside.
    """
    odd = _Oddities(faces)
    around = _RingsAround(rings, hole_depths(faces, edges, passes, rings))
    owner = np.full(faces.count, -1)
    for face, changes in winding_changes(faces, passes):
        around.change(changes)
        for ring in around.twice:
            odd.ring_winds_twice(face, rings[ring])
        for part in around.without_shell:
            odd.hole_outside(face, [rings[ring] for ring in around.holes[part]])
        for shape, count in around.shapes.items():
            if count > 1:
                odd.parts_overlap(face, shapes[shape], shape)
        if around.shapes:
            first, *others = sorted(around.shapes)
            owner[face] = first
            for other in others:
                odd.shapes_overlap(face, first, other, shapes)
    for ring in sorted(around.islands):
        if not shapes[rings[ring].shape].nested:
            what = f"{rings[ring].label} lies in another hole; taken for an island"
            log.append(Repair("hole in a hole", rings[ring].place, what))
    log += odd.records()
    for s in np.setdiff1d(np.arange(len(shapes)), owner).tolist():
        if shapes[s].is_empty:
            continue  # there is a record of that
        place = next((ring.place for ring in rings if ring.shape == s), NOWHERE)
        log.append(Repair("polygon lost", place, f"nothing is left of {shapes[s].label}"))
    return owner


class _RingsAround:
    """The rings that wind around the face at hand, and what it is in because of them.

    Attributes
    ----------
    twice : dict
        The rings that wind around it more than once; all dicts without values are ordered sets.
    holes : dict of int to dict
        By part, the holes of it that wind around the face.
    without_shell : dict
        The parts of which only holes do.
    shapes : dict of int to int
        The polygons that it is in, and in how many of their parts.
    islands : set of int
        The holes that lie in other holes, and in their shell, of all faces so far.
    """

    def __init__(self, rings: list[Ring], depths: Mapping[int, int]) -> None:
        self.rings, self.depths = rings, depths
        self.numbers: dict[int, int] = defaultdict(int)
        self.shells: dict[int, int] = {}  # by part
        self.parts_in: dict[int, int] = {}  # those that the face is in, with their polygon
        self.deepest: dict[int, list[tuple[int, int]]] = defaultdict(list)  # heaps, by part
        self.twice: dict[int, None] = {}
        self.holes: dict[int, dict[int, None]] = defaultdict(dict)
        self.without_shell: dict[int, None] = {}
        self.shapes: dict[int, int] = {}
        self.islands: set[int] = set()

    def change(self, changes: Mapping[int, int]) -> None:
        """Go on to the next face."""
        for ring, change in changes.items():
            self.numbers[ring] += change
            self._place(ring)
        for part in {self.rings[ring].part: None for ring in changes}:
            self._judge(part)
        for ring in changes:
            part = self.rings[ring].part
            if part in self.shells:
                around = self.holes[part] if not self.rings[ring].number else (ring,)
                self.islands.update(r for r in around if self._is_island(r))

    def _is_island(self, ring: int) -> bool:
        return bool(self.numbers[ring] and self.rings[ring].number and self.depths[ring])

    def _place(self, ring: int) -> None:
        """Keep a ring, or take it away, by its winding number."""
        number, part = abs(self.numbers[ring]), self.rings[ring].part
        _keep(self.twice, ring, number > 1)
        if not self.rings[ring].number:
            if number:
                self.shells[part] = ring
            else:
                self.shells.pop(part, None)
            return
        if number and ring not in self.holes[part]:
            heappush(self.deepest[part], (-self.depths[ring], ring))
        _keep(self.holes[part], ring, number > 0)

    def _judge(self, part: int) -> None:
        """Whether the face is in a part: in its shell, and in no hole but islands."""
        holes, has_shell = self.holes[part], part in self.shells
        _keep(self.without_shell, part, bool(holes) and not has_shell)
        inside = has_shell and (not holes or (len(holes) > 1 and self._greatest_depth(part) % 2))
        if inside and part not in self.parts_in:
            shape = self.parts_in[part] = self.rings[self.shells[part]].shape
            self.shapes[shape] = self.shapes.get(shape, 0) + 1
        elif not inside and part in self.parts_in:
            shape = self.parts_in.pop(part)
            self.shapes[shape] -= 1
            if not self.shapes[shape]:
                del self.shapes[shape]

    def _greatest_depth(self, part: int) -> int:
        heap = self.deepest[part]
        while heap[0][1] not in self.holes[part]:
            heappop(heap)
        return -heap[0][0]


def _keep(kept: dict[int, None], item: int, keep: bool) -> None:
    if keep:
        kept[item] = None
    else:
        kept.pop(item, None)


@dataclass
class _Oddities:
    """Areas with something odd, each added up over the faces it consists of."""

    faces: Faces
    found: dict[tuple[str, str], list[int]] = field(default_factory=lambda: defaultdict(list))
    texts: dict[tuple[str, str], str] = field(default_factory=dict)

    def ring_winds_twice(self, face: int, ring: Ring) -> None:
        self._add(face, "self-overlap", ring.label, f"{ring.label} winds more than once around")

    def hole_outside(self, face: int, holes: Sequence[Ring]) -> None:
        for hole in holes:
            text = f"{hole.label} is not within its shell, but takes in"
            self._add(face, "hole outside", hole.label, text)

    def parts_overlap(self, face: int, shape: Shape, number: int) -> None:
        text = f"parts of {shape.label} overlap on"
        self._add(face, "overlapping parts", str(number), text)

    def shapes_overlap(self, face: int, first: int, other: int, shapes: Sequence[Shape]) -> None:
        a, b = shapes[first].label, shapes[other].label
        self._add(face, "overlap", f"{first} {other}", f"{a}, which keeps it, and {b} overlap on")

    def _add(self, face: int, kind: str, key: str, text: str) -> None:
        self.found[kind, key].append(face)
        self.texts[kind, key] = text

    def records(self) -> list[Repair]:
        out = []
        for (kind, key), found in sorted(self.found.items(), key=lambda item: min(item[1])):
            faces = sorted(found)
            area = float(self.faces.areas[faces].sum())
            x, y = self.faces.inner_points[max(faces, key=lambda f: self.faces.areas[f])].tolist()
            out.append(Repair(kind, (x, y), f"{self.texts[kind, key]} an area of {area:.6g}"))
        return out
