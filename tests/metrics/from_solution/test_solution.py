"""From values to a metric in one call."""

import numpy as np
import pytest
from reference.meshes import irregular_square

from metrics import (
    Background,
    MetricError,
    absolute,
    h_shocks,
    hessians,
    interpolation_error,
    mesh_edges,
    metric_from_solution,
    predicted_vertices,
    tensor,
)

POINTS, TRIANGLES = irregular_square(40)
X, Y = POINTS.T
FRONT = np.tanh(15 * (X + 0.3 * Y - 0.6))
BOWL = X**2 + 4 * Y**2
HESSIANS = hessians(POINTS, TRIANGLES, FRONT)
CURVATURE = absolute(HESSIANS, 1e-8 * np.abs(HESSIANS).max())


@pytest.mark.parametrize("recovery", ["least squares", "projection", "green"])
@pytest.mark.parametrize("p", [1, 2, np.inf])
def test_the_count_is_met(p, recovery):
    got = metric_from_solution(
        POINTS,
        TRIANGLES,
        FRONT,
        target_vertices=2000,
        p=p,
        h_min=1e-3,
        h_max=0.3,
        recovery=recovery,
    )
    assert isinstance(got, Background)
    assert predicted_vertices(POINTS, TRIANGLES, got.tensors) == pytest.approx(2000, rel=1e-3)


def test_a_paraboloid_gets_the_same_ellipse_everywhere():
    got = metric_from_solution(POINTS, TRIANGLES, BOWL, complexity=1000).tensors
    np.testing.assert_allclose(got, np.tile([500.0, 0, 2000.0], (1600, 1)), rtol=1e-3, atol=0.1)


@pytest.mark.parametrize("p", [1, 2, np.inf])
def test_the_error_is_met_by_the_estimate(p):
    got = metric_from_solution(
        POINTS, TRIANGLES, FRONT, error=1e-3, p=p, gradation=None, max_anisotropy=30
    ).tensors
    bounded = tensor.limit(CURVATURE, max_anisotropy=30)
    assert interpolation_error(POINTS, TRIANGLES, got, bounded, p) == pytest.approx(1e-3, rel=0.02)


def test_half_the_error_needs_twice_the_complexity():
    counts = [
        predicted_vertices(
            POINTS,
            TRIANGLES,
            metric_from_solution(POINTS, TRIANGLES, BOWL, error=e).tensors,
        )
        for e in (1e-4, 5e-5)
    ]
    assert counts[1] / counts[0] == pytest.approx(2, rel=0.05)


def test_an_error_that_the_coarsest_metric_does_not_reach_gives_the_coarsest():
    got = metric_from_solution(POINTS, TRIANGLES, FRONT, error=1e3, h_max=0.2)
    np.testing.assert_allclose(tensor.sizes(got.tensors), 0.2)
    with pytest.raises(
        MetricError, match=r"cannot be reached: the finest .* h_min = 0.1 .*allow more"
    ):
        metric_from_solution(POINTS, TRIANGLES, FRONT, error=1e-9, h_min=0.1)


def test_gradation_limits_and_anisotropy_hold():
    got = metric_from_solution(
        POINTS,
        TRIANGLES,
        FRONT,
        target_vertices=3000,
        h_min=2e-3,
        h_max=0.1,
        max_anisotropy=8,
        gradation=1.4,
        law="h-correction",
    ).tensors
    small, large = tensor.sizes(got).T
    assert small.min() > 2e-3 * (1 - 1e-9) and large.max() < 0.1 * (1 + 1e-9)
    assert (large / small).max() < 8 * (1 + 1e-9)
    assert h_shocks(POINTS, mesh_edges(TRIANGLES)[0], got).max() < 1.4 * (1 + 1e-3)


def test_fields_of_different_units_count_alike():
    both = np.stack([FRONT, BOWL], axis=1)
    wanted = metric_from_solution(POINTS, TRIANGLES, both, complexity=1000).tensors
    got = metric_from_solution(POINTS, TRIANGLES, both * [1e6, 1e-3], complexity=1000).tensors
    np.testing.assert_allclose(got, wanted, rtol=1e-6, atol=1e-6 * wanted.max())
    alone = metric_from_solution(POINTS, TRIANGLES, FRONT, complexity=1000).tensors
    assert np.abs(wanted - alone).max() > 0.1 * alone.max()


def test_each_field_has_its_own_error():
    both = np.stack([FRONT, BOWL], axis=1)
    got = metric_from_solution(POINTS, TRIANGLES, both, error=[1e-3, 1e-4]).tensors
    bowl = absolute(hessians(POINTS, TRIANGLES, BOWL))
    shares = [
        interpolation_error(POINTS, TRIANGLES, got, CURVATURE) / 1e-3,
        interpolation_error(POINTS, TRIANGLES, got, bowl) / 1e-4,
    ]
    assert max(shares) == pytest.approx(1, rel=0.02)
    average = metric_from_solution(POINTS, TRIANGLES, both, error=[1e-3, 1e-4], combine="average")
    assert np.abs(average.tensors - got).max() > 0.01 * got.max()


def test_values_may_have_any_offset_and_unit():
    wanted = metric_from_solution(POINTS, TRIANGLES, FRONT, target_vertices=500).tensors
    for u in (-FRONT, FRONT * 1e-12, FRONT * 1e12):
        got = metric_from_solution(POINTS, TRIANGLES, u, target_vertices=500).tensors
        np.testing.assert_allclose(got, wanted, rtol=1e-6, atol=1e-6 * wanted.max())


def test_a_linear_function_keeps_the_sizes_it_is_sampled_with():
    """Its curvature is nothing but rounding, and must not be taken for more."""
    points = POINTS**2  # small at one corner
    got = metric_from_solution(
        points, TRIANGLES, 3 + points @ [1.0, 2.0], target_vertices=1600, gradation=None
    ).tensors
    small, large = tensor.sizes(got).T
    assert (large / small).max() < 1 + 1e-6
    near, far = small[(POINTS < 0.3).all(axis=1)], small[(POINTS > 0.7).all(axis=1)]
    assert near.max() < far.min()


@pytest.mark.parametrize(
    ("values", "options", "message"),
    [
        (FRONT[:5], {"complexity": 10}, r"shape \(1600,\), or \(1600, k\)"),
        (0 * FRONT + 2, {"complexity": 10}, "field 0 is 2 everywhere"),
        (FRONT, {}, "give one target"),
        (FRONT, {"complexity": 10, "error": 1e-3}, "give one target"),
        (FRONT, {"error": 0}, "error must be positive"),
        (FRONT, {"error": [1e-3, 1e-3]}, "error must be positive, one number or 1"),
        (FRONT, {"complexity": 10, "p": 0.5}, "L\\^p"),
        (FRONT, {"complexity": 10, "h_min": 1, "h_max": 0.1}, "h_min <= h_max"),
        (FRONT, {"complexity": 10, "law": "none"}, "law must be"),
        (FRONT, {"complexity": 10, "recovery": "exact"}, "method must be"),
        (FRONT, {"complexity": 10, "combine": "sum"}, "combined by"),
        (np.where(X > 0.9, np.nan, FRONT), {"complexity": 10}, "not finite"),
    ],
)
def test_what_makes_no_sense_is_refused(values, options, message):
    with pytest.raises(MetricError, match=message):
        metric_from_solution(POINTS, TRIANGLES, values, **options)
