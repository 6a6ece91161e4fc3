"""The 2x2 algebra in decimal arithmetic with 60 digits, for the very doubles given."""

from decimal import Decimal, getcontext

getcontext().prec = 60


def exact(packed):
    return [Decimal(float(v)) for v in packed]


def det(m):
    a, b, c = m
    return a * c - b * b


def reduced(s, t):
    """(low, high, factor): t relative to s, and the square of what belongs to high.

    s + (x - 1) * factor is s with the eigenvalue 1 along the eigenvector of high made x; with it,
    t = s + (high - 1) * factor + (low - 1) * (s - factor).
    """
    mixed = s[0] * t[2] + s[2] * t[0] - 2 * s[1] * t[1]
    trace, product = mixed / det(s), det(t) / det(s)
    root = max(trace * trace / 4 - product, Decimal(0)).sqrt()
    low, high = trace / 2 - root, trace / 2 + root
    if root == 0:
        return low, high, [Decimal(0)] * 3
    return low, high, [(y - low * x) / (high - low) for x, y in zip(s, t, strict=True)]


def intersection(s, t):
    low, high, factor = reduced(s, t)
    return combination(s, factor, max(low, 1), max(high, 1))


def union(s, t):
    low, high, factor = reduced(s, t)
    return combination(s, factor, min(low, 1), min(high, 1))


def combination(s, factor, at_low, at_high):
    pairs = zip(s, factor, strict=True)
    return [at_low * (x - f) + at_high * f for x, f in pairs]


def spectral(function, m):
    """A function of a symmetric matrix."""
    a, b, c = m
    mean, d = (a + c) / 2, (a - c) / 2
    r = (d * d + b * b).sqrt()
    low, high = function(mean - r), function(mean + r)
    slope = (high - low) / (2 * r) if r else Decimal(0)
    middle = (high + low) / 2
    return [middle + slope * d, slope * b, middle - slope * d]


def geometric_mean(s, t):
    root_s, root_t = det(s).sqrt(), det(t).sqrt()
    total = [x / root_s + y / root_t for x, y in zip(s, t, strict=True)]
    factor = (root_s * root_t / det(total)).sqrt()
    return [factor * x for x in total]


def hypot(s, t):
    """The root of the sum of the squares, by its eigenvalues."""
    squares = [[a * a + b * b, b * (a + c), b * b + c * c] for a, b, c in (s, t)]
    return spectral(_root, [x + y for x, y in zip(*squares, strict=True)])


def _root(x):
    return max(x, Decimal(0)).sqrt()


def length(m, x, y):
    return (m[0] * x * x + 2 * m[1] * x * y + m[2] * y * y).sqrt()
