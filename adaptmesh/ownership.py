"""Which polygon each face belongs to, and what is odd about that.

A face is in a part of a polygon if the shell winds around it, in either direction, and no hole
does. A ring within a hole is an island, one within that a hole again, and so on. A polygon is all
its parts together. Of several polygons that a face is in, the first one gets it.
"""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray

from .arrangement import NOWHERE, Faces, Repair
from .raw import Shape
from .rings import Ring

Ints = NDArray[np.int64]
Windings = Sequence[Mapping[int, int]]


def owners_of_faces(
    faces: Faces,
    windings: Windings,
    shapes: Sequence[Shape],
    rings: Sequence[Ring],
    log: list[Repair],
) -> Ints:
    """The polygon that each face belongs to, -1 for none.

    Parameters
    ----------
    faces : Faces
    windings : sequence of mapping
        For each face the rings that wind around it, and how often.
    shapes : sequence of Shape
    rings : sequence of Ring
    log : list of Repair
        Gets a record of each area that is there twice, and of each hole that is outside.
    """
    odd = _Oddities(faces)
    depth = _Depths(windings, rings)
    owner = np.full(faces.count, -1)
    for face, winding in enumerate(windings):
        parts: dict[int, list[int]] = defaultdict(list)
        for ring, number in winding.items():
            parts[rings[ring].part].append(ring)
            if abs(number) > 1:
                odd.ring_winds_twice(face, rings[ring])
        inside: dict[int, int] = defaultdict(int)
        for part in parts.values():
            if all(rings[ring].number for ring in part):
                odd.hole_outside(face, [rings[ring] for ring in part])
            elif _is_inside(part, rings, depth):
                inside[rings[part[0]].shape] += 1
        for shape, count in inside.items():
            if count > 1:
                odd.parts_overlap(face, shapes[shape], shape)
        if inside:
            first, *others = sorted(inside)
            owner[face] = first
            for other in others:
                odd.shapes_overlap(face, first, other, shapes)
    for ring in depth.islands():
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


def _is_inside(part: Sequence[int], rings: Sequence[Ring], depth: _Depths) -> bool:
    """Whether a face within these rings of a part, one of them the shell, is in the part."""
    holes = [ring for ring in part if rings[ring].number]
    return not holes or (len(holes) > 1 and max(map(depth.of, holes)) % 2 == 1)


class _Depths:
    """How many holes of its part each hole lies in."""

    def __init__(self, windings: Windings, rings: Sequence[Ring]) -> None:
        self.windings, self.rings = windings, rings
        self.depths: dict[int, int] = {}
        self.faces_of: dict[int, set[int]] | None = None

    def of(self, hole: int) -> int:
        """0 for one that is in no other hole. Only asked where holes of a part overlap."""
        if hole not in self.depths:
            mine = self._faces_of()[hole]
            others = [
                self._faces_of()[ring]
                for face in [min(mine)]
                for ring in self.windings[face]
                if self.rings[ring].part == self.rings[hole].part and self.rings[ring].number
            ]
            self.depths[hole] = sum(mine < other for other in others)
        return self.depths[hole]

    def islands(self) -> Iterable[int]:
        """The holes that lie in another hole, as far as they were asked for."""
        return [hole for hole, depth in self.depths.items() if depth]

    def _faces_of(self) -> dict[int, set[int]]:
        if self.faces_of is None:
            self.faces_of = defaultdict(set)
            for face, winding in enumerate(self.windings):
                for ring in winding:
                    self.faces_of[ring].add(face)
        return self.faces_of


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
        for (kind, key), faces in self.found.items():
            area = float(self.faces.areas[faces].sum())
            x, y = self.faces.places[max(faces, key=lambda f: self.faces.areas[f])].tolist()
            out.append(Repair(kind, (x, y), f"{self.texts[kind, key]} an area of {area:.6g}"))
        return out
