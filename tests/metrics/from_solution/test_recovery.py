"""Recovered derivatives: exact for quadratics, and how fast they converge, at the border too."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from reference.frames import frames
from reference.meshes import delaunay, irregular_square, on_border, regular_square

from metrics import MetricError, absolute, gradients, hessians, tensor


def wave(x):
    x, y = x.T
    return np.sin(3 * x) * np.cos(2 * y) + x * y


def wave_gradient(x):
    x, y = x.T
    return np.stack(
        [3 * np.cos(3 * x) * np.cos(2 * y) + y, -2 * np.sin(3 * x) * np.sin(2 * y) + x], axis=1
    )


def wave_hessian(x):
    x, y = x.T
    s = np.sin(3 * x) * np.cos(2 * y)
    return np.stack([-9 * s, -6 * np.cos(3 * x) * np.sin(2 * y) + 1, -4 * s], axis=1)


def star(arms):
    """A hub with so many neighbours, at irregular angles and distances."""
    rng = np.random.default_rng(arms)
    angle = 2 * np.pi * (np.arange(arms) + rng.uniform(-0.3, 0.3, arms)) / arms
    rim = rng.uniform(0.8, 1, arms)[:, None] * np.stack([np.cos(angle), np.sin(angle)], axis=1)
    k = np.arange(arms)
    triangles = np.stack([0 * k, 1 + k, 1 + (k + 1) % arms], axis=1)
    return np.concatenate([[[0.0, 0.0]], rim]), triangles


def orders(error, mesh=irregular_square, sizes=(20, 40, 80)):
    """Orders of convergence, inside and at the border, of the root mean square error."""
    found = []
    for n in sizes:
        points, triangles = mesh(n)
        e, border = error(points, triangles), on_border(points)
        found.append([np.sqrt((e[where] ** 2).mean()) for where in (~border, border)])
    return np.log2(np.divide(found[:-1], found[1:]))


def least_squares_gradient_error(points, triangles):
    got = gradients(points, triangles, wave(points))
    return np.abs(got - wave_gradient(points)).max(axis=1)


def hessian_error(method):
    def error(points, triangles):
        got = hessians(points, triangles, wave(points), method)
        return np.abs(got - wave_hessian(points)).max(axis=1)

    return error


# --- exactness ---------------------------------------------------------------------------------


@settings(max_examples=30, deadline=None)
@given(
    st.lists(st.floats(-10, 10), min_size=6, max_size=6),
    st.integers(0, 2**32 - 1),
    st.floats(-6, 6),
)
def test_quadratics_are_exact_to_rounding(c, seed, exponent):
    """On any mesh of any scale, at every vertex: what is left is the rounding of values."""
    scale = 10**exponent
    points = np.random.default_rng(seed).random((60, 2))
    triangles = delaunay(points)
    x, y = points.T
    u = c[0] + c[1] * x + c[2] * y + c[3] * x * x / 2 + c[4] * x * y + c[5] * y * y / 2
    h = hessians(scale * points, triangles, u) * scale**2
    g = gradients(scale * points, triangles, u) * scale
    size = max(map(abs, c)) + 1e-9
    np.testing.assert_allclose(h, np.tile(c[3:], (60, 1)), atol=1e-8 * size)
    wanted = np.stack([c[1] + c[3] * x + c[4] * y, c[2] + c[4] * x + c[5] * y], axis=1)
    np.testing.assert_allclose(g, wanted, atol=1e-9 * size)


def test_quadratics_are_exact_on_thin_triangles():
    """A million to one, turned by 30 degrees: the frame of the fit goes along."""
    points, triangles = irregular_square(12)
    c, s = np.cos(np.pi / 6), np.sin(np.pi / 6)
    turn = np.array([[c, -s], [s, c]])
    thin = points * [1, 1e-6] @ turn.T
    u = (points**2).sum(axis=1) / 2
    wanted = turn @ np.diag([1, 1e12]) @ turn.T
    got = tensor.unpack(hessians(thin, triangles, u))
    np.testing.assert_allclose(got, np.tile(wanted, (len(points), 1, 1)), rtol=1e-7)
    along = np.einsum("i,nij,j->n", turn[:, 0], got, turn[:, 0])
    np.testing.assert_allclose(along, 1, atol=1e-2)  # 1 beside 1e12: four digits are left of it


@pytest.mark.parametrize("method", ["projection", "green"])
def test_other_methods_are_exact_inside_where_triangles_lie_symmetrically(method):
    points, triangles = regular_square(12)
    x, y = points.T
    got = hessians(points, triangles, x * x + 3 * x * y - y * y, method)
    inside = ((points > 0.15) & (points < 0.85)).all(axis=1)
    np.testing.assert_allclose(got[inside], np.tile([2.0, 3.0, -2.0], (inside.sum(), 1)), rtol=1e-9)


def test_projected_gradients_of_linear_functions_are_exact():
    points, triangles = irregular_square(9)
    got = gradients(points, triangles, 1 + 2 * points[:, 0] - points[:, 1], "projection")
    np.testing.assert_allclose(got, np.tile([2.0, -1.0], (81, 1)), rtol=1e-12)


# --- convergence -------------------------------------------------------------------------------


def test_fitted_gradients_are_of_second_order_everywhere():
    assert orders(least_squares_gradient_error).min() > 1.8


def test_fitted_hessians_are_of_first_order_everywhere():
    found = orders(hessian_error("least squares"))
    assert found.min() > 0.85
    assert found.max() < 1.4


def test_fitted_hessians_are_of_second_order_inside_symmetric_meshes():
    def error(points, triangles):
        inside = ((points > 0.2) & (points < 0.8)).all(axis=1)
        return np.where(inside, hessian_error("least squares")(points, triangles), 1e-9)

    assert orders(error, regular_square)[:, 0].min() > 1.7


def test_projected_gradients_are_of_first_order():
    def error(points, triangles):
        got = gradients(points, triangles, wave(points), "projection")
        return np.abs(got - wave_gradient(points)).max(axis=1)

    assert orders(error).min() > 0.85


@pytest.mark.parametrize(("method", "bound"), [("projection", 5.0), ("green", 8.0)])
def test_other_hessians_stay_bounded_but_do_not_converge(method, bound):
    """As they are described: of the right magnitude, no better on a finer mesh."""
    errors = []
    for n in (20, 80):
        points, triangles = irregular_square(n)
        errors.append(np.sqrt((hessian_error(method)(points, triangles) ** 2).mean()))
    assert max(errors) < bound
    assert errors[1] > 0.5 * errors[0]


# --- odd meshes --------------------------------------------------------------------------------


def test_a_corner_with_two_rings_too_small_takes_more():
    """A corner cut by one triangle, and the rest beyond it."""
    points, triangles = irregular_square(5)
    tip = np.array([[-0.3, -0.3]])
    points, triangles = np.r_[points, tip], np.r_[triangles, [[25, 1, 0], [25, 0, 5]]]
    u = points[:, 0] ** 2 - points[:, 0] * points[:, 1]
    np.testing.assert_allclose(
        hessians(points, triangles, u), np.tile([2.0, -1.0, 0.0], (26, 1)), atol=1e-10
    )


def test_a_strip_of_one_cell_does_not_determine_second_derivatives_across():
    x = np.linspace(0, 1, 20)
    points = np.r_[np.c_[x, 0 * x], np.c_[x, 0 * x + 0.1]]
    k = np.arange(19)
    triangles = np.r_[np.c_[k, k + 1, k + 21], np.c_[k, k + 21, k + 20]]
    with pytest.raises(MetricError, match=r"around point 0 \(0.0, 0.0\) do not determine"):
        hessians(points, triangles, x.repeat(2))
    hessians(points, triangles, x.repeat(2), "projection")
    with pytest.raises(MetricError, match=r"around point 0 \(0.0, 0.0\) do not determine"):
        hessians(points, triangles, x.repeat(2), "green")


def test_greens_formula_is_that_of_the_hat_functions_and_the_border_is_fitted():
    """Against the sums over the triangles around each vertex, written out."""
    points, triangles = irregular_square(9)
    u = np.sin(3 * points[:, 0]) * points[:, 1] ** 2
    got, fitted = (hessians(points, triangles, u, m) for m in ("green", "least squares"))
    for v in range(len(points)):
        if on_border(points[[v]])[0]:
            np.testing.assert_array_equal(got[v], fitted[v])
            continue
        total, area = np.zeros((2, 2)), 0.0
        for t in triangles[(triangles == v).any(axis=1)]:
            slopes = np.linalg.inv(np.c_[np.ones(3), points[t]])[1:]  # of the three hats, columns
            size = abs(np.linalg.det(np.c_[np.ones(3), points[t]])) / 2
            total -= size * np.outer(slopes @ u[t], slopes[:, t == v])
            area += size / 3
        wanted = (total + total.T) / 2 / area
        np.testing.assert_allclose(got[v], wanted[[0, 0, 1], [0, 1, 1]], rtol=1e-9, atol=1e-9)


def test_a_hub_with_many_spokes_takes_no_more_than_it_needs():
    angle = np.linspace(0, 2 * np.pi, 3000, endpoint=False)
    rim = np.stack([np.cos(angle), np.sin(angle)], axis=1)
    points = np.r_[[[0.0, 0.0]], rim, 1.5 * rim]
    k = np.arange(3000)
    k1 = (k + 1) % 3000
    triangles = np.concatenate(
        [
            np.stack([0 * k, k + 1, k1 + 1], 1),
            np.stack([k + 1, k + 3001, k1 + 3001], 1),
            np.stack([k + 1, k1 + 3001, k1 + 1], 1),
        ]
    )
    x, y = points.T
    got = hessians(points, triangles, x * x + x * y)
    np.testing.assert_allclose(got, np.tile([2.0, 1.0, 0.0], (len(points), 1)), atol=1e-6)


def test_what_cannot_be_used_is_refused():
    points, triangles = irregular_square(4)
    u = wave(points)
    with pytest.raises(MetricError, match=r"shape \(16,\)"):
        hessians(points, triangles, u[:3])
    with pytest.raises(MetricError, match=r"value at point 2 .* not finite: nan"):
        gradients(points, triangles, np.where(np.arange(16) == 2, np.nan, u))
    with pytest.raises(MetricError, match=r"triangle 0 .* not counter-clockwise"):
        hessians(points, triangles[:, ::-1], u)
    with pytest.raises(MetricError, match=r"point 16 \(9.0, 9.0\) is in no triangle"):
        hessians(np.r_[points, [[9.0, 9.0]]], triangles, np.r_[u, 1])
    with pytest.raises(MetricError, match="method must be one of"):
        hessians(points, triangles, u, "spr")
    with pytest.raises(MetricError, match="for gradients use the projection"):
        gradients(points, triangles, u, "green")


# --- absolute values ---------------------------------------------------------------------------

entries = st.floats(-1e3, 1e3).filter(lambda v: v == 0 or abs(v) > 1e-100)
symmetric = st.tuples(entries, entries, entries).map(lambda t: np.array([t]))


@given(symmetric, st.floats(0, 100))
def test_absolute_values_have_the_same_axes_and_raised_eigenvalues(h, floor):
    values, vectors = np.linalg.eigh(tensor.unpack(h)[0])
    wanted = vectors * np.maximum(np.abs(values), floor) @ vectors.T
    scale = np.abs(values).max() + floor + 1e-300
    assert np.abs(tensor.unpack(absolute(h, floor))[0] - wanted).max() < 1e-12 * scale


@given(symmetric)
def test_absolute_values_do_not_know_signs(h):
    turned, scale = absolute(-h) - absolute(h), np.abs(h).max()
    assert np.abs(turned).max() <= 4 * np.spacing(scale)  # axes are found from the larger end
    np.testing.assert_allclose(absolute(absolute(h)), absolute(h), rtol=1e-9, atol=1e-12)


def test_absolute_value_of_a_saddle_and_of_nothing():
    got = absolute([[0.0, 3.0, 0.0], [0.0, 0.0, 0.0], [2.0, 0.0, -1e-9]], [0.0, 0.5, 0.0])
    np.testing.assert_allclose(got, [[3, 0, 3], [0.5, 0, 0.5], [2, 0, 1e-9]], atol=1e-15)
    np.testing.assert_allclose(absolute(tensor.unpack([[0.0, 3.0, 0.0]])), [[3, 0, 3]])


def test_absolute_refuses():
    for wrong, message in [
        ([1.0, 2.0, 3.0], "shape"),
        ([[np.inf, 0, 0]], "item 0 is not finite"),
    ]:
        with pytest.raises(MetricError, match=message):
            absolute(wrong)
    with pytest.raises(MetricError, match="negative"):
        absolute([[1.0, 0, 1]], -1)


def test_neighbours_on_the_two_axes_only_are_not_enough():
    """A corner whose two and three rings lie on the sides: x y is 0 at all of them."""
    points = [(0, 0), (1, 0), (0, 1), (2, 0), (0, 2), (3, 0), (0, 3), (3.5, 3), (3, 3.5)]
    triangles = [(0, 1, 2), (1, 3, 2), (3, 4, 2), (3, 5, 4), (5, 6, 4), (5, 7, 6), (7, 8, 6)]
    x, y = np.transpose(points)
    second = hessians(points, triangles, x * x + 3 * x * y - y * y)
    np.testing.assert_allclose(second, np.tile([2.0, 3.0, -2.0], (9, 1)), atol=1e-9)


@pytest.mark.parametrize("angle", [0, 0.3, np.pi / 4, 2])
def test_where_the_mesh_is_one_triangle_thick_it_is_all_but_flat_across(angle):
    """A long strip, thick at its far end only: what is there is not asked how it bends here."""
    x = np.linspace(0, 10, 101)
    middle = np.c_[x[-1] + 0.1, 0.1]
    points = np.r_[np.c_[x, 0 * x], np.c_[x, 0 * x + 0.2], middle]
    k = np.arange(100)
    triangles = np.r_[np.c_[k, k + 1, k + 102], np.c_[k, k + 102, k + 101], [[100, 202, 201]]]
    u = np.sin(4 * points[:, 0])
    turn = np.array([[np.cos(angle), np.sin(angle)], [-np.sin(angle), np.cos(angle)]])
    second = tensor.unpack(hessians(points @ turn, triangles, u))
    along, across = turn[0], turn[1]
    near = (points[:, 0] > 0.3) & (points[:, 0] < 4)
    np.testing.assert_allclose(
        np.einsum("i,nij,j->n", along, second, along)[near], -16 * u[near], atol=2
    )
    assert abs(np.einsum("i,nij,j->n", across, second, across)[near]).max() < 1.6


@pytest.mark.parametrize("frame", frames(*star(150))[1])
def test_around_a_hub_results_do_not_depend_on_the_numbering_or_the_axes(frame):
    """Of so many neighbours of the hub, those of the others are some: the same in any frame."""
    points, triangles = star(150)
    own, others = frames(points, triangles)
    other = others[frame]
    u = np.sin(3 * points[:, 0]) * points[:, 1]
    wanted = hessians(own.points, own.triangles, u)
    got = hessians(other.points, other.triangles, other.at_vertices(u))
    back = other.old_tensors(other.old_vertices(got))
    error = np.abs(back - wanted).max(axis=1) / np.abs(wanted).max(axis=1)
    assert error.max() < 1e3 * other.transform.rounding


@pytest.mark.parametrize("seed", range(0, 60))
def test_fits_do_not_depend_on_the_axes_on_small_irregular_meshes(seed):
    rng = np.random.default_rng(seed)
    points = rng.random((rng.integers(7, 40), 2)) * [1, 10 ** rng.uniform(-3, 0)]
    triangles = delaunay(points)
    a = rng.uniform(0, 2 * np.pi)
    turn = np.array([[np.cos(a), -np.sin(a)], [np.sin(a), np.cos(a)]])
    u = np.sin(4 * points[:, 0]) + points[:, 1] ** 3 / points[:, 1].max() ** 3
    wanted = tensor.unpack(hessians(points, triangles, u))
    got = turn.T @ tensor.unpack(hessians(points @ turn.T, triangles, u)) @ turn
    error = np.abs(got - wanted).max(axis=(1, 2)) / np.abs(wanted).max(axis=(1, 2))
    assert error.max() < 1e-9
