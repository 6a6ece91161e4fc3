"""The laws of the 2x2 algebra, against slow oracles in decimal arithmetic and scipy."""

from decimal import Decimal

import numpy as np
import pytest
import scipy.linalg
from hypothesis import given, settings
from hypothesis import strategies as st
from reference import tensor_oracle as oracle

from metrics import MetricError, tensor


def from_axes(h1, h2, angle):
    """Packed tensors with the size h1 along the angle and h2 across."""
    l1, l2, c, s = 1 / h1**2, 1 / h2**2, np.cos(angle), np.sin(angle)
    return np.stack([l1 * c * c + l2 * s * s, (l1 - l2) * c * s, l1 * s * s + l2 * c * c], -1)


def random_tensors(n, condition, seed=0):
    rng = np.random.default_rng(seed)
    h = condition ** (0.25 * rng.uniform(-1, 1, (2, n)))
    return from_axes(h[0], h[1], rng.uniform(0, np.pi, n))


@st.composite
def tensors(draw, condition=1e6):
    exponent = 0.25 * np.log10(condition)
    h1, h2 = (10 ** draw(st.floats(-exponent, exponent)) for _ in range(2))
    return from_axes(h1, h2, draw(st.floats(0, np.pi)))[None]


def exact(function, packed):
    """A function of the very doubles given, by the spectral formula with 60 digits."""
    return np.array(oracle.spectral(function, oracle.exact(packed)), float)


def relative(got, wanted):
    return np.abs(got - wanted).max() / np.abs(wanted).max()


def smallest_eigenvalue(packed):
    return np.linalg.eigvalsh(tensor.unpack(packed))[:, 0]


# --- packing -----------------------------------------------------------------------------------


def test_pack_takes_sizes_packed_and_matrices():
    wanted = np.array([[4.0, 0.0, 4.0], [100.0, 0.0, 100.0]])
    np.testing.assert_allclose(tensor.pack([0.5, 0.1]), wanted)
    np.testing.assert_array_equal(tensor.pack(wanted), wanted)
    np.testing.assert_array_equal(tensor.pack(tensor.unpack(wanted)), wanted)
    assert tensor.pack(np.array([1, 2])).dtype == np.float64
    assert tensor.pack([]).shape == (0, 3)


def test_pack_gives_a_fresh_array_and_leaves_its_input():
    given = np.array([[4.0, 0.0, 4.0]])
    given.flags.writeable = False
    tensor.pack(given)[0, 0] = 7
    assert given[0, 0] == 4


@pytest.mark.parametrize("layout", ["F", "strided", "float32", "reversed", "big-endian"])
def test_pack_takes_any_memory_layout(layout):
    m = random_tensors(6, 100)
    other = {
        "F": np.asfortranarray(m),
        "strided": np.repeat(m, 2, axis=0)[::2],
        "float32": m.astype(np.float32),
        "reversed": m[::-1].copy()[::-1],
        "big-endian": m.astype(">f8"),
    }[layout]
    np.testing.assert_allclose(tensor.pack(other), m, rtol=1e-6)


@pytest.mark.parametrize(
    ("values", "message"),
    [
        (3.0, "one value for each point"),
        (np.ones((4, 1)), "drop the last axis"),
        (np.ones((4, 2)), "must be"),
        (np.ones((4, 3, 3)), "must be"),
        (np.ones(4) * 1j, "real numbers"),
        (np.ones(4, bool), "real numbers"),
        (["a", "b"], "real numbers"),
        (None, "real numbers"),
        ([[1.0], [1.0, 2.0]], "array of numbers"),
        ([1.0, np.nan], r"item 1 is not finite: nan"),
        ([1.0, 2.0, -0.5], r"item 2 is not positive: h = -0.5"),
        ([1.0, 0.0], "item 1 is not positive"),
        ([np.inf], "not finite"),
        ([1e-90], "out of range"),
        ([1e90], "out of range"),
        ([[1.0, 2.0, 1.0]], r"not positive definite.*eigenvalues -1 and 3"),
        ([[-1.0, 0.0, -1.0]], "not positive definite"),
        ([[1.0, 1.0, 1.0]], "singular to double precision"),
        ([[1.0, np.inf, 1.0]], "not finite"),
        ([[[1.0, 0.1], [0.2, 1.0]]], r"not symmetric.*\(M \+ M.T\) / 2"),
    ],
)
def test_pack_refuses(values, message):
    with pytest.raises(MetricError, match=message):
        tensor.pack(values)


def test_pack_refuses_masked_values_but_takes_a_masked_array_without_any():
    values = np.ma.masked_array([1.0, 2.0], mask=[False, True])
    with pytest.raises(MetricError, match="item 1 is not finite"):
        tensor.pack(values)
    assert tensor.pack(np.ma.masked_array([1.0, 2.0])).shape == (2, 3)


def test_pack_forgives_rounded_asymmetry():
    lower = np.array([[0.0, 0.0], [1.0, 0.0]])
    m = np.array([[[2.0, 1.0], [1.0, 2.0]]]) + 1e-13 * lower
    np.testing.assert_allclose(tensor.pack(m), [[2.0, 1.0, 2.0]])
    with pytest.raises(MetricError, match="not symmetric"):
        tensor.pack(m + 1e-6 * lower)
    assert tensor.pack((m + 1e-6 * lower).astype(np.float32)).shape == (1, 3)


def test_sizes_are_those_of_the_axes():
    m = from_axes(np.array([0.01, 3.0]), np.array([2.0, 0.5]), np.array([0.3, 1.2]))
    np.testing.assert_allclose(tensor.sizes(m), [[0.01, 2.0], [0.5, 3.0]], rtol=1e-10)


# --- functions of one tensor -------------------------------------------------------------------


@pytest.mark.parametrize("condition", [1.0001, 1e2, 1e8, 1e12])
def test_log_is_exact_for_the_entries_given(condition):
    m = random_tensors(300, condition)
    for got, packed in zip(tensor.log(m), m, strict=True):
        assert np.abs(got - exact(Decimal.ln, packed)).max() < 1e-12 * max(np.abs(got).max(), 1e-3)


def test_log_of_axis_aligned_tensors_keeps_all_digits():
    m = np.array([[1e24, 0.0, 1.0], [1.0, 0.0, 1e-24], [1e-30, 0.0, 1e30], [2.0, 0.0, 2.0]])
    wanted = np.stack([np.log(m[:, 0]), np.zeros(4), np.log(m[:, 2])], 1)
    np.testing.assert_allclose(tensor.log(m), wanted, rtol=1e-14, atol=1e-14)


@pytest.mark.parametrize("condition", [1.0001, 1e2, 1e8, 1e12])
def test_exp_and_sqrt_are_exact_for_the_entries_given(condition):
    m = random_tensors(100, condition, seed=1)
    for got, packed in zip(tensor.sqrt(m), m, strict=True):
        assert relative(got, exact(Decimal.sqrt, packed)) < 1e-14
    logs = tensor.log(m)
    for got, packed in zip(tensor.exp(logs), logs, strict=True):
        assert relative(got, exact(Decimal.exp, packed)) < 1e-13


@pytest.mark.parametrize("condition", [1.0001, 1e2, 1e8])
def test_exp_and_sqrt_agree_with_scipy(condition):
    """As far as scipy is right: its small eigenvalues are blurred by 1e-16 of the large ones."""
    m = random_tensors(30, condition, seed=2)
    logs = tensor.log(m)
    pairs = [
        (tensor.exp(logs), scipy.linalg.expm, logs, 1e-11),
        (tensor.sqrt(m), scipy.linalg.sqrtm, m, 1e-15 * np.sqrt(condition)),
    ]
    for got, function, given_, blur in pairs:
        for ours, packed in zip(tensor.unpack(got), tensor.unpack(given_), strict=True):
            assert relative(ours, np.real(function(packed))) < 1e-12 + blur


@pytest.mark.parametrize("r", [0.0, 1e-200, 1e-9, 0.29999, 0.3, 0.30001, 5.0, 30.0])
def test_exp_keeps_both_eigenvalues_along_the_axes(r):
    got = tensor.exp([[1 + r, 0.0, 1 - r], [1 - r, 0.0, 1 + r]])
    wanted = np.exp([[1 + r, -np.inf, 1 - r], [1 - r, -np.inf, 1 + r]])
    np.testing.assert_allclose(got, wanted, rtol=1e-13)


def test_exp_that_overflows_is_refused():
    with pytest.raises(MetricError, match="the exponential at item 1"):
        tensor.exp([[0.0, 0.0, 0.0], [2000.0, 0.0, 0.0]])


@given(tensors(1e12))
def test_log_and_exp_are_inverse(m):
    assert relative(tensor.exp(tensor.log(m)), m) < 1e-13


@given(tensors(1e3), st.floats(-2, 2), st.floats(-2, 2))
def test_powers_add_up(m, s, t):
    """M^s and M^t commute: their logs add up to that of M^(s + t)."""
    got = tensor.exp(s * tensor.log(m) + t * tensor.log(m))
    assert relative(tensor.power(m, s + t), got) < 1e-9


@pytest.mark.parametrize("condition", [1, 10, 1e8, 1e12])
def test_eigh_rebuilds_the_tensor(condition):
    m = random_tensors(200, condition, seed=3)
    values, vectors = tensor.eigh(m)
    assert (values[:, 0] <= values[:, 1]).all() and (values > 0).all()
    rebuilt = vectors * values[:, None, :] @ vectors.transpose(0, 2, 1)
    np.testing.assert_allclose(np.linalg.det(vectors), 1, rtol=1e-14)
    assert relative(rebuilt, tensor.unpack(m)) < 1e-14


def test_det_is_exact_where_products_cancel():
    a = 1 + 2.0**-26
    m = [[a, 1.0, 1.0]]
    np.testing.assert_array_equal(tensor.det(m), [2.0**-26])
    wanted = [Decimal(p[0]) * Decimal(p[2]) - Decimal(p[1]) ** 2 for p in random_tensors(50, 1e12)]
    np.testing.assert_allclose(
        tensor.det(random_tensors(50, 1e12)), np.array(wanted, float), rtol=1e-14
    )


def test_limit_brings_sizes_into_the_interval_and_keeps_axes():
    m = from_axes(np.array([0.01, 1.0]), np.array([2.0, 1.5]), 0.4)
    got = tensor.limit(m, 0.1, 1.7)
    np.testing.assert_allclose(got, from_axes(np.array([0.1, 1.0]), np.array([1.7, 1.5]), 0.4))
    np.testing.assert_array_equal(got[1], m[1])
    np.testing.assert_array_equal(tensor.limit(m), m)
    for bad in [(0.2, 0.1), (-1.0, 1.0), (0.0, 0.0), (np.nan, 1.0)]:
        with pytest.raises(MetricError, match="h_min"):
            tensor.limit(m, *bad)


def test_limit_lowers_the_larger_size_of_thin_ellipses():
    m = from_axes(np.array([0.01, 1.0]), np.array([2.0, 1.5]), 0.4)
    got = tensor.limit(m, max_anisotropy=10)
    np.testing.assert_allclose(got[0], from_axes(0.01, 0.1, 0.4))
    np.testing.assert_array_equal(got[1], m[1])
    np.testing.assert_allclose(tensor.sizes(tensor.limit(m, 0.05, 1, 4)), [[0.05, 0.2], [1, 1]])
    for bad in (0.5, np.nan, -3):
        with pytest.raises(MetricError, match="max_anisotropy"):
            tensor.limit(m, max_anisotropy=bad)


@given(tensors(1e10), st.floats(1e-3, 1), st.floats(1, 1e3), st.floats(1, 1e4))
def test_limits_hold_and_hold_again(m, h_min, h_max, ratio):
    got = tensor.limit(m, h_min, h_max, ratio)
    small, large = tensor.sizes(got)[0]
    assert h_min * (1 - 1e-9) <= small <= large <= h_max * (1 + 1e-6)
    assert large <= small * ratio * (1 + 1e-6)
    assert relative(tensor.limit(got, h_min, h_max, ratio), got) < 1e-9


# --- functions of several ----------------------------------------------------------------------


def test_mean_of_commuting_tensors_is_the_geometric_one():
    m = tensor.pack([0.01, 1.0])
    np.testing.assert_allclose(tensor.mean(m), tensor.pack([0.1])[0], rtol=1e-13)
    np.testing.assert_allclose(tensor.mean(m, [3.0, 1.0]), tensor.pack([10**-1.5])[0], rtol=1e-13)
    two = tensor.mean(m, [[1.0, 0.0], [1.0, 1.0]])
    np.testing.assert_allclose(two, tensor.pack([0.01, 0.1]), rtol=1e-13)


@pytest.mark.parametrize("weights", [[1.0], [1.0, -1.0], [0.0, 0.0], [np.nan, 1.0], 1.0])
def test_mean_refuses_weights(weights):
    with pytest.raises(MetricError, match="weights"):
        tensor.mean([0.1, 0.2], weights)


@given(tensors(), tensors())
def test_geometric_mean_is_the_midpoint_of_the_geodesic(s, t):
    """G solves G S^-1 G = T; here S^-1 is the adjugate of S over its determinant."""
    g = tensor.unpack(tensor.geometric_mean(s, t))[0]
    adjugate = np.array([[s[0, 2], -s[0, 1]], [-s[0, 1], s[0, 0]]])
    scale = np.abs(g).max() ** 2 * np.abs(adjugate).max()
    wanted = tensor.unpack(t)[0] * tensor.det(s)
    assert np.abs(g @ adjugate @ g - wanted).max() < 1e-9 * max(scale, np.abs(wanted).max())
    assert relative(tensor.geometric_mean(t, s), tensor.geometric_mean(s, t)) < 1e-12


@given(tensors(), tensors())
def test_intersection_is_commutative_and_never_coarser(s, t):
    both = tensor.intersect(s, t)
    assert relative(tensor.intersect(t, s), both) < 1e-9
    scale = np.abs(both).max()
    assert smallest_eigenvalue(both - s)[0] > -1e-12 * scale
    assert smallest_eigenvalue(both - t)[0] > -1e-12 * scale


@pytest.mark.parametrize("condition", [2, 1e2, 1e4])
def test_intersection_is_the_simultaneous_reduction(condition):
    """Against the generalised eigenproblem t v = l s v, with v' s v = 1."""
    first, second = random_tensors(100, condition, seed=6), random_tensors(100, condition, seed=7)
    got = tensor.unpack(tensor.intersect(first, second))
    pairs = zip(tensor.unpack(first), tensor.unpack(second), strict=True)
    for k, (s, t) in enumerate(pairs):
        values, vectors = scipy.linalg.eigh(t, s)
        inverse = vectors.T @ s
        wanted = inverse.T * np.maximum(values, 1) @ inverse
        assert relative(got[k], wanted) < 1e-15 * condition**1.5 + 1e-13


@given(tensors())
def test_intersection_is_idempotent_and_absorbs(m):
    np.testing.assert_array_equal(tensor.intersect(m, m), m)
    np.testing.assert_array_equal(tensor.intersect(m, 2 * m), 2 * m)
    np.testing.assert_array_equal(tensor.intersect(2 * m, m), 2 * m)
    assert relative(tensor.intersect(m, m * (1 + 1e-15)), m) < 1e-14


def test_intersection_of_crossed_layers_keeps_the_thin_size_of_each():
    s, t = from_axes(1e-3, 1.0, 0.0)[None], from_axes(1e-3, 1.0, np.pi / 2)[None]
    np.testing.assert_allclose(tensor.sizes(tensor.intersect(s, t)), [[1e-3, 1e-3]], rtol=1e-12)


@given(tensors(), tensors())
def test_union_is_commutative_and_never_finer(s, t):
    both = tensor.union(s, t)
    scale = np.abs(s).max() + np.abs(t).max()
    assert relative(tensor.union(t, s), both) < 1e-9
    assert smallest_eigenvalue(s - both)[0] > -1e-12 * scale
    assert smallest_eigenvalue(t - both)[0] > -1e-12 * scale


@given(tensors(), tensors())
def test_union_and_intersection_add_up(s, t):
    both = tensor.union(s, t) + tensor.intersect(s, t)
    assert np.abs(both - (s + t)).max() < 1e-13 * np.abs(s + t).max()


@given(tensors(1e4), tensors(1e4))
def test_union_is_dual_to_intersection(s, t):
    def inverse(m):
        return tensor.power(m, -1)

    dual = inverse(tensor.intersect(inverse(s), inverse(t)))
    assert relative(tensor.union(s, t), dual) < 1e-7


@given(tensors())
def test_union_is_idempotent_and_absorbs(m):
    np.testing.assert_array_equal(tensor.union(m, m), m)
    np.testing.assert_array_equal(tensor.union(m, 2 * m), m)
    np.testing.assert_array_equal(tensor.union(2 * m, m), m)
    np.testing.assert_array_equal(tensor.intersect(m, tensor.union(m, 2 * m)), m)


@given(tensors(1e4), tensors(1e4), st.floats(-2, 2), st.floats(-2, 2), st.floats(-2, 2))
def test_intersection_and_union_go_along_with_linear_maps(s, t, a, b, c):
    """Of all ellipses inside, the largest: that does not depend on coordinates."""
    g = np.array([[1.0, a], [0.0, 1.0]]) @ np.array([[1.0, 0.0], [b, 1.0]]) * np.exp(c)

    def mapped(m):
        return tensor.pack((lambda x: 0.5 * (x + x.T))(g.T @ tensor.unpack(m)[0] @ g)[None])

    for function in (tensor.intersect, tensor.union):
        got, wanted = function(mapped(s), mapped(t)), mapped(function(s, t))
        assert relative(got, wanted) < 1e-7


def test_intersection_is_the_largest_ellipse_inside_and_union_the_smallest_around():
    """Against ellipses at random that lie inside, or around, both."""
    rng = np.random.default_rng(11)
    s, t = random_tensors(200, 100, seed=8), random_tensors(200, 100, seed=9)
    inside, around = tensor.intersect(s, t), tensor.union(s, t)
    angles = np.linspace(0, np.pi, 721)
    e = np.stack([np.cos(angles), np.sin(angles)], 1)

    def squares(m):
        return np.einsum("ki,nij,kj->nk", e, tensor.unpack(m), e)

    for _ in range(20):
        other = random_tensors(200, 1e4, seed=rng.integers(1 << 30))
        q, lower, upper = squares(other), squares(s), squares(t)
        largest = other * (np.maximum(lower, upper) / q).max(1)[:, None]
        smallest = other * (np.minimum(lower, upper) / q).min(1)[:, None]
        assert (tensor.det(largest) >= tensor.det(inside) * (1 - 1e-3)).all()
        assert (tensor.det(smallest) <= tensor.det(around) * (1 + 1e-3)).all()


@pytest.mark.parametrize("condition", [1.001, 1e3, 1e10])
def test_simultaneous_reduction_makes_identity_and_diagonal(condition):
    s, t = random_tensors(200, condition, seed=12), random_tensors(200, condition, seed=13)
    values, p = tensor.simultaneous_reduction(s, t)
    assert (values[:, 0] > 0).all() and (values[:, 0] <= values[:, 1]).all()
    for k in range(200):
        # Backward: what P makes of both is right up to a small change of their entries.
        inverse = np.linalg.inv(p[k])
        first = inverse.T @ inverse
        second = inverse.T * values[k] @ inverse
        assert relative(first, tensor.unpack(s)[k]) < 1e-14
        assert relative(second, tensor.unpack(t)[k]) < 1e-14


def test_simultaneous_reduction_agrees_with_scipy():
    s, t = random_tensors(50, 1e3, seed=14), random_tensors(50, 1e3, seed=15)
    values, p = tensor.simultaneous_reduction(s, t)
    for k in range(50):
        wanted, vectors = scipy.linalg.eigh(tensor.unpack(t)[k], tensor.unpack(s)[k])
        np.testing.assert_allclose(values[k], wanted, rtol=1e-9)
        signs = np.sign((p[k] * vectors).sum(0))
        np.testing.assert_allclose(p[k] * signs, vectors, rtol=1e-8, atol=1e-8 * abs(vectors).max())


@given(tensors(), tensors(), st.floats(-3, 3), st.floats(-3, 3), st.floats(0.1, 10))
def test_length_is_symmetric_homogeneous_and_between_the_ends(s, t, dx, dy, k):
    def length(a, b, e):
        return tensor.lengths(a, b, e)[0]

    e = np.array([[dx, dy]])
    here = length(s, t, e)
    assert length(t, s, -e) == pytest.approx(here, rel=1e-12)
    assert length(s, t, k * e) == pytest.approx(k * here, rel=1e-12)
    assert length(k * k * s, k * k * t, e) == pytest.approx(k * here, rel=1e-12)
    assert length(s, s, e) == pytest.approx(np.sqrt(e[0] @ tensor.unpack(s)[0] @ e[0]), rel=1e-9)
    ends = [length(s, s, e), length(t, t, e)]
    assert here <= max(ends) * (1 + 1e-9)  # the geometric mean is below the arithmetic one


def test_length_of_a_geometric_size_is_nearly_the_logarithmic_one():
    for a, b, error in [(1.0, 2.0, 1e-4), (1.0, 4.0, 2e-3)]:
        got = tensor.lengths([1 / a], [1 / b], [[1.0, 0.0]])[0]
        assert got == pytest.approx((b - a) / np.log(b / a), rel=error)


def test_pairs_must_match():
    for function in (tensor.intersect, tensor.union, tensor.geometric_mean):
        with pytest.raises(MetricError, match="both sides, got 1 and 2"):
            function([0.1], [0.1, 0.2])
    with pytest.raises(MetricError, match=r"edges must have the shape \(1, 2\)"):
        tensor.lengths([0.1], [0.1], [1.0, 0.0])


@settings(max_examples=30)
@given(st.integers(-60, 60))
def test_everything_scales(exponent):
    """No hidden absolute tolerance: tensors times a power of four give the same bits, scaled."""
    k = 4.0**exponent
    s, t = random_tensors(20, 1e4, seed=4), random_tensors(20, 1e4, seed=5)
    np.testing.assert_array_equal(tensor.intersect(k * s, k * t), k * tensor.intersect(s, t))
    wanted = k * tensor.geometric_mean(s, t)
    np.testing.assert_array_equal(tensor.geometric_mean(k * s, k * t), wanted)


def test_voigt_order_is_asked_for_by_name():
    voigt = np.array([[4.0, 9.0, 1.0]])  # xx, yy, xy
    assert np.array_equal(tensor.pack(voigt, order="voigt"), [[4.0, 1.0, 9.0]])
    with pytest.raises(MetricError, match=r"order='voigt'"):
        tensor.pack(voigt)
    with pytest.raises(ValueError, match="order='xyz'"):
        tensor.pack(voigt, order="xyz")
