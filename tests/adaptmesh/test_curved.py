"""Domains of curves: corners and joints, what is enclosed, what is refused, and their meshes."""

import numpy as np
import pytest

import adaptmesh as am
from adaptmesh import Domain, DomainError
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


def box(x0, y0, x1, y1):
    c = [(x0, y0), (x1, y0), (x1, y1), (x0, y1)]
    return [Line(c[i], c[(i + 1) % 4]) for i in range(4)]


def aerofoil(n=60):
    x = 0.5 * (1 - np.cos(np.linspace(0, np.pi, n)))
    powers = x[:, None] ** [0.5, 1, 2, 3, 4]
    y = 0.6 * powers @ [0.2969, -0.126, -0.3516, 0.2843, -0.1036]
    y[-1] = 0
    return np.concatenate([np.stack([x, y], 1)[::-1], np.stack([x, -y], 1)[1:]])


def sine(t):
    return np.stack([4 * t, 1 + 0.3 * np.sin(4 * np.pi * t)], axis=1)


def spiral(t):
    a, r = 4 * np.pi * t, 0.1 + 0.8 * t
    return np.stack([r * np.cos(a), r * np.sin(a)], axis=1)


def parabola(factor):
    return Parametric(lambda t: np.stack([t, factor * t**2], axis=1))


def figure_eight(t):
    return np.stack([np.sin(2 * np.pi * t), np.sin(4 * np.pi * t)], axis=1)


def kinked(t):
    return np.stack([2 * t - 1, np.abs(2 * t - 1.1)], axis=1)


DISC = Domain.from_curves([Circle((0, 0), 1)], names={"rim": [0]})


def vertices(domain):
    return domain.points[domain.curved.is_vertex]


# ------------------------------------------------------------------------------------------ joining


def test_smooth_joints_are_no_vertices_and_corners_are():
    stadium = [
        Line((0, 0), (2, 0)),
        Arc((2, 1), 1, -np.pi / 2, np.pi / 2),
        Line((2, 2), (0, 2)),
        Arc((0, 1), 1, np.pi / 2, 3 * np.pi / 2),
    ]
    domain = Domain.from_curves(stadium)
    assert len(vertices(domain)) == 1  # a closed line begins somewhere
    assert [len(run.parts) for run in domain.curved.runs] == [4]
    assert len(vertices(Domain.from_curves(stadium, names={"bottom": [0]}))) == 2
    assert len(vertices(Domain.from_curves([*stadium, Line((2, 0), (1, 1))]))) == 2
    assert domain.area == pytest.approx(4 + np.pi, rel=1e-14)


@pytest.mark.parametrize(("angle", "expected"), [(50, 3), (70, 1)])
def test_corners_by_angle(angle, expected):
    """Three arcs of 60 degrees, like a Reuleaux triangle that bulges less: 60 degrees between."""
    corners = [np.array([np.cos(a), np.sin(a)]) for a in np.radians([90, 210, 330])]
    arcs = []
    for i in range(3):
        a, b = corners[i], corners[(i + 1) % 3]
        middle = 0.5 * (a + b)
        bulge = np.hypot(*(b - a)) / 2 * np.tan(np.radians(30) / 2)
        arcs.append(Arc.through(a, middle * (1 + bulge / np.hypot(*middle)), b))
    assert len(vertices(Domain.from_curves(arcs, corner_angle=angle))) == expected


def test_curves_may_come_in_any_order_and_direction():
    quarter = [Arc((0, 0), 1, k * np.pi / 2, (k + 1) * np.pi / 2) for k in range(4)]
    shuffled = [quarter[2].reversed(), quarter[0], quarter[3], quarter[1].reversed()]
    domain = Domain.from_curves(shuffled)
    assert domain.area == pytest.approx(np.pi, rel=1e-14)
    assert [len(run.parts) for run in domain.curved.runs] == [4]


def test_ends_join_within_the_tolerance_only():
    gap = [Line((0, 0), (1, 0)), Line((1, 1e-6), (0, 1)), Line((0, 1), (0, 0))]
    with pytest.raises(DomainError, match="not closed"):
        Domain.from_curves(gap)
    domain = Domain.from_curves(gap, join_tolerance=1e-5)
    assert len(domain.points) == 3
    assert domain.area == pytest.approx(0.5, abs=1e-5)


def test_breaks_stay_vertices():
    ring = Polyline([(0, 0), (1, 0), (1.05, 0.5), (1, 1), (0, 1)], closed=True)
    assert len(vertices(Domain.from_curves([ring]))) == 5
    given = Parametric(kinked, breaks=[0.55])
    domain = Domain.from_curves([given, Line((1, 0.9), (-1, 1.1))])
    assert (np.hypot(*(vertices(domain) - (0.1, 0)).T) < 1e-15).sum() == 1


def test_a_curve_may_end_on_a_straight_line_exactly():
    domain = Domain.from_curves(
        [*box(0, 0, 4, 2), Parametric(sine)],
        names={"interface": [4], "left": [3]},
        regions={"low": (2, 0.1), "high": (2, 1.9)},
    )
    assert domain.area == pytest.approx(8, rel=1e-12)
    assert (domain.segment_tags == domain.names["left"]).sum() == 2
    assert set(domain.triangle_regions) == {1, 2}


# ------------------------------------------------------------------------------------------- areas


@pytest.mark.parametrize(
    ("curves", "area"),
    [
        ([Circle((3, 1), 2)], 4 * np.pi),
        ([EllipticArc((1, 1), (3, 0.2), 0.3)], 0.6 * np.pi),
        ([Circle((0, 0), 2), Circle((0.5, 0), 1)], 3 * np.pi),
        ([*box(0, 0, 4, 2), Circle((1, 1), 0.5)], 8 - 0.25 * np.pi),
        ([parabola(1), Line((0, 0), (1, 0)), Line((1, 0), (1, 1))], 1 / 3),
        ([Bezier([(0, 0), (0, 1), (1, 1), (1, 0)]), Line((0, 0), (1, 0))], 0.6),
        ([BSpline([(1, 0), (1, 1), (0, 1)], 2, None, [1, np.sqrt(0.5), 1]), Line((0, 1), (0, 0)),
          Line((0, 0), (1, 0))], np.pi / 4),
    ],
)  # fmt: skip
def test_area_is_that_between_the_true_curves(curves, area):
    assert Domain.from_curves(curves).area == pytest.approx(area, rel=1e-10)


# ------------------------------------------------------------------------------------------ meshes

CASES = {
    "disc": (lambda: DISC, 0.15),
    "aerofoil": (
        lambda: Domain.from_curves([*box(-1, -1, 2, 1), Spline(aerofoil())], names={"wing": [4]}),
        lambda x: 0.02 + 0.2 * np.hypot(np.maximum(0, np.abs(x[:, 0] - 0.5) - 0.5), x[:, 1]),
    ),
    "plate with holes": (
        lambda: Domain.from_curves(
            [*box(0, 0, 4, 2), Circle((1, 1), 0.4), EllipticArc((2.8, 1), (0.7, 0.25), 0.5)]
        ),
        0.2,
    ),
    "two regions": (
        lambda: Domain.from_curves(
            [*box(0, 0, 4, 2), Parametric(sine)],
            names={"interface": [4]},
            regions={"low": (2, 0.1), "high": (2, 1.9)},
        ),
        0.2,
    ),
    "dangling spiral": (
        lambda: Domain.from_curves([Circle((0, 0), 1.2), Parametric(spiral)], names={"s": [1]}),
        0.12,
    ),
    "disc of two halves": (
        lambda: Domain.from_curves(
            [Arc((0, 0), 1, 0, np.pi), Arc((0, 0), 1, np.pi, 2 * np.pi), Line((-1, 0), (1, 0))],
            names={"top": [0], "bottom": [1]},
            regions={"north": (0, 0.5), "south": (0, -0.5)},
        ),
        0.2,
    ),
    "slanted": (
        lambda: Domain.from_curves([Circle((0, 0), 1), EllipticArc((0.2, 0), (0.5, 0.2), 0.5)]),
        lambda x: np.tile([[5012.5, 4987.5, 5012.5]], (len(x), 1)),
    ),
    # coarser than the curves allow: chords are added
    "disc in six": (lambda: DISC, 10.0),
    "thin annulus": (lambda: Domain.from_curves([Circle((0, 0), 1), Circle((0, 0), 0.999)]), 0.3),
    "hole in a bulge": (
        lambda: Domain.from_curves([Circle((0, 0), 1), Circle((0.97, 0.1), 0.01)]),
        1.0,
    ),
    "two arcs a hair apart": (
        lambda: Domain.from_curves(
            [*box(-2, -2, 2, 2), Arc((0, 0), 1, 0, 3), Arc((0, 0), 1.001, 0, 3)]
        ),
        0.5,
    ),
    "lens": (
        lambda: Domain.from_curves(
            [Arc.through((-1, 0), (0, 0.1), (1, 0)), Arc.through((-1, 0), (0, -0.1), (1, 0))]
        ),
        10.0,
    ),
    "cusp": (
        lambda: Domain.from_curves([parabola(2), parabola(1), Line((1, 2), (1, 1))]),
        0.2,
    ),
    "tangent circles": (lambda: Domain.from_curves([Circle((0, 0), 2), Circle((1, 0), 1)]), 0.3),
    "tiny": (lambda: Domain.from_curves([Circle((0, 0), 1e-6), Circle((0, 0), 5e-7)]), 2e-7),
    "huge": (lambda: Domain.from_curves([Circle((1e6, 0), 1e6), Circle((1e6, 0), 5e5)]), 2e5),
    "far off": (lambda: Domain.from_curves([Circle((1e6, 1e6), 1), Circle((1e6, 1e6), 0.5)]), 0.2),
}


@pytest.mark.parametrize("name", CASES)
def test_meshes_are_valid_on_their_curves(name):
    make, size = CASES[name]
    mesh = am.generate(make(), size)
    mesh.validate().raise_if_invalid()
    assert mesh.validate()["curves present"].ok


def test_vertices_are_on_the_circle_to_rounding():
    mesh = am.generate(DISC, 0.05)
    radii = np.hypot(*mesh.points[np.unique(mesh.edges)].T)
    assert np.abs(radii - 1).max() < 4e-16
    n = len(mesh.edges)
    assert n == 126  # 2 pi / 0.05
    assert mesh.areas.sum() == pytest.approx(n / 2 * np.sin(2 * np.pi / n), rel=1e-13)


def test_seeds_and_points_between_chord_and_curve_are_minded():
    near = (0.9999, 0.0001)
    domain = Domain.from_curves([Circle((0, 0), 1)], regions={"all": near}, points=[(0, 0.999)])
    mesh = am.generate(domain, 1.0)
    mesh.validate().raise_if_invalid()
    assert (mesh.regions == 1).all()
    assert (mesh.points == (0, 0.999)).all(axis=1).any()


def test_prediction_holds_for_curved_domains():
    mesh = am.generate(DISC, 0.05)
    assert am.predict(DISC, 0.05) == pytest.approx(len(mesh.points), rel=0.05)


def test_too_large_a_boundary_is_refused():
    with pytest.raises(am.BudgetError):
        am.generate(DISC, 1e-6, max_vertices=1000)


# ----------------------------------------------------------------------------------------- refused


@pytest.mark.parametrize(
    ("curves", "says"),
    [
        ([], "no curves"),
        ([[(0, 0), (1, 0)]], "curve 0 is a list"),
        ([Arc((0, 0), 1, 0, 6)], r"not closed.* point 0 \(1, 0\)|not closed.* point 1 "),
        ([Circle((0, 0), 2), Circle((1, 0), 1.5)], r"curve 1 .* and curve 0 .*\(1.375\d*, 1.452"),
        ([Circle((0, 0), 1), Circle((0, 0), 1)], "curve 0 .* and curve 1"),
        ([Circle((0, 0), 1), Line((0, 0), (np.cos(1), np.sin(1)))], r"\(0.5403\d*, 0.8414"),
        ([Spline([(0, 0), (1, 1), (1, 0), (0, 1)], closed=True)], r"curve 0 .* itself at \(0.[45]"),
        ([Parametric(figure_eight, closed=True)], "curve 0 .*figure_eight.* itself"),
        ([Parametric(kinked), Line((1, 0.9), (-1, 1.1))], r"kink at \(0.1"),
        ([*box(0, 0, 1, 1), Line((0, 0), (1, 1)), Line((1, 0), (0, 1))], "curve 4 .* curve 5"),
        ([*box(0, 0, 1, 1), Circle((3, 3), 1).part(0, 0.5)], "not closed|outside"),
    ],
)  # fmt: skip
def test_refused_with_the_place(curves, says):
    with pytest.raises(DomainError, match=says):
        Domain.from_curves(curves)


@pytest.mark.parametrize(
    ("options", "says"),
    [
        ({"names": {"a": [1]}}, "curve 1, but the curves are numbered 0 to 0"),
        ({"names": {"a": [0], "b": [0]}}, "curve 0 is named both 'a' and 'b'"),
        ({"holes": "odd"}, "nesting"),
        ({"holes": [(5, 5)]}, "hole 0"),
        ({"regions": {"a": (5, 5)}}, "region 'a'"),
        ({"points": [(5, 5)]}, r"\(5, 5\)"),
        ({"points": [(1, 0)]}, r"\(1, 0\)"),
        ({"corner_angle": -1}, "corner_angle"),
        ({"corner_angle": np.nan}, "corner_angle"),
        ({"join_tolerance": 7}, "join_tolerance"),
        ({"join_tolerance": np.nan}, "join_tolerance"),
    ],
)
def test_wrong_options(options, says):
    with pytest.raises(DomainError, match=says):
        Domain.from_curves([Circle((0, 0), 1)], **options)
