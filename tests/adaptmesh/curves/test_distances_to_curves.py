"""Distances from domains of curves: to the curves themselves, not to chords of them.

The oracle is a search on the formula of the curve: many places, then bisection of the derivative of
the distance, without any of the code that it judges.
"""

import pickle

import numpy as np
import pytest
from reference.transforms import SIMILARITIES

import adaptmesh as am
import metrics
from adaptmesh.curves import Circle, EllipticArc, Line, Spline
from metrics import tensor

AXES, TURN = np.array([1.0, 0.35]), 0.6


def ellipse(t):
    c, s = np.cos(TURN), np.sin(TURN)
    x, y = AXES[0] * np.cos(t), AXES[1] * np.sin(t)
    return np.stack([c * x - s * y, s * x + c * y], axis=-1)


def distance_to_ellipse(points):
    """By bisections between 72 places: each ends on the ellipse, one where it is nearest."""
    c, s = np.cos(TURN), np.sin(TURN)
    p = points @ np.array([[c, -s], [s, c]])  # in the axes of the ellipse

    def slope(t):
        return (AXES[1] ** 2 - AXES[0] ** 2) * np.sin(t) * np.cos(t) + (
            AXES[0] * p[:, :1] * np.sin(t) - AXES[1] * p[:, 1:] * np.cos(t)
        )

    t = np.linspace(0, 2 * np.pi, 73)[None] + np.zeros((len(p), 1))
    low, high = t[:, :-1].copy(), t[:, 1:].copy()
    for _ in range(60):
        middle = 0.5 * (low + high)
        falls = slope(middle) < 0
        low, high = np.where(falls, middle, low), np.where(falls, high, middle)
    at = np.stack([AXES[0] * np.cos(low), AXES[1] * np.sin(low)], axis=-1)
    d = np.hypot(*np.moveaxis(at - p[:, None], -1, 0))
    return d.min(axis=1)


def similar(transform, curve, centre=(0.0, 0.0), size=1.0):
    """A circle or the ellipse, carried along."""
    angle = np.arctan2(*np.array(transform.matrix)[::-1, 0])
    turn = angle + (TURN if transform.determinant > 0 else -TURN)
    if curve == "ellipse":
        return EllipticArc(transform((0.0, 0.0)), transform.scale * AXES, turn)
    return Circle(transform(centre), size * transform.scale)


def points_about(rng, n):
    """Points everywhere about the ellipse, and on it and very near it."""
    near = ellipse(rng.uniform(0, 2 * np.pi, n)) + rng.normal(size=(n, 2)) * 10.0 ** rng.uniform(
        -9, -1, (n, 1)
    )
    return np.concatenate([rng.uniform(-2, 2, (n, 2)), near, ellipse(np.linspace(0, 7, n))])


@pytest.mark.fast_cases(2)
@pytest.mark.parametrize("transform", SIMILARITIES, ids=str)
def test_distances_to_an_ellipse(transform):
    domain = am.Domain.from_curves(
        [similar(transform, "circle", size=3.0), similar(transform, "ellipse")],
        names={"wall": [1], "far": [0]},
    )
    geometry = metrics.Geometry(domain.sides("wall"))
    points = points_about(np.random.default_rng(0), 150)
    right = distance_to_ellipse(points)
    found = geometry.distances(transform(points)) / transform.scale
    rounding = 40 * transform.rounding + 1e-10 * 6
    near = right < 0.1  # no other part of the ellipse is as near
    assert np.abs(found - right)[near].max() < rounding
    assert np.abs(found - right).max() < 1e-5 * 6
    assert np.quantile(np.abs(found - right), 0.99) < rounding

    nearest = geometry.nearest(transform(points))
    off = nearest.points - transform(points)
    np.testing.assert_allclose(np.hypot(*off.T), nearest.distances, atol=1e-12 * transform.scale)
    np.testing.assert_allclose(np.hypot(*nearest.directions.T), 1, rtol=1e-12)
    on = distance_to_ellipse(transform.inverse(nearest.points))
    assert on.max() < rounding
    copied = pickle.loads(pickle.dumps(geometry))
    np.testing.assert_array_equal(copied.distances(transform(points)), nearest.distances)


def test_the_first_height_of_a_layer_on_a_curved_wall():
    for transform in SIMILARITIES:
        domain = am.Domain.from_curves(
            [similar(transform, "circle", size=2.0), similar(transform, "circle", size=0.5)],
            names={"wall": [1]},
        )
        h = 1e-6 if not np.any(transform.offset) else 1e-4
        h *= transform.scale
        field = metrics.BoundaryLayer(domain.sides("wall"), h, 1.2, 0.05 * transform.scale)
        t = np.linspace(0, 2 * np.pi, 721)
        for d in (0.0, 1e-3, 0.1):
            at = transform((0.5 + d) * np.stack([np.cos(t), np.sin(t)], axis=1))
            low = tensor.sizes(field(at)).min(axis=1)
            right = min(h + 0.2 * d * transform.scale, 0.05 * transform.scale)
            np.testing.assert_allclose(low, right, rtol=3e-3)


def test_domains_of_lines_are_measured_as_ever():
    square = am.Domain.rectangle(0, 0, 1, 1)
    points = np.random.default_rng(0).uniform(-1, 2, (200, 2))
    one, other = metrics.Geometry(square), metrics.Geometry(square.points[square.segments])
    np.testing.assert_array_equal(one.distances(points), other.distances(points))
    assert metrics.Geometry(square.sides("left")).distances([[0.25, 0.5]])[0] == 0.25
    with pytest.raises(am.DomainError, match="no boundary is named 'wall'"):
        square.sides("wall")


def test_lines_that_go_on_into_curves_and_corners():
    """A stadium of lines and half circles; and a corner, from where directions point away."""
    half = [am.curves.Arc((1, 0), 0.5, -np.pi / 2, np.pi / 2)]
    half.append(am.curves.Arc((-1, 0), 0.5, np.pi / 2, 3 * np.pi / 2))
    lines = [Line((1, 0.5), (-1, 0.5)), Line((-1, -0.5), (1, -0.5))]
    geometry = metrics.Geometry(am.Domain.from_curves([*half, *lines]))
    points = np.random.default_rng(0).uniform(-3, 3, (2000, 2))
    x = np.clip(points[:, 0], -1, 1)
    right = np.abs(np.hypot(points[:, 0] - x, points[:, 1]) - 0.5)
    np.testing.assert_allclose(geometry.distances(points), right, atol=1e-9)

    lens = [Spline([(0, 0), (1, 0.4), (2, 0)]), Spline([(2, 0), (1, -0.4), (0, 0)])]
    geometry = metrics.Geometry(am.Domain.from_curves(lens))
    near = geometry.nearest([(-1.0, 0.0), (3.0, 0.5)])
    np.testing.assert_allclose(near.points, [(0, 0), (2, 0)], atol=1e-12)
    np.testing.assert_allclose(near.directions[0], (-1, 0), atol=1e-12)


@pytest.mark.parametrize("transform", SIMILARITIES, ids=str)
def test_sizes_of_regions_between_curves(transform):
    """An ellipse within a circle: which region a point is in, by the formula of the ellipse."""
    domain = am.Domain.from_curves(
        [similar(transform, "circle", size=2.0), similar(transform, "ellipse")],
        holes=[],
        regions={"in": transform((0.0, 0.0)), "out": transform((0.0, 1.5))},
    )
    field = metrics.RegionSizes(domain, {"in": 0.3, "out": 0.1}, outside="error", growth=None)
    rng = np.random.default_rng(1)
    t, off = rng.uniform(0, 2 * np.pi, 3000), rng.normal(size=3000) * 10.0 ** rng.uniform(-7, -1)
    normal = np.stack([np.cos(t) / AXES[0], np.sin(t) / AXES[1]], axis=1)
    normal /= np.hypot(*normal.T)[:, None]
    c, s = np.cos(TURN), np.sin(TURN)
    points = ellipse(t) + off[:, None] * normal @ np.array([[c, s], [-s, c]])
    w = points @ np.array([[c, -s], [s, c]]) / AXES
    inside = np.hypot(*w.T) < 1
    clear = np.abs(np.hypot(*w.T) - 1) > 1e-8 + 100 * transform.rounding
    found = tensor.sizes(field(transform(points)))[:, 0]
    np.testing.assert_allclose(found[clear], np.where(inside, 0.3, 0.1)[clear])
    on = tensor.sizes(field(transform(ellipse(np.linspace(0, 7, 500)))))[:, 0]
    np.testing.assert_allclose(on, 0.1)
    rim = 2 * np.stack([np.cos(t), np.sin(t)], axis=1)
    np.testing.assert_allclose(tensor.sizes(field(transform(rim)))[:, 0], 0.1)
    with pytest.raises(am.AdaptmeshError, match="outside"):
        field(transform([[2.1, 0.0]]))


def test_regions_of_a_mesh_of_curves_are_those_of_its_domain():
    circles = [Circle((0, 0), 1), Circle((0, 0), 0.5)]
    domain = am.Domain.from_curves(
        circles, holes=[], names={"i": [1]}, regions={"in": (0, 0), "ring": (0.75, 0)}
    )
    coarse = am.generate(domain, 0.4)
    field = metrics.RegionSizes(coarse, {"in": 0.02, "ring": 0.2}, growth=None)
    t = np.linspace(0, 2 * np.pi, 721)
    on = 0.5 * np.stack([np.cos(t), np.sin(t)], axis=1)
    np.testing.assert_allclose(tensor.sizes(field(on)), 0.02)
    mesh = am.generate(domain, field)
    assert len(mesh.edges_named("i")) == pytest.approx(np.pi / 0.02, rel=0.05)
