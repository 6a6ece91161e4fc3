"""Meshing again for the metric that a mesh implies gives as many triangles."""

import numpy as np
import pytest

import adaptmesh as am
import metrics
from metrics import tensor

SQUARE = am.Domain.rectangle(0, 0, 1, 1)


def layer(x):
    """Thin along y = 0.5, thicker and rounder away from it."""
    h = 0.004 + 0.2 * np.abs(x[:, 1] - 0.5)
    return np.stack([1 / np.maximum(h, 0.05) ** 2, 0 * h, 1 / h**2], axis=1)


@pytest.fixture(
    scope="module",
    params=[0.03, lambda x: 0.006 + 0.1 * np.hypot(*x.T), layer],
    ids=["uniform", "graded", "layer"],
)
def mesh(request):
    return am.generate(SQUARE, request.param)


@pytest.mark.parametrize("factor", [1, 1 / 4, 4])
def test_as_many_triangles_times_the_factor(mesh, factor):
    """A metric times 4 halves all sizes: four times as many."""
    metric = metrics.implied_metric(mesh.points, mesh.triangles)
    again = am.adapt(mesh, factor * metric)
    assert len(again.triangles) == pytest.approx(factor * len(mesh.triangles), rel=0.03)


def test_a_mesh_is_unit_in_its_own_metric(mesh):
    metric = metrics.implied_metric(mesh.points, mesh.triangles)
    report = am.measure(mesh, metrics.Background(mesh.points, mesh.triangles, metric))
    assert report.unit_fraction > 0.98
    assert report.count_ratio == pytest.approx(1, rel=0.03)


@pytest.mark.parametrize("p", [1, 2])
def test_the_error_asked_for_is_the_error_of_the_mesh(p):
    """A convex function, a few adaptations, and the true error by quadrature."""

    def u(x):
        x, y = x.T
        return np.exp(3 * x) + 2 * (y - 0.3) ** 2 + np.exp(20 * (x + y - 2))

    mesh = am.generate(SQUARE, 0.03)
    for _ in range(3):
        metric = metrics.metric_from_solution(
            mesh.points, mesh.triangles, u(mesh.points), error=2e-3, p=p
        )
        mesh = am.adapt(mesh, metric)
    rng = np.random.default_rng(0)
    weights = rng.dirichlet([1, 1, 1], 50)
    corners, nodal = mesh.points[mesh.triangles], u(mesh.points)[mesh.triangles]
    errors = [np.abs(u(np.einsum("i,tij->tj", w, corners)) - nodal @ w) ** p for w in weights]
    error = (mesh.areas @ np.mean(errors, axis=0)) ** (1 / p)
    assert error == pytest.approx(2e-3, rel=0.2)
    predicted = metrics.predicted_vertices(mesh.points, mesh.triangles, metric(mesh.points))
    assert len(mesh.points) == pytest.approx(predicted, rel=0.1)
    assert tensor.sizes(metric.tensors).min() > 1e-4
