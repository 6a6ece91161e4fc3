"""Counts that are asked for are met, whatever the limits; what cannot be is said."""

from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from reference.meshes import from_axes, irregular_square, regular_square
from reference.transforms import SIMILARITIES, TRANSFORMS

from metrics import (
    Limits,
    MetricError,
    combined,
    h_shocks,
    interpolation_error,
    lp_metric,
    mesh_edges,
    nodal_complexity,
    normalised,
    predicted_vertices,
    tensor,
)

POINTS, TRIANGLES = irregular_square(25)
FRONT = from_axes(1e-3 + np.abs(POINTS[:, 0] + 0.3 * POINTS[:, 1] - 0.6), 1.0, 0.29)
everywhere = pytest.mark.parametrize("transform", TRANSFORMS, ids=str)
turned_and_scaled = pytest.mark.parametrize("transform", SIMILARITIES, ids=str)


def carried(transform):
    """The metric of a front, points and triangles in another frame."""
    return transform.metric(FRONT), transform(POINTS), transform.triangles(TRIANGLES)


# --- the L^p metric ----------------------------------------------------------------------------


@pytest.mark.parametrize("p", [1, 1.5, 2, 8, np.inf])
def test_lp_metric_is_the_formula(p):
    h = from_axes(0.1, 2.0, 0.4)[None]
    exponent = 0 if p == np.inf else -1 / (2 * p + 2)
    np.testing.assert_allclose(lp_metric(h, p), np.linalg.det(tensor.unpack(h)[0]) ** exponent * h)


@everywhere
@pytest.mark.parametrize("p", [1, 2, 4, 50])
def test_lp_metric_has_the_least_error_of_its_complexity(p, transform):
    """Any other scaling in space, at the same complexity, has a larger one."""
    hessians, points, triangles = carried(transform)
    best = normalised(lp_metric(hessians, p), points, triangles, complexity=1000)
    least = interpolation_error(points, triangles, best, hessians, p)
    rng = np.random.default_rng(3)
    for size in (0.3, 0.03):
        bump = np.exp(size * np.sin(3 * rng.normal(size=2) @ POINTS.T))[:, None]
        other = normalised(best * bump, points, triangles, complexity=1000)
        assert interpolation_error(points, triangles, other, hessians, p) > least * (1 + 1e-6)


@everywhere
@pytest.mark.parametrize("p", [1, 2, 3, np.inf])
@pytest.mark.parametrize("n", [2, 5])
def test_error_is_that_on_equilateral_triangles(p, n, transform):
    """A paraboloid on a triangle cut into n * n equilateral ones: |e| = (R^2 - r^2) / 2 in each."""
    x, w = np.polynomial.legendre.leggauss(30)
    x, w = (x + 1) / 2, w / 2
    s, t = np.repeat(x, 30), np.outer(1 - x, x).ravel()
    weight = np.outer(w * (1 - x), w).ravel() * 2
    corners = np.array([[0, 0], [1, 0], [0.5, np.sqrt(3) / 2]]) / n
    place = corners[0] + np.outer(s, corners[1]) + np.outer(t, corners[2])
    centre = corners.mean(axis=0)
    error = 3 * ((centre**2).sum() - ((place - centre) ** 2).sum(axis=1)) / 2
    wanted = error.max() if p == np.inf else (np.sqrt(3) / 4 * (weight @ error**p)) ** (1 / p)
    sizes, hessians = (transform.metric(m) for m in ([[n**2, 0, n**2]] * 3, [[3.0, 0.0, 3.0]] * 3))
    triangle = transform.triangles([[0, 1, 2]])
    got = interpolation_error(transform(corners * n), triangle, sizes, hessians, p)
    wanted *= abs(transform.determinant) ** (1 / p)
    rounding = 1e-9 + 10 * transform.rounding
    assert got == pytest.approx(wanted, rel=2e-2 if p == np.inf else rounding)


@everywhere
def test_error_is_half_where_the_sizes_are_smaller_by_root_two(transform):
    front, *mesh = carried(transform)
    first = interpolation_error(*mesh, front, front)
    assert interpolation_error(*mesh, 2 * front, front) == pytest.approx(first / 2)


@pytest.mark.parametrize("p", [0.5, 0, -1, np.nan])
def test_norms_below_one_are_refused(p):
    with pytest.raises(MetricError, match="L\\^p norm, from 1 to inf"):
        lp_metric(FRONT, p)


# --- counts ------------------------------------------------------------------------------------


@pytest.mark.parametrize(
    "limits",
    [
        Limits(gradation=None),
        Limits(h_max=0.1, gradation=None),
        Limits(h_min=0.005, h_max=0.2, gradation=None),
        Limits(max_anisotropy=5, gradation=None),
        Limits(gradation=1.3),
        Limits(h_min=0.002, h_max=0.15, max_anisotropy=20, gradation=1.5, law="metric"),
        Limits(h_min=0.002, h_max=0.15, gradation=1.2, law="h-correction"),
    ],
)
@pytest.mark.parametrize("target", [400, 20_000])
@turned_and_scaled
def test_the_count_is_met_after_the_limits(limits, target, transform):
    front, points, triangles = carried(transform)
    scale = transform.scale
    units = replace(limits, h_min=limits.h_min * scale, h_max=limits.h_max * scale)
    got = normalised(front, points, triangles, target_vertices=target, limits=units)
    assert predicted_vertices(points, triangles, got) == pytest.approx(target, rel=1e-3)
    small, large = tensor.sizes(got).T / scale
    assert small.min() >= limits.h_min * (1 - 1e-9)
    assert large.max() <= limits.h_max * (1 + 1e-9)
    assert (large / small).max() <= limits.max_anisotropy * (1 + 1e-9)
    if limits.law == "h-correction":
        shocks = h_shocks(points, mesh_edges(triangles)[0], got)
        assert shocks.max() < limits.gradation * (1 + 1e-4)


@settings(max_examples=20, deadline=None)
@given(
    st.integers(0, 2**32 - 1),
    st.floats(1, 5),
    st.sampled_from([None, 1.2, 2.0]),
    st.floats(1, 1e3),
    st.floats(-3, 3),
    st.sampled_from(TRANSFORMS),
)
def test_any_complexity_of_any_field(seed, target, gradation, anisotropy, scale, transform):
    rng = np.random.default_rng(seed)
    points, triangles = regular_square(6)
    metric = from_axes(
        10 ** rng.uniform(-3, 0, 36), 10 ** rng.uniform(-3, 0, 36), rng.uniform(0, np.pi, 36)
    )
    points, triangles = transform(points), transform.triangles(triangles)
    metric = transform.metric(metric)
    limits = Limits(max_anisotropy=anisotropy, gradation=gradation)
    got = normalised(metric * 10**scale, points, triangles, complexity=10**target, limits=limits)
    assert nodal_complexity(points, triangles, got) == pytest.approx(10**target, rel=1e-2)


@everywhere
def test_without_limits_it_is_a_factor(transform):
    front, *mesh = carried(transform)
    ratio = normalised(front, *mesh, complexity=500) / front
    np.testing.assert_allclose(ratio, ratio[0, 0], rtol=1e-9)


def test_what_the_limits_do_not_allow_is_refused_with_what_they_do():
    coarsest = predicted_vertices(POINTS, TRIANGLES, np.full(len(POINTS), 0.02))
    with pytest.raises(
        MetricError,
        match=f"50 vertices cannot be reached.* h_max = 0.02 .* has {coarsest:.6g}; raise h_max",
    ):
        normalised(FRONT, POINTS, TRIANGLES, target_vertices=50, limits=Limits(h_max=0.02))
    finest = nodal_complexity(POINTS, TRIANGLES, np.full(len(POINTS), 0.1))
    with pytest.raises(
        MetricError,
        match=f"1000 complexity cannot be reached.* h_min = 0.1 .* has {finest:.6g}; lower h_min",
    ):
        normalised(FRONT, POINTS, TRIANGLES, complexity=1000, limits=Limits(h_min=0.1))


@pytest.mark.parametrize(
    "targets",
    [{}, {"target_vertices": 10, "complexity": 10}, {"target_vertices": 2}]
    + [{"complexity": c} for c in (0, -1, np.nan, np.inf)],
)
def test_one_target_is_needed(targets):
    with pytest.raises(MetricError, match=r"target|complexity"):
        normalised(FRONT, POINTS, TRIANGLES, **targets)


# --- several -----------------------------------------------------------------------------------


def test_metrics_are_combined_in_order():
    parts = [from_axes(0.1, 1.0, angle)[None] for angle in (0.0, 1.0, 2.0)]
    in_turn = tensor.intersect(tensor.intersect(parts[0], parts[1]), parts[2])
    np.testing.assert_array_equal(combined(parts), in_turn)
    np.testing.assert_allclose(combined(parts, "average")[0], tensor.mean(np.concatenate(parts)))
    np.testing.assert_array_equal(combined([[0.5]]), [[4, 0, 4]])
    with pytest.raises(MetricError, match="at least one"):
        combined([])
    with pytest.raises(MetricError, match='"intersection" or "average"'):
        combined(parts, "union")
