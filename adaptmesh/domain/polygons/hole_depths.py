"""In how many other holes of its part each hole lies: odd for islands.

+-----------+   A hole lies in another if the other winds around all of it, and around more. Where
| +-------+ |   they have no point in common, that is so if the other winds around any face at the
| | +---+ | |   border of the hole: so the holes around that face are counted. Only where they meet
| | | 2 | | |   are faces compared.
| | +-1-+ | |
| +---0---+ |
+-----------+
"""

from __future__ import annotations

from collections import defaultdict

import numpy as np

from adaptmesh.arrangement.faces import Faces
from adaptmesh.arrangement.winding import Passes, winding_changes
from adaptmesh.types import Int64s

from .rings import Ring


def hole_depths(faces: Faces, edges: Int64s, passes: Passes, rings: list[Ring]) -> dict[int, int]:
    """By ring, for the holes that wind around anything: how many holes of their part they lie in.

    Parameters
    ----------
    faces : Faces
    edges : (e, 2) array
        Between the faces.
    passes : (edge, ring, net) arrays
        As `arrangement.winding.sum_passes` returns them.
    rings : list of Ring
    """
    meeting = _meeting_holes(edges, passes, rings)
    numbers: dict[int, int] = defaultdict(int)
    holes_around: dict[int, int] = defaultdict(int)  # the face at hand, by part
    meeting_around: set[int] = set()
    depths: dict[int, int] = {}
    entered_in: dict[int, list[int]] = {}
    faces_in: dict[int, set[int]] = defaultdict(set)
    for face, changes in winding_changes(faces, passes):
        new = []
        for ring, change in changes.items():
            was = numbers[ring] != 0
            numbers[ring] += change
            here = numbers[ring] != 0
            if not rings[ring].number or was == here:
                continue
            holes_around[rings[ring].part] += 1 if here else -1
            if ring in meeting:
                (meeting_around.add if here else meeting_around.discard)(ring)
            if here and ring not in depths:
                new.append(ring)
        for ring in new:
            depths[ring] = holes_around[rings[ring].part] - 1
            if ring in meeting:
                entered_in[ring] = [r for r in meeting_around if rings[r].part == rings[ring].part]
        for ring in meeting_around:
            faces_in[ring].add(face)
    for ring, others in entered_in.items():
        mine = faces_in[ring]
        depths[ring] -= sum(other != ring and not mine < faces_in[other] for other in others)
    return depths


def _meeting_holes(edges: Int64s, passes: Passes, rings: list[Ring]) -> set[int]:
    """The holes that have a point in common with another hole of their part."""
    edge, ring, _ = passes
    is_hole = np.array([r.number > 0 for r in rings])[ring]
    edge, ring = edge[is_hole], ring[is_hole]
    part = np.array([r.part for r in rings], dtype=np.int64)[ring]
    columns = edges[edge].ravel(), np.repeat(part, 2), np.repeat(ring, 2)
    ends = np.unique(np.stack(columns, axis=1), axis=0)
    same = (ends[1:, :2] == ends[:-1, :2]).all(axis=1)
    return {*ends[1:][same, 2].tolist(), *ends[:-1][same, 2].tolist()}
