"""Whether the rings of a polygon lie in each other as it says: holes in their shell."""

from __future__ import annotations

import numpy as np

from adaptmesh.arrangement.faces import find_faces
from adaptmesh.arrangement.record import Repair
from adaptmesh.arrangement.winding import sum_passes
from adaptmesh.domain.inputs import OR_REPAIR
from adaptmesh.errors import DomainError
from adaptmesh.types import Bools, Floats, Int64s, Ints

from .face_owners import owners_of_faces
from .rings import Ring, ring_area, ring_label
from .shape import Shape


def rings_with_labels(shape: Shape) -> tuple[list[Ring], list[Floats]]:
    """The rings of a polygon that have points: where each is from, and its points."""
    rings, points = [], []
    for k, part in enumerate(shape.parts):
        for r, ring in enumerate(part):
            if len(ring):
                x, y = ring[0].tolist()
                label = ring_label(shape, k, r)
                rings.append(Ring(0, k, r, label, ring_area(ring), (x, y)))
                points.append(ring)
    return rings, points


def refuse_rings_out_of_place(
    shape: Shape,
    rings: list[Ring],
    points: Floats,
    pieces: Ints,
    along: Bools,
    ring: Int64s,
) -> None:
    """Raise a `DomainError` if a hole is not in its shell, or parts or holes overlap.

    Parameters
    ----------
    shape : Shape
    rings : list of Ring
    points : (n, 2) array
    pieces : (p, 2) array
        Of rings, which meet only at points.
    along : (p,) array of bool
        Whether the ring goes from the first point of a piece to its second.
    ring : (p,) array
        The ring of each piece.
    """
    edges = pieces.astype(np.int64)
    passes = sum_passes(np.arange(len(edges)), np.where(along, 1, -1), ring)
    log: list[Repair] = []
    owners_of_faces(find_faces(points, edges), edges, passes, [shape], rings, log)
    if log:
        raise DomainError(f"{log[0]}: mend it, {OR_REPAIR}")
