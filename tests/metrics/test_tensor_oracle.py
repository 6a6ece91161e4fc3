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
CONDITIONS = (1.001, 1e4, 1e12)


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


@pytest.mark.parametrize("n", [3000, MANY])
def test_reduction_intersection_and_union(n):
    parts = [random_pair(n // 3, condition, 1) for condition in CONDITIONS]
    s, t = (np.concatenate(part) for part in zip(*parts, strict=True))
    pairs = [(oracle.exact(a), oracle.exact(b)) for a, b in zip(s, t, strict=True)]
    inside = np.array([oracle.intersection(a, b) for a, b in pairs], float)
    around = np.array([oracle.union(a, b) for a, b in pairs], float)
    values = np.array([oracle.reduced(a, b)[:2] for a, b in pairs], float)
    assert error(tensor.intersect(s, t), inside) < 1e-14
    assert error(tensor.union(s, t), around) < 1e-14
    np.testing.assert_allclose(tensor.simultaneous_reduction(s, t)[0], values, rtol=1e-14)


@pytest.mark.parametrize("n", [1500, MANY])
def test_functions_of_one(n):
    m = np.concatenate([random_pair(n // 3, condition, 2)[0] for condition in CONDITIONS])
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


def _eigenvalues(m):
    mean, d = (m[0] + m[2]) / 2, (m[0] - m[2]) / 2
    r = (d * d + m[1] * m[1]).sqrt()
    return mean - r, mean + r
