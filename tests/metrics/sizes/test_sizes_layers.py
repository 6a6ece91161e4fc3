"""Sizes that grow from points, walls and fronts."""

import pickle

import numpy as np
import pytest
import shapely
from hypothesis import given, settings
from hypothesis import strategies as st

import metrics
from metrics import BoundaryLayer, Distance, Geometry, MetricError, Shock, tensor

RNG = np.random.default_rng(5)
WALL = [(0.0, 0.0), (10.0, 0.0)]


def sizes(field, points):
    return tensor.sizes(field(points))


# --- Distance ----------------------------------------------------------------------------------


def test_linear_and_geometric_laws():
    d = np.array([0, 0.5, 1, 3, 100.0])
    points = np.stack([np.full(5, 5.0), d], axis=1)
    for growth, law in ((0.3, "linear"), (1.3, "geometric")):
        got = sizes(Distance(WALL, 0.1, growth, 5, law), points)[:, 0]
        np.testing.assert_allclose(got, np.minimum(0.1 + 0.3 * d, 5))


@given(st.floats(1.01, 2), st.floats(1e-3, 1e3))
@settings(max_examples=30, deadline=None)
def test_geometric_steps_as_long_as_the_size_they_start_at_are_a_geometric_sequence(ratio, h_min):
    field = Distance((0, 0), h_min, ratio, law="geometric")
    d, steps = 0.0, []
    for _ in range(12):
        steps.append(sizes(field, [[d, 0]])[0, 0])
        d += steps[-1]
    np.testing.assert_allclose(steps, h_min * ratio ** np.arange(12), rtol=1e-9)


def test_unit_steps_grow_by_the_exponential_of_the_slope():
    """Unit steps end at h_min (exp(slope k) - 1) / slope; see metrics.sizes.growth."""
    ends = 0.1 * np.expm1(0.2 * np.arange(10)) / 0.2
    points = np.stack([ends, 0 * ends], axis=1)
    edges = np.stack([np.arange(9), np.arange(1, 10)], axis=1)
    field = Distance((0, 0), 0.1, 0.2)
    np.testing.assert_allclose(metrics.edge_lengths(points, edges, field), 1, rtol=1e-3)


@given(st.integers(0, 2**32 - 1), st.floats(0, 2))
@settings(max_examples=40, deadline=None)
def test_sizes_change_by_no_more_than_the_slope(seed, slope):
    rng = np.random.default_rng(seed)
    field = Distance(rng.uniform(-1, 1, (8, 2, 2)), 0.1, slope, 1.0)
    p, q = rng.uniform(-2, 2, (2, 100, 2))
    change = np.abs(sizes(field, p)[:, 0] - sizes(field, q)[:, 0])
    assert (change <= slope * np.linalg.norm(p - q, axis=1) + 1e-12).all()


def test_inside_a_polygon():
    points = [[0.5, 0.5], [0.5, 0.9], [2, 0.5]]
    box = shapely.box(0, 0, 1, 1)
    np.testing.assert_allclose(sizes(Distance(box, 0.1, 1), points)[:, 0], [0.1, 0.1, 1.1])
    boundary = Distance(box, 0.1, 1, inside="boundary")
    np.testing.assert_allclose(sizes(boundary, points)[:, 0], [0.6, 0.2, 1.1])


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        ({"h_min": 0}, "h_min must be positive, not 0"),
        ({"h_min": "small"}, "h_min must be a number, not 'small'"),
        ({"h_min": True}, "h_min must be a number"),
        ({"h_min": np.nan}, "h_min must be finite"),
        ({"growth": -0.1}, "growth must be finite and not below 0, not -0.1"),
        ({"growth": np.inf}, "growth must be finite"),
        ({"growth": 0.2, "law": "geometric"}, "ratio .* at least 1, as 1.2"),
        ({"law": "cubic"}, "law must be one of 'linear', 'geometric', not 'cubic'"),
        ({"h_max": 0.01}, "h_max = 0.01 is smaller than h_min = 0.1"),
        ({"h_max": np.nan}, "h_max must be finite"),
        ({"inside": "negative"}, "inside must be one of"),
        ({"geometry": []}, "geometry"),
    ],
)
def test_distance_refused(arguments, message):
    with pytest.raises(MetricError, match=message):
        Distance(**({"geometry": WALL, "h_min": 0.1, "growth": 0.2} | arguments))


# --- BoundaryLayer -----------------------------------------------------------------------------


def test_the_two_sizes_of_a_layer():
    """Thin across until it is as high as long; from there on the same, to h_max."""
    field = BoundaryLayer(WALL, 0.001, 1.25, 0.1, h_max=0.5)
    d = np.array([0, 0.01, 0.1, 0.396, 1.0, 10.0])
    got = field(np.stack([np.full(6, 5.0), -d], axis=1))
    across = np.minimum(0.001 + 0.25 * d, 0.5)
    np.testing.assert_allclose(got[:, 2] ** -0.5, across)
    np.testing.assert_allclose(got[:, 0] ** -0.5, np.maximum(across, 0.1))
    np.testing.assert_array_equal(got[:, 1], 0)


def test_a_size_along_that_is_smaller_than_across_is_kept_at_the_wall():
    got = BoundaryLayer(WALL, 0.1, 1.5, 0.01)([[5.0, 0.0], [5.0, 1.0]])
    np.testing.assert_allclose(got[:, 0] ** -0.5, [0.01, 0.51])
    np.testing.assert_allclose(got[:, 2] ** -0.5, [0.1, 0.6])


@given(st.floats(0, 2 * np.pi), st.integers(0, 2**32 - 1))
@settings(max_examples=30, deadline=None)
def test_a_layer_turns_with_its_wall(angle, seed):
    rng = np.random.default_rng(seed)
    wall, points = rng.uniform(-1, 1, (5, 2)), rng.uniform(-1, 1, (30, 2))
    c, s = np.cos(angle), np.sin(angle)
    turn = np.array([[c, -s], [s, c]])
    here = tensor.unpack(BoundaryLayer(wall, 0.01, 1.2, 0.3, 1)(points))
    there = tensor.unpack(BoundaryLayer(wall @ turn.T, 0.01, 1.2, 0.3, 1)(points @ turn.T))
    np.testing.assert_allclose(there, turn @ here @ turn.T, rtol=1e-6, atol=1e-6)


@given(st.integers(0, 2**32 - 1), st.sampled_from([1e-9, 1.0, 1e9]))
@settings(max_examples=30, deadline=None)
def test_the_sizes_of_a_layer_depend_on_the_distance_only(seed, scale):
    """So they are continuous, also where the direction is not: on the medial axis."""
    rng = np.random.default_rng(seed)
    wall, points = scale * rng.uniform(-1, 1, (8, 2)), scale * rng.uniform(-1.5, 1.5, (50, 2))
    d = Geometry(wall).distances(points)
    got = sizes(BoundaryLayer(wall, 0.001 * scale, 1.3, 0.1 * scale, 0.3 * scale), points)
    across = np.minimum(0.001 * scale + 0.3 * d, 0.3 * scale)
    np.testing.assert_allclose(got[:, 0], across, rtol=1e-9)
    np.testing.assert_allclose(got[:, 1], np.maximum(across, 0.1 * scale), rtol=1e-6)


def test_the_size_along_is_asked_for_on_the_wall():
    layer = BoundaryLayer(WALL, 0.001, 1.2, lambda x: 0.1 + 0.01 * x[:, 0])
    got = layer([[2.0, 0.01], [7.0, -0.02]])
    np.testing.assert_allclose(got[:, 0] ** -0.5, [0.12, 0.17])
    # a tensor is taken at its size along the wall
    layer = BoundaryLayer(WALL, 0.001, 1.2, lambda x: np.tile([4.0, 0.0, 1e6], (len(x), 1)))
    np.testing.assert_allclose(layer([[2.0, 0.01]])[0, 0] ** -0.5, 0.5)


def test_the_size_along_follows_the_curvature():
    t = np.linspace(0, 2 * np.pi, 401)
    wall = np.stack([3 * np.cos(t), np.sin(t)], axis=1)
    along = metrics.BoundaryCurvature(wall, elements_per_circle=60, growth=10)
    tip, side = BoundaryLayer(wall, 1e-4, 1.2, along)(wall[[0, 100]])
    np.testing.assert_allclose(tip[2] ** -0.5, 2 * np.pi / 60 / 3, rtol=1e-2)  # R = b^2/a
    np.testing.assert_allclose(side[0] ** -0.5, 2 * np.pi / 60 * 9, rtol=1e-2)  # R = a^2/b


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        ({"wall": (0, 0)}, r"a wall is made of curves, but the point \(0.0, 0.0\) is alone"),
        ({"wall": [(1, 1), (1, 1)]}, "alone"),
        ({"first_height": 0}, "first_height must be positive"),
        ({"growth_ratio": 0.2}, "growth_ratio = 0.2 is the ratio"),
        ({"tangential": -1}, "not positive"),
        ({"tangential": "x"}, "metrics.Expression"),
        ({"h_max": 1e-4}, "h_max = 0.0001 is smaller than first_height"),
    ],
)
def test_layer_refused(arguments, message):
    good = {"wall": WALL, "first_height": 0.001, "growth_ratio": 1.2, "tangential": 0.1}
    with pytest.raises(MetricError, match=message):
        BoundaryLayer(**(good | arguments))


def test_first_height():
    """y+ = 1 at Re = 1e6 on 1 m: c_f = (12 - 0.65)^-2.3 = 0.003746."""
    assert metrics.first_height(1, 1e6, 1.0) == pytest.approx(2.3106e-5, rel=1e-4)
    white = metrics.first_height(1, 1e6, 1.0, correlation="white")
    assert white == pytest.approx(2.3068e-5, rel=1e-3)
    assert metrics.first_height(30, 1e6, 2.0) == pytest.approx(60 * 2.3106e-5, rel=1e-4)


@given(st.floats(5e5, 1e9))
def test_the_two_correlations_agree_within_a_few_percent(reynolds):
    one = metrics.first_height(1, reynolds, 1)
    assert metrics.first_height(1, reynolds, 1, correlation="white") == pytest.approx(one, rel=0.05)


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        ((0, 1e6, 1), "y_plus must be positive"),
        ((1, 100, 1), "Reynolds number 100 is not within 1e4"),
        ((1, 1e6, -1), "length must be positive"),
    ],
)
def test_first_height_refused(arguments, message):
    with pytest.raises(MetricError, match=message):
        metrics.first_height(*arguments)
    with pytest.raises(MetricError, match="correlation must be one of"):
        metrics.first_height(1, 1e6, 1, correlation="blasius")


# --- Shock -------------------------------------------------------------------------------------


def circle(x):
    return np.hypot(x[:, 0], x[:, 1]) - 1


def test_a_level_set_that_is_a_distance_is_the_curve():
    t = np.linspace(0, 2 * np.pi, 3001)
    curve = np.stack([np.cos(t), np.sin(t)], axis=1)
    points = RNG.uniform(-2, 2, (500, 2))
    one, other = Shock(curve, 0.01, 0.5, 0.3)(points), Shock(circle, 0.01, 0.5, 0.3)(points)
    np.testing.assert_allclose(sizes(lambda x: one, points), sizes(lambda x: other, points), 2e-3)
    np.testing.assert_allclose(one, other, rtol=5e-3, atol=5e-3 * one.max())


@pytest.mark.parametrize("gradient", [None, lambda x: 2 * x * [1, 4]])
def test_a_level_set_that_is_no_distance_is_one_to_first_order(gradient):
    """phi = x^2 + 4 y^2 - 4, at a little distance from (2, 0) and from (0, 1)."""
    field = Shock(lambda x: x[:, 0] ** 2 + 4 * x[:, 1] ** 2 - 4, 0.001, 0.1, 0.2, gradient=gradient)
    m = field([[2.01, 0.0], [0.0, 0.98]])
    np.testing.assert_allclose([m[0, 0], m[1, 2]], [0.003**-2, 0.005**-2], rtol=0.02)
    np.testing.assert_allclose([m[0, 2], m[1, 0]], 0.1**-2, rtol=1e-6)


def test_where_the_gradient_vanishes():
    def ball(x):
        return (x**2).sum(axis=1) - 1

    with pytest.raises(MetricError, match=r"vanishes at point 1 \(0.0, 0.0\).*give h_max"):
        Shock(ball, 0.01, 0.1)([[1.0, 0.0], [0.0, 0.0]])
    np.testing.assert_allclose(sizes(Shock(ball, 0.01, 0.1, h_max=0.4), [[0, 0]]), [[0.4, 0.4]])
    cross = Shock(lambda x: x[:, 0] * x[:, 1], 0.01, 0.1)  # two fronts that cross: both are thin
    np.testing.assert_allclose(sizes(cross, [[0, 0]]), [[0.01, 0.01]])
    constant = Shock(ball, 0.01, 0.1, growth=0)
    np.testing.assert_allclose(sizes(constant, [[0, 0], [2, 0]]), [[0.01, 0.01], [0.01, 0.1]])


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        ({"front": (0, 0)}, "a front is made of curves"),
        ({"across": 0}, "across must be positive"),
        ({"along": 0}, "not positive"),
        ({"growth": -1}, "growth must be"),
        ({"step": 0.1}, "are for a level set"),
        ({"front": circle, "step": 0}, "step must be positive"),
    ],
)
def test_shock_refused(arguments, message):
    with pytest.raises(MetricError, match=message):
        Shock(**({"front": WALL, "across": 0.01, "along": 0.1} | arguments))


@pytest.mark.parametrize(
    ("phi", "gradient", "message"),
    [
        (lambda x: x, None, r"the level set: expected an array of shape \(2,\), got \(2, 2\)"),
        (lambda x: x[:, 0] / 0, None, r"the level set at point 0 \(1.0, 2.0\) is not finite"),
        (lambda x: 1 / 0, None, "the level set raised ZeroDivisionError"),
        (lambda x: ["a", "b"], None, "must be real numbers"),
        (circle, circle, r"the gradient of the level set: expected .* \(2, 2\), got \(2,\)"),
    ],
)
def test_what_a_level_set_must_return(phi, gradient, message):
    with np.errstate(all="ignore"), pytest.raises(MetricError, match=message):
        Shock(phi, 0.1, 1, gradient=gradient)([[1.0, 2.0], [3.0, 4.0]])


# --- together ----------------------------------------------------------------------------------

FIELDS = {
    "distance": lambda: Distance(WALL, 0.01, 0.2),
    "layer": lambda: BoundaryLayer(WALL, 0.001, 1.2, 0.3),
    "shock": lambda: Shock([(0, -1), (3, 4)], 0.01, 0.2),
    "level set": lambda: Shock(circle, 0.01, 0.2, h_max=0.5),
    "tensor": lambda: metrics.Expression("100 + x**2, 0.1*x*y, 4 + y**2"),
    "formula": lambda: metrics.Expression("0.01 + 0.1*hypot(x, y)"),
}


@pytest.mark.parametrize("name", FIELDS)
def test_every_field_composes_with_fields_functions_and_numbers(name):
    field = FIELDS[name]()
    points = RNG.uniform(-3, 3, (200, 2))
    directions = RNG.normal(size=(200, 2))

    def squares(m):
        return np.einsum("ni,nij,nj->n", directions, tensor.unpack(m), directions)

    for other in (*(make() for make in FIELDS.values()), 0.05, lambda x: 0.01 + np.abs(x[:, 0])):
        for both in (field & other, other & field):
            assert (squares(both(points)) >= squares(field(points)) * (1 - 1e-9)).all()
    assert field([]).shape == (0, 3)
    limited = sizes(field.limited(0.02, 0.1), points)
    assert limited.min() >= 0.02 * (1 - 1e-9) and limited.max() <= 0.1 * (1 + 1e-9)
    np.testing.assert_allclose(sizes(field.scaled(2), points), 2 * sizes(field, points))
    assert repr(field)


@pytest.mark.parametrize("name", ["distance", "layer", "shock"])
def test_fields_are_pickled(name):
    field = FIELDS[name]()
    points = RNG.uniform(-3, 3, (20, 2))
    np.testing.assert_array_equal(pickle.loads(pickle.dumps(field))(points), field(points))


def test_a_geometry_is_shared():
    geometry = Geometry(WALL)
    assert Distance(geometry, 1, 0).geometry is geometry
    assert BoundaryLayer(geometry, 1, 1, 1).wall is geometry
