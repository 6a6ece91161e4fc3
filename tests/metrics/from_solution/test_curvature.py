"""Hessians of a field, and the error of its interpolation on each triangle."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from reference.meshes import irregular_square

from metrics import Curvature, MetricError, interpolation_errors, tensor

POINTS, TRIANGLES = irregular_square(30)
X, Y = POINTS.T


def slow_error(corners, hessian, p, depth=60):
    """The L^p norm of interpolant minus quadratic on one triangle, by many small triangles."""
    a, b, c = hessian
    u, v = corners[1] - corners[0], corners[2] - corners[0]
    area = abs(u[0] * v[1] - u[1] * v[0]) / 2
    at = [
        ((i + up / 3) / depth, (j + up / 3) / depth)
        for i in range(depth)
        for j in range(depth - i)
        for up in ((1, 2) if i + j < depth - 1 else (1,))
    ]
    weights = np.array([(s, t, 1 - s - t) for s, t in at])

    def quadratic(x):
        return (a * x[:, 0] ** 2 + 2 * b * x[:, 0] * x[:, 1] + c * x[:, 1] ** 2) / 2

    error = np.abs(weights @ quadratic(corners) - quadratic(weights @ corners))
    return error.max() if p == np.inf else (area * np.mean(error**p)) ** (1 / p)


def gradient(points, hessian):
    """Of the quadratic with this Hessian, at points."""
    a, b, c = hessian
    return np.array(points, float) @ [[a, b], [b, c]]


numbers = st.integers(-1000, 1000).map(lambda k: k / 1000)


@given(
    st.lists(st.tuples(numbers, numbers), min_size=3, max_size=3),
    st.tuples(numbers, numbers, numbers),
    st.sampled_from([1, 2, 3.5, np.inf]),
)
def test_of_a_quadratic_it_is_exact(corners, hessian, p):
    corners = np.array(corners)
    u, v = corners[1] - corners[0], corners[2] - corners[0]
    if abs(u[0] * v[1] - u[1] * v[0]) < 0.01:
        return
    got = interpolation_errors(corners, [[0, 1, 2]], gradient(corners, hessian), p)
    scale = np.abs(hessian).max()
    rel = 0.06 if p == np.inf else 0.02  # the oracle does not look on edges
    assert got[0] == pytest.approx(slow_error(corners, hessian, p), rel=rel, abs=1e-3 * scale)


def test_even_norms_of_a_saddle_are_exact_and_do_not_overflow():
    corners, triangle = np.array([(0, 0), (1, 0), (0, 1)]), [[0, 1, 2]]
    saddle = gradient(corners, (0, 1, 0))  # the error of xy is -xy, its mean square 1/90
    for scale in (1e-200, 1, 1e200):
        got = interpolation_errors(corners, triangle, scale * saddle)
        assert got[0] == pytest.approx(scale * np.sqrt(1 / 180), rel=1e-12)
    assert interpolation_errors(corners, triangle, 0 * saddle, 1) == 0
    assert interpolation_errors(corners, triangle, saddle, np.inf)[0] == pytest.approx(0.25)


@pytest.mark.parametrize("recovery", ["least squares", "projection", "green"])
def test_the_error_on_a_mesh_is_that_of_the_function(recovery):
    def u(x):
        return np.sin(3 * x[..., 0]) * np.cos(2 * x[..., 1])

    got = Curvature.of(POINTS, TRIANGLES, u(POINTS), recovery).interpolation_errors()
    corners, nodal, depth, squares = POINTS[TRIANGLES], u(POINTS)[TRIANGLES], 8, 0
    v, w = corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0]
    areas = abs(v[:, 0] * w[:, 1] - v[:, 1] * w[:, 0]) / 2
    for i in range(depth):
        for j in range(depth - i):
            for up in (1, 2) if i + j < depth - 1 else (1,):
                s, t = (i + up / 3) / depth, (j + up / 3) / depth
                at = [s, t, 1 - s - t]
                error = nodal @ at - u(np.einsum("k,tkd->td", at, corners))
                squares += areas * error**2 / depth**2
    total = np.sqrt([np.sum(got**2), np.sum(squares)])
    assert total[0] == pytest.approx(total[1], rel=0.02 if recovery == "least squares" else 0.25)


def test_components_count_by_their_size():
    u = np.tanh(10 * (X - 0.5))
    small = 1e-9 * np.tanh(10 * (Y - 0.5))
    alone = Curvature.of(POINTS, TRIANGLES, u)
    both = Curvature.of(POINTS, TRIANGLES, np.stack([u, small], axis=1))
    assert len(both.hessians) == 2
    np.testing.assert_allclose(both.absolute, alone.absolute, rtol=1e-5, atol=1e-3)
    turned = Curvature.of(POINTS, TRIANGLES, np.stack([0.6 * u, 0.8 * u], axis=1))
    np.testing.assert_allclose(turned.interpolation_errors(), alone.interpolation_errors())


def test_a_function_without_curvature_has_no_error():
    flat = Curvature.of(POINTS, TRIANGLES, 3 * X + Y)
    assert (tensor.sizes(flat.absolute) > 0).all()
    assert flat.interpolation_errors().max() < 1e-12


def test_wrong_shapes_are_named():
    with pytest.raises(MetricError, match=r"shape \(900,\), or \(900, k\)"):
        Curvature.of(POINTS, TRIANGLES, X[:-1])
    with pytest.raises(MetricError, match="gradients must have the shape"):
        interpolation_errors(POINTS, TRIANGLES, np.ones((4, 2)))
