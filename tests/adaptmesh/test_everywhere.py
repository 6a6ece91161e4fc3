"""Domains of every kind, turned, sheared, scaled and far from the origin.

The figure and its metric are carried by the same map, so that lengths and numbers of vertices stay
what they were. Meshes are judged by an exact oracle that shares no code with the package.
"""

from fractions import Fraction

import numpy as np
import pytest
from reference.exact_mesh import faults_of_mesh, faults_of_segments
from reference.transforms import SIMILARITIES, TRANSFORMS, Moved

import adaptmesh as am
from adaptmesh.curves import Arc, Circle, EllipticArc, Line, Spline

SIZE = 0.25
everywhere = pytest.mark.parametrize("transform", TRANSFORMS, ids=str)

# Two regions with an interface, a hole, a line that dangles, a point.
OUTLINE = [(0, 0), (2, 0), (4, 0.5), (4, 2), (2, 2), (0, 2)]
HOLE = [(0.5, 0.5), (1, 0.5), (1, 1), (0.5, 1)]
POINTS = np.array([*OUTLINE, *HOLE, (2.6, 1), (3.3, 1.3), (1.6, 1.2)])
SEGMENTS = [(0, 1), (1, 2), (2, 3), (3, 4), (4, 5), (5, 0), (1, 4)]
SEGMENTS += [(6, 7), (7, 8), (8, 9), (9, 6), (10, 11)]
NAMES = {"bottom": [0, 1], "interface": [6], "hole": [7, 8, 9, 10], "wire": [11]}
AREA, LEFT = 4 + 2 * (2 + 1.5) / 2 - 0.25, 4 - 0.25


def plate(transform):
    left, right = transform([(0.2, 1.5), (2.5, 1.5)])
    return am.Domain(
        transform(POINTS),
        SEGMENTS,
        holes=[transform((0.75, 0.75))],
        regions={"left": left, "right": right},
        names=NAMES,
    )


def carried(transform, h=SIZE):
    """Metric of the size h before the map, for functions of the new coordinates."""
    return lambda x: np.tile(transform.metric(np.array([h**-2, 0.0, h**-2])), (len(x), 1))


def length_before(transform, mesh, name):
    ends = transform.inverse(mesh.points[mesh.edges_named(name)])
    return np.hypot(*(ends[:, 1] - ends[:, 0]).T).sum()


def exact_area(points, triangles):
    """Of the domain, from the corners as they were rounded."""
    p = [[Fraction(float(x)) for x in row] for row in points]
    return (
        sum(
            (p[b][0] - p[a][0]) * (p[c][1] - p[a][1]) - (p[b][1] - p[a][1]) * (p[c][0] - p[a][0])
            for a, b, c in triangles.tolist()
        )
        / 2
    )


def check_plate(transform, mesh):
    domain = mesh.domain
    assert faults_of_mesh(mesh) == []
    area = exact_area(domain.points, domain.triangles)
    assert faults_of_segments(mesh, domain.points, SEGMENTS, area) == []
    assert am.validate(mesh)
    rtol = 20 * transform.rounding + 1e-13
    areas = mesh.areas / abs(transform.determinant)
    assert areas.sum() == pytest.approx(AREA, rel=rtol)
    assert areas[mesh.triangles_in("left")].sum() == pytest.approx(LEFT, rel=rtol)
    for name, length in {"interface": 2, "hole": 2, "wire": np.hypot(0.7, 0.3)}.items():
        assert length_before(transform, mesh, name) == pytest.approx(length, rel=rtol)
    report = am.measure(mesh, carried(transform))
    assert report.unit_fraction > 0.97 and report.quality_min > 0.3


@everywhere
@pytest.mark.parametrize("placement", ["front", "edges"])
def test_segments_holes_regions_and_names(transform, placement):
    mesh = am.generate(plate(transform), carried(transform), placement=placement)
    check_plate(transform, mesh)
    here = am.generate(plate(TRANSFORMS[0]), carried(TRANSFORMS[0]), placement=placement)
    assert len(mesh.points) == pytest.approx(len(here.points), rel=0.04)
    predicted = am.predict(plate(transform), carried(transform))
    assert predicted == pytest.approx(len(mesh.points), rel=0.1)


@pytest.mark.fast_cases(4)
@everywhere
@pytest.mark.parametrize("keep", [False, True])
def test_adapted_to_and_fro(transform, keep):
    mesh = am.generate(plate(transform), carried(transform))
    for h in (SIZE / 2, 2 * SIZE, SIZE):
        mesh = am.adapt(mesh, carried(transform, h), keep=keep)
        assert am.validate(mesh)
    check_plate(transform, mesh)


@everywhere
def test_a_mesh_without_a_domain_has_that_of_its_edges(transform):
    mesh = am.generate(plate(transform), carried(transform))
    bare = am.Mesh(
        mesh.points,
        mesh.triangles,
        mesh.regions,
        mesh.edges,
        mesh.edge_tags,
        mesh.names,
        mesh.region_names,
    )
    again = am.adapt(bare, carried(transform))
    assert am.validate(again) and faults_of_mesh(again) == []
    rtol = 20 * transform.rounding + 1e-13
    assert again.areas.sum() / abs(transform.determinant) == pytest.approx(AREA, rel=rtol)
    assert length_before(transform, again, "interface") == pytest.approx(2, rel=rtol)
    assert len(again.points) == pytest.approx(len(mesh.points), rel=0.06)


# Curves


def rounded_plate(transform):
    """Lines and an arc around an ellipse and beside a spline that parts two regions."""
    spline = Spline([(1.5, 0), (1.7, 0.4), (1.3, 1), (1.7, 1.6), (1.5, 2)])
    sides = [Line((0, 0), (1.5, 0)), Line((1.5, 0), (3, 0)), Arc((3, 1), 1, -np.pi / 2, np.pi / 2)]
    sides += [Line((3, 2), (1.5, 2)), Line((1.5, 2), (0, 2)), Line((0, 2), (0, 0))]
    hole = EllipticArc((2.8, 1), (0.6, 0.25), 0.5)
    curves = [Moved(c, transform) for c in (*sides, spline, hole)]
    left, right = transform([(0.5, 1), (2, 1.5)])
    return am.Domain.from_curves(
        curves,
        names={"nose": [2], "interface": [6], "hole": [7]},
        regions={"left": left, "right": right},
    )


def check_rounded_plate(transform, mesh):
    assert faults_of_mesh(mesh) == []
    assert am.validate(mesh)
    atol = 10 * transform.rounding * np.linalg.cond(transform.matrix)
    nose = transform.inverse(mesh.points[np.unique(mesh.edges_named("nose"))]) - (3, 1)
    assert np.abs(np.hypot(*nose.T) - 1).max() < atol
    c, s = np.cos(0.5), np.sin(0.5)
    hole = transform.inverse(mesh.points[np.unique(mesh.edges_named("hole"))]) - (2.8, 1)
    along, across = hole @ [c, s] / 0.6, hole @ [-s, c] / 0.25
    assert np.abs(np.hypot(along, across) - 1).max() < 5 * atol
    area = mesh.areas.sum() / abs(transform.determinant)
    assert area == pytest.approx(6 + np.pi / 2 - np.pi * 0.6 * 0.25, rel=0.02)
    # Round the tips of thin ellipses an edge turns by less than the metric would allow.
    least = 0.95 if transform in SIMILARITIES else 0.9
    assert am.measure(mesh, carried(transform)).unit_fraction > least


@pytest.mark.fast_cases(4)
@everywhere
def test_curves(transform):
    domain = rounded_plate(transform)
    exact = 6 + np.pi / 2 - np.pi * 0.6 * 0.25
    rtol = 30 * transform.rounding + 1e-11
    assert domain.area / abs(transform.determinant) == pytest.approx(exact, rel=rtol)
    mesh = am.generate(domain, carried(transform))
    check_rounded_plate(transform, mesh)
    here = am.generate(rounded_plate(TRANSFORMS[0]), carried(TRANSFORMS[0]))
    within = 0.05 if transform in SIMILARITIES else 0.3
    assert len(mesh.points) == pytest.approx(len(here.points), rel=within)


@pytest.mark.fast_cases(2)
@everywhere
@pytest.mark.parametrize("keep", [False, True])
def test_curves_adapted_to_and_fro(transform, keep):
    mesh = am.generate(rounded_plate(transform), carried(transform))
    for h in (SIZE / 2, SIZE):
        mesh = am.adapt(mesh, carried(transform, h), keep=keep)
    check_rounded_plate(transform, mesh)


# Periodic sides


def wavy(x0):
    y = np.linspace(0, 1, 9)
    return Spline(np.stack([x0 + 0.1 * np.sin(2 * np.pi * y), y], axis=1))


def channel(transform, curved):
    left, right = (wavy(0), wavy(2)) if curved else (Line((0, 0), (0, 1)), Line((2, 0), (2, 1)))
    curves = [left, Line((0, 0), (2, 0)), right, Line((0, 1), (2, 1)), Circle((1, 0.5), 0.2)]
    domain = am.Domain.from_curves(
        [Moved(c, transform) for c in curves], names={"left": [0], "right": [2]}
    )
    return domain.with_periodic("left", "right")


def check_periodic(mesh, motion, atol):
    assert faults_of_mesh(mesh) == [] and am.validate(mesh)
    ((first, second),) = mesh.periodic_vertices()
    pairs = mesh.periodic_vertices()[first, second]
    for name, column in ((first, 0), (second, 1)):
        assert set(pairs[:, column]) == set(np.unique(mesh.edges_named(name)))
    gaps = motion(mesh.points[pairs[:, 0]]) - mesh.points[pairs[:, 1]]
    assert np.abs(gaps).max() <= atol
    image = dict(pairs.tolist())
    edges = {frozenset((image[a], image[b])) for a, b in mesh.edges_named(first).tolist()}
    assert edges == {frozenset(e) for e in mesh.edges_named(second).tolist()}


@pytest.mark.fast_cases(2)
@everywhere
@pytest.mark.parametrize("curved", [False, True])
@pytest.mark.parametrize("keep", [False, True])
def test_periodic_sides(transform, curved, keep):
    shift = transform((2, 0)) - transform((0, 0))
    atol = 20 * transform.rounding * np.abs(transform.matrix).max()
    mesh = am.generate(channel(transform, curved), carried(transform, 0.15))
    check_periodic(mesh, lambda x: x + shift, atol)
    for h in (0.08, 0.15):
        mesh = am.adapt(mesh, carried(transform, h), keep=keep)
        check_periodic(mesh, lambda x: x + shift, atol)


@pytest.mark.parametrize("transform", SIMILARITIES, ids=str)
def test_periodic_by_rotation(transform):
    a = np.radians(60)
    turn = np.array([[np.cos(a), -np.sin(a)], [np.sin(a), np.cos(a)]])
    side = np.array([[1, 0], [1.3, 0.15], [1.7, 0.1], [2, 0]])
    curves = [Arc((0, 0), 1, 0, a), Arc((0, 0), 2, 0, a), Spline(side), Spline(side @ turn.T)]
    domain = am.Domain.from_curves(
        [Moved(c, transform) for c in curves], names={"low": [2], "high": [3]}
    )
    degrees = 60 * np.sign(transform.determinant)
    domain = domain.with_periodic("low", "high", rotation=degrees, centre=transform((0, 0)))
    mesh = am.generate(domain, carried(transform, 0.15))
    atol = 40 * transform.rounding * transform.scale
    check_periodic(mesh, lambda x: transform(transform.inverse(x) @ turn.T), atol)


# Nested rings, lines between holes, sides chosen by place


@everywhere
def test_nested_rings_have_the_areas_of_their_kind(transform):
    square = np.array([(-1, -1), (1, -1), (1, 1), (-1, 1)])
    rings = [transform(half * square) for half in (4, 3, 2, 1)]
    segments = [(4 * k + i, 4 * k + (i + 1) % 4) for k in range(4) for i in range(4)]
    curves = [Line(ring[i], ring[(i + 1) % 4]) for ring in rings for i in range(4)]
    points = np.concatenate(rings)
    rtol = 20 * transform.rounding + 1e-13
    for domain, area in (
        (am.Domain(points, segments), 40),
        (am.Domain(points, segments, holes=[]), 64),
        (am.Domain.polygon(rings[0], rings[1:]), 40),
        (am.Domain.from_curves(curves), 40),
        (am.Domain.from_curves(curves, holes=[]), 64),
    ):
        assert domain.area / abs(transform.determinant) == pytest.approx(area, rel=rtol)


@everywhere
def test_lines_between_holes_and_from_them(transform):
    points = [(0, 0), (6, 0), (6, 3), (0, 3), (1, 1), (2, 1), (2, 2), (1, 2)]
    points += [(4, 1), (5, 1), (5, 2), (4, 2), (3, 1.5), (5.2, 0.7)]
    segments = [(k + i, k + (i + 1) % 4) for k in (0, 4, 8) for i in range(4)]
    domain = am.Domain(
        transform(points),
        [*segments, (6, 12), (12, 11), (9, 13)],
        holes=transform([(1.5, 1.5), (4.5, 1.5)]),
        names={"between": [12, 13], "from": [14]},
    )
    mesh = am.generate(domain, carried(transform))
    assert am.validate(mesh) and faults_of_mesh(mesh) == []
    rtol = 20 * transform.rounding + 1e-13
    assert mesh.areas.sum() / abs(transform.determinant) == pytest.approx(16, rel=rtol)
    assert length_before(transform, mesh, "between") == pytest.approx(5**0.5, rel=rtol)
    assert length_before(transform, mesh, "from") == pytest.approx(0.13**0.5, rel=rtol)


@pytest.mark.parametrize("transform", SIMILARITIES, ids=str)
def test_sides_chosen_by_place_and_direction(transform):
    ring = [(0, 0), (3, 0), (3, 1), (2, 1), (2, 0.5), (1, 0.5), (1, 1), (0, 1)]
    origin = transform((0, 0))
    domain = am.Domain.polygon(
        transform(ring),
        names={
            "up": am.facing(transform((0, 1)) - origin),
            "left": am.nearest(transform((-0.2, 0.5))),
            "right": lambda x: transform.inverse(x)[:, 0] > 3 - 1e-6,
        },
    ).with_periodic("left", "right")
    mesh = am.generate(domain, carried(transform))
    assert am.validate(mesh)
    rtol = 100 * transform.rounding + 1e-13
    for name, length in {"up": 3, "left": 1, "right": 1}.items():
        assert length_before(transform, mesh, name) == pytest.approx(length, rel=rtol)
    assert len(mesh.periodic_vertices()["left", "right"]) == len(mesh.edges_named("left")) + 1
