"""What may be a metric, what is refused and how the refusal reads, and the algebra of fields."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

import metrics
from metrics import ControlSpace, MetricError, as_control_space, tensor

POINTS = np.array([[0.0, 0.0], [0.5, 0.25], [1.0, 2.0], [3.0, 1.0]])


def size(x):
    return 0.1 + x[:, 0]


def wall(x):
    """Thin across y = 0."""
    return np.stack([1 + 0 * x[:, 0], 0 * x[:, 0], 1 / (0.01 + x[:, 1]) ** 2], 1)


# --- what is accepted --------------------------------------------------------------------------


@pytest.mark.parametrize("number", [2, 0.5, np.float32(0.5), np.int64(2), np.array(0.5)[()]])
def test_a_number_is_a_size_everywhere(number):
    np.testing.assert_allclose(
        as_control_space(number)(POINTS), tensor.pack(np.full(4, float(number)))
    )


@pytest.mark.parametrize(
    "convert",
    [
        lambda h: h,
        list,
        tuple,
        np.float32,
        lambda h: tensor.pack(h),
        lambda h: tensor.pack(h).tolist(),
        lambda h: tensor.unpack(tensor.pack(h)),
        lambda h: np.asfortranarray(tensor.pack(h)),
        lambda h: np.repeat(h, 2)[::2],
        lambda h: np.broadcast_to(h, (1, 4))[0],
    ],
)
def test_a_function_may_return_any_of_the_three_in_any_layout(convert):
    field = as_control_space(lambda x: convert(size(x)))
    np.testing.assert_allclose(field(POINTS), tensor.pack(size(POINTS)), rtol=1e-6)


def test_integers_are_sizes():
    field = as_control_space(lambda x: np.array([1, 2, 3, 4]))
    np.testing.assert_allclose(tensor.sizes(field(POINTS))[:, 0], [1, 2, 3, 4])


def test_a_read_only_result_is_copied():
    table = np.full((4, 3), [1.0, 0.0, 1.0])
    table.flags.writeable = False
    got = as_control_space(lambda x: table)(POINTS)
    got[:] = 0
    assert table[0, 0] == 1


@pytest.mark.parametrize("points", [[], np.empty((0, 2))])
def test_no_points_give_no_tensors(points):
    for field in (0.1, size, wall, as_control_space(size) & 0.1, metrics.Expression("x")):
        assert as_control_space(field)(points).shape == (0, 3)


def test_points_of_any_layout_are_the_same():
    field = as_control_space(size)
    for points in (POINTS.tolist(), np.asfortranarray(POINTS), np.repeat(POINTS, 2, 0)[::2]):
        np.testing.assert_array_equal(field(points), field(POINTS))
    np.testing.assert_allclose(field(POINTS.astype(int)), field(POINTS.astype(int).astype(float)))


def test_a_function_that_writes_on_its_argument_does_not_reach_ours():
    def careless(x):
        x -= 5
        return np.full(len(x), 0.1)

    points = POINTS.copy()
    (as_control_space(careless) & size)(points)
    np.testing.assert_array_equal(points, POINTS)


def test_a_control_space_is_returned_as_it_is():
    field = as_control_space(0.1)
    assert as_control_space(field) is field


# --- what is refused ---------------------------------------------------------------------------


@pytest.mark.parametrize(
    ("metric", "message"),
    [
        (0.0, "uniform size at item 0 is not positive: h = 0.0"),
        (-1, "not positive"),
        (np.nan, "not finite"),
        (np.inf, "not finite"),
        (True, "not bool"),
        (1 + 1j, "not complex"),
        (None, "not NoneType"),
        ("0.1*x", r"metrics.Expression\(text\)"),
        (np.ones(4), r"metrics.Background.on\(mesh, values\)"),
        ([0.1, 0.2], "Background.on"),
    ],
)
def test_what_is_not_a_metric(metric, message):
    with pytest.raises(MetricError, match=message):
        as_control_space(metric)


@pytest.mark.parametrize(
    ("result", "message"),
    [
        (0.1, r"shape \(\); it must be \(4,\) .*\(4, 3\) .*\(4, 2, 2\).*np.full"),
        (np.ones((4, 1)), r"shape \(4, 1\).*values\[:, 0\]"),
        (np.ones(3), r"shape \(3,\); it must be \(4,\)"),
        (np.ones((3, 4)), r"shape \(3, 4\).*transpose"),
        (np.ones((2, 2, 4)), "transpose"),
        (np.ones(4) * 1j, "real numbers, not complex128"),
        (None, "real numbers, not object"),
        ([0.1, 0.1, np.nan, 0.1], r"at point 2 \(1.0, 2.0\) is not finite"),
        ([0.1, -0.1, 0.1, 0.1], r"at point 1 \(0.5, 0.25\) is not positive: h = -0.1"),
        ([[1, 0, 1], [1, 0, 1], [1, 0, 1], [1, 5, 1]], r"at point 3 \(3.0, 1.0\) is not pos.* -4 "),
        ([np.eye(2), [[1, 0.5], [0, 1]], np.eye(2), np.eye(2)], "at point 1 .*not symmetric"),
    ],
)
def test_a_function_that_returns_something_else(result, message):
    def my_sizes(x):
        return result

    with pytest.raises(MetricError, match=message) as caught:
        as_control_space(my_sizes)(POINTS)
    assert "my_sizes" in str(caught.value) and "test_control.py:" in str(caught.value)


def test_a_function_that_raises_is_named_and_its_error_kept():
    def broken(x):
        return 1 / 0

    with pytest.raises(MetricError, match=r"broken .*ZeroDivisionError .*4 points.*\(4, 2\)") as e:
        as_control_space(broken)(POINTS)
    assert isinstance(e.value.__cause__, ZeroDivisionError)


def test_an_interrupt_is_not_an_error_of_the_function():
    def interrupted(x):
        raise KeyboardInterrupt

    with pytest.raises(KeyboardInterrupt):
        as_control_space(interrupted)(POINTS)


@pytest.mark.parametrize(
    ("points", "message"),
    [
        ([0.0, 1.0], r"\(n, 2\), not \(2,\); for a single point write \[\[x, y\]\]"),
        (np.ones((4, 3)), r"not \(4, 3\)"),
        ([[0.0, np.nan]], "point 0 is not finite"),
        ([["a", "b"]], "real numbers"),
    ],
)
def test_points_that_are_none(points, message):
    with pytest.raises(MetricError, match=message):
        as_control_space(0.1)(points)


# --- the algebra -------------------------------------------------------------------------------


def test_intersection_with_numbers_and_functions_on_either_side():
    field = as_control_space(wall)
    wanted = tensor.intersect(wall(POINTS), tensor.pack(np.full(4, 0.1)))
    for both in (field & 0.1, 0.1 & field, np.float64(0.1) & field, field & (lambda x: [0.1] * 4)):
        assert isinstance(both, ControlSpace)
        np.testing.assert_allclose(both(POINTS), wanted, rtol=1e-12)
    np.testing.assert_allclose((size & field)(POINTS), (field & size)(POINTS), rtol=1e-12)


def test_intersection_with_what_is_not_a_metric():
    with pytest.raises(MetricError, match="a metric is a size"):
        as_control_space(0.1) & "x"


@given(st.floats(0.01, 100))
def test_scaled_multiplies_sizes(factor):
    field = as_control_space(wall)
    got = tensor.sizes(field.scaled(factor)(POINTS))
    np.testing.assert_allclose(got, factor * tensor.sizes(field(POINTS)), rtol=1e-9)


@pytest.mark.parametrize("factor", [0, -1, np.nan, np.inf])
def test_scaled_refuses(factor):
    with pytest.raises(MetricError, match="positive factor"):
        as_control_space(0.1).scaled(factor)


def test_limited_brings_sizes_into_the_interval():
    got = tensor.sizes(as_control_space(wall).limited(0.1, 0.7)(POINTS))
    wanted = np.clip(tensor.sizes(wall(POINTS)), 0.1, 0.7)
    np.testing.assert_allclose(got, wanted, rtol=1e-12)
    with pytest.raises(MetricError, match="h_min <= h_max"):
        as_control_space(0.1).limited(1.0, 0.5)


def test_a_field_of_ones_own_is_checked_too():
    class Mine(ControlSpace):
        def values(self, points):
            return -points[:, 0]

        def __repr__(self):
            return "Mine()"

    with pytest.raises(MetricError, match=r"Mine\(\) at point 0"):
        Mine()(POINTS)
    assert (Mine() & 0.1)([]).shape == (0, 3)


def test_repr_says_how_a_field_is_made():
    field = (as_control_space(0.5) & metrics.Expression("x")).scaled(2).limited(h_max=1)
    assert repr(field) == "((Uniform(0.5) & Expression('x')).scaled(2.0)).limited(0.0, 1.0)"


def test_union_is_everywhere_the_longer_step():
    field = as_control_space(size) | 0.4
    np.testing.assert_allclose(tensor.sizes(field(POINTS))[:, 0], np.maximum(size(POINTS), 0.4))
    assert repr(0.4 | as_control_space(0.2)) == "Uniform(0.4) | Uniform(0.2)"


def test_means_of_sizes_are_geometric():
    field = as_control_space(size)
    halfway = np.sqrt(0.4 * size(POINTS))
    np.testing.assert_allclose(tensor.sizes(field.mean(0.4)(POINTS))[:, 0], halfway)
    np.testing.assert_allclose(tensor.sizes(field.geometric_mean(0.4)(POINTS))[:, 0], halfway)
    third = 0.4**0.25 * size(POINTS) ** 0.75
    np.testing.assert_allclose(tensor.sizes(field.mean(0.4, 0.25)(POINTS))[:, 0], third)


def test_means_lie_between_the_fields_and_agree_where_these_commute():
    field = as_control_space(wall)
    one, other = field.mean(0.3)(POINTS), field.geometric_mean(0.3)(POINTS)
    np.testing.assert_allclose(one, other, rtol=1e-12)
    np.testing.assert_allclose(field.mean(0.3, 0.0)(POINTS), field(POINTS), rtol=1e-12)
    with pytest.raises(MetricError, match="between 0 and 1"):
        field.mean(0.3, 1.5)
