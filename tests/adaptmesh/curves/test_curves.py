"""The curve classes: where they are, where they go, and what is refused."""

import numpy as np
import pytest
from numpy.testing import assert_allclose

from adaptmesh import DomainError
from adaptmesh.curves import (
    Arc,
    Bezier,
    BSpline,
    Circle,
    EllipticArc,
    Line,
    Parametric,
    Polyline,
    Spline,
)

QUARTER_AS_NURBS = BSpline(
    [(1, 0), (1, 1), (0, 1)], degree=2, knots=[0, 0, 0, 1, 1, 1], weights=[1, np.sqrt(0.5), 1]
)
ZIGZAG = [(0, 0), (1, 0.2), (2, -0.3), (3, 0.1), (2.5, 2)]

CURVES = {
    "line": Line((1, 2), (3, -1)),
    "polyline": Polyline(ZIGZAG),
    "ring": Polyline(ZIGZAG, closed=True),
    "arc": Arc((1, 1), 2, 0.3, -2),
    "arc through": Arc.through((0, 0), (1, 1), (3, 0)),
    "circle": Circle((1e3, 1), 2),
    "elliptic": EllipticArc((1, 0), (3, 0.5), 0.7, 1, 5),
    "ellipse": EllipticArc((1, 0), (3, 0.5), 0.7),
    "cubic Bezier": Bezier([(0, 0), (1, 2), (3, 2), (4, 0)]),
    "spline": Spline(ZIGZAG),
    "closed spline": Spline(ZIGZAG, closed=True),
    "B-spline": BSpline(ZIGZAG),
    "closed B-spline": BSpline(ZIGZAG, closed=True),
    "NURBS": QUARTER_AS_NURBS,
    "parametric": Parametric(lambda t: np.stack([t, np.sin(6 * t)], axis=1)),
    "part": Circle((0, 0), 1).part(0.7, 0.2),
}
each = pytest.mark.parametrize("curve", CURVES.values(), ids=CURVES)


@each
def test_derivative_is_that_of_the_points(curve):
    t = np.linspace(0.013, 0.9871, 60)
    step = 1e-5
    by_differences = (curve.point(t + step) - curve.point(t - step)) / (2 * step)
    size = np.abs(by_differences).max()
    assert_allclose(curve.derivative(t), by_differences, atol=2e-6 * size)


@each
def test_reversed_is_the_same_backwards(curve):
    t = np.linspace(0, 1, 33)
    back = curve.reversed()
    assert_allclose(back.point(1 - t), curve.point(t), atol=1e-12)
    assert_allclose(back.start, curve.end, atol=1e-12)
    assert_allclose(back.end, curve.start, atol=1e-12)
    assert back.is_closed == curve.is_closed
    assert_allclose(back.breaks, np.sort(1 - curve.breaks))


@each
def test_closed_curves_and_only_these_end_where_they_begin(curve):
    first, last = curve.point([0, 1])
    assert_allclose(curve.end, last, atol=1e-9)
    assert curve.is_closed == (np.hypot(*(first - last)) < 1e-9)


@pytest.mark.parametrize("name", ["arc", "circle", "arc through", "NURBS"])
def test_circular_arcs_keep_their_distance(name):
    curve = CURVES[name]
    p = curve.point(np.linspace(0, 1, 99))
    centre, radius = ((0, 0), 1) if name == "NURBS" else (curve.centre, curve.radius)
    assert_allclose(np.hypot(*(p - centre).T), radius, rtol=1e-12)


def test_arc_through_three_points_passes_them_in_order():
    for b in [(0.4, 0.9), (0.3, -0.2)]:
        arc = Arc.through((0, 0), b, (1, 0))
        p = arc.point(np.linspace(0, 1, 2001))
        assert_allclose(p[[0, -1]], [(0, 0), (1, 0)], atol=1e-15)
        assert np.hypot(*(p - b).T).min() < 1e-3


def test_ellipse_satisfies_its_equation():
    x, y = (CURVES["elliptic"].point(np.linspace(0, 1, 99)) - (1, 0)).T
    c, s = np.cos(0.7), np.sin(0.7)
    assert_allclose(((c * x + s * y) / 3) ** 2 + ((c * y - s * x) / 0.5) ** 2, 1)


def test_bezier_by_the_bernstein_polynomials():
    t = np.linspace(0, 1, 9)
    p = np.array([(0, 0), (1, 2), (3, 2), (4, 0)])
    weights = np.stack([(1 - t) ** 3, 3 * t * (1 - t) ** 2, 3 * t**2 * (1 - t), t**3], axis=1)
    assert_allclose(Bezier(p).point(t), weights @ p, atol=1e-15)


@pytest.mark.parametrize("closed", [False, True])
def test_splines_pass_through_their_points_smoothly(closed):
    spline = Spline(ZIGZAG, closed=closed)
    lengths = np.hypot(*np.diff(spline.points, axis=0).T)
    t = np.concatenate([[0], np.cumsum(lengths)]) / lengths.sum()
    assert_allclose(spline.point(np.minimum(t, 1)), spline.points, atol=1e-14)
    if closed:
        assert_allclose(*spline.derivative([0, 1]), atol=1e-12)


def test_closed_b_spline_closes_smoothly():
    curve = CURVES["closed B-spline"]
    assert_allclose(*curve.point([0, 1]), atol=1e-15)
    assert_allclose(*curve.derivative([0, 1]), atol=1e-12)


def test_b_spline_of_degree_one_is_a_polyline():
    curve = BSpline(ZIGZAG, degree=1)
    assert_allclose(curve.breaks, [0.25, 0.5, 0.75])
    assert_allclose(curve.point(curve.breaks), ZIGZAG[1:-1])


def test_b_spline_has_kinks_at_knots_as_many_as_its_degree():
    knots = [2, 2, 2, 3, 3, 4, 6, 6, 6]
    curve = BSpline([(0, 0), (1, 1), (2, 0), (3, 1), (4, 0), (5, 1)], degree=2, knots=knots)
    assert_allclose(curve.breaks, [0.25])


@pytest.mark.parametrize("n", [2, 3, 7, 10, 49, 1000])
def test_points_of_a_polyline_are_met_exactly(n):
    p = np.random.default_rng(n).random((n, 2))
    line = Polyline(p)
    assert (line.point([0, *line.breaks, 1]) == p).all()


def test_part_of_a_part():
    part = Circle((0, 0), 1).part(0.75, 0.25).part(0.5, 1)
    assert_allclose(part.point([0, 1]), [(-1, 0), (0, 1)], atol=1e-15)
    assert not part.is_closed


def test_scalars_and_empty_arrays():
    for curve in CURVES.values():
        assert curve.point(0.5).shape == (1, 2)
        assert curve.point(np.empty(0)).shape == (0, 2)


def broken(t):
    return np.stack([t, np.where(t == 0.5, np.nan, t)], axis=1)


@pytest.mark.parametrize(
    ("make", "says"),
    [
        (lambda: Line((1, 2), (1, 2)), r"points 0 and 1 are the same, \(1, 2\)"),
        (lambda: Line((1, 2), (1, np.inf)), "finite"),
        (lambda: Line((1, 2, 3), (1, 0, 0)), "two finite numbers"),
        (lambda: Polyline([(0, 0), (1, 0), (1, 0), (2, 0)]), r"points 1 and 2 .*\(1, 0\)"),
        (lambda: Polyline([(0, 0), (1, np.nan)]), "point 1"),
        (lambda: Polyline([(0, 0), (1, 1)], closed=True), "expected at least 3 points, got 2"),
        (lambda: Polyline([0, 1, 2]), r"shape \(3,\)"),
        (lambda: Polyline("points"), "numbers"),
        (lambda: Arc((0, 0), 0, 0, 1), "expected positive radii, got 0"),
        (lambda: Arc((0, 0), -1, 0, 1), "got -1"),
        (lambda: Arc((0, 0), np.nan, 0, 1), "finite"),
        (lambda: Arc((0, 0), 1, 1, 1), "expected a turn between 0 and 2 pi .* got 0"),
        (lambda: Arc((0, 0), 1, 0, 10), "expected a turn .* got 10"),
        (lambda: Arc((0, 0), 1, 0, np.nan), "angles"),
        (lambda: Arc.through((0, 0), (1, 1), (2, 2)), "use a Line"),
        (lambda: Arc.through((0, 0), (1, 1), (0, 0)), "use a Line"),
        (lambda: EllipticArc((0, 0), (1, 0)), "positive radii, got 0"),
        (lambda: Bezier([(0, 0)]), "expected at least 2 points, got 1"),
        (lambda: Bezier([(1, 1), (1, 1), (1, 1)]), "all the same"),
        (lambda: Spline([(0, 0), (1, 0), (1, 0)]), "points 1 and 2"),
        (lambda: BSpline([(0, 0), (1, 1)]), "got degree 3 and 2 points"),
        (
            lambda: BSpline(ZIGZAG, knots=[0, 1]),
            "expected 9 knots for degree 3 and 5 points, got 2",
        ),
        (lambda: BSpline(ZIGZAG, knots=[0, 0, 0, 0, 2, 1, 1, 1, 1]), "ascending after knot 4"),
        (lambda: BSpline(ZIGZAG, weights=[1, 1, 0, 1, 1]), "positive"),
        (lambda: BSpline(ZIGZAG, closed=True, knots=range(9)), "equidistant"),
        (
            lambda: Parametric(broken),
            r"broken: expected a finite point at t = 0.5, got \(0.5, nan\)",
        ),
        (lambda: Parametric(lambda t: t), r"got \(65,\)"),
        (lambda: Parametric(lambda t: np.zeros((len(t), 2))), "no length"),
        (lambda: Parametric(lambda t: np.stack([t, t], 1), closed=True), "its end is 1.41421 away"),
        (
            lambda: Parametric(lambda t: np.stack([t, t], 1), lambda t: t),
            "expected its derivative to return",
        ),
        (lambda: Parametric(lambda t: np.stack([t, t], 1), breaks=[1.5]), "breaks"),
        (lambda: Circle((0, 0), 1e80), "another unit of length"),
        (lambda: Line((0, 0), (1, 0)).part(0.5, 0.5), "two different parameters"),
        (lambda: Line((0, 0), (1, 0)).part(0.5, 1.5), "two different parameters"),
    ],
)
def test_what_is_no_curve_is_refused(make, says):
    with pytest.raises(DomainError, match=says):
        make()


def test_arrays_handed_in_stay_as_they_are():
    p = np.array(ZIGZAG)
    line = Polyline(p)
    p[0] = 7
    assert (line.start == ZIGZAG[0]).all()
    with pytest.raises(ValueError, match="read-only"):
        line.points[0] = 7
