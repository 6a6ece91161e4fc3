"""Conservative transfer against exact arithmetic, and polynomials on pairs of meshes of every kind.

In the long lane, on 700 random pairs.
"""

from fractions import Fraction

import numpy as np
import pytest
from reference import supermesh
from reference.mesh_pairs import (
    HARD,
    KINDS,
    SAME_DOMAIN,
    hard_pair,
    moved_by_ulps,
    random_pair,
    refined,
)
from reference.transforms import TRANSFORMS, Transform

import adaptmesh as am
from adaptmesh import _core
from adaptmesh.transfer.spaces import Space

SEEDS = [range(1), pytest.param(range(1, 5), marks=pytest.mark.slow)]
SPACES = ("P0", "P1", "P2")


def _turned_thin(width, offset=(0.0, 0.0)):
    c, s = np.cos(0.4), np.sin(0.4)
    matrix = ((float(c), float(-s * width)), (float(s), float(c * width)))
    return Transform(f"{width:g} as wide, turned", matrix, offset)


THIN = [_turned_thin(width) for width in (1e-3, 1e-6, 1e-9, 1e-12)]
# Where arithmetic is exact, and slow: turned, turned and far from the origin, and thin.
FEW = [TRANSFORMS[1], TRANSFORMS[7], THIN[1]]


def carried(mesh, transform):
    return am.Mesh(transform(mesh.points), transform.triangles(mesh.triangles))


def integral(mesh, values, space):
    on_triangles = values[Space(mesh, space).nodes_of_triangles]
    return mesh.areas @ on_triangles[:, 3 if space == "P2" else 0 :].mean(axis=1)


class Polynomial:
    """A random polynomial of coordinates that are centred and scaled to the size of a mesh.

    Its values at midpoints are those at the exact midpoints: far from the origin, rounding moves
    them, and a polynomial of degree 2 sees that.
    """

    def __init__(self, mesh, degree, rng):
        self.degree, self.coefficients = degree, rng.normal(size=6)
        self.origin = mesh.points[0]
        self.size = np.abs(mesh.points - self.origin).max()

    def at_nodes(self, mesh):
        local = am.Mesh((mesh.points - self.origin) / self.size, mesh.triangles)
        x, y = Space(local, f"P{self.degree}").nodes.T
        terms = [np.ones_like(x), x, y, x * x, x * y, y * y][: (1, 3, 6)[self.degree]]
        return self.coefficients[: len(terms)] @ terms


# ---- Areas ----


def exact_area(corners):
    (ax, ay), (bx, by), (cx, cy) = [(Fraction(x), Fraction(y)) for x, y in corners.tolist()]
    return ((bx - ax) * (cy - ay) - (by - ay) * (cx - ax)) / 2


@pytest.mark.parametrize("transform", [*TRANSFORMS, *THIN], ids=str)
def test_areas_of_nearly_collinear_points_are_accurate(transform):
    rng = np.random.default_rng(0)
    a, b, t = rng.random((300, 2)), rng.random((300, 2)), rng.random((300, 1))
    corners = transform(np.stack([a, b, a + t * (b - a)], axis=1))
    corners += np.spacing(corners) * rng.integers(-2, 3, corners.shape)
    corners[:100, 2] = corners[:100, 0] * 0.5 + corners[:100, 1] * 0.5
    corners[100:110, 2] = corners[100:110, 1]
    areas = _core.triangle_areas(np.ascontiguousarray(corners.reshape(-1, 6)))
    for area, triangle in zip(areas, corners, strict=True):
        exact = exact_area(triangle)
        assert abs(Fraction(float(area)) - exact) <= abs(exact) * Fraction(1, 2**46)


@pytest.mark.parametrize("exponent", [-500, -300, 300, 500])
def test_areas_at_the_ends_of_the_range_of_numbers(exponent):
    rng = np.random.default_rng(1)
    a, b, t = rng.random((50, 2)), rng.random((50, 2)), rng.random((50, 1))
    corners = np.ldexp(np.stack([a, b, a + t * (b - a)], axis=1), exponent)
    areas = _core.triangle_areas(np.ascontiguousarray(corners.reshape(-1, 6)))
    for area, triangle in zip(areas, corners, strict=True):
        exact = exact_area(triangle)
        assert np.sign(area) == (exact > 0) - (exact < 0)
        if abs(exact) > Fraction(np.finfo(float).tiny):
            assert abs(Fraction(float(area)) - exact) <= abs(exact) * Fraction(1, 2**46)


@pytest.mark.parametrize("transform", THIN, ids=str)
def test_areas_of_meshes_of_thin_triangles(transform):
    mesh = carried(am.generate(am.Domain.rectangle(0, 0, 1, 1), 0.3), transform)
    for area, triangle in zip(mesh.areas, mesh.points[mesh.triangles], strict=True):
        assert area == pytest.approx(float(exact_area(triangle)), rel=1e-13)


# ---- Against exact arithmetic ----

TRIANGLE = am.Domain.polygon([(0, 0), (1, 0.1), (0.3, 0.9)])
INTERFACE = am.Domain(
    [(0, 0), (1, 0), (1, 1), (0, 1), (0.3, 0), (0.8, 1)],
    [(0, 4), (4, 1), (1, 2), (2, 5), (5, 3), (3, 0), (4, 5)],
)


def ring(n, turned=0.0):
    angles = turned + 2 * np.pi * np.arange(n) / n
    return am.Domain.polygon(np.stack([np.cos(angles), np.sin(angles)], axis=1))


def two_triangles():
    return am.Mesh(
        [(4.1, 5.3), (3.7, 0.1), (6.9, 4.4), (0.7, 1.9)], np.array([(0, 1, 2), (1, 0, 3)])
    )


def small_pairs():
    """Meshes of 2 to 20 triangles."""
    edge = two_triangles()
    return {
        "slanted border": (am.generate(TRIANGLE, 0.5), am.generate(TRIANGLE, 0.3)),
        "interface": (am.generate(INTERFACE, 0.9), am.generate(INTERFACE, 0.6)),
        "midpoints": (edge, None),
        "moved by ulps": (edge, moved_by_ulps(edge, np.random.default_rng(0))),
        "chords": (am.generate(ring(5), 2), am.generate(ring(6, 0.3), 2)),
    }


@pytest.fixture(scope="module")
def pairs():
    return small_pairs()


@pytest.mark.fast_cases(2)
@pytest.mark.parametrize("transform", FEW, ids=str)
@pytest.mark.parametrize("case", small_pairs(), ids=str)
@pytest.mark.parametrize("space", SPACES)
def test_projections_are_those_of_exact_arithmetic(pairs, case, transform, space):
    old, new = pairs[case]
    old = carried(old, transform)
    new = refined(old) if new is None else carried(new, transform)
    values = np.random.default_rng(2).random(Space(old, space).size)
    exact = supermesh.projection(
        values,
        (old.points, old.triangles),
        Space(old, space).nodes_of_triangles,
        (new.points, new.triangles),
        Space(new, space).nodes_of_triangles,
        int(space[1]),
    )
    moved = am.Overlay(old, new).project(values, space=space)
    np.testing.assert_allclose(moved, exact, rtol=0, atol=1e-13)


@pytest.mark.parametrize("transform", [*TRANSFORMS, *THIN], ids=str)
@pytest.mark.parametrize("case", small_pairs(), ids=str)
def test_common_areas_are_those_of_exact_arithmetic(pairs, case, transform):
    old, new = pairs[case]
    old = carried(old, transform)
    new = refined(old) if new is None else carried(new, transform)
    overlay = am.Overlay(old, new)
    found = dict(zip(map(tuple, overlay.pairs.tolist()), overlay.areas.tolist(), strict=True))
    exact = supermesh.common_areas((old.points, old.triangles), (new.points, new.triangles))
    for t, k in exact.keys() | found.keys():
        smaller = min(old.areas[t], new.areas[k])
        assert abs(found.get((t, k), 0) - float(exact.get((t, k), 0))) < 1e-14 * smaller


# ---- Polynomials and integrals, on many pairs ----


@pytest.mark.parametrize("transform", [*TRANSFORMS, *THIN], ids=str)
@pytest.mark.parametrize("kind", KINDS)
@pytest.mark.parametrize("seeds", SEEDS)
def test_polynomials_come_back(kind, transform, seeds):
    for seed in seeds:
        rng = np.random.default_rng([seed, KINDS.index(kind)])
        old, new = random_pair(rng, kind, lambda mesh: carried(mesh, transform))
        for space, degree in zip(SPACES, range(3), strict=True):
            polynomial = Polynomial(old, degree, rng)
            moved = am.transfer(
                polynomial.at_nodes(old), old, new, method="conservative", space=space
            )
            expected = polynomial.at_nodes(new)
            error = np.abs(moved - expected).max() / np.abs(expected).max()
            assert error < 1e-12, (seed, space)


@pytest.mark.parametrize("transform", TRANSFORMS[:6], ids=str)
@pytest.mark.parametrize("kind", HARD)
def test_polynomials_and_integrals_on_triangles_of_any_shape_and_size(kind, transform):
    """Thinner than coordinates are rounded, and areas that differ by 20 powers of ten and more."""
    for seed in range(3):
        rng = np.random.default_rng(seed)
        old, new = hard_pair(rng, kind, transform)
        overlay = am.Overlay(old, new)
        for space, degree in zip(SPACES, range(3), strict=True):
            polynomial = Polynomial(old, degree, rng)
            moved = overlay.project(polynomial.at_nodes(old), space=space)
            error = np.abs(moved - polynomial.at_nodes(new)).max() / np.abs(moved).max()
            assert error < 1e-12, (seed, space)
            values = rng.random(Space(old, space).size)
            kept = overlay.project(values, space=space, keep_bounds=True)
            before = integral(old, values, space)
            assert integral(new, kept, space) == pytest.approx(before, rel=1e-13)


def beyond(overlay):
    """The share of the domain that one of two meshes leaves out: rounding of slanted borders."""
    both = np.abs(overlay.lost).sum() + np.abs(overlay.uncovered).sum()
    return both / overlay.area


@pytest.mark.parametrize("transform", [*TRANSFORMS, *THIN[:2]], ids=str)
@pytest.mark.parametrize("kind", SAME_DOMAIN)
@pytest.mark.parametrize("seeds", SEEDS)
def test_integrals_and_bounds_are_kept(kind, transform, seeds):
    """The integral to 1e-13, and what rounding moved the border by."""
    for seed in seeds:
        rng = np.random.default_rng([seed, KINDS.index(kind)])
        old, new = random_pair(rng, kind, lambda mesh: carried(mesh, transform))
        overlay = am.Overlay(old, new)
        assert beyond(overlay) < 1e-6
        for space in SPACES:
            values = rng.random(Space(old, space).size)
            for keep_bounds in (False, True):
                moved = overlay.project(values, space=space, keep_bounds=keep_bounds)
                before = integral(old, values, space)
                change = abs(integral(new, moved, space) - before) / before
                assert change < 1e-13 + 3 * beyond(overlay), (seed, space)
            if space != "P2":  # a quadratic through values in [0, 1] leaves them in between
                assert moved.min() >= 0
                assert moved.max() <= 1
