"""Sizes from the curvature of curves, and how they spread."""

import pickle

import numpy as np
import pytest
import shapely
from hypothesis import given, settings
from hypothesis import strategies as st

from metrics import BoundaryCurvature, MetricError, _core, tensor


def arc(radius, start, end, n):
    t = np.linspace(start, end, n)
    return radius * np.stack([np.cos(t), np.sin(t)], axis=1)


def sizes(field, points):
    return tensor.sizes(field(points))[:, 0]


@given(
    st.floats(0.01, 100),
    st.lists(st.floats(0.01, 0.3), min_size=25, max_size=60),
    st.floats(0, 6),
)
@settings(max_examples=40, deadline=None)
def test_exact_on_a_circle_however_it_is_sampled(radius, steps, start):
    t = start + np.cumsum(steps)
    t = t[t < start + 6]
    curve = radius * np.stack([np.cos(t), np.sin(t)], axis=1) + [3, -2]
    field = BoundaryCurvature(curve, elements_per_circle=24)
    np.testing.assert_allclose(sizes(field, curve), 2 * np.pi * radius / 24, rtol=1e-9)
    field = BoundaryCurvature(curve, chord_error=1e-3 * radius)
    np.testing.assert_allclose(sizes(field, curve), np.sqrt(8e-3) * radius, rtol=1e-9)


def test_a_chord_of_that_size_has_the_error_asked_for():
    h = np.sqrt(8 * 0.001 * 5)  # chord_error 0.001, radius 5
    sagitta = 5 - np.sqrt(25 - h**2 / 4)
    assert sagitta == pytest.approx(0.001, rel=1e-3)
    field = BoundaryCurvature(arc(5, 0, 6, 200), chord_error=0.001)
    np.testing.assert_allclose(sizes(field, [[5.0, 0.0]]), h)


def test_the_smaller_of_both_and_the_bounds():
    curve = arc(1, 0, 6, 200)
    both = BoundaryCurvature(curve, chord_error=1e-3, elements_per_circle=10)
    np.testing.assert_allclose(sizes(both, [[1, 0]]), np.sqrt(8e-3))
    np.testing.assert_allclose(sizes(BoundaryCurvature(curve, 1e-3, h_min=0.2), [[1, 0]]), 0.2)
    np.testing.assert_allclose(sizes(BoundaryCurvature(curve, 1e-3, h_max=0.02), [[5, 0]]), 0.02)


def test_an_ellipse_against_its_formula():
    field = BoundaryCurvature(
        lambda t: np.stack([3 * np.cos(t), np.sin(t)], axis=1),
        elements_per_circle=100,
        interval=(0, 2 * np.pi),
        growth=2,
    )
    t = np.linspace(0, 2 * np.pi, 50)
    radius = (9 * np.sin(t) ** 2 + np.cos(t) ** 2) ** 1.5 / 3
    got = sizes(field, np.stack([3 * np.cos(t), np.sin(t)], axis=1))
    np.testing.assert_allclose(got, 2 * np.pi * radius / 100, rtol=3e-3)


def test_straight_sides_and_corners_ask_for_nothing():
    """A stadium with one sharp corner: small on its arc only."""
    round_end = arc(1, -np.pi / 2, np.pi / 2, 61)
    ring = np.concatenate([round_end, [(-9.0, 1.0), (-9.0, -1.0), (0.0, -1.0)]])
    field = BoundaryCurvature(ring, elements_per_circle=30, h_max=5, growth=0.5)
    h = 2 * np.pi / 30
    np.testing.assert_allclose(sizes(field, [[1.0, 0.0]]), h)
    np.testing.assert_allclose(sizes(field, [[-9.0, 1.0]]), h + 0.5 * 9, rtol=0.02)
    sharp = BoundaryCurvature(ring, elements_per_circle=30, h_max=5, growth=0.5, corner_angle=100)
    assert sizes(sharp, [[-9.0, 1.0]])[0] < 2


def test_the_edges_of_a_domain_in_any_order():
    curve = arc(2, 0, 2 * np.pi, 101)
    segments = np.stack([curve[:-1], curve[1:]], axis=1)
    segments[::3] = segments[::3, ::-1]
    np.random.default_rng(0).shuffle(segments)
    for given_ in (curve, segments, shapely.Polygon(curve)):
        field = BoundaryCurvature(given_, elements_per_circle=20)
        np.testing.assert_allclose(sizes(field, curve), 2 * np.pi * 2 / 20, rtol=1e-6)


@given(st.integers(0, 2**32 - 1), st.floats(0.05, 2))
@settings(max_examples=30, deadline=None)
def test_spreading_is_the_least_over_all_points_of_all_segments(seed, growth):
    """Against samples of the segments, which may be a little above, and never below."""
    rng = np.random.default_rng(seed)
    ends = rng.uniform(-1, 1, (15, 2, 2))
    ends[::5, 1] = ends[::5, 0]
    h = rng.uniform(0.1, 1.5, (15, 2))
    h[::5, 1] = h[::5, 0]
    points = rng.uniform(-2, 2, (40, 2))
    got = _core.Spreading(_core.Segments(ends.reshape(-1, 4)), h, growth).at(points)
    s = np.linspace(0, 1, 1001)[:, None, None]
    places = ends[:, 0] + s * (ends[:, 1] - ends[:, 0])
    at = h[:, 0] + s[..., 0] * (h[:, 1] - h[:, 0])
    cost = at + growth * np.linalg.norm(points[:, None, None] - places, axis=3)
    sampled = cost.min(axis=(1, 2))
    assert (got <= sampled + 1e-12).all()
    np.testing.assert_allclose(got, sampled, atol=5e-3 * (1 + growth))


@given(st.integers(0, 2**32 - 1))
@settings(max_examples=20, deadline=None)
def test_nowhere_steeper_than_the_growth(seed):
    rng = np.random.default_rng(seed)
    curve = np.cumsum(rng.uniform(-1, 1, (30, 2)), axis=0)
    field = BoundaryCurvature(curve, 1e-2, growth=0.3, h_max=2, corner_angle=120)
    p, q = rng.uniform(-5, 5, (2, 200, 2))
    change = np.abs(sizes(field, p) - sizes(field, q))
    assert (change <= 0.3 * np.linalg.norm(p - q, axis=1) + 1e-9).all()


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        ({"chord_error": None}, "give chord_error, elements_per_circle, or both"),
        ({"chord_error": 0}, "chord_error must be positive"),
        ({"elements_per_circle": 2}, "elements_per_circle must be finite and not below 3"),
        ({"h_min": -1}, "h_min must be finite and not below 0"),
        ({"h_min": 1, "h_max": 0.5}, "smaller than h_min"),
        ({"growth": 0}, "growth must be positive"),
        ({"curve": [(0, 0), (1, 0), (2, 0)]}, "straight.*give h_max"),
        ({"curve": (0, 0)}, "alone"),
        ({"curve": lambda t: t}, r"shape \(n, 2\)"),
        ({"curve": lambda t: np.zeros((7, 2))}, "1000 are asked for, 7 came"),
        ({"curve": lambda t: np.zeros((len(t), 2)), "samples": 2}, "samples must be"),
    ],
)
def test_refused(arguments, message):
    with pytest.raises(MetricError, match=message):
        BoundaryCurvature(**({"curve": arc(1, 0, 1, 9), "chord_error": 0.1} | arguments))


def test_pickled():
    field = BoundaryCurvature(arc(1, 0, 2, 50), 1e-3)
    points = np.random.default_rng(0).uniform(-1, 1, (20, 2))
    np.testing.assert_array_equal(pickle.loads(pickle.dumps(field))(points), field(points))
