"""The plane sweep over borders, held against all pairs of edges and exact winding numbers."""

from __future__ import annotations

import itertools
from fractions import Fraction

import numpy as np
import pytest
from reference.exact import orient2d, sign
from reference.transforms import TRANSFORMS

from adaptmesh import _core


def side(a, b, c):
    return int(sign(np.array([orient2d(a, b, c)], dtype=object))[0])


def meet(p, e, f):
    """Whether two edges have more in common than an end, by all cases."""
    (a, b), (c, d) = e, f
    sides = [side(p[i], p[j], p[k]) for i, j, k in ((a, b, c), (a, b, d), (c, d, a), (c, d, b))]
    if sides[0] * sides[1] < 0 and sides[2] * sides[3] < 0:
        return True
    hangs = zip(sides, ((a, b, c), (a, b, d), (c, d, a), (c, d, b)), strict=True)
    return any(
        s == 0
        and k not in (i, j)
        and all(min(x, y) <= z <= max(x, y) for x, y, z in zip(p[i], p[j], p[k], strict=True))
        for s, (i, j, k) in hangs
    )


def winding(p, edges, q):
    """How often directed edges wind around a point."""
    turns = 0
    for a, b in edges:
        if (p[a][1] <= q[1]) != (p[b][1] <= q[1]):
            up = p[b][1] > p[a][1]
            if (side(p[a], p[b], q) > 0) == up:
                turns += 1 if up else -1
    return turns


def fractions(points):
    return [tuple(map(Fraction, xy)) for xy in points.tolist()]


@pytest.mark.parametrize("size", [3, 5, 1000])
def test_edges_on_a_lattice(size):
    """Points on a small lattice: collinear, vertical, overlapping and hanging in every way."""
    rng = np.random.default_rng(size)
    found = 0
    for _ in range(200):
        points = np.unique(rng.integers(0, size, (8, 2)), axis=0).astype(float)
        edges = np.array(list(itertools.combinations(range(len(points)), 2)), np.int32)
        edges = rng.permutation(edges)[: rng.integers(1, 6)]
        p = fractions(points)
        met = [
            (e, f)
            for e, f in itertools.combinations(range(len(edges)), 2)
            if meet(p, edges[e].tolist(), edges[f].tolist())
        ]
        pair, _ = _core.sweep_border(points, edges)
        assert (pair in met) if met else (pair == (-1, -1)), (points, edges)
        found += bool(met)
    assert 20 < found < 200


def rings(rng):
    """Closed rings around random places, in either direction; many cross, some lie in others."""
    points, edges = [], []
    for _ in range(rng.integers(1, 6)):
        n = int(rng.integers(3, 9))
        angle = 2 * np.pi * (np.arange(n) + rng.uniform(0, 0.9, n)) / n
        radius = rng.choice([0.1, 0.4, 1.5]) * rng.uniform(0.7, 1, n)
        ring = np.arange(n) + len(points)
        ring = ring[::-1] if rng.random() < 0.4 else ring
        edges += list(zip(ring.tolist(), np.roll(ring, -1).tolist(), strict=True))
        centre = rng.uniform(-1, 1, 2)
        points += (centre + radius[:, None] * np.stack([np.cos(angle), np.sin(angle)], 1)).tolist()
    return np.array(points), edges


@pytest.mark.fast_cases(1)
@pytest.mark.parametrize("transform", TRANSFORMS[1::2], ids=str)
def test_layers_are_winding_numbers(transform):
    rng = np.random.default_rng(7)
    simple = 0
    for _ in range(60):
        points, edges = rings(rng)
        points = transform(points)
        p = fractions(points)
        met = {
            (e, f)
            for e, f in itertools.combinations(range(len(edges)), 2)
            if meet(p, edges[e], edges[f])
        }
        pair, layers = _core.sweep_border(points, np.array(edges, np.int32))
        if met:
            assert pair in met
            continue
        assert pair == (-1, -1)
        simple += 1
        for (a, b), found in zip(edges, layers.tolist(), strict=True):
            d = (p[b][0] - p[a][0], p[b][1] - p[a][1])
            hair = Fraction(1, 2**200)
            q = ((p[a][0] + p[b][0]) / 2 - hair * d[1], (p[a][1] + p[b][1]) / 2 + hair * d[0])
            assert found == winding(p, edges, q)
    assert simple > 10
