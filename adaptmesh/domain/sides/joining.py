"""Joining curves end to end: where the corners are, and the paths of curves between them.

::

        curve 0      curve 1           Corners are where other than two ends meet, the name changes,
      A ------- . ~~~~~~~~~~ B         or the direction does; A and B here. Between them a path is
                 \\  smooth             one smooth line with a parameter of its own, whatever curves
                  joint                it is made of.
"""

from __future__ import annotations

import itertools
from collections.abc import Sequence
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from adaptmesh.curves import Curve
from adaptmesh.errors import DomainError
from adaptmesh.topology import components
from adaptmesh.types import Bools, Floats, Ints

from .paths import Path

STEPS = 8
"""By which the length of a piece of a curve is measured."""


class Piece(NamedTuple):
    """What lies between two neighbouring kinks of a curve; or a curve that has none."""

    curve: int
    t0: float
    t1: float


class Joined(NamedTuple):
    """Corners (n, 2), straight lines between them (k, 2), the curve of each, (k,), and paths."""

    corners: Floats
    lines: Ints
    line_curves: Ints
    paths: tuple[Path, ...]


def join(
    curves: Sequence[Curve], tags: Ints, corner_angle: float, tolerance: float, stops: Floats
) -> Joined:
    """Find corners, straight lines and paths.

    Parameters
    ----------
    curves : sequence of Curve
    tags : (k,) array of int
        The number of the name of each; a path has one name.
    corner_angle : float
        Where a line turns by more than this, in degrees, is a corner.
    tolerance : float
        Ends nearer than this are one. What is itself no longer than that, and begins and ends in
        one place, is left out.
    stops : (m, 2) array
        Where ends are corners, be they smooth or not.
    """
    pieces = _pieces(curves)
    ends = np.stack([_ends(curves, pieces, 0), _ends(curves, pieces, 1)])
    place = places_of(ends.reshape(-1, 2), tolerance).reshape(2, -1)
    stays = np.array(
        [
            not _vanishes(curves, piece, start, end, tolerance)
            for piece, (start, end) in zip(pieces, place.T.tolist(), strict=True)
        ]
    )
    if not stays.any():
        raise DomainError(
            f"all curves are shorter than join_tolerance={tolerance:g}: choose a smaller one"
        )
    pieces = list(itertools.compress(pieces, stays))
    ends = ends[:, stays].reshape(-1, 2)
    number = np.unique(place[:, stays], return_inverse=True)[1].ravel()
    node = number.tolist()
    at: list[list[int]] = [[] for _ in range(number.max() + 1)]
    for e, v in enumerate(node):
        at[v].append(e)
    stopped = set(number[are_near(ends, stops, tolerance)].tolist())
    is_corner = [
        v in stopped or _is_corner(curves, tags, pieces, found, corner_angle)
        for v, found in enumerate(at)
    ]
    walks = _walks(node, at, is_corner, len(pieces))
    return _joined(curves, pieces, ends, node, is_corner, walks)


def _joined(
    curves: Sequence[Curve],
    pieces: list[Piece],
    ends: Floats,
    node: list[int],
    is_corner: list[bool],
    walks: list[list[int]],
) -> Joined:
    """Corners, and what each walk from corner to corner is: a straight line, or a path."""
    corner_number = np.cumsum(is_corner) - 1
    _, first = np.unique(node, return_index=True)
    corners = ends[first[np.array(is_corner)]]
    lines, owners, paths = [], [], []
    for walk in walks:
        a, b = (
            int(corner_number[node[walk[0]]]),
            int(corner_number[node[_other(walk[-1], len(pieces))]]),
        )
        piece = pieces[walk[0] % len(pieces)]
        if len(walk) == 1 and curves[piece.curve].is_straight:
            lines.append((a, b))
            owners.append(piece.curve)
            continue
        parts = tuple(_part(curves, pieces, e) for e in walk)
        owner = tuple(pieces[e % len(pieces)].curve for e in walk)
        paths.append(Path(parts, owner, (a, b), corners[a], corners[b]))
    return Joined(
        corners,
        np.array(lines, np.int32).reshape(-1, 2),
        np.array(owners, np.int32),
        tuple(paths),
    )


def _pieces(curves: Sequence[Curve]) -> list[Piece]:
    out = []
    for i, curve in enumerate(curves):
        t = [0.0, *curve.breaks.tolist(), 1.0]
        out += [Piece(i, t0, t1) for t0, t1 in itertools.pairwise(t)]
    return out


def _vanishes(
    curves: Sequence[Curve], piece: Piece, start: int, end: int, tolerance: float
) -> bool:
    """Whether nothing is left of a piece, as its ends, of these numbers, are one place.

    A closed curve stays, be it ever so small; so does one that comes back from far away.
    """
    curve = curves[piece.curve]
    if start != end or (curve.is_closed and piece.t1 - piece.t0 == 1):
        return False
    length = length_of(curve, piece.t0, piece.t1)
    if length <= tolerance:
        return True
    if not curve.is_straight:
        return False
    (x0, y0), (x1, y1) = curve.point(np.array([piece.t0, piece.t1])).tolist()
    raise DomainError(
        f"{name_of_curve(curves, piece.curve)} from ({x0:g}, {y0:g}) to ({x1:g}, {y1:g}) is "
        f"{length:.3g} long, but both its ends are one place with join_tolerance={tolerance:g}, as "
        "shorter curves lie between them: choose a smaller join_tolerance"
    )


def length_of(curve: Curve, t0: float = 0.0, t1: float = 1.0) -> float:
    """The length of a piece of a curve, about, by that of chords."""
    p = curve.point(np.linspace(t0, t1, STEPS + 1))
    return float(np.hypot(*np.diff(p, axis=0).T).sum())


def _ends(curves: Sequence[Curve], pieces: list[Piece], which: int) -> Floats:
    """Where the pieces begin or end, (n, 2)."""
    out = []
    for i, found in itertools.groupby(pieces, key=lambda piece: piece.curve):
        t = np.array([piece.t1 if which else piece.t0 for piece in found])
        if curves[i].is_closed:
            t[t == 1] = 0  # it ends exactly where it began
        out.append(curves[i].point(t))
    return np.concatenate(out)


def name_of_curve(curves: Sequence[Curve], i: int) -> str:
    """A curve in words."""
    return f"curve {i} ({curves[i]!r})"


def places_of(ends: Floats, tolerance: float) -> NDArray[np.intp]:
    """The number of the place of each end; ends within the tolerance share one."""
    from scipy.spatial import KDTree

    pairs = KDTree(ends).query_pairs(tolerance, output_type="ndarray")
    return components(len(ends), pairs)


def are_near(points: Floats, places: Floats, tolerance: float) -> Bools:
    """Which of the points (n, 2) are within the tolerance of one of the places (m, 2)."""
    from scipy.spatial import KDTree

    if not len(places):
        return np.zeros(len(points), bool)
    distance, _ = KDTree(places).query(points)
    return distance <= tolerance


# Ends are numbered: e < n is where piece e begins, e >= n where piece e - n ends. To walk a piece
# from an end is to come out at the other one.


def _other(end: int, n: int) -> int:
    return end + n if end < n else end - n


def _part(curves: Sequence[Curve], pieces: list[Piece], end: int) -> Curve:
    """The piece walked from this end, as a curve."""
    i, t0, t1 = pieces[end % len(pieces)]
    if end >= len(pieces):
        t0, t1 = t1, t0
    return curves[i] if (t0, t1) == (0, 1) else curves[i].part(t0, t1)


def _is_corner(
    curves: Sequence[Curve], tags: Ints, pieces: list[Piece], found: list[int], angle: float
) -> bool:
    if len(found) != 2:
        return True
    p, q = (pieces[e % len(pieces)] for e in found)
    if tags[p.curve] != tags[q.curve] or (
        curves[p.curve].is_straight and curves[q.curve].is_straight
    ):
        return True
    t = [p.t1 if found[0] >= len(pieces) else p.t0, q.t1 if found[1] >= len(pieces) else q.t0]
    if any(0 < s < 1 for s in t):  # a kink
        return True
    u, v = (_direction(_part(curves, pieces, e)) for e in found)
    turn = np.arctan2(abs(u[0] * v[1] - u[1] * v[0]), -(u @ v))
    return bool(np.degrees(turn) > angle)


def _direction(curve: Curve) -> Floats:
    """The unit vector in which a curve leaves its start, whatever its speed there."""
    out = curve.derivative(0.0)[0]
    step = curve.point([1e-4])[0] - curve.start
    if np.hypot(*out) < 1e-3 * np.hypot(*step) / 1e-4:  # stands still there, or nearly
        out = step
    norm = np.hypot(*out)
    return out / norm if norm else np.array([1.0, 0.0])


def _walks(node: list[int], at: list[list[int]], is_corner: list[bool], n: int) -> list[list[int]]:
    """Walks from corner to corner, each as the ends at which its pieces are entered.

    A closed line without a corner gets one: where the first of its pieces begins.
    """
    walked = [False] * n
    walks = []
    for start in [*(v for v in range(len(at)) if is_corner[v]), *node[:n]]:
        for first in at[start]:
            if walked[first % n]:
                continue
            is_corner[start] = True
            walk, e = [], first
            while True:
                walked[e % n] = True
                walk.append(e)
                v = node[_other(e, n)]
                if is_corner[v]:
                    break
                e = next(other for other in at[v] if other != _other(e, n))
            walks.append(walk)
    return walks
