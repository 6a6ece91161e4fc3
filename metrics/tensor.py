"""2x2 symmetric positive definite algebra on packed arrays.

A packed array is ``(n, 3)``: the entries m11, m12, m22 of n tensors. A tensor M asks for steps e
with ``e @ M @ e == 1``: an ellipse of half axes (sizes) ``h = 1 / sqrt(eigenvalue)``.

Every function is vectorised and compiled, takes anything that `pack` takes, returns new arrays
and raises `MetricError`, naming the first offending item, for input that is not positive definite.

What a double can hold. The rounding of three entries blurs the larger size of a thin ellipse at a
general angle: with r the ratio of the two sizes, by r² 2^-54 of itself, which is 1e-8 for r = 1e4,
6e-5 for 1e6, and all of it for 2^27 = 1.3e8. Along the axes any ratio is held. `pack` refuses what
is not positive definite by 2^-53 of the product of its diagonal: r above 6.7e7 at 45 degrees, and
sooner or later for others; keep it below 1e7 (see `limit`).

All closed forms of this module hold nearly all digits for the entries as stored, at any angle: the
sizes, determinants, logarithms and lengths they give are exact to about 1e-14, and the entries of
the tensors they give to about 1e-14 of the largest entry, which is as well as they can be stored.
What goes in and comes out at the limit is raised by so little that it is not refused.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike

import metrics._core as _core

from .checks import as_numbers
from .errors import MetricError
from .packing import as_packed, pack, unpack
from .types import Floats

__all__ = [
    "det",
    "eigh",
    "exp",
    "geometric_mean",
    "hypot",
    "intersect",
    "lengths",
    "limit",
    "log",
    "mean",
    "pack",
    "power",
    "simultaneous_reduction",
    "sizes",
    "sqrt",
    "union",
    "unpack",
]


def sizes(tensors: ArrayLike) -> Floats:
    """The two sizes of each tensor, (n, 2), the smaller first.

    Examples
    --------
    >>> from metrics.tensor import sizes
    >>> sizes([[100.0, 0.0, 4.0]])
    array([[0.1, 0.5]])
    """
    values, _ = _core.spectra(pack(tensors))
    return 1 / np.sqrt(values[:, ::-1])


def det(tensors: ArrayLike) -> Floats:
    """Determinants, (n,)."""
    return _core.det(pack(tensors))


def eigh(tensors: ArrayLike) -> tuple[Floats, Floats]:
    """Eigenvalues and eigenvectors, laid out as by `numpy.linalg.eigh`.

    Returns
    -------
    values : (n, 2) array of float
        Ascending.
    vectors : (n, 2, 2) array of float
        ``vectors[i, :, k]`` is the unit eigenvector of ``values[i, k]``; a rotation.
    """
    values, high = _core.spectra(pack(tensors))
    x, y = high.T
    vectors = np.stack([y, x, -x, y], axis=1).reshape(-1, 2, 2)
    return values, vectors


def log(tensors: ArrayLike) -> Floats:
    """Matrix logarithms, packed (n, 3): symmetric, no longer definite."""
    return _core.log(pack(tensors))


def exp(logs: ArrayLike) -> Floats:
    """Matrix exponentials of packed symmetric (n, 3) tensors: positive definite.

    Raises
    ------
    MetricError
        If an exponential is not finite, or not positive to double precision.
    """
    return pack(_core.exp(as_packed(logs)), what="the exponential")


def power(tensors: ArrayLike, exponent: float) -> Floats:
    """The tensors to any real power, packed (n, 3)."""
    return pack(_core.power(pack(tensors), float(exponent)), what="the power")


def sqrt(tensors: ArrayLike) -> Floats:
    """Positive definite square roots, packed (n, 3)."""
    return power(tensors, 0.5)


def mean(tensors: ArrayLike, weights: ArrayLike | None = None) -> Floats:
    """Log-Euclidean mean of n tensors: the exponential of the weighted mean of the logarithms.

    Parameters
    ----------
    tensors : array_like
        What `pack` takes, n at least 1.
    weights : (n,) or (k, n) array_like, optional
        Not negative, and not all zero; equal if not given. Each row gives one mean.

    Returns
    -------
    (3,) or (k, 3) array of float

    References
    ----------
    Arsigny, Fillard, Pennec, Ayache: Log-Euclidean metrics for fast and simple calculus on
    diffusion tensors. Magnetic Resonance in Medicine 56 (2006).
    """
    logs = log(tensors)
    w = as_numbers(np.ones(len(logs)) if weights is None else weights, "weights").astype(np.float64)
    if w.ndim not in (1, 2) or w.shape[-1] != len(logs):
        raise MetricError(f"weights must have the shape ({len(logs)},) or (k, {len(logs)})")
    total = w.sum(axis=-1, keepdims=True)
    if not np.isfinite(w).all() or (w < 0).any() or (total <= 0).any():
        raise MetricError("weights must be finite, not negative, and not all zero")
    shape = (*w.shape[:-1], 3)
    return exp(np.atleast_2d((w / total) @ logs)).reshape(shape)


def geometric_mean(first: ArrayLike, second: ArrayLike) -> Floats:
    """Geometric means A#B of two packed arrays, (n, 3); ``(AB)^(1/2)`` where A and B commute.

    In two dimensions it is closed: with the square roots a, b of the determinants and
    ``G = A / a + B / b``, it is ``sqrt(a b / det G) G``.

    References
    ----------
    Bhatia: Positive definite matrices. Princeton University Press (2007), proposition 4.1.12.
    """
    return _core.geometric_mean(*_pair(first, second))


def hypot(first: ArrayLike, second: ArrayLike) -> Floats:
    """``sqrt(A @ A + B @ B)`` of symmetric tensors of any signs, packed (n, 3); not below zero.

    How a field of several components is curved in all: with the Hessians H_c of its components,
    S = sqrt(sum of H_c²) turns with the axes of the plane, does not change when the components are
    those along other axes, and for one component is its absolute value. It is associative, and
    bounds the curvature of what is seen of the field along any unit vector v: with
    K = sum of v_c H_c, K² is not above S², so that abs(K) is not above S, as the square root is
    monotone for matrices (Löwner and Heinz).

    Parameters
    ----------
    first, second : (n, 3) array_like
        Packed, finite.

    Examples
    --------
    >>> from metrics.tensor import hypot
    >>> hypot([[3.0, 0.0, 1.0]], [[4.0, 0.0, 0.0]])
    array([[5., 0., 1.]])
    """
    s, t = as_packed(first), as_packed(second)
    if len(s) != len(t):
        raise MetricError(f"expected as many tensors on both sides, got {len(s)} and {len(t)}")
    return _core.hypot(s, t)


def intersect(first: ArrayLike, second: ArrayLike) -> Floats:
    """Intersections of two packed arrays, (n, 3): no step is longer than either allows.

    The largest ellipse inside both. By simultaneous reduction: in the basis where one tensor is
    the identity and the other diagonal, the larger of each pair of eigenvalues. Commutative, but
    not associative. Tensors that differ by no more than rounding (4e-16 of their trace) count as
    equal.

    References
    ----------
    Alauzet, Frey: Estimateur d'erreur géométrique et métriques anisotropes pour l'adaptation de
    maillage. INRIA report 4759 (2003).
    """
    return _core.intersect(*_pair(first, second))


def union(first: ArrayLike, second: ArrayLike) -> Floats:
    """Unions of two packed arrays, (n, 3): every step is as long as either allows.

    The smallest ellipse around both; in the basis of `simultaneous_reduction` the smaller of each
    pair of eigenvalues. Dual to `intersect`: the inverse of the intersection of the inverses; and
    intersection and union add up to the sum of the two. Commutative, but not associative.
    """
    return _core.unite(*_pair(first, second))


def simultaneous_reduction(first: ArrayLike, second: ArrayLike) -> tuple[Floats, Floats]:
    """The basis in which the first tensor is the identity and the second diagonal.

    Returns
    -------
    values : (n, 2) array of float
        The second relative to the first, ascending: its squared length where the first has 1.
    vectors : (n, 2, 2) array of float
        As by ``scipy.linalg.eigh(second, first)``: with P = ``vectors[i]``,
        ``P.T @ first @ P`` is the identity and ``P.T @ second @ P`` is diagonal, `values`.

    Examples
    --------
    >>> from metrics.tensor import simultaneous_reduction
    >>> values, vectors = simultaneous_reduction([[1.0, 0.0, 4.0]], [[9.0, 0.0, 1.0]])
    >>> values
    array([[0.25, 9.  ]])
    """
    values, vectors = _core.reduce(*_pair(first, second))
    return values, vectors.reshape(-1, 2, 2)


def lengths(at_start: ArrayLike, at_end: ArrayLike, edges: ArrayLike) -> Floats:
    """Lengths of edges between two tensors, as the mesher measures them.

    Simpson's rule, with the geometric mean of the two tensors half way. (The mesher sums the same
    terms in a quicker order, which loses digits above a ratio of sizes of 1e6.) Exact lengths in a
    field that is known everywhere: `metrics.edge_lengths`.

    Parameters
    ----------
    at_start, at_end : array_like
        The tensors at the two ends of each edge; what `pack` takes.
    edges : (n, 2) array_like
        The vectors from start to end.

    Returns
    -------
    (n,) array of float
    """
    start, end = _pair(at_start, at_end)
    vectors = np.ascontiguousarray(as_numbers(edges, "edges"), np.float64)
    if vectors.shape != (len(start), 2):
        raise MetricError(f"edges must have the shape ({len(start)}, 2), not {vectors.shape}")
    return _core.lengths(start, end, vectors)


def limit(
    tensors: ArrayLike,
    h_min: float = 0.0,
    h_max: float = np.inf,
    max_anisotropy: float = np.inf,
) -> Floats:
    """Tensors of the same axes within limits, packed (n, 3).

    First both sizes are brought into [h_min, h_max], then the larger is lowered to `max_anisotropy`
    times the smaller.
    """
    check_limits(h_min, h_max, max_anisotropy)
    high = float(h_min) ** -2 if h_min > 0 else np.inf
    out = _core.limited(pack(tensors), float(h_max) ** -2, high, float(max_anisotropy) ** 2)
    return pack(out, what="the limited metric")


def check_limits(h_min: float, h_max: float, max_anisotropy: float) -> None:
    """Raise for invalid bounds on sizes, or on their ratio."""
    if not 0 <= h_min <= h_max or h_max == 0:
        raise MetricError(f"0 <= h_min <= h_max and 0 < h_max are needed, not {h_min}, {h_max}")
    if not max_anisotropy >= 1:
        raise MetricError(f"max_anisotropy is a ratio of sizes, at least 1, not {max_anisotropy}")


def _pair(first: ArrayLike, second: ArrayLike) -> tuple[Floats, Floats]:
    s, t = pack(first), pack(second)
    if len(s) != len(t):
        raise MetricError(f"expected as many tensors on both sides, got {len(s)} and {len(t)}")
    return s, t
