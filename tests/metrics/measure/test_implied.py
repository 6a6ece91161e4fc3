"""The metric a mesh is unit for."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from reference.meshes import irregular_square
from reference.transforms import TRANSFORMS

from metrics import (
    MetricError,
    implied_metric,
    mesh_edges,
    nodal_complexity,
    nodal_lengths,
    tensor,
    triangle_metrics,
)

coordinates = st.floats(-10, 10)
everywhere = pytest.mark.parametrize("transform", TRANSFORMS, ids=str)


def lengths_squared(edges, metric):
    return np.einsum("...i,...ij,...j->...", edges, tensor.unpack(metric)[..., None, :, :], edges)


def test_it_solves_the_three_equations():
    points, triangles = irregular_square(8)
    got = triangle_metrics(points * [1, 1e-3], triangles)
    for t, m in zip(triangles, got, strict=True):
        corners = points[t] * [1, 1e-3]
        x, y = (np.roll(corners, -1, axis=0) - corners).T
        system = np.stack([x * x, 2 * x * y, y * y], axis=1)
        np.testing.assert_allclose(m, np.linalg.solve(system, np.ones(3)), rtol=1e-9)


@given(st.lists(coordinates, min_size=6, max_size=6))
def test_all_edges_are_unit(c):
    corners = np.array(c).reshape(3, 2)
    u, v = corners[1:] - corners[0]
    area = u[0] * v[1] - u[1] * v[0]
    extent = np.ptp(corners, axis=0).max()
    if abs(area) < 1e-4 * max(extent, 1) ** 2:  # the product below loses extent²/area squared
        return
    triangle = [[0, 1, 2]] if area > 0 else [[0, 2, 1]]
    m = tensor.unpack(triangle_metrics(corners, triangle))[0]
    edges = np.roll(corners, -1, axis=0) - corners
    np.testing.assert_allclose(np.einsum("ki,ij,kj->k", edges, m, edges), 1, rtol=1e-6)


@everywhere
def test_all_edges_of_a_mesh_are_unit(transform):
    points, triangles = irregular_square(8)
    points, triangles = transform(points * [1, 1e-2]), transform.triangles(triangles)
    corners = points[triangles]
    edges = np.roll(corners, -1, axis=1) - corners
    got = triangle_metrics(points, triangles)
    np.testing.assert_allclose(lengths_squared(edges, got), 1, rtol=1e-7)


@everywhere
def test_of_an_equilateral_triangle_it_is_the_size(transform):
    points = transform(0.3 * np.array([[0, 0], [1, 0], [0.5, np.sqrt(3) / 2]]))
    triangle = transform.triangles([[0, 1, 2]])
    wanted = transform.metric(tensor.pack([0.3]))
    tolerance = (1e-13 + 20 * transform.rounding) * np.linalg.cond(transform.matrix)
    for got in (triangle_metrics(points, triangle), implied_metric(points, triangle)):
        ratios = tensor.simultaneous_reduction(np.tile(wanted, (len(got), 1)), got)[0]
        np.testing.assert_allclose(ratios, 1, rtol=tolerance)


@everywhere
def test_a_mesh_is_nearly_unit_and_keeps_its_complexity(transform):
    """sqrt(3)/4 for each triangle, also where they grow and are thin."""
    points, triangles = irregular_square(30)
    points = transform(np.stack([points[:, 0] ** 2, 0.01 * points[:, 1]], axis=1))
    triangles = transform.triangles(triangles)
    metric = implied_metric(points, triangles)
    wanted = np.sqrt(3) / 4 * len(triangles)
    assert nodal_complexity(points, triangles, metric) == pytest.approx(wanted, rel=0.04)
    lengths = nodal_lengths(points, mesh_edges(triangles)[0], metric)
    assert (np.abs(np.log2(lengths)) < 0.5).mean() > 0.85


def test_it_goes_along_with_rotations_and_scales():
    points, triangles = irregular_square(6)
    c, s = np.cos(0.7), np.sin(0.7)
    turn = np.array([[c, -s], [s, c]])
    wanted = turn @ tensor.unpack(implied_metric(points, triangles)) @ turn.T / 9
    got = tensor.unpack(implied_metric(3 * points @ turn.T, triangles))
    np.testing.assert_allclose(got, wanted, rtol=1e-10, atol=1e-10)


def test_what_has_no_metric_is_refused():
    points = [[0.0, 0.0], [1.0, 0.0], [0.0, 1.0], [2.0, 0.0]]
    with pytest.raises(MetricError, match=r"triangle 0 .* not counter-clockwise"):
        implied_metric(points, [[0, 2, 1]])
    with pytest.raises(MetricError, match="not counter-clockwise"):
        triangle_metrics(points, [[0, 1, 3]])
    with pytest.raises(MetricError, match=r"point 3 \(2.0, 0.0\) is in no triangle"):
        implied_metric(points, [[0, 1, 2]])
