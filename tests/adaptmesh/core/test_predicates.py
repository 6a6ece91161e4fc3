"""The predicates against exact oracles, where floating point is weakest."""

import itertools

import numpy as np
import pytest
from reference import exact

from adaptmesh import _core

CASES = 6000  # of each family: about 1e5 in all


def random(rng, n):
    return rng.uniform(-1, 1, (4, 2, n))


def integer_grid(rng, n):
    return rng.integers(-2, 3, (4, 2, n)).astype(float)


def tenth_grid(rng, n):
    return rng.integers(0, 5, (4, 2, n)) * 0.1


def tenth_grid_far_away(rng, n):
    return 1e6 + rng.integers(0, 5, (4, 2, n)) * 0.1


def nudged(rng, points):
    """Moves coordinates by up to two units in the last place, half of them not at all."""
    units = rng.integers(-2, 3, points.shape) * rng.integers(0, 2, points.shape)
    return points * (1 + units * 2.0**-52)


def collinear(rng, n):
    along, start, step = rng.uniform(-1, 1, (4, 1, n)), rng.random((2, n)), rng.random((2, n))
    return nudged(rng, start + along * step)


def cocircular(rng, n):
    angle = rng.uniform(0, 2 * np.pi, (4, n))
    return nudged(rng, np.stack([np.cos(angle), np.sin(angle)], axis=1))


def cocircular_far_away(rng, n):
    return nudged(rng, 1e6 + 1e-3 * cocircular(rng, n))


def cocircular_of_all_sizes(rng, n):
    return cocircular(rng, n) * 10 ** rng.uniform(-9, 9, n)


def squares(rng, n, bits):
    """Tilted squares of that many bits with integer corners, in any order, half of them broken."""
    centre, half = rng.integers(-(2**bits), 2**bits, (2, 2, n))
    turned = np.stack([-half[1], half[0]])
    corners = np.stack([centre + half, centre + turned, centre - half, centre - turned])
    corners[0, 0] += rng.integers(0, 2, n)
    order = np.argsort(rng.random((4, 1, n)), axis=0)
    return np.take_along_axis(corners, order, axis=0).astype(float)


def squares_of_about_12_bits(rng, n):
    """Where the few-bits stage of incircle ends."""
    return np.concatenate([squares(rng, n // 3, bits) for bits in (9, 10, 11)], axis=-1)


def squares_of_40_bits(rng, n):
    return squares(rng, n, 40)


def small_areas_of_about_26_bits(rng, n):
    """Where the few-bits stage of orient2d ends: the determinant of (k+i, k), (k, k-i) is -i^2."""
    k, cx, cy, dx, dy = rng.integers(0, 2 ** rng.integers(24, 29, n), (5, n))
    i = rng.integers(-2, 3, n)
    points = np.array([[cx + k + i, cy + k], [cx + k, cy + k - i], [cx, cy], [dx, dy]])
    return points.astype(float)


def multiples_of_a_point(rng, n):
    """Collinear, half of them exactly, with differences longer than a double."""
    points = np.ldexp(rng.random((2, n)), rng.integers(-40, 41, (4, 1, n)))
    return np.where(rng.integers(0, 2, n), points, nudged(rng, points))


def rectangles(rng, n):
    """Of a graded tensor grid, half of them with a corner moved by a unit in the last place."""
    (x0, x1), (y0, y1) = rng.random((2, 2, n))
    points = np.array([[x0, y0], [x1, y0], [x1, y1], [x0, y1]])
    points[rng.integers(0, 4), 0] *= 1 + rng.integers(0, 2, n) * 2.0**-52
    return points


def duplicates(rng, n):
    return np.take_along_axis(random(rng, n), rng.integers(0, 4, (4, 1, n)), axis=0)


def zeros(rng, n):
    return random(rng, n) * rng.integers(0, 2, (4, 2, n))


def grid_at_all_exponents(rng, n):
    """Integers times one power of two a case, from subnormal to nearly infinite."""
    return np.ldexp(integer_grid(rng, n), rng.integers(-1074, 1022, n))


def cocircular_at_all_exponents(rng, n):
    """Across the limits of all stages; results below the normal range are rounded."""
    return np.ldexp(cocircular(rng, n), rng.integers(-1074, 1023, n))


def all_exponents_mixed(rng, n):
    return rng.choice([-1.0, 1.0], (4, 2, n)) * 10 ** rng.uniform(-320, 300, (4, 2, n))


def diamonds_hardly_broken(rng, n):
    """(1, 0), (0, 1), (-1, 0), (0, -1) with zeros replaced by the tiniest numbers, times 2^k."""
    points = np.array([[1.0, 0], [0, 1], [-1, 0], [0, -1]])[:, :, np.newaxis].repeat(n, axis=2)
    tiny = rng.integers(-1, 2, (4, 2, n)) * 10 ** rng.uniform(-320, -10, (4, 2, n))
    return np.where(points == 0, tiny, np.ldexp(points, rng.integers(-3, 4, n)))


FAMILIES = [
    random,
    integer_grid,
    tenth_grid,
    tenth_grid_far_away,
    collinear,
    cocircular,
    cocircular_far_away,
    cocircular_of_all_sizes,
    squares_of_about_12_bits,
    squares_of_40_bits,
    small_areas_of_about_26_bits,
    multiples_of_a_point,
    rectangles,
    duplicates,
    zeros,
    grid_at_all_exponents,
    cocircular_at_all_exponents,
    all_exponents_mixed,
    diamonds_hardly_broken,
]


@pytest.fixture(params=FAMILIES, ids=lambda family: family.__name__)
def cases(request):
    """Points of many cases: (4, 2, number of cases)."""
    return request.param(np.random.default_rng(20260), CASES)


def core(predicate, points):
    """The predicate of the core, for points as the families have them."""
    return predicate(*(np.ascontiguousarray(p.T) for p in points))


def assert_same(found, expected, points):
    wrong = np.flatnonzero(found != expected)
    if wrong.size:
        k = wrong[0]
        pytest.fail(f"{wrong.size} wrong, first {found[k]} for {expected[k]}: {points[..., k]!r}")


def test_orient2d_is_exact(cases):
    expected = exact.sign(exact.orient2d(*exact.as_integers(cases[:3])))
    assert_same(core(_core.orient2d, cases[:3]), expected, cases)


def test_incircle_is_exact(cases):
    expected = exact.sign(exact.incircle(*exact.as_integers(cases)))
    assert_same(core(_core.incircle, cases), expected, cases)


def test_permutations_change_the_sign_with_their_parity(cases):
    cases = cases[..., :500]
    orientation, inside = core(_core.orient2d, cases[:3]), core(_core.incircle, cases)
    for order in itertools.permutations(range(4)):
        parity = round(np.linalg.det(np.eye(4)[list(order)]))
        permuted = cases[list(order)]
        assert_same(core(_core.incircle, permuted), parity * inside, permuted)
        if order[3] == 3:
            assert_same(core(_core.orient2d, permuted[:3]), parity * orientation, permuted)


def test_mirror_images_have_opposite_signs(cases):
    for image in (cases * [[-1.0], [1.0]], cases[:, ::-1]):
        assert_same(core(_core.orient2d, image[:3]), -core(_core.orient2d, cases[:3]), image)
        assert_same(core(_core.incircle, image), -core(_core.incircle, cases), image)


@pytest.mark.parametrize("exponent", [-900, -260, -230, -201, 199, 201, 260, 900])
def test_scaling_keeps_signs(exponent):
    """A power of two moves the case to another stage, not to another answer."""
    rng = np.random.default_rng(exponent + 1000)
    cases = np.concatenate([family(rng, 1000) for family in (tenth_grid, cocircular)], axis=-1)
    image = np.ldexp(cases, exponent)
    assert_same(core(_core.orient2d, image[:3]), core(_core.orient2d, cases[:3]), image)
    assert_same(core(_core.incircle, image), core(_core.incircle, cases), image)


def test_integer_oracle_agrees_with_fractions(cases):
    cases = cases[..., :60]
    integers, fractions = exact.as_integers(cases), exact.as_fractions(cases)
    for determinant, points in ((exact.orient2d, 3), (exact.incircle, 4)):
        from_integers = exact.sign(determinant(*integers[:points]))
        assert_same(from_integers, exact.sign(determinant(*fractions[:points])), cases)


def test_signs_mean_what_they_say():
    a, b, c = np.array([[0.0, 0], [1, 0], [0, 1]])[:, np.newaxis]
    assert _core.orient2d(a, b, c) == [1]
    assert _core.orient2d(a, c, b) == [-1]
    assert _core.orient2d(a, b, 3 * b) == [0]
    assert _core.incircle(a, b, c, np.array([[0.5, 0.5]])) == [1]
    assert _core.incircle(a, b, c, np.array([[2.0, 2.0]])) == [-1]
    assert _core.incircle(a, b, c, np.array([[1.0, 1.0]])) == [0]


def test_result_is_int8_of_the_same_length():
    for n in (0, 3):
        found = _core.incircle(*np.zeros((4, n, 2)))
        assert found.dtype == np.int8
        assert found.shape == (n,)


def test_lengths_must_agree():
    with pytest.raises(ValueError, match=r"c has 2 points but a has 3"):
        _core.orient2d(np.zeros((3, 2)), np.zeros((3, 2)), np.zeros((2, 2)))


@pytest.mark.parametrize("value", [np.nan, np.inf, -np.inf])
def test_coordinates_must_be_finite(value):
    points = np.zeros((4, 3, 2))
    points[1, 2, 0] = value
    with pytest.raises(ValueError, match=r"b\[2\] = .* is not finite"):
        _core.incircle(*points)
