"""The metric for one number wanted of a solution."""

import numpy as np
import pytest
from reference.meshes import irregular_square

from metrics import (
    MetricError,
    absolute,
    gradients,
    hessians,
    metric_from_adjoint,
    metric_from_solution,
    predicted_vertices,
)
from metrics.tensor import sizes

POINTS, TRIANGLES = irregular_square(40)
X, Y = POINTS.T
U = np.tanh(15 * (X + 0.3 * Y - 0.6))
BOUNDS = {"h_max": 0.3, "gradation": None}


def carried(velocity, u):
    return u[:, None] * np.asarray(velocity)


def test_the_count_is_met():
    got = metric_from_adjoint(
        POINTS, TRIANGLES, carried((1, 2), U), np.exp(Y), target_vertices=1500, h_max=0.3
    )
    assert predicted_vertices(POINTS, TRIANGLES, got.tensors) == pytest.approx(1500, rel=1e-3)


def test_a_linear_adjoint_weighs_all_points_alike():
    """Then it is the metric of the L1 norm of the flux it looks along."""
    got = metric_from_adjoint(
        POINTS, TRIANGLES, carried((1, 0), U), 3 * X, complexity=500, **BOUNDS
    )
    plain = metric_from_solution(POINTS, TRIANGLES, U, p=1, complexity=500, **BOUNDS)
    np.testing.assert_allclose(sizes(got.tensors), sizes(plain.tensors), rtol=1e-3)


def test_it_is_the_optimal_metric_of_the_flux_along_the_gradient_of_the_adjoint():
    flux = np.stack([carried((1, -2), U), carried((0.5, 1), X**2 * Y)], axis=1)
    z = np.stack([np.sin(2 * X), X * Y], axis=1)
    expected = np.zeros((len(POINTS), 3))
    for k in range(2):
        g = gradients(POINTS, TRIANGLES, z[:, k])
        h = [hessians(POINTS, TRIANGLES, flux[:, k, i]) for i in range(2)]
        expected += absolute(g[:, [0]] * h[0] + g[:, [1]] * h[1])
    got = metric_from_adjoint(POINTS, TRIANGLES, flux, z, complexity=800, gradation=None).tensors
    # In proportion to det^(-1/4) H, the optimal metric of the L1 norm.
    det = expected[:, 0] * expected[:, 2] - expected[:, 1] ** 2
    well = det > 1e-6 * np.abs(expected).max() ** 2
    ratio = got[well] / (det[well] ** -0.25)[:, None] / expected[well]
    np.testing.assert_allclose(ratio, ratio[0, 0], rtol=1e-3)


def test_components_of_one_equation_add_up_before_the_absolute_value():
    flux = np.stack([carried((1, -2), U), carried((0.5, 1), X**2 * Y)], axis=1)
    z = np.stack([np.sin(2 * X), X * Y], axis=1)
    one = metric_from_adjoint(
        POINTS, TRIANGLES, flux[:, None], z[:, None], complexity=800, gradation=None
    )
    # The same equations, rotated among themselves and their adjoints along.
    turn = np.array([[0.6, -0.8], [0.8, 0.6]])
    other = metric_from_adjoint(
        POINTS,
        TRIANGLES,
        np.einsum("kl,nli->nki", turn, flux)[:, None],
        (z @ turn.T)[:, None],
        complexity=800,
        gradation=None,
    )
    np.testing.assert_allclose(one.tensors, other.tensors, rtol=1e-6, atol=1e-6)


def test_vertices_go_where_the_adjoint_changes():
    """Two equal layers; the goal looks at one of them."""
    u = np.tanh(20 * (X - 0.25)) + np.tanh(20 * (X - 0.75))
    adjoint = np.where(X < 0.5, (0.5 - X) ** 2, 0.0)
    got = metric_from_adjoint(
        POINTS, TRIANGLES, carried((1, 0), u), adjoint, target_vertices=600, h_max=0.2
    )
    h = sizes(got.tensors).min(axis=1)
    at = lambda x: h[np.abs(X - x) < 0.03].min()  # noqa: E731
    assert at(0.25) < 0.25 * at(0.75)


def test_what_is_wrong_is_named():
    flux = carried((1, 1), U)
    with pytest.raises(MetricError, match="adjoint must have the shape"):
        metric_from_adjoint(POINTS, TRIANGLES, flux, np.ones((len(X), 3)), complexity=100)
    with pytest.raises(MetricError, match="fluxes must have the shape"):
        metric_from_adjoint(POINTS, TRIANGLES, U, U, complexity=100)
    with pytest.raises(MetricError, match="does not ask for any size"):
        metric_from_adjoint(POINTS, TRIANGLES, 0 * flux, U, complexity=100)
    with pytest.raises(MetricError, match=r"flux at point 7 .* is not finite"):
        flux[7, 1] = np.nan
        metric_from_adjoint(POINTS, TRIANGLES, flux, U, complexity=100)
    with pytest.raises(MetricError, match="one target"):
        metric_from_adjoint(POINTS, TRIANGLES, carried((1, 1), U), U)
