"""The border of a mesh as curves: what turns little from edge to edge was smooth.

*----*--.            Sides of several edges in one line are straight lines. Between them, and
         *           between corners, where the border turns by more than an angle, the vertices
          \\          lie on a cubic spline.
           *
"""

from __future__ import annotations

import itertools
from collections.abc import Sequence

import numpy as np

from adaptmesh.curves import Curve, Line, Spline
from adaptmesh.errors import DomainError
from adaptmesh.geometry.products import cross
from adaptmesh.types import Floats

SAGITTA = 2
"""Pieces of a smooth curve that are straight to the tolerance are off it by hardly more than it."""


def smooth_curves(
    points: Floats,
    chain: Sequence[int],
    corners: Sequence[int],
    corner_angle: float,
    ring: bool,
    tolerance: float = 0.0,
) -> list[Curve]:
    """Lines and splines through a chain of vertices.

    Parameters
    ----------
    points : (n, 2) array
    chain : sequence of int
        Vertices along the border.
    corners : sequence of int
        Those that a polyline needs; between two of them that are no neighbours it is straight.
    corner_angle : float
        In degrees.
    ring : bool
        Whether the chain is closed and may be smooth where it starts, too.
    tolerance : float
        How far vertices may be off a straight line: where a smooth curve is that near to its chord,
        several edges on one line do not make it straight.
    """
    if not 0 <= corner_angle < 180:
        raise DomainError(f"corner_angle={corner_angle}: expected degrees from 0 to below 180")
    edges = {frozenset(pair) for pair in itertools.pairwise(chain)}
    straight = np.array([frozenset(pair) not in edges for pair in itertools.pairwise(corners)])
    p = points[list(corners)]
    straight &= _sagittas(p, ring) >= SAGITTA * tolerance
    # At vertex i segment i - 1 ends and segment i starts; the first and the last are neighbours.
    breaks = straight | np.roll(straight, 1) | (_turns(p) > corner_angle)
    if not ring:
        breaks[0] = True
    if not breaks.any():
        return [Spline(p[:-1], closed=True)]
    first = int(np.argmax(breaks))
    p = np.concatenate([p[first:-1], p[: first + 1]]) if first else p
    ends = [*np.flatnonzero(np.roll(breaks, -first)).tolist(), len(p) - 1]
    return [
        Line(p[i], p[j]) if j == i + 1 else Spline(p[i : j + 1])
        for i, j in itertools.pairwise(ends)
    ]


def _sagittas(p: Floats, ring: bool) -> Floats:
    """How far the pieces of a polyline are off a smooth curve through its points, (k,).

    A curve that turns by an angle from the middle of a piece of length l to that of another, of
    length m, is off its chord by l² angle / (l + m) / 4; the lesser turn at the two ends counts.
    """
    length = np.hypot(*np.diff(p, axis=0).T)
    turn = np.radians(_turns(p))  # where a piece begins
    bend = 2 * turn / (length + np.roll(length, 1))
    at_end = np.roll(bend, -1)
    if not ring:  # nothing lies beyond the ends
        bend[0], at_end[-1] = at_end[0], bend[-1]
        if len(bend) == 1:
            return np.full(1, np.inf)
    return length**2 * np.minimum(bend, at_end) / 8


def _turns(p: Floats) -> Floats:
    """By how many degrees a closed polyline (k + 1, 2) turns at each of its first k points."""
    after = np.diff(p, axis=0)
    before = np.roll(after, 1, axis=0)
    turn = np.arctan2(cross(before, after), (before * after).sum(axis=1))
    return np.degrees(np.abs(turn))
