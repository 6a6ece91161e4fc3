"""The picture of a domain: its points and sides with their numbers, and its names."""

from __future__ import annotations

from collections.abc import Sequence
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from ..domain import Domain
from ..mesh import Mesh
from .colours import FADED, PAPER, rgb
from .frame import Frame
from .key import Pen

Floats = NDArray[np.float64]

ROOM = (22.0, 15.0)
"""Pixels across and along that a number takes: where there is no room it is left out."""


class Number(NamedTuple):
    """A number, and where it stands."""

    words: str
    x: float
    y: float
    is_side: bool


def mesh_of_domain(domain: Domain) -> Mesh:
    """The triangles between the points of a domain, with its lines and names, to be drawn."""
    return Mesh(
        domain.points,
        domain.triangles,
        regions=domain.triangle_regions,
        edges=domain.pieces,
        edge_tags=domain.segment_tags[domain.piece_segments],
        names=domain.names,
        region_names=domain.region_names,
    )


def numbers_of(domain: Domain) -> list[Number]:
    """The numbers of sides, at their middles, then those of points.

    Sides are the curves that the domain is made of, or its segments, as ``names`` count them.
    Points that only hold chords of curves have none.
    """
    curves = domain.curved.curves
    middles = (
        np.concatenate([curve.point(0.5) for curve in curves])
        if curves
        else domain.points[domain.segments].mean(axis=1)
    )
    sides = [Number(str(i), x, y, True) for i, (x, y) in enumerate(middles.tolist())]
    vertices = np.flatnonzero(domain.curved.is_vertex).tolist()
    places = domain.points[vertices].tolist()
    points = [Number(str(v), x, y, False) for v, (x, y) in zip(vertices, places, strict=True)]
    return sides + points


def draw_numbers(pen: Pen, numbers: Sequence[Number]) -> int:
    """Write numbers, those of sides in bold, those of points pale beside them; returns how many."""
    x0, y0, x1, y1 = pen.frame.view
    places = _pixels(pen.frame, np.array([(n.x, n.y) for n in numbers]))
    in_view = ((places >= (x0 - 1, y0 - 1)) & (places <= (x1 + 1, y1 + 1))).all(axis=1)
    taken: set[tuple[int, int]] = set()
    chosen = []
    for i in np.flatnonzero(in_view).tolist():
        x, y = places[i].tolist() if numbers[i].is_side else (places[i] + (5, 9)).tolist()
        cell = int(x // ROOM[0]), int(y // ROOM[1])
        if cell not in taken:
            taken.add(cell)
            chosen.append((numbers[i], x, y))
    half = 4.5 * pen.frame.unit
    boxes = [
        (x - half * len(n.words) - 2, y - 8, x + half * len(n.words) + 2, y + 8)
        for n, x, y in chosen
        if n.is_side
    ]
    if boxes:
        pen.rectangles(boxes, np.tile(rgb(PAPER), (len(boxes), 1)))
    for number, x, y in chosen:
        if number.is_side:
            pen.text(number.words, x - half * len(number.words), y, size=15, bold=True)
        else:
            pen.text(number.words, x, y, colour=FADED, size=13)
    return len(chosen)


def _pixels(frame: Frame, points: Floats) -> Floats:
    """Points of the domain as pixels of the window, from its lower left corner."""
    placed = frame.place(points)[:, :2].astype(np.float64)
    out: Floats = np.array(frame.window) / 2 + (placed - np.array(frame.centre)) * frame.pixel
    return out
