"""Vertices at unit distances along the sides of a domain, or along parts of them.

::

        o-------o====o===o====o-------o       a part of a side (=), given by the parameters of its
            ^ rest                ^ rest      ends, is cut; the vertices of the rest stay, and get
                                              more where polylines would cross

A straight part of length L becomes the n equal pieces for which sqrt((n - 1) n) < L <= sqrt(n (n +
1)): as near to unit as they can be. So does a curved one, but for more pieces where it turns by
more than `MAX_TURN` along one, or where they would cross something.
"""

from __future__ import annotations

import numpy as np

from adaptmesh import ragged
from adaptmesh.domain.sides.inscribed_polygon import MESH_TURN
from adaptmesh.domain.sides.polyline import Polylines, polylines_along
from adaptmesh.domain.sides.side import SideParts, SidePoints, Sides, turns_between
from adaptmesh.errors import BudgetError, DomainError
from adaptmesh.types import Floats, Index
from metrics import ControlSpace

from .edge_lengths import measured_edges, straight_lengths
from .measure_curves import equal_shares, inscribed_chords, measure_parts
from .vertex_limit import about

MAX_TURN = MESH_TURN
"""By how much a curve may turn along an edge of a mesh, in degrees: a circle gets at least six."""

LONG_EDGE = 1.3
"""A curved part with an edge longer than this is cut again, ..."""

MAX_CUTS = 4
"""... up to so many times."""

MAX_ROUNDS = 20
"""In which vertices that one periodic side needs are carried to the other."""


def unit_polylines(
    sides: Sides, parts: SideParts, rest: SidePoints, metric: ControlSpace, max_vertices: int
) -> Polylines:
    """Polylines along all sides, those of the parts of unit edges where they can be.

    Parameters
    ----------
    sides : Sides
    parts : SideParts
    rest : SidePoints
        The vertices outside the parts, and at their ends.
    metric : ControlSpace
    max_vertices : int
        A boundary of many more vertices than this is refused.
    """
    straight = sides.is_straight[parts.side]
    cuts = _straight_cuts(sides, parts.where(straight), metric, max_vertices)
    rest = rest.joined(cuts)
    if straight.all():
        return polylines_along(sides, rest, MAX_TURN)
    return _curved(sides, parts.where(~straight), rest, metric, max_vertices)


def check_count(n: float, max_vertices: int) -> None:
    """Refuse a boundary of more vertices than a mesh may have."""
    if n > max_vertices:
        raise BudgetError(
            f"the boundary alone would have about {about(n)} vertices, but max_vertices is "
            f"{max_vertices:,}: ask for larger sizes, or allow more"
        )


def _straight_cuts(
    sides: Sides, parts: SideParts, metric: ControlSpace, max_vertices: int
) -> SidePoints:
    low, high = parts.u.T
    points = np.concatenate([sides.point(parts.side, u) for u in (low, high)])
    edges = np.arange(len(points)).reshape(2, -1).T
    measured = measured_edges(points, metric(points), edges, metric, max_vertices)
    check_count(len(sides.corners) + measured.lengths().sum(), max_vertices)
    share, part = measured.cut()
    return SidePoints(parts.side[part], low[part] + share * (high - low)[part])


def _curved(
    sides: Sides, parts: SideParts, rest: SidePoints, metric: ControlSpace, max_vertices: int
) -> Polylines:
    """Cut the parts by their lengths along the curves, and again where edges are too long."""
    chords = inscribed_chords(sides, parts)
    measured = measure_parts(sides, parts, chords, metric, max_vertices)
    cuts = measured.unit_cuts(_min_parts(sides, parts, chords))
    for _ in range(MAX_CUTS):
        lines = polylines_along(sides, rest.joined(_points_of(parts, cuts)), MAX_TURN)
        part = SidePoints(lines.side, lines.u.mean(axis=1)).within(parts)
        mine = np.flatnonzero(part >= 0)
        part, u = part[mine], lines.u[mine]
        lengths = straight_lengths(lines.points, lines.ends[mine], metric, max_vertices)
        if (lengths <= LONG_EDGE).all():
            return lines
        cuts = _cut_again(part, u, cuts, measured.lengths_between(part, u), lengths)
    return polylines_along(sides, rest.joined(_points_of(parts, cuts)), MAX_TURN)


def _points_of(parts: SideParts, cuts: list[Floats]) -> SidePoints:
    return SidePoints(np.repeat(parts.side, [len(u) for u in cuts]), np.concatenate(cuts))


def _min_parts(sides: Sides, parts: SideParts, chords: tuple[Index, Floats]) -> Index:
    """In how many parts each is to be divided so that none turns by more than `MAX_TURN`."""
    part, u = chords
    a, b = (sides.point(parts.side[part], u[:, i]) for i in (0, 1))
    turns = np.where(np.diff(part) == 0, turns_between(b - a), 0.0)
    turn = np.bincount(part[1:], turns, minlength=len(parts.side))
    return np.maximum(1, np.ceil(turn / np.radians(MAX_TURN))).astype(int)


def _cut_again(
    part: Index, u: Floats, cuts: list[Floats], along: Floats, lengths: Floats
) -> list[Floats]:
    """Cuts of parts that have edges that are too long, so close that these become unit.

    An edge whose ends lie across a thin layer, not along it, is longer in the metric than its
    curve. Of its length l the part t along the curve goes with the number m of pieces that it is
    cut into, and the rest with m^2, as the turn does: 1 = (t / m)^2 + (l^2 - t^2) / m^4.
    """
    rest = np.maximum(lengths**2 - along**2, 0)
    demand = np.sqrt(0.5 * (along**2 + np.sqrt(along**4 + 4 * rest)))
    out = list(cuts)
    for p in np.unique(part[lengths > LONG_EDGE]):
        mine = part == p
        out[p] = equal_shares(u[mine], demand[mine], np.ones((np.count_nonzero(mine), 2)))
    return out


def periodic_polylines(sides: Sides, lines: Polylines) -> Polylines:
    """The same polylines on sides that correspond; more vertices where these would cross something.

    Of two sides that are periodic, the one with fewer vertices gets the images of the other's.
    """
    pairs = [(i, image.side) for i, image in sides.images.items() if i < image.side]
    if not pairs:
        return lines
    for _ in range(MAX_ROUNDS):
        lines = polylines_along(sides, _with_images(sides, lines.inner, pairs), MAX_TURN)
        counts = lines.inner.counts(len(sides))
        differing = [i for i, j in pairs if counts[i] != counts[j]]
        if not differing:
            return lines
    first, second = sides.images[differing[0]].names
    raise DomainError(
        f"{first!r} and {second!r} cannot be cut alike: what comes near one of them needs more "
        "vertices there"
    )


def _with_images(sides: Sides, points: SidePoints, pairs: list[tuple[int, int]]) -> SidePoints:
    rows = ragged.split(points.u, points.counts(len(sides)))
    for i, j in pairs:
        if len(rows[i]) < len(rows[j]):
            i, j = j, i
        rows[j] = np.sort(sides.image(i, rows[i]))
    return SidePoints(ragged.owners(np.array([len(row) for row in rows])), np.concatenate(rows))
