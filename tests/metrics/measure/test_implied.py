"""The metric a mesh is unit for."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from reference.meshes import irregular_square

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


def test_of_an_equilateral_triangle_it_is_the_size():
    points = 0.3 * np.array([[0, 0], [1, 0], [0.5, np.sqrt(3) / 2]])
    for got in (triangle_metrics(points, [[0, 1, 2]]), implied_metric(points, [[0, 1, 2]])):
        np.testing.assert_allclose(got, np.tile(tensor.pack([0.3]), (len(got), 1)), atol=1e-14)


def test_a_mesh_is_nearly_unit_and_keeps_its_complexity():
    """sqrt(3)/4 for each triangle, also where they grow and are thin."""
    points, triangles = irregular_square(30)
    points = np.stack([points[:, 0] ** 2, 0.01 * points[:, 1]], axis=1)
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
