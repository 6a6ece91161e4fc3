"""Points near segments, and crossings, against all pairs looked at in fractions."""

from fractions import Fraction

import numpy as np
import pytest
from reference.exact import orient2d

from adaptmesh import _core

EVERYTHING = 10**9


def encounters(points, segments, tolerance, unseen=None, most=EVERYTHING):
    points, segments = np.asarray(points, float), np.asarray(segments, np.int32).reshape(-1, 2)
    unseen = np.ones(len(segments), bool) if unseen is None else np.asarray(unseen)
    near, crossings = _core.encounters(points, segments, unseen, tolerance, most)
    return {*map(tuple, near.tolist())}, {*map(tuple, crossings.tolist())}


def near_by_hand(points, segment, v, tolerance):
    a, b = segment
    if v in (a, b) or a == b:
        return False
    (ax, ay), (bx, by), (px, py) = ([Fraction(x) for x in points[k]] for k in (a, b, v))
    ux, uy, wx, wy = bx - ax, by - ay, px - ax, py - ay
    squared = ux * ux + uy * uy
    t = (ux * wx + uy * wy) / squared
    if not 0 < t < 1:
        return False
    off = (ux * wy - uy * wx) ** 2 / squared
    to_a, to_b = wx**2 + wy**2, (px - bx) ** 2 + (py - by) ** 2
    return off <= Fraction(tolerance) ** 2 and max(to_a, to_b) < squared


def cross_by_hand(points, s, t):
    if {*s} & {*t}:
        return False
    a, b, c, d = ([Fraction(x) for x in points[k]] for k in (*s, *t))
    return orient2d(a, b, c) * orient2d(a, b, d) < 0 and orient2d(c, d, a) * orient2d(c, d, b) < 0


@pytest.mark.parametrize("seed", range(40))
def test_all_are_found_and_no_others(seed):
    rng = np.random.default_rng(seed)
    n, grid = 14, rng.choice([8, 64, 2**40])  # small grids: collinear, overlapping, touching
    points = rng.integers(0, grid, (n, 2)) / grid
    segments = rng.integers(0, n, (20, 2))
    points = np.unique(points, axis=0)
    segments = segments[(segments < len(points)).all(axis=1)]
    tolerance = rng.choice([2**-40, 0.03])
    unseen = rng.random(len(segments)) < rng.choice([0.3, 1.0])
    near, crossings = encounters(points, segments, tolerance, unseen)

    pairs = [
        (i, j)
        for i in range(len(segments))
        for j in range(i + 1, len(segments))
        if unseen[i] or unseen[j]
    ]
    assert crossings == {
        (i, j) for i, j in pairs if cross_by_hand(points, segments[i], segments[j])
    }
    assert near == {
        (k, int(v))
        for i, j in pairs
        for k, other in ((i, j), (j, i))
        for v in segments[other]
        if near_by_hand(points, segments[k], v, tolerance)
    }


def test_nothing():
    assert encounters(np.empty((0, 2)), [], 1e-9) == (set(), set())
    assert encounters([(0, 0), (1, 0)], [(0, 1)], 1e-9) == (set(), set())
    assert encounters([(0, 0), (1, 1), (0, 1), (1, 0)], [(0, 1), (2, 3)], 0.0, [False] * 2) == (
        set(),
        set(),
    )


def test_it_stops_after_so_many_crossings():
    k = np.arange(30.0)
    ends = np.concatenate([np.stack([k, 0 * k], 1), np.stack([29 - k, 0 * k + 1 + k / 99], 1)])
    segments = np.stack([np.arange(30), np.arange(30, 60)], axis=1)
    assert len(encounters(ends, segments, 1e-9)[1]) == 435
    assert 10 < len(encounters(ends, segments, 1e-9, most=10)[1]) < 20
