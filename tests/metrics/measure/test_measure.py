"""Lengths, areas, qualities and complexity against closed forms and brute force."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from scipy.spatial import Delaunay

from metrics import (
    MetricError,
    as_control_space,
    complexity,
    edge_lengths,
    mesh_edges,
    metric_areas,
    qualities,
    tensor,
)

SQUARE = np.array([[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]])
TWO = np.array([[0, 1, 2], [0, 2, 3]])
EQUILATERAL = np.array([[0.0, 0.0], [1.0, 0.0], [0.5, np.sqrt(0.75)]])


def growing(x):
    """h = 1 + x."""
    return 1 + x[:, 0]


def wave(x):
    """A layer of thickness 0.02 along a sine, aspect ratio up to 50."""
    slope = 0.2 * 2 * np.pi * np.cos(2 * np.pi * x[:, 0])
    height = x[:, 1] - 0.5 - 0.2 * np.sin(2 * np.pi * x[:, 0])
    norm = np.hypot(slope, 1)
    nx, ny = -slope / norm, 1 / norm
    thin, wide = (0.02 + 0.4 * np.abs(height) / norm) ** -2.0, 1.0
    return np.stack(
        [thin * nx**2 + wide * ny**2, (thin - wide) * nx * ny, thin * ny**2 + wide * nx**2], 1
    )


def brute_length(field, p, q, n=20_000):
    """The sum over many short chords, each with the metric at its middle."""
    t = (np.arange(n) + 0.5) / n
    m = tensor.unpack(as_control_space(field)(p + t[:, None] * (q - p)))
    return np.sqrt(np.einsum("i,kij,j->k", q - p, m, q - p)).mean()


def brute_area(field, corners, n=300):
    """The sum over n * n congruent triangles, each with the metric at its centroid."""
    i, j = np.mgrid[:n, :n].reshape(2, -1)
    up, down = i + j < n, i + j < n - 1
    a = np.concatenate([i[up] + 1 / 3, i[down] + 2 / 3]) / n
    b = np.concatenate([j[up] + 1 / 3, j[down] + 2 / 3]) / n
    p, u, v = corners[0], corners[1] - corners[0], corners[2] - corners[0]
    where = p + a[:, None] * u + b[:, None] * v
    roots = np.sqrt(tensor.det(as_control_space(field)(where)))
    return 0.5 * (u[0] * v[1] - u[1] * v[0]) * roots.mean()


def random_mesh(n=60, seed=0):
    points = np.random.default_rng(seed).random((n, 2))
    triangles = Delaunay(points).simplices
    p = points[triangles]
    u, v = p[:, 1] - p[:, 0], p[:, 2] - p[:, 0]
    clockwise = u[:, 0] * v[:, 1] < u[:, 1] * v[:, 0]
    return points, np.where(clockwise[:, None], triangles[:, ::-1], triangles)


# --- lengths -----------------------------------------------------------------------------------


def test_length_in_a_constant_metric_is_that_of_the_form():
    m = np.array([[4.0, 1.0, 9.0]])
    points = np.random.default_rng(1).random((20, 2))
    edges = np.random.default_rng(2).integers(0, 20, (40, 2))
    e = points[edges[:, 1]] - points[edges[:, 0]]
    wanted = np.sqrt(4 * e[:, 0] ** 2 + 2 * e[:, 0] * e[:, 1] + 9 * e[:, 1] ** 2)
    got = edge_lengths(points, edges, lambda x: np.tile(m, (len(x), 1)))
    np.testing.assert_allclose(got, wanted, rtol=1e-13)


def test_length_of_a_linear_size_is_logarithmic():
    got = edge_lengths([[0, 0], [1, 0], [99, 0]], [[0, 1], [0, 2], [2, 1]], growing)
    np.testing.assert_allclose(got, np.log([2, 100, 50]), rtol=2e-4)


def test_length_across_a_jump_of_size():
    got = edge_lengths(SQUARE, [[0, 1]], lambda x: np.where(x[:, 0] < 0.3, 0.01, 1.0))
    assert got == pytest.approx(30.7, rel=3e-3)


def test_lengths_agree_with_brute_force():
    points, triangles = random_mesh()
    edges, _ = mesh_edges(triangles)
    wanted = [brute_length(wave, *points[edge]) for edge in edges]
    np.testing.assert_allclose(edge_lengths(points, edges, wave), wanted, rtol=1e-2)
    fine = edge_lengths(points, edges, wave, rtol=1e-6, max_depth=16)
    errors = np.abs(fine / wanted - 1)
    assert np.quantile(errors, 0.98) < 1e-5
    assert errors.max() < 1e-2  # two coarse sums may agree by chance, across a kink


@given(st.floats(0.1, 10), st.integers(0, 1000))
def test_length_is_symmetric_and_homogeneous(k, seed):
    points = np.random.default_rng(seed).random((2, 2))
    here, back = edge_lengths(points, [[0, 1], [1, 0]], wave)
    assert back == pytest.approx(here, rel=1e-9)
    finer = edge_lengths(points, [[0, 1]], as_control_space(wave).scaled(1 / k))
    assert finer == pytest.approx(k * here, rel=1e-9)


def test_many_edges_are_measured_in_blocks():
    edges = np.tile([[0, 1], [1, 2]], (50_000, 1))
    seen = []

    def watched(x):
        seen.append(len(x))
        return np.full(len(x), 0.5)

    np.testing.assert_allclose(edge_lengths(SQUARE, edges, watched), 2.0, rtol=1e-13)
    assert max(seen) < 500_000 and sum(seen) == 15 * len(edges)


# --- areas and qualities -----------------------------------------------------------------------


def test_area_in_a_constant_metric():
    got = metric_areas(SQUARE, [*TWO, [2, 1, 0]], 0.1)
    np.testing.assert_allclose(got, [50, 50, -50], rtol=1e-13)


@pytest.mark.slow
def test_areas_agree_with_brute_force():
    points, triangles = random_mesh()
    for field, rtol in ((growing, 1e-4), (wave, 2e-2)):
        wanted = np.array([brute_area(field, points[t]) for t in triangles])
        got = metric_areas(points, triangles, field)
        np.testing.assert_allclose(got, wanted, rtol=rtol)
        assert got.sum() == pytest.approx(wanted.sum(), rel=rtol / 4)


def test_quality_of_the_equilateral_triangle_is_one():
    for h in (0.01, 1.0, 7.0):
        assert qualities(EQUILATERAL, [[0, 1, 2]], h) == pytest.approx(1)
    assert qualities(EQUILATERAL, [[2, 1, 0]], 1.0) == pytest.approx(-1)
    right = qualities(SQUARE, TWO, 1.0)
    np.testing.assert_allclose(right, 4 * np.sqrt(3) * 0.5 / 4)


def test_quality_is_measured_in_the_metric():
    """The image of an equilateral triangle under M^(-1/2) is perfect."""
    m = np.array([[50.0, 30.0, 40.0]])
    points = EQUILATERAL @ tensor.unpack(tensor.power(m, -0.5))[0]
    field = as_control_space(lambda x: np.tile(m, (len(x), 1)))
    assert qualities(points, [[0, 1, 2]], field) == pytest.approx(1)
    np.testing.assert_allclose(edge_lengths(points, [[0, 1], [1, 2]], field), 1)


@given(st.integers(0, 10_000))
def test_quality_never_exceeds_one_in_a_constant_metric(seed):
    points, triangles = random_mesh(12, seed)
    q = qualities(points, triangles, lambda x: np.tile([9.0, -2.0, 1.0], (len(x), 1)))
    assert (q > 0).all() and (q <= 1 + 1e-12).all()


def test_known_lengths_are_used():
    points, triangles = random_mesh()
    lengths = edge_lengths(points, mesh_edges(triangles)[0], wave)
    got = qualities(points, triangles, wave, lengths=lengths)
    np.testing.assert_array_equal(got, qualities(points, triangles, wave))
    with pytest.raises(MetricError, match="lengths must have the shape"):
        qualities(points, triangles, wave, lengths=lengths[1:])


def test_mesh_edges():
    edges, sides = mesh_edges(TWO)
    np.testing.assert_array_equal(edges, [[0, 1], [0, 2], [0, 3], [1, 2], [2, 3]])
    np.testing.assert_array_equal(sides, [[3, 1, 0], [4, 2, 1]])


triples = st.lists(st.lists(st.integers(0, 9), min_size=3, max_size=3), max_size=30)


@given(triples, st.sampled_from([1, 3, 200_000_000]))
def test_mesh_edges_are_those_of_a_dictionary(triangles, step):
    t = step * np.array(triangles, np.int64).reshape(-1, 3)
    edges, sides = mesh_edges(t)
    ends = [[tuple(sorted((v[i - 2], v[i - 1]))) for i in range(3)] for v in t.tolist()]
    number = {edge: k for k, edge in enumerate(sorted({e for three in ends for e in three}))}
    assert [tuple(e) for e in edges.tolist()] == list(number)
    assert sides.tolist() == [[number[e] for e in three] for three in ends]
    assert edges.dtype == sides.dtype == np.int32


def test_mesh_edges_around_a_hub():
    spokes = np.random.default_rng(3).permutation(np.arange(1, 100))
    hub = np.stack([np.zeros(99, int), spokes, np.roll(spokes, -1)], axis=1)
    edges, sides = mesh_edges(hub)
    np.testing.assert_array_equal(edges[:99], [[0, k] for k in range(1, 100)])
    np.testing.assert_array_equal(edges[sides[:, 2], 1], spokes)


# --- complexity --------------------------------------------------------------------------------


def wall(x):
    """h across y = 0 grows from 1e-4 by 0.15 y, and is 0.1 along it."""
    h = 1e-4 + 0.15 * x[:, 1]
    return np.stack([np.full(len(x), 100.0), 0 * h, h**-2], 1)


def point_source(x):
    """h = 1e-4 + 0.2 r: four decades."""
    return 1e-4 + 0.2 * np.hypot(x[:, 0], x[:, 1])


def disc(x):
    """A jump of the size by 50."""
    return np.where(np.hypot(x[:, 0] - 0.45, x[:, 1] - 0.55) < 0.2, 0.002, 0.1)


def test_complexity_of_a_uniform_size_is_exact():
    got = complexity(SQUARE, TWO, 0.05)
    assert got.value == pytest.approx(400, rel=1e-12)
    assert got.error < 1e-9


def quarter_circle_source():
    """The integral of h^-2 over the unit square, by polar coordinates and a fine sum."""
    angle = (np.arange(20_000) + 0.5) / 20_000 * np.pi / 4
    k = 0.2 / np.cos(angle) / 1e-4
    inner = (np.log1p(k) - k / (1 + k)) / 0.2**2  # of r / (1e-4 + 0.2 r)^2 from 0 to 1 / cos
    return 2 * inner.mean() * np.pi / 4


@pytest.mark.fast_cases(5)
@pytest.mark.parametrize(
    ("field", "wanted"),
    [
        (growing, 0.5),
        (wall, 10 / 0.15 * np.log((1e-4 + 0.15) / 1e-4)),
        (point_source, quarter_circle_source()),
        (disc, np.pi * 0.04 * (500**2 - 100) + 100),
        (wave, None),
    ],
)
@pytest.mark.parametrize("fan", [False, True])
def test_complexity_from_two_triangles_or_a_thin_fan(field, wanted, fan):
    points, triangles = SQUARE, TWO
    if fan:  # thirty slivers from one corner
        t = np.linspace(0, 1, 16)[:, None]
        rim = np.concatenate([[1, 0] + t * [0, 1], ([1, 1] + t * [-1, 0])[1:]])
        points = np.concatenate([[[0.0, 0.0]], rim])
        k = np.arange(1, len(rim))
        triangles = np.stack([0 * k, k, k + 1], 1)
    if wanted is None:
        wanted = sum(brute_area(field, SQUARE[t], 600) for t in TWO)
    got = complexity(points, triangles, field)
    assert got.value == pytest.approx(wanted, rel=0.02)
    assert abs(got.value - wanted) <= got.error <= 0.01 * got.value
    assert got.evaluations <= (50_000 if fan else 30_000)
    fine = complexity(points, triangles, field, rtol=2e-4, max_evaluations=1_000_000)
    assert fine.value == pytest.approx(wanted, rel=2e-3)


def across_square(density, normal, offset, thin):
    """The integral over the unit square of a function of s = normal . x - offset, by panels.

    The chord of the square at s is linear between its corners; panels get finer towards s = 0.
    """
    s = SQUARE @ normal - offset
    graded = np.concatenate([[0], np.geomspace(1e-3 * thin, 2, 300)])
    ends = np.unique(np.clip(np.concatenate([s, graded, -graded]), s.min(), s.max()))
    x, w = np.polynomial.legendre.leggauss(10)
    middle, half = 0.5 * (ends[1:] + ends[:-1]), 0.5 * np.diff(ends)
    at = middle[:, None] + half[:, None] * x
    order = np.sort(s)  # the chord rises to the second corner, stays, and falls from the third
    rise = max(abs(normal).min(), 1e-15) * abs(normal).max()
    longest = 1 / abs(normal).max()
    chord = np.clip(np.minimum(at - order[0], order[3] - at) / rise, 0, longest)
    return (density(at) * chord * w * half[:, None]).sum()


@pytest.mark.fast_cases(2)
@pytest.mark.parametrize("thin", [0.1, 1e-2, 1e-3, 1e-4])
@pytest.mark.parametrize("kind", ["isotropic", "along it 0.2"])
def test_the_error_of_a_complexity_is_a_bound_for_layers_at_any_angle(thin, kind):
    rng = np.random.default_rng(int(1 / thin))
    met = []
    for angle in [0, np.pi / 4, np.pi / 2, *rng.uniform(0, np.pi, 5)]:
        for growth in (0.1, 0.3):
            normal = np.array([np.cos(angle), np.sin(angle)])
            offset = SQUARE.mean(axis=0) @ normal + rng.uniform(-0.4, 0.4)

            def density(s, growth=growth):
                h = thin + growth * np.abs(s)
                return 1 / (h * (h if kind == "isotropic" else np.maximum(h, 0.2)))

            def size(x, normal=normal, offset=offset, density=density):
                return density(x @ normal - offset) ** -0.5

            wanted = across_square(density, normal, offset, thin)
            got = complexity(SQUARE, TWO, size)
            assert abs(got.value - wanted) <= got.error, (angle, growth)
            met.append(got.error <= 0.01 * got.value)
            assert met[-1] or got.evaluations > 99_000
    assert all(met) or thin < 1e-2


def test_complexity_keeps_its_budget_and_says_so():
    calls = []

    def watched(x):
        calls.append(len(x))
        return disc(x)

    for budget in (0, 6000, 20_000):
        calls.clear()
        got = complexity(SQUARE, TWO, watched, rtol=0.0, max_evaluations=budget)
        assert got.evaluations == sum(calls) <= max(budget, 42)
        assert got.error > 0


def test_complexity_of_a_large_mesh_is_taken_once():
    points, triangles = random_mesh(2000)
    got = complexity(points, triangles, growing, max_evaluations=1000)
    assert got.evaluations == 21 * len(triangles)
    wanted = metric_areas(points, triangles, growing).sum()
    assert got.value == pytest.approx(wanted, rel=1e-6)


def test_complexity_of_nothing():
    assert complexity(np.empty((0, 2)), np.empty((0, 3), int), 0.1) == (0, 0, 0)


def test_complexity_of_a_polygon_by_a_signed_fan():
    """An L from one corner: clockwise triangles take away what is counted twice."""
    shape = np.array([[0, 0], [2, 0], [2, 1], [1, 1], [1, 2], [0, 2]], float)[[1, 2, 3, 4, 5, 0]]
    fan = [[0, k, k + 1] for k in range(1, 5)]
    assert complexity(shape, fan, 0.1).value == pytest.approx(300, rel=1e-9)


@pytest.mark.parametrize("function", [edge_lengths, metric_areas, qualities, complexity])
def test_measures_refuse_what_is_out_of_range_and_what_is_no_metric(function):
    items = [[0, 1]] if function is edge_lengths else TWO
    with pytest.raises(MetricError, match="out of range"):
        function(SQUARE, np.array(items) + 3, 0.1)
    with pytest.raises(MetricError, match=r"growing .* is not positive: h = "):
        function(SQUARE - [5, 0], items, growing)
