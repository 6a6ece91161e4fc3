"""Meshes of a domain and a metric that are mapped together: of the same quality, if not the same.

A metric gives mapped edges the lengths they had, so that only rounding, and what of the algorithms
depends on the axes, is between the meshes.
"""

import functools

import numpy as np
import pytest
from reference.meshes import from_axes
from reference.transforms import TRANSFORMS, Transform

import adaptmesh as am
import metrics

OUTLINE = np.array([(0, 0), (2, 0.1), (2.2, 1), (1, 1.3), (0.1, 0.9)])
HOLE = np.array([(0.8, 0.4), (0.8, 0.7), (1.2, 0.6)])


def graded(x):
    return from_axes(*2 * [0.01 + 0.1 * np.hypot(x[:, 0] - 0.4, x[:, 1] - 0.3)], 0 * x[:, 0])


def layer(x):
    """Fifty to one along a curved front."""
    d = np.hypot(x[:, 0] - 0.2, x[:, 1] + 0.8) - 1.4
    across = 0.002 + 0.15 * np.abs(d)
    along = np.maximum(across, 0.1)
    return from_axes(across, along, np.arctan2(x[:, 1] + 0.8, x[:, 0] - 0.2))


def meshed(metric, transform):
    rings = [transform(ring) for ring in (OUTLINE, HOLE)]
    if transform.determinant < 0:
        rings = [ring[::-1] for ring in rings]
    field = metrics.as_control_space(lambda x: transform.metric(metric(transform.inverse(x))))
    domain = am.Domain.polygon(rings[0], holes=rings[1:])
    return am.generate(domain, field), field


def stretched(ratio, angle):
    c, s = np.cos(angle), np.sin(angle)
    return Transform(f"stretched by {ratio:g} at {angle:.2f}", ((c * ratio, -s), (s * ratio, c)))


FRAMES = [*TRANSFORMS[1:], *(stretched(r, a) for r in (1e4, 1e6) for a in (np.pi / 4, 0.6))]


@functools.cache
def own(metric):
    mesh, field = meshed(metric, TRANSFORMS[0])
    return am.measure(mesh, field), am.predict(mesh.domain, field)


@pytest.mark.fast_cases(4)
@pytest.mark.parametrize("metric", [graded, layer])
@pytest.mark.parametrize("transform", FRAMES, ids=str)
def test_a_turned_domain_with_a_turned_metric_has_as_good_a_mesh(metric, transform):
    wanted, predicted = own(metric)
    mesh, field = meshed(metric, transform)
    got = am.measure(mesh, field)
    assert got.n_points == pytest.approx(wanted.n_points, rel=0.015)
    assert got.complexity == pytest.approx(wanted.complexity, rel=5e-3)
    assert am.predict(mesh.domain, field) == pytest.approx(predicted, rel=0.01)
    assert got.unit_fraction > wanted.unit_fraction - 0.005
    assert got.efficiency_index == pytest.approx(wanted.efficiency_index, abs=0.003)
    assert got.quality_mean == pytest.approx(wanted.quality_mean, abs=0.01)
    implied = metrics.implied_metric(mesh.points, mesh.triangles)
    complexity = metrics.nodal_complexity(mesh.points, mesh.triangles, implied)
    assert complexity == pytest.approx(np.sqrt(3) / 4 * got.n_triangles, rel=0.01)


def test_thinner_than_a_double_holds_at_an_angle_is_refused_with_the_remedy():
    """Along the axes it is held; at an angle the entries no longer say how long the ellipse is."""
    meshed(graded, stretched(1e9, 0))
    with pytest.raises(am.MetricError, match=r"singular .* keep the ratio of sizes below 1e7"):
        meshed(graded, stretched(1e9, 0.6))
