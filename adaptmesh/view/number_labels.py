"""Numbers of the points and sides of a domain, for its picture."""

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
from .legend import Pen

WIDTH, HEIGHT = 9.0, 16.0
"""Size of a digit in pixels."""

OFFSET = 13.0
"""Pixels from a point to the centre of its number."""


class NumberLabel(NamedTuple):
    """A number, the point (x, y) that it belongs to, and its direction from there."""

    words: str
    x: float
    y: float
    direction: tuple[float, float]
    is_side: bool


def make_domain_mesh(domain: Domain) -> Mesh:
    """Make a mesh of the triangles, lines and names of a domain, for drawing."""
    return Mesh(
        domain.points,
        domain.triangles,
        regions=domain.triangle_regions,
        edges=domain.pieces,
        edge_tags=domain.segment_tags[domain.piece_segments],
        names=domain.names,
        region_names=domain.region_names,
    )


def label_domain(domain: Domain) -> list[NumberLabel]:
    """Label sides at their midpoints, then points.

    Sides are the curves of the domain or its segments, numbered as in ``names``. Points between
    the chords of a curve get no number.
    """
    curves = domain.curved.curves
    middles = (
        np.concatenate([curve.point(0.5) for curve in curves])
        if curves
        else domain.points[domain.segments].mean(axis=1)
    )
    sides = [
        NumberLabel(str(i), x, y, (0.0, 0.0), True) for i, (x, y) in enumerate(middles.tolist())
    ]
    vertices = np.flatnonzero(domain.curved.is_vertex).tolist()
    places = domain.points[vertices].tolist()
    points = [
        NumberLabel(str(v), x, y, free, False)
        for v, (x, y), free in zip(
            vertices, places, _find_free_directions(domain, vertices), strict=True
        )
    ]
    return sides + points


def _find_free_directions(domain: Domain, vertices: Sequence[int]) -> list[tuple[float, float]]:
    """Return for each vertex the bisector of the widest angle between its lines."""
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


def draw_numbers(pen: Pen, numbers: Sequence[NumberLabel]) -> int:
    """Draw numbers where they do not overlap: sides bold, points pale; return how many."""
    x0, y0, x1, y1 = pen.frame.view
    unit = pen.frame.unit
    places = _to_pixels(pen.frame, np.array([(n.x, n.y) for n in numbers]))
    in_view = ((places >= (x0 - 1, y0 - 1)) & (places <= (x1 + 1, y1 + 1))).all(axis=1)
    centres = places + OFFSET * unit * np.array([n.direction for n in numbers])
    half = np.array([(len(n.words) * WIDTH / 2 + 1, HEIGHT / 2) for n in numbers]) * unit
    boxes = np.concatenate([centres - half, centres + half], axis=1)
    chosen = _select_disjoint(boxes, np.flatnonzero(in_view))
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


def _select_disjoint(boxes: Floats, candidates: NDArray[np.intp]) -> list[int]:
    """Select boxes (x0, y0, x1, y1) in order, without those that overlap a selected one."""
    chosen: list[int] = []
    taken = np.empty((len(candidates), 4))
    for i in candidates.tolist():
        x0, y0, x1, y1 = boxes[i]
        t = taken[: len(chosen)]
        if not ((t[:, 0] < x1) & (x0 < t[:, 2]) & (t[:, 1] < y1) & (y0 < t[:, 3])).any():
            taken[len(chosen)] = boxes[i]
            chosen.append(i)
    return chosen


def _to_pixels(frame: Frame, points: Floats) -> Floats:
    """Map points to pixel coordinates from the lower left corner of the window."""
    placed = frame.place(points)[:, :2].astype(np.float64)
    return np.array(frame.window) / 2 + (placed - np.array(frame.centre)) * frame.pixel
