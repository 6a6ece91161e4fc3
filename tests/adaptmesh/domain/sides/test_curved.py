"""Domains of curves: corners and joints, what is enclosed, what is refused, and their meshes."""

import re

import numpy as np
import pytest
from reference.curved import CASES, DISC, box, figure_eight, kinked, parabola, sine

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
    assert [len(run.parts) for run in domain.curved.paths] == [4]
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
    assert [len(run.parts) for run in domain.curved.paths] == [4]


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
        ([Circle((0, 0), 1), Circle((0, 0), 1)], r"curve [01] .* curve [01] .*\("),
        ([Circle((0, 0), 1), Line((0, 0), (np.cos(1), np.sin(1)))], r"\(0.5403\d*, 0.8414"),
        ([Spline([(0, 0), (1, 1), (1, 0), (0, 1)], closed=True)], r"curve 0 .* itself at \(0.[45]"),
        ([Parametric(figure_eight, closed=True)], "curve 0 .*figure_eight.* itself"),
        ([Parametric(kinked), Line((1, 0.9), (-1, 1.1))], r"kink at \(0.1"),
        ([*box(0, 0, 1, 1), Line((0, 0), (1, 1)), Line((1, 0), (0, 1))], "curve 4 .* curve 5"),
        ([*box(0, 0, 1, 1), Circle((3, 3), 1).part(0, 0.5)], "not closed|outside"),
        ([Circle((0, 0), 2), Circle((0, 0), 1), Arc((0, 0), 0.5, 0, 1)], r"in a hole.* near "),
    ],
)  # fmt: skip
def test_refused_with_the_place(curves, says):
    with pytest.raises(DomainError, match=says):
        Domain.from_curves(curves)


def test_a_point_where_smooth_curves_join_stays_a_vertex():
    rim = [Arc((0, 0), 1, 0, np.pi), Arc((0, 0), 1, np.pi, 2 * np.pi)]
    for points, count in (([], 1), ([(-1, 0)], 1), ([(-1, 0), (0.2, 0.3)], 2)):
        domain = Domain.from_curves(
            [*rim, Line((-0.3, -0.3), (0.3, -0.3))], points=points, names={"slit": [2]}
        )
        assert domain.curved.is_vertex.sum() == count + 2
        mesh = am.generate(domain, 0.3)
        for new in (mesh, am.adapt(mesh, 0.9), am.adapt(mesh, 0.9, frozen=["slit"])):
            assert new.validate().ok
            assert set(points) <= set(map(tuple, np.round(new.points, 12).tolist()))


@pytest.mark.parametrize(
    ("options", "says"),
    [
        ({"names": {"a": [1]}}, "curve 1, but the curves are numbered 0 to 0"),
        ({"names": {"a": [0], "b": [0]}}, "curve 0 is named both 'a' and 'b'"),
        ({"holes": "odd"}, "nesting"),
        ({"holes": [(5, 5)]}, "hole 0"),
        ({"regions": {"a": (5, 5)}}, "region 'a'"),
        ({"points": [(5, 5)]}, r"\(5, 5\)"),
        ({"points": [(0, 1)]}, r"\(0, 1\)"),
        ({"corner_angle": -1}, "corner_angle"),
        ({"corner_angle": np.nan}, "corner_angle"),
        ({"join_tolerance": 7}, "join_tolerance"),
        ({"join_tolerance": np.nan}, "join_tolerance"),
    ],
)
def test_wrong_options(options, says):
    with pytest.raises(DomainError, match=says):
        Domain.from_curves([Circle((0, 0), 1)], **options)


# -------------------------------------------------------------------------------------- anisotropic


def polar(x, radial, tangential):
    """The metric with these sizes (n,) along and across the radius."""
    c, s = x.T / np.maximum(np.hypot(*x.T), 1e-12)
    a, b = 1 / radial**2, 1 / tangential**2
    return np.stack([a * c * c + b * s * s, (a - b) * c * s, a * s * s + b * c * c], axis=1)


def layer_inside_disc(x):
    d = np.abs(1 - np.hypot(*x.T))
    return polar(x, 1e-3 + 0.2 * d, np.full(len(x), 0.1))


def layer_around_hole(x):
    d = np.abs(np.hypot(*x.T) - 1)
    return polar(x, np.minimum(1e-2 + 0.3 * d, 0.5), 0.2 + 0.1 * d)


@pytest.mark.parametrize(
    ("curves", "metric"),
    [
        ([Circle((0, 0), 1)], layer_inside_disc),
        ([Circle((0, 0), 4), Circle((0, 0), 1)], layer_around_hole),
    ],
    ids=["inside", "around"],
)
def test_chords_across_thin_layers_are_unit(curves, metric):
    """A chord cuts into the layer that its curve runs along; equal shares of the curve do not do.

    By these, no edge on the boundary of the disc is shorter than 2.5, and of all edges 96.0 % are
    unit.
    """
    report = am.measure(am.generate(Domain.from_curves(curves), metric), metric)
    assert report.unit_fraction > 0.99


@pytest.mark.slow
def test_many_holes():
    """Work goes with the number of curves and chords, not with their square."""
    holes = [Circle((i, j), 0.3) for i in range(8) for j in range(8)]
    domain = Domain.from_curves([*holes, Circle((3.5, 3.5), 6)])
    assert domain.area == pytest.approx(np.pi * (36 - 64 * 0.09), rel=1e-12)
    am.generate(domain, 0.3).validate().raise_if_invalid()


@pytest.mark.parametrize("tolerance", [0.1, 1e-3, 1e-6])
def test_outline_is_near_its_curves(tolerance):
    ellipse = EllipticArc((2.8, 1), (0.7, 0.05), 0.5)
    domain = Domain.from_curves([*box(0, 0, 4, 2), ellipse], names={"hole": [4]})
    outline = domain.outline(tolerance)
    assert np.hypot(*(outline[:4, 1] - outline[:4, 0]).T).sum() == 12
    ring = outline[4:]
    assert (ring[1:, 0] == ring[:-1, 1]).all()
    area = 0.5 * np.sum(ring[:, 0, 0] * ring[:, 1, 1] - ring[:, 0, 1] * ring[:, 1, 0])
    assert 0 < np.pi * 0.7 * 0.05 - abs(area) < 3 * tolerance  # its length is less than 3
    assert len(ring) < 40 + 10 / np.sqrt(tolerance)


def test_outline_of_segments_and_wrong_tolerances():
    square = Domain.rectangle(0, 0, 1, 1)
    assert (square.outline(0.1) == square.points[square.segments]).all()
    for wrong in (0, -1, np.nan, 1e-13):
        with pytest.raises(DomainError, match="tolerance"):
            DISC.outline(wrong)


def random_curves(rng):
    """A wobbly ring and a few curves in or across it, at any scale and place; and the scale."""
    scale = 10.0 ** rng.uniform(-6, 6)
    place = scale * rng.normal(0, 10, 2) * (rng.random() < 0.3)

    def ring(centre, radius, n, noise):
        angles = np.arange(n) * 2 * np.pi / n
        radii = radius * (1 + noise * rng.uniform(-1, 1, n))
        points = radii[:, None] * np.stack([np.cos(angles), np.sin(angles)], axis=1)
        return (centre + points) * scale + place

    curves = [Spline(ring((0, 0), 1, rng.integers(4, 12), rng.choice([0, 0.1, 0.3])), closed=True)]
    for kind in rng.integers(0, 4, rng.integers(0, 4)):
        centre, radius = rng.uniform(-0.7, 0.7, 2), 10.0 ** rng.uniform(-3, -0.4)
        at, r = centre * scale + place, radius * scale
        if kind == 0:
            curves.append(Circle(at, r))
        elif kind == 1:
            curves.append(EllipticArc(at, (r, r * 10.0 ** rng.uniform(-3, 0)), rng.uniform(0, 3)))
        elif kind == 2:
            curves.append(BSpline(ring(centre, radius, rng.integers(4, 9), 0.3), closed=True))
        else:
            curves.append(Bezier(rng.uniform(-0.5, 0.5, (rng.integers(2, 6), 2)) * scale + place))
    return curves, scale


@pytest.mark.parametrize("seed", range(40))
def test_random_curves_are_meshed_or_refused_with_the_place(seed):
    rng = np.random.default_rng(seed)
    curves, scale = random_curves(rng)
    try:
        domain = Domain.from_curves(curves)
    except DomainError as error:
        assert re.search(
            r"curve \d.*\(-?[\d.e+-]+, -?[\d.e+-]+\)|not closed.* point \d", str(error)
        )
        return
    mesh = am.generate(domain, scale * 10.0 ** rng.uniform(-1, 0.5))
    mesh.validate().raise_if_invalid()


@pytest.mark.parametrize("shift", np.random.default_rng(1).uniform(-1, 1, (20, 2)).tolist())
def test_circles_that_touch_but_for_rounding_are_refused(shift):
    """Where rounding puts the two a unit in the last place apart as well."""
    x, y = shift
    circles = [Circle((x, y), 2), Circle((x - 0.8, y), 0.8), Circle((x + 0.8, y), 0.8)]
    with pytest.raises(am.DomainError, match=r"(cross or touch at|passes the point of) .*\("):
        am.Domain.from_curves(circles)


@pytest.mark.parametrize(
    ("curves", "message"),
    [
        (Circle((0, 0), 1), "expected a sequence of curves"),
        (
            [Parametric(lambda t: 1e80 * Circle((0, 0), 1).point(t), closed=True)],
            "choose another unit of length",
        ),
        ([Circle((1e6, 0), 1e-9)], "curve 0 (Circle around (1e+06, 0)) is 2.1e-09 long or wide"),
    ],
)
def test_curves_that_coordinates_cannot_hold_are_refused(curves, message):
    with pytest.raises(DomainError, match=re.escape(message)):
        Domain.from_curves(curves)


def hall(shift):
    """A square on two arcs, moved."""
    corners = np.array([(0, 0), (0.4, 0), (1, 0), (1, 1), (0, 1)]) + shift
    below = np.array([(0.2, -0.1), (0.7, -0.1)]) + shift
    arcs = [Arc.through(corners[k], below[k], corners[k + 1]) for k in (0, 1)]
    lines = [Line(corners[k], corners[(k + 1) % 5]) for k in (2, 3, 4)]
    return Domain.from_curves([*arcs, *lines], names={"below": [0, 1]})


@pytest.mark.parametrize("shift", np.random.default_rng(2).uniform(-1e6, 1e6, (20, 2)).tolist())
def test_ends_far_from_the_origin_are_joined(shift):
    """Where coordinates are rounded to more than 1e-12 of the extent."""
    domain = hall(shift)
    assert domain.area == pytest.approx(hall((0, 0)).area, rel=1e-8)
    assert domain.curved.is_vertex.sum() == 5
    am.generate(domain, 0.2).validate().raise_if_invalid()


def test_curves_that_turn_more_than_an_edge_may_meet_in_a_corner():
    """Whatever corner_angle says: no chord over the joint is right, however short."""
    arcs = [Arc((-1, 0), 1, np.pi, 2 * np.pi), Arc((1, 0), 1, np.pi, 2 * np.pi)]
    lines = [Line((2, 0), (2, 1)), Line((2, 1), (-2, 1)), Line((-2, 1), (-2, 0))]
    domain = Domain.from_curves([*arcs, *lines], names={"arcs": [0, 1]}, corner_angle=180)
    assert (np.hypot(*vertices(domain).T) < 1e-12).any()
    for size in (3.0, 0.37, 0.2):
        am.generate(domain, size).validate().raise_if_invalid()


def test_circles_far_smaller_than_rounding_are_refused_at_once():
    """They were halved until the memory was full."""
    curves = [Circle((1, 1), 0.4), Line((0, 0), (4e18, 0)), Line((4e18, 0), (0, 4e18))]
    curves += [Line((0, 4e18), (0, 0))]
    with pytest.raises(DomainError, match="smaller than can be told apart"):
        Domain.from_curves(curves, join_tolerance=0.0)
