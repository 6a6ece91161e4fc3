"""The picture of a domain: its points and sides with their numbers, and its names."""

from __future__ import annotations

from collections.abc import Sequence
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from adaptmesh.domain.domain import Domain
from adaptmesh.mesh.mesh import Mesh
from adaptmesh.types import Floats

from .colours import FADED, PAPER, rgb
from .frame import Frame
from .key import Pen

WIDTH, HEIGHT = 9.0, 16.0
"""Pixels that a digit takes."""

ASIDE = 13.0
"""Pixels from a point to the middle of its number."""


class Number(NamedTuple):
    """A number, what it belongs to, and in which direction from there it stands."""

    words: str
    x: float
    y: float
    aside: tuple[float, float]
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
    sides = [Number(str(i), x, y, (0.0, 0.0), True) for i, (x, y) in enumerate(middles.tolist())]
    vertices = np.flatnonzero(domain.curved.is_vertex).tolist()
    places = domain.points[vertices].tolist()
    points = [
        Number(str(v), x, y, free, False)
        for v, (x, y), free in zip(
            vertices, places, _free_directions(domain, vertices), strict=True
        )
    ]
    return sides + points


def _free_directions(domain: Domain, vertices: Sequence[int]) -> list[tuple[float, float]]:
    """For each vertex the middle of the widest angle between its lines."""
    ends = np.concatenate([domain.pieces, domain.pieces[:, ::-1]])
    along = domain.points[ends[:, 1]] - domain.points[ends[:, 0]]
    angle = np.arctan2(along[:, 1], along[:, 0])
    order = np.lexsort((angle, ends[:, 0]))
    first = np.searchsorted(ends[order, 0], np.arange(len(domain.points) + 1))
    out = []
    for v in vertices:
        mine = angle[order[first[v] : first[v + 1]]]
        if len(mine) == 0:
            mine = np.array([np.pi / 4 - np.pi])
        gaps = np.diff(np.append(mine, mine[0] + 2 * np.pi))
        i = int(np.argmax(gaps))
        middle = float(mine[i] + gaps[i] / 2)
        out.append((float(np.cos(middle)), float(np.sin(middle))))
    return out


def draw_numbers(pen: Pen, numbers: Sequence[Number]) -> int:
    """Write numbers, those of sides in bold, those of points pale beside them; returns how many."""
    x0, y0, x1, y1 = pen.frame.view
    unit = pen.frame.unit
    places = _pixels(pen.frame, np.array([(n.x, n.y) for n in numbers]))
    in_view = ((places >= (x0 - 1, y0 - 1)) & (places <= (x1 + 1, y1 + 1))).all(axis=1)
    centres = places + ASIDE * unit * np.array([n.aside for n in numbers])
    half = np.array([(len(n.words) * WIDTH / 2 + 1, HEIGHT / 2) for n in numbers]) * unit
    boxes = np.concatenate([centres - half, centres + half], axis=1)
    chosen = _apart(boxes, np.flatnonzero(in_view))
    sides = [i for i in chosen if numbers[i].is_side]
    if sides:
        pen.rectangles(boxes[sides].tolist(), np.tile(rgb(PAPER), (len(sides), 1)))
    for i in chosen:
        words, x, y = numbers[i].words, float(boxes[i, 0] + unit), float(centres[i, 1])
        if numbers[i].is_side:
            pen.text(words, x, y, size=15, bold=True)
        else:
            pen.text(words, x, y, colour=FADED, size=13)
    return len(chosen)


def _apart(boxes: Floats, candidates: NDArray[np.intp]) -> list[int]:
    """Which boxes (x0, y0, x1, y1) overlap none chosen before them."""
    chosen: list[int] = []
    taken = np.empty((len(candidates), 4))
    for i in candidates.tolist():
        x0, y0, x1, y1 = boxes[i]
        t = taken[: len(chosen)]
        if not ((t[:, 0] < x1) & (x0 < t[:, 2]) & (t[:, 1] < y1) & (y0 < t[:, 3])).any():
            taken[len(chosen)] = boxes[i]
            chosen.append(i)
    return chosen


def _pixels(frame: Frame, points: Floats) -> Floats:
    """Points of the domain as pixels of the window, from its lower left corner."""
    placed = frame.place(points)[:, :2].astype(np.float64)
    return np.array(frame.window) / 2 + (placed - np.array(frame.centre)) * frame.pixel
