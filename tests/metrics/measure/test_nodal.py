"""Measures from the metric at the vertices: closed forms against quadrature, and named rules."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from reference.meshes import from_axes, irregular_square
from reference.transforms import TRANSFORMS

from metrics import (
    Background,
    MetricError,
    complexity,
    edge_lengths,
    efficiency_index,
    h_shocks,
    mesh_edges,
    metric_areas,
    nodal_areas,
    nodal_complexity,
    nodal_lengths,
    nodal_qualities,
    predicted_vertices,
    qualities,
    tensor,
)

POINTS, TRIANGLES = irregular_square(9)
EDGES, _ = mesh_edges(TRIANGLES)
TURNING = from_axes(0.02 + POINTS[:, 0], 0.3 - 0.2 * POINTS[:, 1], 3 * POINTS[:, 0])
everywhere = pytest.mark.parametrize("transform", TRANSFORMS, ids=str)


@everywhere
def test_they_are_the_measures_of_the_background(transform):
    points, triangles = transform(POINTS), transform.triangles(TRIANGLES)
    turning = transform.metric(TURNING)
    background = Background(points, triangles, turning)
    wanted = edge_lengths(points, EDGES, background, rtol=1e-12)
    np.testing.assert_allclose(nodal_lengths(points, EDGES, turning), wanted, rtol=1e-6)
    wanted = metric_areas(points, triangles, background, rtol=1e-10)
    np.testing.assert_allclose(nodal_areas(points, triangles, turning), wanted, rtol=1e-7)
    wanted = qualities(points, triangles, background)
    np.testing.assert_allclose(nodal_qualities(points, triangles, turning), wanted, rtol=5e-3)
    wanted = complexity(points, triangles, background, rtol=1e-5).value
    assert nodal_complexity(points, triangles, turning) == pytest.approx(wanted, rel=1e-4)


@everywhere
@pytest.mark.parametrize("rule", ["quadrature", "simpson", "logarithmic"])
def test_rules_agree_where_the_metric_is_constant_and_are_symmetric(rule, transform):
    points, turning = transform(POINTS), transform.metric(TURNING)
    before = np.broadcast_to(from_axes(0.1, 2.0, 0.4), (len(POINTS), 3))
    one = transform.metric(before)
    e = POINTS[EDGES[:, 1]] - POINTS[EDGES[:, 0]]
    wanted = np.sqrt(np.einsum("ki,ij,kj->k", e, tensor.unpack(before[:1])[0], e))
    rtol = 1e-12 + 200 * transform.rounding * np.linalg.cond(transform.matrix)
    np.testing.assert_allclose(nodal_lengths(points, EDGES, one, rule), wanted, rtol=rtol)
    there = nodal_lengths(points, EDGES, turning, rule)
    back = nodal_lengths(points, EDGES[:, ::-1], turning, rule)
    np.testing.assert_allclose(there, back, rtol=1e-12)


def test_rules_differ_as_they_say():
    """h = 1 and 1/2 at the ends of an edge of length 1, without direction: a = 1, b = 2."""
    points, edges, h = [[0.0, 0.0], [1.0, 0.0]], [[0, 1]], [1.0, 0.5]
    mean = 1 / np.log(2)
    assert nodal_lengths(points, edges, h, "logarithmic")[0] == pytest.approx(mean, rel=1e-14)
    assert nodal_lengths(points, edges, h, "quadrature")[0] == pytest.approx(mean, rel=1e-14)
    simpson = (1 + 4 * np.sqrt(2) + 2) / 6
    assert nodal_lengths(points, edges, h, "simpson")[0] == pytest.approx(simpson, rel=1e-14)
    with pytest.raises(MetricError, match="rule must be one of 'quadrature', 'simpson'"):
        nodal_lengths(points, edges, h, "gauss")


@given(st.lists(st.floats(-12, 12), min_size=3, max_size=3))
def test_areas_are_exact_for_any_change_of_size(logs):
    """exp of a linear function over a triangle, cut into strips and summed by Gauss points."""
    points, triangles = [[0.0, 0.0], [1.0, 0.0], [0.0, 1.0]], [[0, 1, 2]]
    x, w = np.polynomial.legendre.leggauss(60)
    x, w = (x + 1) / 2, w / 2
    s, t = x[:, None], (1 - x[:, None]) * x[None]
    f = logs[0] * (1 - s - t) + logs[1] * s + logs[2] * t
    wanted = (w[:, None] * w[None] * (1 - x[:, None]) * np.exp(f)).sum()
    h = np.exp(-0.5 * np.array(logs))
    assert nodal_areas(points, triangles, h)[0] == pytest.approx(wanted, rel=1e-12)
    assert nodal_areas(points, [[0, 2, 1]], h)[0] == pytest.approx(-wanted, rel=1e-12)


@pytest.mark.parametrize("gap", [0, 1e-15, 1e-9, 1e-3, 0.3, 0.999, 1.001, 5])
def test_areas_where_two_sizes_are_equal(gap):
    """The integral of e^(gap s) over the triangle is (e^gap - 1 - gap) / gap^2."""
    wanted = sum(gap**k / float(np.prod(np.arange(1.0, k + 3))) for k in range(40))
    for h in ([1, 1, np.exp(-gap / 2)], [1, np.exp(-gap / 2), 1], [np.exp(-gap / 2), 1, 1]):
        got = nodal_areas([[0.0, 0.0], [1.0, 0.0], [0.0, 1.0]], [[0, 1, 2]], h)[0]
        assert got == pytest.approx(wanted, rel=1e-13)


def test_a_unit_equilateral_lattice_has_quality_one_and_the_predicted_vertices():
    k = np.arange(30)
    i, j = (part.ravel() for part in np.meshgrid(k, k))
    points = np.stack([i + j / 2, j * np.sqrt(3) / 2], axis=1)
    n = (j * 30 + i).reshape(30, 30)
    a, b, c, d = (p.ravel() for p in (n[:-1, :-1], n[:-1, 1:], n[1:, 1:], n[1:, :-1]))
    triangles = np.concatenate([np.stack([a, b, d], 1), np.stack([b, c, d], 1)])
    one = np.ones(900)
    np.testing.assert_allclose(nodal_qualities(points, triangles, one), 1, rtol=1e-12)
    assert predicted_vertices(points, triangles, one) == pytest.approx(900, rel=1e-12)


def test_functions_are_evaluated_at_the_vertices():
    def field(x):
        return 0.1 + x[:, 0]

    got = nodal_lengths(POINTS, EDGES, field)
    np.testing.assert_array_equal(got, nodal_lengths(POINTS, EDGES, field(POINTS)))


def test_h_shock_of_a_chain_of_unit_edges_is_its_ratio():
    """Sizes that change geometrically along an edge that is unit in them."""
    for ratio in (1.001, 1.2, 3.0):
        step = np.log(ratio) / (1 - 1 / ratio)  # of length 1: (1 - 1 / r) / ln r = 1 / step
        got = h_shocks([[0.0, 0.0], [0.0, step]], [[0, 1], [1, 0]], [1.0, ratio])
        np.testing.assert_allclose(got, ratio, rtol=1e-12)
    assert h_shocks(POINTS, EDGES, np.full(len(POINTS), 0.1)).max() == pytest.approx(1)
    assert h_shocks(POINTS, EDGES, TURNING).min() >= 1


@given(st.floats(0.01, 100))
def test_efficiency_index_does_not_tell_long_from_short(length):
    for definition in ("mean square", "frey-george"):
        got = efficiency_index([length], definition)
        assert got == pytest.approx(efficiency_index([1 / length], definition))
        assert 0 < got <= 1
    assert efficiency_index([1.0, 1.0]) == 1
    assert efficiency_index([1.0, 2.0]) == pytest.approx(1 - 0.125)
    assert efficiency_index([0.5], "frey-george") == pytest.approx(np.exp(-0.5))


def test_measures_refuse_what_they_cannot_measure():
    with pytest.raises(MetricError, match="lengths must be positive"):
        efficiency_index([1.0, 0.0])
    with pytest.raises(MetricError, match="definition must be"):
        efficiency_index([1.0], "borouchaki")
    for function in (nodal_lengths, h_shocks):
        with pytest.raises(MetricError, match="out of range"):
            function(POINTS, [[0, 99]], TURNING)
        with pytest.raises(MetricError, match=r"shape \(3,\)"):
            function(POINTS, EDGES, [1.0, 2.0, 3.0])


@pytest.mark.parametrize("rule", ["quadrature", "simpson", "logarithmic"])
def test_an_edge_without_length(rule):
    points = [[1.0, 2.0], [1.0, 2.0]]
    assert nodal_lengths(points, [[0, 1]], [0.1, 0.2], rule) == 0
    with pytest.raises(MetricError, match=r"edge 0 = \(0, 1\) has no length"):
        h_shocks(points, [[0, 1]], [0.1, 0.2])


@pytest.mark.parametrize("rule", ["quadrature", "logarithmic"])
def test_lengths_along_the_thinnest_ellipses_are_not_lost(rule):
    """With sizes 1e-7 and 1, the entries hold the square of the length 1 to two digits only."""
    angle = np.linspace(0, 2 * np.pi, 200)
    thin = from_axes(1.0, 1e-7, angle)
    points = np.concatenate([0 * thin[:, :2], np.stack([np.cos(angle), np.sin(angle)], axis=1)])
    k = np.arange(200)
    got = nodal_lengths(points, np.stack([k, k + 200], 1), np.concatenate([thin, thin]), rule)
    np.testing.assert_allclose(got, 1, atol=0.05)
