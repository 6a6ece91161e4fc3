"""What is left of a constrained triangulation: the domain, its holes, its regions; and faults."""

from __future__ import annotations

import numpy as np
import pytest
import shapely
from hypothesis import given, settings
from hypothesis import strategies as st
from reference.constrained import check_constrained_delaunay, cut_segments, twice_area

from adaptmesh import _core

NOTHING = np.empty((0, 2))


def triangulate(points, segments, holes=NOTHING, seeds=NOTHING, nesting=False, certain=False):
    out = _core.triangulate(
        np.array(points, dtype=float).reshape(-1, 2),
        np.array(segments, dtype=np.int32).reshape(-1, 2),
        np.array(holes, dtype=float).reshape(-1, 2),
        np.array(seeds, dtype=float).reshape(-1, 2),
        nesting,
        certain,
    )
    triangles, _, sub_edges, _, is_boundary = out
    check_constrained_delaunay(points, triangles.tolist(), sub_edges.tolist(), is_boundary.tolist())
    return out


def ring(corners, first=0):
    n = len(corners)
    return [(first + k, first + (k + 1) % n) for k in range(n)]


def square(x, y, side):
    return [(x, y), (x + side, y), (x + side, y + side), (x, y + side)]


def rings(*loops):
    """Points and segments of closed polygons."""
    points, segments = [], []
    for loop in loops:
        segments += ring(loop, len(points))
        points += loop
    return points, segments


def area(points, triangles):
    return float(twice_area(points, triangles)) / 2


NESTED = rings(square(0, 0, 9), square(1, 1, 7), square(2, 2, 5), square(3, 3, 3))


@pytest.mark.parametrize(
    ("options", "expected", "boundary"),
    [
        ({}, 81, 4),
        ({"holes": [(4, 4)]}, 81 - 9, 8),
        ({"holes": [(1.5, 4)]}, 81 - 49 + 25, 12),
        ({"holes": [(1.5, 4), (4, 4)]}, 81 - 49 + 25 - 9, 16),
        ({"holes": [(1.5, 4), (4, 1.5)]}, 81 - 49 + 25, 12),  # two in one hole: harmless
        ({"nesting": True}, 81 - 49 + 25 - 9, 16),
        ({"nesting": True, "seeds": [(1.5, 4)]}, 81 - 25 + 9, 12),
    ],
)
def test_nested_squares(options, expected, boundary):
    points, segments = NESTED
    triangles, _, _, segment_of, is_boundary = triangulate(points, segments, **options)
    assert area(points, triangles) == expected
    assert is_boundary.sum() == boundary
    assert (np.diff(segment_of) >= 0).all()


def test_regions_are_numbered_by_their_seeds():
    points, segments = NESTED
    seeds = [(4.5, 4), (0.5, 0.5), (2.5, 3)]
    triangles, labels, _, _, _ = triangulate(points, segments, seeds=seeds)
    expected = {0: 49 - 25, 1: 9, 2: 81 - 49, 3: 25 - 9}
    for label, size in expected.items():
        assert area(points, triangles[labels == label]) == size


def test_an_inner_wall_is_not_a_nested_loop():
    """Both rooms are one crossing from the outside."""
    points, segments = [*square(0, 0, 2), (1, 0), (1, 2)], [*ring(range(4)), (4, 5)]
    out = triangulate(points, segments, nesting=True, seeds=[(0.5, 1), (1.5, 1)])
    assert area(points, out[0]) == 4
    assert sorted(out[1].tolist()) == [1, 1, 2, 2]


def test_dangling_segments_and_single_points_stay():
    points = [*square(0, 0, 8), (2, 2), (4, 3), (0, 5), (3, 5), (6, 6), (4, 0)]
    segments = [*ring(range(4)), (4, 5), (6, 7)]
    for nesting in (False, True):
        triangles, _, sub_edges, segment_of, is_boundary = triangulate(
            points, segments, nesting=nesting
        )
        assert area(points, triangles) == 64
        assert set(triangles.ravel().tolist()) == set(range(10))
        pieces = [(a, b, k) for (a, b), k in zip(sub_edges.tolist(), segment_of, strict=True)]
        assert pieces == cut_segments(points, segments)
        assert np.array_equal(is_boundary, segment_of < 4)


def test_two_parts_that_meet_in_a_vertex():
    points = [(0, 0), (1, 0), (1, 1), (2, 1), (2, 2), (1, 2), (0, 1)]
    segments = [(0, 1), (1, 2), (2, 6), (6, 0), (2, 3), (3, 4), (4, 5), (5, 2)]
    triangles, labels, _, _, is_boundary = triangulate(points, segments, seeds=[(0.4, 0.5)])
    assert area(points, triangles) == 2 and is_boundary.all()
    assert sorted(labels.tolist()) == [0, 0, 1, 1]


def test_a_hole_that_touches_the_boundary():
    points = [*square(0, 0, 4), (2, 0), (3, 2), (1, 2)]
    segments = [*ring(range(4)), (4, 5), (5, 6), (6, 4)]
    triangles, _, sub_edges, _, is_boundary = triangulate(points, segments, holes=[(2, 1)])
    assert area(points, triangles) == 14 and is_boundary.all() and len(sub_edges) == 8


def test_a_hole_on_the_boundary_would_leave_out_their_common_segment():
    points = [*square(0, 0, 4), (1, 0), (3, 0), (2, 2)]
    segments = [*ring(range(4)), (5, 6), (6, 4)]
    assert kind_of(points, segments, holes=[(2, 1)]) == ("open_hole", 4, 0, 1, 0)


NINE = [(i, j) for i in range(4) for j in range(4)]
CELLS = [
    *((4 * i + j, 4 * i + j + 1) for i in range(4) for j in range(3)),
    *((4 * i + j, 4 * i + 4 + j) for i in range(3) for j in range(4)),
]


def test_the_middle_one_of_nine_squares_may_be_a_hole():
    nine = {"points": NINE, "segments": CELLS, "nesting": True}
    assert area(NINE, triangulate(**nine)[0]) == 8
    assert area(NINE, triangulate(**nine, seeds=[(1.5, 1.25)])[0]) == 9
    assert area(NINE, triangulate(**nine, seeds=[(1.5, 1.25)], certain=True)[0]) == 9
    assert kind_of(**nine, certain=True)[0] == "uncertain_hole"


@pytest.mark.parametrize("inner", [[], [(4, 8)], [(4, 8), (8, 9)]])
def test_lines_that_part_nothing_leave_holes_certain(inner):
    """A line from a hole into the domain, and a wall of the domain that does not meet the hole."""
    points = [*square(0, 0, 4), *square(1, 1, 1), (0.5, 0.5), (0.25, 0.5), (3, 0), (3, 4)]
    segments = [*ring(range(4)), *ring(range(4), 4), *inner, (10, 11)]
    triangles, *_ = triangulate(points, segments, nesting=True, certain=True)
    assert area(points, triangles) == 15


star = st.lists(st.integers(20, 100), min_size=3, max_size=24)


@pytest.mark.slow
@settings(max_examples=60, deadline=None)
@given(star, st.integers(1, 4), st.integers(0, 2**16))
def test_nested_stars(radii, depth, seed):
    """Star polygons in star polygons, over random points: areas and regions as shapely has them."""
    angle = 2 * np.pi * np.arange(len(radii)) / len(radii)
    outline = np.array(radii)[:, None] * np.stack([np.cos(angle), np.sin(angle)], axis=1)
    loops = [(outline * 0.5**k).tolist() for k in range(depth)]
    shapes = [shapely.Polygon(loop) for loop in loops]
    points, segments = rings(*loops)
    scattered = np.random.default_rng(seed).uniform(-100, 100, (30, 2))
    inside = shapely.contains_xy(shapes[0], scattered[:, 0], scattered[:, 1])
    points = np.array(points + scattered[inside].tolist())

    between = [
        a.difference(b) for a, b in zip(shapes, [*shapes[1:], shapely.Polygon()], strict=True)
    ]
    seeds = [shape.representative_point().coords[0] for shape in between]
    triangles, labels, _, _, is_boundary = triangulate(points, segments, seeds=seeds)
    assert is_boundary.sum() == len(radii)
    for k, shape in enumerate(between):
        assert area(points, triangles[labels == k + 1]) == pytest.approx(shape.area, rel=1e-12)
        centres = points[triangles[labels == k + 1]].mean(axis=1)
        assert shapely.contains_xy(shape, centres[:, 0], centres[:, 1]).all()

    n = len(radii)  # the scattered points in holes would be outside: only the loops
    triangles, _, _, _, is_boundary = triangulate(points[: n * depth], segments, nesting=True)
    kept = sum(shape.area for shape in between[::2])
    assert area(points, triangles) == pytest.approx(kept, rel=1e-12)
    assert is_boundary.all() and len(is_boundary) == n * depth


def kind_of(points, segments, **options):
    with pytest.raises(_core.InputError) as caught:
        triangulate(points, segments, **options)
    kind, *rest = caught.value.args
    return (kind.name, *rest)


SQUARE = square(0, 0, 4)
SIDES = ring(range(4))


@pytest.mark.parametrize(
    ("points", "segments", "options", "fault"),
    [
        # an open outline, and an open one beside a closed one; a loose end outside
        (SQUARE, SIDES[:3], {}, ("open_boundary", 0, 0, 0, 0)),
        (SQUARE, SIDES[1:], {}, ("open_boundary", 1, 0, 4, 0)),
        ([*SQUARE, (5, 1), (6, 1), (6, 2)], [*SIDES, (4, 5), (5, 6)], {},
         ("open_boundary", 4, 4, 5, 1)),
        ([*SQUARE, (4, 2), (6, 2)], [*SIDES, (4, 5)], {}, ("open_boundary", 5, 4, 6, 2)),
        # an open hole lets the hole out into the domain; a segment in a hole
        ([*SQUARE, *square(1, 1, 2)], [*SIDES, *ring(range(4), 4)[:3]], {"holes": [(2, 2)]},
         ("open_hole", 4, 4, 1, 1)),
        ([*SQUARE, *square(1, 1, 2), (1.5, 1.5), (2, 1.5)], [*SIDES, *ring(range(4), 4), (8, 9)],
         {"nesting": True}, ("open_hole", 8, 8, 1.5, 1.5)),
        # seeds
        (SQUARE, SIDES, {"holes": [(5, 1)]}, ("hole_outside", 0, -1, 5, 1)),
        (SQUARE, SIDES, {"holes": [(2, 0)]}, ("hole_on_segment", 0, 0, 2, 0)),
        (SQUARE, SIDES, {"holes": [(4, 4)]}, ("hole_on_segment", 0, 1, 4, 4)),
        (SQUARE, SIDES, {"holes": [(1, 1)]}, ("empty_domain", -1, -1, 0, 0)),
        (SQUARE, SIDES, {"seeds": [(1, 1), (5, 1)]}, ("region_seed_outside", 1, -1, 5, 1)),
        (SQUARE, SIDES, {"seeds": [(1, 4)]}, ("region_seed_on_segment", 0, 2, 1, 4)),
        (SQUARE, SIDES, {"seeds": [(1, 1), (1, 2)]}, ("two_seeds_one_region", 0, 1, 1, 2)),
        ([*SQUARE, *square(1, 1, 2)], [*SIDES, *ring(range(4), 4)],
         {"holes": [(2.5, 2)], "seeds": [(2, 2)]}, ("region_seed_outside", 0, -1, 2, 2)),
        # a line that divides a hole, one between two holes, one between a hole and the outside
        ([*SQUARE, *square(1, 1, 2)], [*SIDES, *ring(range(4), 4), (4, 6)], {"nesting": True},
         ("open_hole", 4, 8, 1, 1)),
        ([*SQUARE, *square(1, 1, 2)], [*SIDES, *ring(range(4), 4), (4, 6)],
         {"holes": [(2, 1.5), (1.5, 2)]}, ("open_hole", 4, 8, 1, 1)),
        ([*SQUARE, *square(1, 1, 2)], [*SIDES, *ring(range(4), 4)], {"holes": [(.5, .5)]},
         ("open_hole", 0, 0, 0, 0)),
        # points
        ([*SQUARE, (5, 2)], SIDES, {}, ("point_outside", 4, -1, 5, 2)),
        ([*SQUARE, *square(1, 1, 2), (2, 2)], [*SIDES, *ring(range(4), 4)], {"nesting": True},
         ("point_outside", 8, -1, 2, 2)),
        (SQUARE, [], {}, ("empty_domain", -1, -1, 0, 0)),
        ([(0, 0), (1, 0), (2, 0)], [(0, 1)], {}, ("all_collinear", -1, -1, 0, 0)),
        ([(0, 0), (1, 0)], [(0, 1)], {}, ("too_few_points", 2, -1, 0, 0)),
        ([*SQUARE, (np.nan, 0)], SIDES, {}, None),
    ],
)  # fmt: skip
def test_faults(points, segments, options, fault):
    args = kind_of(points, segments, **options)
    if fault is None:
        assert args[:2] == ("not_finite", 4)
    else:
        assert args == fault


def test_a_seed_on_an_edge_or_point_that_is_no_segment_is_fine():
    points = [*SQUARE, (2, 2)]
    triangles, labels, *_ = triangulate(points, SIDES, seeds=[(2, 2)])
    assert len(triangles) == 4 and (labels == 1).all()
    _, labels, *_ = triangulate(points, SIDES, seeds=[(1, 1)])
    assert (labels == 1).all()


def test_wrong_arrays_are_refused():
    with pytest.raises(TypeError):
        _core.triangulate(np.zeros((3, 3)), np.zeros((1, 2), np.int32), NOTHING, NOTHING, False)
