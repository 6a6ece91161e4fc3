"""Distances, nearest points, directions and insides, against a slow search over all segments."""

import pickle
import time
from types import SimpleNamespace

import numpy as np
import pytest
import shapely
from hypothesis import given, settings
from hypothesis import strategies as st

from metrics import Geometry, MetricError

RNG = np.random.default_rng(3)


def slow_nearest(segments, points):
    """Distances (n,) and nearest points (n, 2) by looking at every segment."""
    a, e = segments[:, 0], segments[:, 1] - segments[:, 0]
    square = (e * e).sum(axis=1)
    r = points[:, None] - a
    share = np.clip((r * e).sum(axis=2) / np.where(square > 0, square, 1), 0, 1)
    feet = a + share[..., None] * e
    distances = np.linalg.norm(points[:, None] - feet, axis=2)
    best = distances.argmin(axis=1)
    n = np.arange(len(points))
    return distances[n, best], feet[n, best]


coordinates = st.integers(-4, 4).map(float) | st.floats(-4, 4)
segment_lists = st.lists(st.lists(coordinates, min_size=4, max_size=4), min_size=1, max_size=60)


@given(segment_lists, st.integers(0, 2**32 - 1), st.sampled_from([1e-9, 1.0, 1e9]))
@settings(max_examples=60, deadline=None)
def test_nearest_is_that_of_a_search_over_all(segments, seed, scale):
    segments = scale * np.array(segments).reshape(-1, 2, 2)
    rng = np.random.default_rng(seed)
    points = scale * np.concatenate([rng.uniform(-6, 6, (20, 2)), rng.integers(-4, 5, (20, 2))])
    near = Geometry(segments).nearest(points)
    wanted, _ = slow_nearest(segments, points)
    tolerance = 1e-13 * 10 * scale
    np.testing.assert_allclose(near.distances, wanted, rtol=1e-12, atol=tolerance)
    along = segments[near.segments]
    on_it = along[:, 0] + near.shares[:, None] * (along[:, 1] - along[:, 0])
    np.testing.assert_allclose(near.points, on_it, atol=tolerance)
    np.testing.assert_allclose(
        np.linalg.norm(points - near.points, axis=1), near.distances, atol=tolerance
    )
    lengths = np.linalg.norm(near.directions, axis=1)
    assert ((np.abs(lengths - 1) < 1e-12) | (lengths == 0)).all()
    np.testing.assert_allclose(  # from the nearest point to the point
        near.points + near.distances[:, None] * near.directions, points, atol=1e-12 * scale * 10
    )


@given(st.integers(0, 2**32 - 1))
@settings(max_examples=20, deadline=None)
def test_the_answer_for_a_point_does_not_depend_on_the_others(seed):
    rng = np.random.default_rng(seed)
    geometry = Geometry(rng.integers(-3, 4, (40, 2, 2)).astype(float))
    points = rng.integers(-5, 6, (50, 2)).astype(float)
    together = geometry.nearest(points)
    for i in range(len(points)):
        alone = geometry.nearest(points[i : i + 1])
        for one, many in zip(alone, together, strict=True):
            np.testing.assert_array_equal(one[0], many[i])


def test_inside_is_that_of_shapely():
    t = np.sort(RNG.uniform(0, 2 * np.pi, 300))
    r = 1 + 0.5 * np.sin(5 * t) + RNG.uniform(-0.1, 0.1, 300)
    outer = np.stack([r * np.cos(t), r * np.sin(t)], axis=1)
    island = shapely.Point(3, 0).buffer(0.5)
    shape = shapely.union_all([shapely.Polygon(outer) - shapely.box(-0.2, -0.2, 0.2, 0.2), island])
    points = RNG.uniform(-2, 4, (5000, 2))
    geometry = Geometry(shape)
    inside = shapely.contains_xy(shape, points)
    np.testing.assert_array_equal(geometry.contains(points), inside)
    wanted = shapely.distance(shape.boundary, shapely.points(points)) * np.where(inside, -1, 1)
    np.testing.assert_allclose(geometry.signed_distance(points), wanted, atol=1e-14)


@given(
    st.lists(
        st.tuples(st.integers(-3, 3), st.integers(-3, 3)), min_size=3, max_size=12, unique=True
    )
)
@settings(max_examples=60, deadline=None)
def test_inside_of_any_ring_is_an_odd_winding(ring):
    """Rings through integer points, which may cross themselves, by counting all crossings."""
    ring = np.array(ring, float)
    points = np.stack(np.meshgrid(np.arange(-4, 4) + 0.5, np.arange(-4, 4) + 0.37), -1).reshape(
        -1, 2
    )
    a, b = ring, np.roll(ring, -1, axis=0)
    crosses = (a[:, 1] > points[:, 1:]) != (b[:, 1] > points[:, 1:])
    with np.errstate(all="ignore"):
        x = a[:, 0] + (points[:, 1:] - a[:, 1]) / (b[:, 1] - a[:, 1]) * (b[:, 0] - a[:, 0])
    gap = np.abs(np.where(crosses, x - points[:, :1], 1)).min(axis=1)
    odd = (crosses & (x > points[:, :1])).sum(axis=1) % 2 == 1
    clear = gap > 1e-9
    np.testing.assert_array_equal(Geometry.polygon(ring).contains(points)[clear], odd[clear])


def test_directions_beside_past_and_on_a_segment():
    geometry = Geometry([(0, 0), (4, 0)])
    near = geometry.nearest([[1, 2], [1, -2], [7, 4], [2, 0], [0, 0], [-1e-17, 0], [1, 1e-17]])
    wanted = [[0, 1], [0, -1], [0.6, 0.8], [0, 1], [0, 1], [0, 1], [0, 1]]
    np.testing.assert_allclose(near.directions, wanted, atol=1e-15)


@pytest.mark.parametrize("offset", [0.0, 1e6])
def test_directions_are_exact_however_near_the_wall(offset):
    """Not made of rounding errors: beside a slanted wall the direction is that across it."""
    ends = np.array([(0.0, 0.0), (3.0, 1.0)]) + offset
    s = np.linspace(0.05, 0.95, 50)[:, None]
    points = ends[0] + s * (ends[1] - ends[0])
    got = Geometry(ends).nearest(points).directions
    np.testing.assert_allclose(np.abs(got @ [-1, 3]) / np.sqrt(10), 1, rtol=1e-12)


def test_direction_at_a_vertex_is_between_those_of_its_segments():
    t = np.radians([0, 10])
    points = np.array([[0, 0], [1, 0], [1 + np.cos(t[1]), np.sin(t[1])]])
    for order in (points, points[::-1]):
        x, y = Geometry(order).nearest([[1.0, 0.0]]).directions[0]
        np.testing.assert_allclose(np.abs([x, y]), [np.sin(t[1] / 2), np.cos(t[1] / 2)])


def test_direction_is_continuous_around_a_convex_corner():
    corner = Geometry([(-1, 0), (0, 0), (0, -1)])
    angles = np.linspace(np.pi / 2 + 0.3, -0.3, 2000)
    points = 0.1 * np.stack([np.cos(angles), np.sin(angles)], axis=1)
    directions = corner.nearest(points).directions
    assert np.linalg.norm(np.diff(directions, axis=0), axis=1).max() < 2e-3


def test_a_lone_point_has_no_direction_on_itself():
    near = Geometry.of_points([(0, 0), (5, 5)]).nearest([[0.0, 0.0], [0.0, 2.0]])
    np.testing.assert_array_equal(near.directions, [[0, 0], [0, 1]])


SQUARE = [(0, 0), (1, 0), (1, 1), (0, 1)]


@pytest.mark.parametrize(
    ("given", "segments", "polygonal"),
    [
        ((2, 3), 1, False),
        ([(2, 3)], 1, False),
        (SQUARE, 3, False),
        ([SQUARE, SQUARE[:2]], 4, False),
        (np.array([SQUARE[:2], SQUARE[2:]]), 2, False),
        ([shapely.Point(0, 0), SQUARE], 4, False),
        (shapely.MultiPoint(SQUARE), 4, False),
        (shapely.LineString([(0, 0, 5), (1, 1, 5)]), 1, False),
        (shapely.LinearRing(SQUARE), 4, False),
        (shapely.MultiLineString([SQUARE, SQUARE[:2]]), 4, False),
        (shapely.box(0, 0, 1, 1), 4, True),
        (shapely.MultiPolygon([shapely.box(0, 0, 1, 1), shapely.box(2, 0, 3, 1)]), 8, True),
        (shapely.GeometryCollection([shapely.Point(0, 0), shapely.box(0, 0, 1, 1)]), 5, False),
        (SimpleNamespace(points=np.array(SQUARE), segments=[(0, 2), (1, 3)]), 2, False),
        (lambda: Geometry.polygon(SQUARE), 4, True),
        ({"type": "LineString", "coordinates": SQUARE}, 3, False),
        ({"type": "Feature", "geometry": shapely.box(0, 0, 1, 1).__geo_interface__}, 4, True),
        ([(0, 0), (0, 0), (1, 0), (1, 0)], 1, False),
    ],
)
def test_forms(given, segments, polygonal):
    geometry = given() if callable(given) else Geometry(given)
    assert geometry.segments.shape == (segments, 2, 2)
    assert geometry.is_polygonal == polygonal


@pytest.mark.parametrize(
    ("given", "message"),
    [
        ([], "empty|shape"),
        (shapely.Point(), "empty"),
        ([(0, 0), (1e200, 0)], "coordinate of 1e\\+200 is too large"),
        (shapely.Polygon(), "empty"),
        (None, "not NoneType"),
        ("wall", "not str"),
        (3.0, "shape"),
        ([(0, 0), (np.nan, 1)], "point 1 is not finite"),
        ([(0, 0, 0), (1, 1, 1)], r"\(2, 3\)"),
        ([SQUARE, [(0, 0), (np.inf, 1)]], "not finite"),
        (SimpleNamespace(points=np.array(SQUARE), segments=[(0, 4)]), "segment 0 .* out of range"),
        (SimpleNamespace(__geo_interface__={"type": "Circle"}), "'Circle' is not known"),
    ],
)
def test_refused(given, message):
    with pytest.raises(MetricError, match=message):
        Geometry(given)


def test_a_line_has_no_inside():
    with pytest.raises(MetricError, match=r"Geometry\.polygon"):
        Geometry(SQUARE).contains([[0.5, 0.5]])


def test_a_ring_of_two_points():
    with pytest.raises(MetricError, match="ring 1 of the polygon has less than 3"):
        Geometry.polygon(SQUARE, [[(0.2, 0.2), (0.4, 0.4), (0.2, 0.2)]])


def test_no_points():
    near = Geometry(SQUARE).nearest(np.empty((0, 2)))
    assert near.distances.shape == (0,) and near.directions.shape == (0, 2)


def test_points_as_far_as_floats_go():
    far = np.array([[1e308, -1e308], [-1e308, 1e308], [0.5, 0.5]])
    np.testing.assert_array_equal(Geometry(SQUARE).nearest(far).distances[2], 0.5)
    assert (Geometry.polygon(SQUARE).contains(far) == [False, False, True]).all()


def test_pickled():
    geometry = Geometry(shapely.box(0, 0, 1, 1) - shapely.box(0.4, 0.4, 0.6, 0.6))
    again = pickle.loads(pickle.dumps(geometry))
    points = RNG.uniform(-1, 2, (100, 2))
    np.testing.assert_array_equal(again.signed_distance(points), geometry.signed_distance(points))


def odd_crossings(rings, points):
    """Whether points are in an odd number of rings, by the winding of each about each point."""
    out = np.zeros(len(points), int)
    for ring in rings:
        w = ring[None] - points[:, None]
        angle = np.arctan2(w[..., 1], w[..., 0])
        turn = np.diff(angle, axis=1, append=angle[:, :1])
        turn = (turn + np.pi) % (2 * np.pi) - np.pi
        out += np.rint(turn.sum(axis=1) / (2 * np.pi)).astype(int) % 2
    return out % 2 == 1


@pytest.mark.parametrize("scale", [1e-6, 1.0, 1e6])
def test_inside_of_many_rings_that_overlap(scale):
    rng = np.random.default_rng(0)
    t = np.sort(rng.uniform(0, 2 * np.pi, (60, 12)), axis=1)
    radii = rng.uniform(0.02, 0.3, (60, 12, 1))
    rings = rng.uniform(0, 1, (60, 1, 2)) + radii * np.stack([np.cos(t), np.sin(t)], axis=-1)
    points = rng.uniform(-0.2, 1.2, (2000, 2))
    geometry = Geometry.polygon(scale * rings[0], [scale * ring for ring in rings[1:]])
    right = odd_crossings(rings, points)
    np.testing.assert_array_equal(geometry.contains(scale * points), right)
    copied = pickle.loads(pickle.dumps(geometry))
    np.testing.assert_array_equal(copied.contains(scale * points), right)


def test_time_grows_little_with_the_number_of_polygons():
    """What is asked for a point grows with the logarithm of the number of rings around it."""
    points = np.random.default_rng(1).random((4000, 2))

    def seconds(n):
        t = np.linspace(0, 2 * np.pi, 13)[:-1]
        ring = 0.3 / np.sqrt(n) * np.stack([np.cos(t), np.sin(t)], axis=1)
        centres = np.random.default_rng(0).random((n, 1, 2))
        geometry = Geometry.polygon(centres[0] + ring, list(centres[1:] + ring))
        best = np.inf
        for _ in range(3):
            start = time.process_time()
            geometry.contains(points)
            best = min(best, time.process_time() - start)
        return best

    assert seconds(4096) < 4 * seconds(256)  # with the square root of it, 4 and more
