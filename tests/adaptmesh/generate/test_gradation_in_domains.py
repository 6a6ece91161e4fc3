"""Sizes that grow slowly all over a domain: `graded`, `generate(gradation=)`, `RegionSizes`."""

import numpy as np
import pytest
from reference.transforms import SIMILARITIES, TRANSFORMS

import adaptmesh as am
import metrics
from adaptmesh.curves import Circle
from metrics import tensor


def two_squares(transform):
    return am.Domain(
        transform([(0, 0), (1, 0), (2, 0), (2, 1), (1, 1), (0, 1)]),
        [(0, 1), (1, 2), (2, 3), (3, 4), (4, 5), (5, 0), (1, 4)],
        regions={"a": transform((0.5, 0.5)), "b": transform((1.5, 0.5))},
    )


def isotropic(transform, size):
    def field(x):
        h = size(transform.inverse(x)) ** -2.0
        return transform.metric(np.stack([h, 0 * h, h], axis=1))

    return field


@pytest.mark.fast_cases(2)
@pytest.mark.parametrize("transform", TRANSFORMS[1::2], ids=str)
def test_a_jump_that_is_graded_gives_good_triangles(transform):
    """Across an inner line, by 20; the metric is turned, sheared and scaled with the domain."""
    domain = two_squares(transform)

    def size(x):
        return np.where(x[:, 0] > 1 - 1e-9, 0.03, 0.45)

    field = metrics.as_control_space(isotropic(transform, size))
    mesh = am.generate(domain, field, gradation=1.5)
    graded = field.graded(domain, 1.5)
    report = am.measure(mesh, graded)
    assert report.unit_fraction > 0.985
    assert report.quality_min > 0.5
    jumping = am.measure(am.generate(domain, field), field)
    assert jumping.quality_min < 0.2
    # Nowhere coarser than asked for, in no direction.
    x = transform(np.random.default_rng(0).uniform(0, 1, (500, 2)) * [2, 1])
    least = np.linalg.eigvalsh(tensor.unpack(graded(x)) - tensor.unpack(field(x)))
    assert least.min() > -1e-9 * np.abs(field(x)).max()


@pytest.mark.slow
@pytest.mark.parametrize("transform", SIMILARITIES[1::3], ids=str)
def test_regions_are_graded_by_default(transform):
    """A small circle in a large one: sizes by the distance, as beta says."""
    s = transform.scale
    centre = transform((0.0, 0.0))
    domain = am.Domain.from_curves(
        [Circle(centre, 2 * s), Circle(centre, 0.5 * s)],
        holes=[],
        names={"i": [1]},
        regions={"in": centre, "out": transform((1.2, 0.0))},
    )
    field = metrics.RegionSizes(domain, {"in": 0.04 * s, "out": 0.4 * s})
    t = np.linspace(0, 2 * np.pi, 200)
    circle = np.stack([np.cos(t), np.sin(t)], axis=1)
    for radius, d in ((0.5, 0.0), (0.45, 0.0), (0.6, 0.1), (0.9, 0.4), (1.9, 1.4)):
        h = tensor.sizes(field(transform(radius * circle))) / s
        right = min(0.4, 0.04 + np.log(1.5) * d)  # "metric" growth; "mixed" is nearly that
        assert np.all(np.abs(h / right - 1) < 0.15), (radius, h.min(), h.max(), right)
    mesh = am.generate(domain, field)
    report = am.measure(mesh, field)
    assert report.quality_min > 0.5
    assert report.unit_fraction > 0.99
    assert len(mesh.edges_named("i")) == pytest.approx(np.pi / 0.04, rel=0.05)
    steps = metrics.RegionSizes(domain, {"in": 0.04 * s, "out": 0.4 * s}, growth=None)
    assert am.measure(am.generate(domain, steps), steps).quality_min < 0.2


@pytest.mark.parametrize("transform", SIMILARITIES[:2], ids=str)
def test_sizes_spread_around_holes_and_not_across_them(transform):
    """Two chambers, a wall between that is open at one end; fine at the other end of one."""
    wall = [(0.99, 0.0), (1.01, 0.0), (1.01, 1.8), (0.99, 1.8)]
    ring = [(0, 0), wall[0], wall[3], wall[2], wall[1], (2, 0), (2, 2), (0, 2)]
    domain = am.Domain.polygon(transform(ring))

    def size(x):
        return np.where(np.hypot(x[:, 0] - 0.95, x[:, 1] - 0.05) < 0.03, 0.02, 0.5)

    graded = metrics.as_control_space(isotropic(transform, size)).graded(domain, 1.5)
    h = tensor.sizes(graded(transform([[0.94, 0.3], [1.06, 0.3]])))[:, 0] / transform.scale
    assert h[0] < 0.18  # 0.22 away
    assert h[1] > 0.4  # 0.1 across the wall, but 3 around it


@pytest.mark.slow
def test_every_control_space_and_every_kind_of_mesh():
    domain = two_squares(SIMILARITIES[0])
    mesh = am.generate(domain, 0.2)
    bare = am.Mesh(mesh.points, mesh.triangles, mesh.regions, mesh.edges, mesh.edge_tags)
    spaces = [
        metrics.Expression("0.02 + 0.4*(1 + tanh(200*(1 - x)))/2"),
        metrics.RegionSizes(domain, {"a": 0.4, "b": 0.02}, growth=None),
        metrics.RegionSizes(mesh, {"a": 0.4, "b": 0.02}, growth=None),
        metrics.Background.on(mesh, np.where(mesh.points[:, 0] < 0.9, 0.4, 0.05)),
        metrics.Uniform(0.4) & metrics.BoundaryLayer([(1, 0), (1, 1)], 0.01, 1.5, 0.1),
    ]
    for space in spaces:
        for where in (domain, bare) if space is spaces[0] else (mesh,):
            graded = space.graded(where, 1.4)
            report = am.measure(am.generate(domain, graded), graded)
            assert report.quality_min > 0.3
            assert report.unit_fraction > 0.97
    background = metrics.Background.on(mesh, np.where(mesh.points[:, 0] < 0.9, 0.4, 0.05))
    for graded in (background.graded(1.3), background.graded(beta=1.3)):
        assert isinstance(graded, metrics.Background)
        right = metrics.graded(background.tensors, mesh.points, mesh.triangles, 1.3)
        np.testing.assert_allclose(graded.tensors, right, rtol=1e-12, atol=1e-12)


@pytest.mark.fast_cases(1)
@pytest.mark.parametrize("keep", [False, True])
@pytest.mark.parametrize("transform", TRANSFORMS[2::4], ids=str)
def test_adapted_meshes_are_graded_too(transform, keep):
    """A function, and values at vertices, that jump by 20; what was graded before is kept."""
    domain = two_squares(transform)

    def size(x):
        return np.where(x[:, 0] > 1 - 1e-9, 0.03, 0.45)

    field = metrics.as_control_space(isotropic(transform, size))
    old = am.generate(domain, field)
    mesh = am.adapt(old, field, keep=keep, gradation=1.5)
    report = am.measure(mesh, field.graded(domain, 1.5))
    assert report.unit_fraction > 0.97
    assert report.quality_min > 0.4
    assert am.measure(am.adapt(old, field, keep=keep), field).quality_min < 0.2
    again = am.adapt(mesh, field(mesh.points), keep=keep, gradation=1.5)
    assert again.validate().ok
    assert len(again.triangles) == pytest.approx(len(mesh.triangles), rel=0.05)
    assert not keep or (again.kept >= 0).mean() > 0.9


def test_uniform_sizes_are_what_they_were():
    domain = two_squares(SIMILARITIES[0])
    one, other = am.generate(domain, 0.1), am.generate(domain, 0.1, gradation=1.5)
    np.testing.assert_array_equal(one.points, other.points)


@pytest.mark.parametrize("bad", [1.0, 0.5, -2.0, np.nan, np.inf, "2"])
def test_what_is_no_gradation(bad):
    domain = two_squares(SIMILARITIES[0])
    with pytest.raises(am.MetricError, match="finite factor above 1"):
        am.generate(domain, 0.1, gradation=bad)
    with pytest.raises(am.MetricError, match="beta must be above 1"):
        metrics.RegionSizes(domain, {"a": 0.4, "b": 0.02}, growth=bad)
    with pytest.raises(am.MetricError, match="expected a domain or a mesh"):
        metrics.Uniform(1.0).graded(None)
