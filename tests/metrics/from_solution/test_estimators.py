"""Indicators of the error, and sizes that spread it evenly."""

import itertools

import numpy as np
import pytest
from reference.meshes import irregular_square, regular_square

from metrics import (
    Background,
    MetricError,
    doerfler_marking,
    gradients,
    metric_from_indicators,
    predicted_vertices,
    residual_indicators,
    zz_indicators,
)
from metrics.tensor import sizes

POINTS, TRIANGLES = irregular_square(20)
X, Y = POINTS.T


def areas(points, triangles):
    p = points[triangles]
    u, v = p[:, 1] - p[:, 0], p[:, 2] - p[:, 0]
    return 0.5 * (u[:, 0] * v[:, 1] - u[:, 1] * v[:, 0])


def slopes(points, triangles, u):
    """Gradients on triangles, one by one."""
    out = []
    for t in triangles:
        a = np.column_stack([points[t], np.ones(3)])
        out.append(np.linalg.solve(a, u[t])[:2])
    return np.array(out)


def middles(points, triangles):
    """The middles of the three sides: a quadrature rule exact for quadratics."""
    return (points[triangles] + points[triangles[:, [1, 2, 0]]]) / 2


@pytest.mark.parametrize("method", ["projection", "least squares"])
def test_zz_is_the_distance_of_the_gradients(method):
    u = np.sin(3 * X) * Y
    g = gradients(POINTS, TRIANGLES, u, method)[TRIANGLES]
    at_middles = (g + g[:, [1, 2, 0]]) / 2 - slopes(POINTS, TRIANGLES, u)[:, None]
    expected = areas(POINTS, TRIANGLES) * (at_middles**2).sum(axis=(1, 2)) / 3
    np.testing.assert_allclose(zz_indicators(POINTS, TRIANGLES, u, method) ** 2, expected)


def test_zz_of_a_linear_function_is_zero():
    eta = zz_indicators(POINTS, TRIANGLES, 3 * X - 2 * Y + 1)
    assert eta.max() < 1e-13


def test_zz_of_several_fields_adds_their_squares():
    fields = np.stack([X**2, np.cos(Y)], axis=1)
    one, two = (zz_indicators(POINTS, TRIANGLES, f) for f in fields.T)
    np.testing.assert_allclose(zz_indicators(POINTS, TRIANGLES, fields), np.hypot(one, two))


def test_zz_comes_to_the_true_error():
    points, triangles = regular_square(60)
    x, y = points.T
    u = np.sin(2 * x) * np.cos(y)
    mid = middles(points, triangles)
    exact = np.stack(
        [
            2 * np.cos(2 * mid[..., 0]) * np.cos(mid[..., 1]),
            -np.sin(2 * mid[..., 0]) * np.sin(mid[..., 1]),
        ],
        axis=-1,
    )
    off = exact - slopes(points, triangles, u)[:, None]
    error = np.sqrt((areas(points, triangles) * (off**2).sum(axis=(1, 2)) / 3).sum())
    estimate = np.sqrt((zz_indicators(points, triangles, u, "least squares") ** 2).sum())
    assert estimate == pytest.approx(error, rel=0.02)


def test_the_residual_sees_the_jump_of_a_kink():
    """u = |x - 1/2| on two columns of squares: du/dn jumps by 2 over the line in the middle."""
    points = np.array([(x, y) for y in (0.0, 1.0) for x in (0.0, 0.5, 1.0)])
    triangles = np.array([(0, 1, 3), (1, 4, 3), (1, 2, 4), (2, 5, 4)], np.int32)
    eta = residual_indicators(points, triangles, np.abs(points[:, 0] - 0.5))
    np.testing.assert_allclose(eta**2, [0, 0.5 * 4, 0.5 * 4, 0], atol=1e-14)


def test_the_residual_of_a_source_alone():
    f = 1 + X
    eta = residual_indicators(POINTS, TRIANGLES, np.zeros(len(POINTS)), source=f)
    corners = POINTS[TRIANGLES]
    longest = np.linalg.norm(corners - corners[:, [1, 2, 0]], axis=2).max(axis=1)
    at_middles = 1 + middles(POINTS, TRIANGLES)[..., 0]
    square = areas(POINTS, TRIANGLES) * (at_middles**2).mean(axis=1)
    np.testing.assert_allclose(eta, longest * np.sqrt(square))
    on_triangles = residual_indicators(
        POINTS, TRIANGLES, 0 * X, source=np.full(len(TRIANGLES), 2.0), diffusion=4.0
    )
    np.testing.assert_allclose(on_triangles, longest * np.sqrt(areas(POINTS, TRIANGLES)))


def test_a_continuous_flux_makes_no_residual():
    """k = 1 and 3 beside each other, slopes 3 and 1: the flux is the same."""
    points, triangles = regular_square(11)
    left = points[triangles, 0].mean(axis=1) < 0.5
    u = np.where(points[:, 0] < 0.5, 3 * points[:, 0], 1 + points[:, 0])
    eta = residual_indicators(points, triangles, u, diffusion=np.where(left, 1.0, 3.0))
    assert eta.max() < 1e-12


@pytest.mark.parametrize("fraction", [0.3, 0.5, 0.9, 1.0])
def test_the_fewest_are_marked(fraction):
    eta = np.random.default_rng(3).random(10)
    marked = doerfler_marking(eta, fraction)
    enough = fraction * (eta**2).sum() * (1 - 1e-12)
    assert (eta[marked] ** 2).sum() >= enough
    fewer = itertools.combinations(eta**2, int(marked.sum()) - 1)
    assert not any(sum(squares) >= enough for squares in fewer)


def test_zero_indicators_are_never_marked():
    assert doerfler_marking([0.0, 2.0, 0.0], 1.0).tolist() == [False, True, False]


def test_equal_errors_keep_sizes_equal():
    points, triangles = regular_square(21)
    got = metric_from_indicators(
        points, triangles, np.ones(len(triangles)), target_vertices=2000, gradation=None
    )
    assert isinstance(got, Background)
    h = sizes(got.tensors)
    np.testing.assert_allclose(h, h[0, 0], rtol=1e-9)
    assert predicted_vertices(points, triangles, got.tensors) == pytest.approx(2000, rel=1e-3)


def test_the_count_is_met_after_gradation():
    eta = np.exp(-30 * np.hypot(X - 0.4, Y - 0.7))[TRIANGLES].mean(axis=1)
    got = metric_from_indicators(POINTS, TRIANGLES, eta, target_vertices=3000, h_max=0.1)
    assert predicted_vertices(POINTS, TRIANGLES, got.tensors) == pytest.approx(3000, rel=1e-3)
    assert sizes(got.tensors).max() <= 0.1 * (1 + 1e-9)


def test_half_the_error_of_first_order_needs_four_times_the_triangles():
    eta = 0.1 + X[TRIANGLES].mean(axis=1)
    total = np.sqrt((eta**2).sum())
    counts = [
        predicted_vertices(
            POINTS,
            TRIANGLES,
            metric_from_indicators(
                POINTS, TRIANGLES, eta, error=total / k, gradation=None, max_change=100
            ).tensors,
        )
        for k in (10, 20)
    ]
    assert counts[1] / counts[0] == pytest.approx(4, rel=0.05)


def test_unmarked_triangles_keep_their_sizes():
    points, triangles = regular_square(31)
    centre = points[triangles].mean(axis=1)
    eta = np.where(np.hypot(*(centre - 0.5).T) < 0.1, 1.0, 1e-6)
    got = metric_from_indicators(
        points, triangles, eta, error=0.5 * np.sqrt((eta**2).sum()), fraction=0.9, gradation=None
    )
    h = sizes(got.tensors)[:, 0]
    far = np.hypot(*(points - 0.5).T) > 0.2
    inside = (np.abs(points - 0.5) < 0.45).all(axis=1)
    # Right-angled halves of squares: the unit triangle of the same area has this side.
    own = np.sqrt(0.5 / (np.sqrt(3) / 4)) / 30
    np.testing.assert_allclose(h[far & inside], own, rtol=1e-9)
    assert h.min() < 0.6 * own


def test_what_is_wrong_is_named():
    ones = np.ones(len(TRIANGLES))
    with pytest.raises(MetricError, match="indicator of triangle 3 is nan"):
        metric_from_indicators(
            POINTS, TRIANGLES, np.where(np.arange(len(ones)) == 3, np.nan, 1), error=1
        )
    with pytest.raises(MetricError, match="indicator of triangle 0 is -1"):
        doerfler_marking([-1.0, 2.0])
    with pytest.raises(MetricError, match="all indicators are zero"):
        doerfler_marking(0 * ones)
    with pytest.raises(MetricError, match="one target"):
        metric_from_indicators(POINTS, TRIANGLES, ones)
    with pytest.raises(MetricError, match="shape"):
        metric_from_indicators(POINTS, TRIANGLES, ones[1:], error=1)
    with pytest.raises(MetricError, match="raise the fraction"):
        metric_from_indicators(POINTS, TRIANGLES, ones, error=1, fraction=0.1)
    with pytest.raises(MetricError, match="give `error`"):
        metric_from_indicators(POINTS, TRIANGLES, ones, target_vertices=100, fraction=0.1)
    with pytest.raises(MetricError, match="above 0 and at most 1"):
        doerfler_marking(ones, 0)
    with pytest.raises(MetricError, match="diffusion on triangle 0"):
        residual_indicators(POINTS, TRIANGLES, X, diffusion=0)
    with pytest.raises(MetricError, match="source at point 5 is not finite"):
        residual_indicators(
            POINTS, TRIANGLES, X, source=np.where(np.arange(len(X)) == 5, np.inf, 0)
        )
    with pytest.raises(MetricError, match="is not finite"):
        zz_indicators(POINTS, TRIANGLES, np.where(X > 0.5, np.nan, 1))
