"""Constrained Delaunay triangulations of random segments: all there, all Delaunay."""

from __future__ import annotations

from itertools import pairwise

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from reference.constrained import check_constrained_delaunay, cut_segments, twice_area

from adaptmesh import _core

NOTHING = np.empty((0, 2))


def triangulate(points, segments, holes=NOTHING, seeds=NOTHING, nesting=False):
    return _core.triangulate(
        np.array(points, dtype=float).reshape(-1, 2),
        np.array(segments, dtype=np.int32).reshape(-1, 2),
        np.array(holes, dtype=float).reshape(-1, 2),
        np.array(seeds, dtype=float).reshape(-1, 2),
        nesting,
    )


SIDE = 10  # lattice points have coordinates from 0 to SIDE
FRAME = [(-1, -1), (SIDE + 1, -1), (SIDE + 1, SIDE + 1), (-1, SIDE + 1)]


def framed(points, segments):
    """A square around everything, its corners the last points and its sides the last segments."""
    n = len(points)
    sides = [(n + k, n + (k + 1) % 4) for k in range(4)]
    return [*points, *FRAME], [*segments, *sides]


def check(points, segments):
    """The constrained triangulation of a frame full of points and segments that do not cross."""
    points, segments = framed(points, segments)
    triangles, labels, sub_edges, segment_of, is_boundary = triangulate(points, segments)
    pieces = [(a, b, k) for (a, b), k in zip(sub_edges.tolist(), segment_of, strict=True)]
    assert pieces == cut_segments(points, segments)
    edges = check_constrained_delaunay(
        points, triangles.tolist(), sub_edges.tolist(), is_boundary.tolist()
    )
    assert twice_area(points, triangles) == 2 * (SIDE + 2) ** 2
    assert set(triangles.ravel().tolist()) == set(range(len(points)))
    assert len(points) - len(edges) + len(triangles) == 1  # Euler
    assert not labels.any()


lattice_point = st.tuples(st.integers(0, SIDE), st.integers(0, SIDE))


@st.composite
def planar_graphs(draw):
    """Points, and segments between some: edges of the Delaunay triangulation of a few of them.

    The other points fall anywhere, on segments too; segments dangle, form trees and loops, touch.
    """
    points = draw(st.lists(lattice_point, min_size=3, max_size=40, unique=True))
    carriers = points[: draw(st.integers(3, len(points)))]
    try:
        triangles, _ = _core.delaunay(np.array(carriers, dtype=float))
    except _core.InputError:
        by_place = sorted(range(len(carriers)), key=lambda v: carriers[v])
        edges = list(pairwise(by_place))
    else:
        edges = sorted(
            {tuple(sorted((t[i - 1], t[i]))) for t in triangles.tolist() for i in (0, 1, 2)}
        )
    segments = [e for e in edges if draw(st.booleans())]
    return points, [e[::-1] if draw(st.booleans()) else e for e in segments]


@pytest.mark.slow
@settings(max_examples=150, deadline=None)
@given(planar_graphs())
def test_random_planar_graphs(graph):
    check(*graph)


@settings(max_examples=60, deadline=None)
@given(
    st.lists(lattice_point, min_size=2, max_size=60, unique=True),
    st.integers(0, SIDE),
    st.integers(0, SIDE),
)
def test_one_long_segment_through_points(points, low, high):
    """Many edges to cross, vertices on both sides and on the segment."""
    ends = [(0, low), (SIDE, high)]
    points = ends + [p for p in points if p not in ends]
    check(points, [(0, 1)])


@pytest.mark.parametrize("seed", range(8))
def test_fans_and_combs(seed):
    """Long segments from one vertex, and nearly parallel ones, through random points."""
    rng = np.random.default_rng(seed)
    scattered = (rng.random((60, 2)) * SIDE).tolist()
    tips = [[SIDE, y] for y in np.linspace(0.5, SIDE - 0.5, 7)]
    teeth = [[x, y] for x in np.linspace(0.25, 0.75, 5) for y in (0.1, SIDE - 0.2)]
    points = [[0.0, SIDE / 2], *tips, *teeth, *scattered]
    check(
        points,
        [(0, 1 + k) for k in range(7)] if seed % 2 else [(8 + 2 * k, 9 + 2 * k) for k in range(5)],
    )


def test_a_triangulation_that_winds_around_a_spike():
    """The triangles along the way touch both sides of edges that point at the segment."""
    rng = np.random.default_rng(12)
    tips = [[x, 5 + 0.01 * (-1) ** k] for k, x in enumerate(np.linspace(1, 9, 17).tolist())]
    roots = [[x, 10 if y > 5 else 0] for x, y in tips]
    spikes = [(2 + k, 2 + len(tips) + k) for k in range(len(tips))]
    points = [[0, 5], [SIDE, 5], *tips, *roots]
    check(points, [(0, 1), *spikes])
    check(points, [*spikes, (1, 0)])
    order = rng.permutation(len(points))
    number = np.argsort(order)
    moved = np.array(points)[order]
    check(moved.tolist(), [(int(number[a]), int(number[b])) for a, b in [(0, 1), *spikes]])


def test_result_does_not_depend_on_the_order_of_segments():
    rng = np.random.default_rng(2)
    points = rng.random((300, 2)) * SIDE
    triangles, _ = _core.delaunay(points[:40])
    edges = sorted({tuple(sorted((t[i - 1], t[i]))) for t in triangles.tolist() for i in (0, 1, 2)})
    points, segments = framed(points.tolist(), edges[::3])
    shuffled = [segments[k] for k in rng.permutation(len(segments))]

    def canonical(out):
        return {min((a, b, c), (b, c, a), (c, a, b)) for a, b, c in out[0].tolist()}

    assert canonical(triangulate(points, segments)) == canonical(triangulate(points, shuffled))


@pytest.mark.parametrize(
    ("points", "segments", "fault"),
    [
        ([(1, 1), (5, 5), (1, 5), (5, 1)], [(0, 1), (2, 3)], ("crossing_segments", 0, 1, 3, 3)),
        ([(1, 1), (5, 1)], [(0, 1), (1, 0)], ("overlapping_segments", 0, 1, 1, 1)),
        ([(1, 1), (5, 1), (3, 1)], [(0, 1), (0, 2)], ("overlapping_segments", 0, 1, 1, 1)),
        ([(1, 1), (5, 1), (3, 1), (7, 1)], [(0, 1), (3, 2)], ("overlapping_segments", 0, 1, 5, 1)),
        ([(1, 1), (5, 1)], [(1, 1)], ("degenerate_segment", 0, 1, 5, 1)),
        ([(1, 1), (5, 1)], [(0, 1), (0, 6)], ("segment_out_of_range", 1, 6, 0, 0)),
        ([(1, 1), (5, 1)], [(-1, 1)], ("segment_out_of_range", 0, -1, 0, 0)),
        ([(1, 1), (5, 1), (1, 1)], [], ("duplicate_points", 0, 2, 1, 1)),
    ],
)
def test_faults(points, segments, fault):
    with pytest.raises(_core.InputError) as caught:
        triangulate(*framed(points, segments))
    kind, *rest = caught.value.args
    assert (kind.name, *rest) == fault


@settings(max_examples=100, deadline=None)
@given(st.lists(st.tuples(lattice_point, lattice_point), min_size=1, max_size=6))
def test_segments_that_cross_or_overlap_are_named(pairs):
    """Any segments at all: either the triangulation is right or a fault is, and names a pair."""
    shapely = pytest.importorskip("shapely")
    points = sorted({p for pair in pairs for p in pair})
    segments = [(points.index(a), points.index(b)) for a, b in pairs]
    try:
        check(points, segments)
    except _core.InputError as fault:
        kind, i, j, x, y = fault.args
        kind = kind.name
        if kind == "degenerate_segment":
            assert pairs[i][0] == pairs[i][1] == (x, y)
            return
        assert i < j
        first, second = shapely.LineString(pairs[i]), shapely.LineString(pairs[j])
        if kind == "crossing_segments":
            assert first.crosses(second)
            meet = first.intersection(second)
            assert meet.distance(shapely.Point(x, y)) < 1e-12
        else:
            assert kind == "overlapping_segments"
            assert first.intersection(second).length > 0
            assert first.distance(shapely.Point(x, y)) == second.distance(shapely.Point(x, y)) == 0
