"""Conservative transfer without rounding: every old triangle cut by every new one, in fractions.

Slow and obvious, for meshes of a few triangles. Meshes are (points, triangles) of float arrays; a
field is a list of values in the order of `adaptmesh.spaces`, and so are moments and results.
"""

from fractions import Fraction

import numpy as np

# The closed rule of Newton and Cotes that is exact for polynomials of degree 4: where, in quarters
# of barycentric coordinates, and weights.
_FORTY_FIFTHS = {(3, 1, 0): 4, (2, 2, 0): -1, (2, 1, 1): 8}
RULE = [
    ([Fraction(n, 4) for n in at], Fraction(weight, 45))
    for kind, weight in _FORTY_FIFTHS.items()
    for at in sorted(
        {tuple(kind[i] for i in order) for order in np.ndindex(3, 3, 3) if len(set(order)) == 3}
    )
]


def cross(a, b, c):
    """Twice the area of abc."""
    return (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0])


def corners_of(points, triangles):
    """The corners of each triangle, as pairs of fractions."""
    exact = [(Fraction(x), Fraction(y)) for x, y in np.asarray(points, float).tolist()]
    return [[exact[v] for v in triangle] for triangle in np.asarray(triangles).tolist()]


def clipped(polygon, a, b):
    """What of a convex polygon lies left of the line from a to b."""
    out = []
    for p, q in zip(polygon, polygon[1:] + polygon[:1], strict=True):
        at_p, at_q = cross(a, b, p), cross(a, b, q)
        if at_p >= 0:
            out.append(p)
        if at_p * at_q < 0:
            t = at_p / (at_p - at_q)
            out.append((p[0] + t * (q[0] - p[0]), p[1] + t * (q[1] - p[1])))
    return out


def pieces(first, second):
    """The common part of two triangles, as triangles."""
    part = first
    for i in range(3):
        part = clipped(part, second[i], second[(i + 1) % 3])
        if len(part) < 3:
            return []
    fan = [(part[0], part[k], part[k + 1]) for k in range(1, len(part) - 1)]
    return [piece for piece in fan if cross(*piece) != 0]


def weights(triangle, p):
    """Barycentric coordinates."""
    whole = cross(*triangle)
    return [cross(triangle[(i + 1) % 3], triangle[(i + 2) % 3], p) / whole for i in range(3)]


def basis(degree, w):
    """The Lagrange basis: vertices, then midpoints of the edges opposite them."""
    if degree == 0:
        return [Fraction(1)]
    if degree == 1:
        return w
    middle = [4 * w[(i + 1) % 3] * w[(i + 2) % 3] for i in range(3)]
    return [x * (2 * x - 1) for x in w] + middle


def points_of_rule(triangle):
    """Points and weights of the rule, times the area."""
    area = cross(*triangle) / 2
    for at, weight in RULE:
        p = tuple(sum(at[i] * triangle[i][k] for i in range(3)) for k in range(2))
        yield p, area * weight


def solve(matrix, right):
    """Gaussian elimination of a positive definite matrix."""
    rows = [[*row, value] for row, value in zip(matrix, right, strict=True)]
    for k, pivot in enumerate(rows):
        for i, row in enumerate(rows):
            if i != k and row[k] != 0:
                factor = row[k] / pivot[k]
                rows[i] = [x - factor * y for x, y in zip(row, pivot, strict=True)]
    return [row[-1] / row[k] for k, row in enumerate(rows)]


def mass(triangle, degree):
    """The mass matrix of a triangle."""
    return _products(triangle, [triangle], degree)


def _products(triangle, parts, degree):
    count = (1, 3, 6)[degree]
    out = [[Fraction(0)] * count for _ in range(count)]
    for part in parts:
        for p, weight in points_of_rule(part):
            phi = basis(degree, weights(triangle, p))
            for i in range(count):
                for j in range(count):
                    out[i][j] += weight * phi[i] * phi[j]
    return out


def common_areas(old, new):
    """The area of the common part of each old and new triangle that overlap, by (old, new)."""
    areas = {}
    for t, T in enumerate(corners_of(*old)):
        for k, K in enumerate(corners_of(*new)):
            area = sum((cross(*piece) for piece in pieces(T, K)), Fraction(0)) / 2
            if area:
                areas[t, k] = area
    return areas


def projection(values, old, old_nodes, new, new_nodes, degree):
    """The L2 projection of a field, which is extended from the part of a new triangle covered.

    old_nodes, new_nodes: the nodes of each triangle. At least half of each new triangle must be
    covered. Only the last system of equations, which is well conditioned, is solved in doubles.
    """
    field = [Fraction(float(value)) for value in values]
    older = corners_of(*old)
    size = int(np.max(new_nodes)) + 1
    matrix, right = np.zeros((size, size)), np.zeros(size)
    for k, K in enumerate(corners_of(*new)):
        nodes = np.asarray(new_nodes)[k].tolist()
        moments, covered = [Fraction(0)] * len(nodes), []
        for t, T in enumerate(older):
            parts = pieces(T, K)
            covered += parts
            local = [field[node] for node in np.asarray(old_nodes)[t].tolist()]
            for part in parts:
                for p, weight in points_of_rule(part):
                    shape = basis(degree, weights(T, p))
                    u = sum(a * b for a, b in zip(shape, local, strict=True))
                    for i, phi in enumerate(basis(degree, weights(K, p))):
                        moments[i] += weight * phi * u
        whole = mass(K, degree)
        assert 2 * sum(cross(*part) for part in covered) >= cross(*K)
        extended = solve(_products(K, covered, degree), moments)
        for i, node in enumerate(nodes):
            right[node] += float(sum(a * b for a, b in zip(whole[i], extended, strict=True)))
            for j, other in enumerate(nodes):
                matrix[node, other] += float(whole[i][j])
    scale = 1 / np.sqrt(matrix.diagonal())
    return scale * np.linalg.solve(scale[:, None] * matrix * scale, scale * right)
