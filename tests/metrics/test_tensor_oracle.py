"""The accuracy of the 2x2 algebra, over many cases, against decimal arithmetic with 60 digits.

Results are compared with those for the entries as stored, entry by entry relative to the largest.
That is what can be had at any condition number: the entries of a tensor with the ratio 1e6 of
sizes at 45 degrees do themselves hold the larger size to 1e-4 only, and so must results.
"""

from decimal import Decimal

import numpy as np
import pytest
from reference import tensor_oracle as oracle

from metrics import tensor

MANY = pytest.param(100_000, marks=pytest.mark.slow)
CONDITIONS = (1.001, 1e4, 1e12, 1e14)


def random_pair(n, condition, seed):
    """Two arrays of tensors, one in three with nearly the same axes."""
    rng = np.random.default_rng(seed)
    angle = rng.uniform(0, np.pi, n)
    turn = np.where(np.arange(n) % 3 == 0, 1e-7, 1) * rng.normal(size=n)

    def tensors(angle):
        low, high = np.sort(condition ** (0.5 * rng.uniform(-1, 1, (2, n))), axis=0)
        c, s = np.cos(angle), np.sin(angle)
        entries = [high * c * c + low * s * s, (high - low) * c * s, high * s * s + low * c * c]
        return np.stack(entries, axis=1)

    return tensors(angle), tensors(angle + turn)


def error(got, wanted):
    """Relative to the largest entry of each item."""
    return (np.abs(got - wanted).max(axis=1) / np.abs(wanted).max(axis=1)).max()


@pytest.mark.parametrize("n", [4000, MANY])
def test_reduction_intersection_and_union(n):
    parts = [random_pair(n // 4, condition, 1) for condition in CONDITIONS]
    s, t = (np.concatenate(part) for part in zip(*parts, strict=True))
    pairs = [(oracle.exact(a), oracle.exact(b)) for a, b in zip(s, t, strict=True)]
    inside = np.array([oracle.intersection(a, b) for a, b in pairs], float)
    around = np.array([oracle.union(a, b) for a, b in pairs], float)
    values = np.array([oracle.reduced(a, b)[:2] for a, b in pairs], float)
    assert error(tensor.intersect(s, t), inside) < 1e-14
    assert error(tensor.union(s, t), around) < 1e-14
    np.testing.assert_allclose(tensor.simultaneous_reduction(s, t)[0], values, rtol=1e-14)


@pytest.mark.parametrize("n", [2000, MANY])
def test_functions_of_one(n):
    m = np.concatenate([random_pair(n // 4, condition, 2)[0] for condition in CONDITIONS])
    items = [oracle.exact(a) for a in m]

    def wanted(function, items=items):
        return np.array([oracle.spectral(function, a) for a in items], float)

    logs = tensor.log(m)
    scale = np.maximum(np.abs(logs).max(axis=1), 1e-3)
    assert (np.abs(logs - wanted(Decimal.ln)).max(axis=1) / scale).max() < 1e-12
    assert error(tensor.exp(logs), wanted(Decimal.exp, [oracle.exact(a) for a in logs])) < 1e-13
    assert error(tensor.sqrt(m), wanted(Decimal.sqrt)) < 1e-14
    assert error(tensor.power(m, -1.0), wanted(lambda x: 1 / x)) < 1e-13
    np.testing.assert_allclose(
        tensor.det(m), np.array([oracle.det(a) for a in items], float), rtol=1e-14
    )
    values = np.array([_eigenvalues(a) for a in items], float)
    np.testing.assert_allclose(tensor.eigh(m)[0], values, rtol=1e-14)


@pytest.mark.parametrize("n", [2000, MANY])
def test_means_and_lengths(n):
    parts = [random_pair(n // 4, condition, 3) for condition in CONDITIONS]
    s, t = (np.concatenate(part) for part in zip(*parts, strict=True))
    x, y = np.random.default_rng(4).normal(size=(2, len(s)))
    pairs = [(oracle.exact(a), oracle.exact(b)) for a, b in zip(s, t, strict=True)]
    means = [oracle.geometric_mean(a, b) for a, b in pairs]
    assert error(tensor.geometric_mean(s, t), np.array(means, float)) < 1e-14
    assert (
        error(tensor.hypot(s, t), np.array([oracle.hypot(a, b) for a, b in pairs], float)) < 1e-14
    )
    wanted = [
        (oracle.length(a, u, v) + 4 * oracle.length(c, u, v) + oracle.length(b, u, v)) / 6
        for (a, b), c, u, v in zip(pairs, means, map(Decimal, x), map(Decimal, y), strict=True)
    ]
    got = tensor.lengths(s, t, np.stack([x, y], axis=1))
    np.testing.assert_allclose(got, np.array(wanted, float), rtol=1e-13)


@pytest.mark.parametrize("ratio", [1e3, 1e5, 1e6, 1e7, 5e7])
def test_means_of_a_tensor_with_itself_are_that_tensor(ratio):
    angle = np.linspace(0.01, 3.13, 200)
    c, s, low = np.cos(angle), np.sin(angle), ratio**-2.0
    m = np.stack([c * c + low * s * s, (1 - low) * c * s, s * s + low * c * c], axis=1)
    m = m[m[:, 0] * m[:, 2] - m[:, 1] ** 2 > 2**-52 * m[:, 0] * m[:, 2]]
    assert len(m) > 40
    for same in (tensor.geometric_mean, tensor.intersect, tensor.union):
        assert error(same(m, m), m) < 1e-15
    assert error(tensor.exp(tensor.log(m)), m) < 2e-14
    assert error(np.stack([tensor.mean([a, a]) for a in m]), m) < 2e-14
    assert error(tensor.power(m, 1.0), m) < 2e-15
    assert error(tensor.hypot(0.6 * m, 0.8 * m), m) < 2e-15


def test_what_is_accepted_is_never_refused_as_a_result():
    """At the very limit of definiteness, where rounding of a result could take it away."""
    rng = np.random.default_rng(5)
    angle, ratio = rng.uniform(0, np.pi, 100_000), 10 ** rng.uniform(6.5, 8.5, 100_000)
    c, s, low = np.cos(angle), np.sin(angle), ratio**-2
    m = np.stack([c * c + low * s * s, (1 - low) * c * s, s * s + low * c * c], axis=1)
    m = m[tensor._core.det(m) > 1.01 * 2**-53 * m[:, 0] * m[:, 2]]
    assert 50_000 < len(m) < 100_000
    assert error(tensor.exp(tensor.log(m)), m) < 1e-13
    inverse = np.stack([m[:, 2], -m[:, 1], m[:, 0]], axis=1) / tensor.det(m)[:, None]
    assert error(tensor.power(m, -1), inverse) < 1e-13
    assert error(tensor.sqrt(m), tensor.power(m, 0.5)) == 0
    assert error(tensor.limit(m, 0, np.inf, 1e9), m) < 2e-15


def _eigenvalues(m):
    mean, d = (m[0] + m[2]) / 2, (m[0] - m[2]) / 2
    r = (d * d + m[1] * m[1]).sqrt()
    return mean - r, mean + r
