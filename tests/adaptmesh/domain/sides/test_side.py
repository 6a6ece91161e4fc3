"""Sides of a domain: points, parameters, projections and images, against obvious oracles."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from reference.transforms import SIMILARITIES

import adaptmesh as am
from adaptmesh import ragged
from adaptmesh.curves import Arc, BSpline, Line
from adaptmesh.domain.projection import project
from adaptmesh.domain.sides.side import SideParts, SidePoints

FEW = st.lists(st.tuples(st.integers(0, 3), st.integers(0, 6)), max_size=12)


def points_of(pairs):
    pairs = sorted(set(pairs))
    return SidePoints(
        np.array([s for s, _ in pairs], np.intp), np.array([u for _, u in pairs], float)
    )


def pairs_of(points):
    return list(zip(points.side.tolist(), points.u.tolist(), strict=True))


@settings(deadline=None)
@given(FEW, FEW)
def test_points_of_sides_are_sets_in_order(one, other):
    a, b = points_of(one), points_of(other)
    assert pairs_of(a.joined(b)) == sorted({*pairs_of(a), *pairs_of(b)})
    assert a.is_in(b).tolist() == [pair in pairs_of(b) for pair in pairs_of(a)]
    ranks = [sum(q <= p for q in pairs_of(b)) for p in pairs_of(a)]
    assert a.rank_in(b).tolist() == ranks
    before = [sum(q < p for q in pairs_of(b)) for p in pairs_of(a)]
    assert a.rank_in(b, strictly=True).tolist() == before
    assert a.counts(4).tolist() == [sum(s == k for s, _ in pairs_of(a)) for k in range(4)]


@settings(deadline=None)
@given(FEW, st.permutations([(0, 0, 2), (0, 2, 3), (0, 5, 6), (2, 1, 4), (3, 0, 6)]))
def test_points_within_parts(pairs, parts):
    points = points_of(pairs)
    found = points.within(
        SideParts(np.array([p[0] for p in parts]), np.array([p[1:] for p in parts], float))
    )
    for (side, u), part in zip(pairs_of(points), found.tolist(), strict=True):
        inside = [k for k, (s, low, high) in enumerate(parts) if s == side and low < u < high]
        assert ([part] if part >= 0 else []) == inside


def test_points_of_no_sides():
    none = SidePoints.none()
    assert none.joined(none).u.size == none.rank_in(none).size == none.is_in(none).size == 0
    assert none.within(SideParts(np.empty(0, int), np.empty((0, 2)))).size == 0


@settings(deadline=None)
@given(st.lists(st.integers(0, 4), max_size=8))
def test_ragged_rows(counts):
    counts = np.array(counts, int)
    rows = [[(k, i) for i in range(n)] for k, n in enumerate(counts.tolist())]
    flat = [item for row in rows for item in row]
    assert ragged.owners(counts).tolist() == [k for k, _ in flat]
    starts = 10 * np.arange(len(counts))
    assert ragged.ranges(starts, counts).tolist() == [10 * k + i for k, i in flat]
    split = ragged.split(np.arange(len(flat)), counts)
    assert [len(row) for row in split] == counts.tolist()
    follows = [k for k in range(len(flat) - 1) if flat[k][0] == flat[k + 1][0]]
    assert ragged.starts_of_pairs(ragged.owners(counts)).tolist() == follows


def tunnel(move=lambda p: p):
    """A floor and walls that are straight, a roof that is a spline and an arc, joined smoothly."""
    p = move(np.array([(4, 0), (4, 2), (3.5, 2.6), (2.5, 3.4), (2, 3), (0, 0), (0, 2), (1, 3)]))
    control = [p[1], p[2], p[3], p[4]]
    return am.Domain.from_curves(
        [
            Line(p[5], p[0]),
            Line(p[0], p[1]),
            BSpline(control),
            BSpline([p[4], p[7], p[6]], degree=2),
            Line(p[6], p[5]),
        ],
        names={"right": [1], "left": [4]},
    )


@pytest.mark.parametrize("transform", SIMILARITIES, ids=str)
def test_a_point_projected_is_where_it_came_from(transform):
    sides = tunnel(transform).all_sides
    assert 0 < sides.n_straight < len(sides)
    u = np.linspace(0, 1, 23)[1:-1]
    side = np.repeat(np.arange(len(sides)), len(u))
    at = np.tile(u, len(sides)) * sides.lengths[side]
    points = sides.point(side, at)
    extent = np.ptp(sides.corners, axis=0).max()
    rounding = 1e-12 * extent + 8 * np.spacing(np.abs(sides.corners).max())
    found = project(sides, side, points, rounding)
    assert found.off.max() <= rounding
    back = sides.point(side, found.u)
    assert np.hypot(*(back - points).T).max() <= 4 * rounding
    normal = sides.derivative(side, at)[:, ::-1] * [1, -1]
    normal /= np.hypot(*normal.T)[:, None]
    beside = project(sides, side, points + 0.01 * extent * normal, rounding)
    assert (beside.off > 100 * rounding).all()


@pytest.mark.parametrize("transform", SIMILARITIES, ids=str)
def test_derivatives_are_those_of_points(transform):
    sides = tunnel(transform).all_sides
    side = np.repeat(np.arange(len(sides)), 5)
    u = np.tile([0.1, 0.3, 0.47, 0.7, 0.93], len(sides)) * sides.lengths[side]
    step = 1e-3
    difference = (sides.point(side, u + step) - sides.point(side, u - step)) / (2 * step)
    extent = np.ptp(sides.corners, axis=0).max()
    rounding = 1e-4 * extent + np.spacing(np.abs(sides.corners).max()) / step
    np.testing.assert_allclose(sides.derivative(side, u), difference, atol=rounding)


@pytest.mark.parametrize("transform", SIMILARITIES, ids=str)
def test_ends_of_sides_are_corners_to_the_bit(transform):
    sides = tunnel(transform).all_sides
    every = np.arange(len(sides))
    for k, u in ((0, 0 * sides.lengths), (1, sides.lengths)):
        assert np.array_equal(sides.point(every, u), sides.corners[sides.ends[:, k]])


@pytest.mark.parametrize("transform", SIMILARITIES, ids=str)
def test_images_are_where_the_motion_carries_points(transform):
    shift = transform(np.array([(4.0, 0), (0, 0)]))
    domain = tunnel(transform).with_periodic("left", "right", translation=shift[0] - shift[1])
    sides = domain.all_sides
    assert len(sides.images) == 2
    extent = np.ptp(sides.corners, axis=0).max()
    for side, image in sides.images.items():
        u = np.linspace(0, sides.lengths[side], 9)
        points = sides.point(np.full(9, side), u)
        images = sides.point(np.full(9, image.side), sides.image(side, u))
        off = np.hypot(*(image.motion(points) - images).T).max()
        assert off <= 1e-9 * extent


def test_arcs_are_images_of_arcs():
    """Curves in opposite directions: parameters grow the other way."""
    lower, upper = Arc((0, 0), 1, np.pi, 2 * np.pi), Arc((0, 3), 1, 0, -np.pi)
    domain = am.Domain.from_curves(
        [lower, Line((1, 0), (1, 3)), upper, Line((-1, 3), (-1, 0))],
        names={"low": [0], "high": [2]},
    ).with_periodic("low", "high", translation=(0, 3))
    sides = domain.all_sides
    (low, image), _ = sorted(sides.images.items())
    u = np.linspace(0, sides.lengths[low], 9)
    assert image.is_reversed
    np.testing.assert_allclose(sides.image(low, u), u[::-1], atol=1e-12)
