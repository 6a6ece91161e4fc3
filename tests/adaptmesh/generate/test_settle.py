"""The last rounds of a mesh: changes that are measured before they are made.

tests/sanitize/final_stage.cpp compares meshes before and after them.
"""

import numpy as np
import pytest

import adaptmesh as am

SQUARE = am.Domain.rectangle(0, 0, 1, 1)
CENTRE, RADIUS = np.array([0.45, 0.55]), 0.2


def in_disc(x):
    return np.hypot(*(x - CENTRE).T) < RADIUS


def in_band(x):
    return abs(x[:, 1] - 0.37 - 0.3 * x[:, 0]) < 0.1


def jump(inside, fine, coarse):
    return lambda x: np.where(inside(x), fine, coarse)


@pytest.mark.fast_cases(2)
@pytest.mark.parametrize("placement", ["front", "edges"])
@pytest.mark.parametrize("inside", [in_disc, in_band], ids=["disc", "band"])
@pytest.mark.parametrize("ratio", [5, 50])
def test_beside_a_jump_nearly_all_edges_are_unit(inside, ratio, placement):
    """Edges across it are unit if most of their length is spent where sizes are small."""
    metric = jump(inside, 0.008, 0.008 * ratio)
    mesh = am.generate(SQUARE, metric, placement=placement)
    assert am.validate(mesh)
    assert am.measure(mesh, metric).unit_fraction > 0.99


def across(mesh):
    """Triangles with corners on both sides of the jump."""
    corners = in_disc(mesh.points)[mesh.triangles]
    return np.flatnonzero(corners.any(axis=1) & ~corners.all(axis=1))


def strip_quality(mesh, triangle, metric):
    """Quality of a triangle, its area integrated along rays from the apex over the shortest side.

    The metric area of a thin triangle across a jump lies in a strip at its base.
    """
    p = mesh.points[triangle]
    sides = np.linalg.norm(np.roll(p, -1, 0) - np.roll(p, 1, 0), axis=1)
    apex, a, b = np.roll(p, -int(np.argmin(sides)), 0)
    t = 1 - np.geomspace(1e-5, 1, 400)
    along, weights = (t[1:] + t[:-1]) / 2, -np.diff(t**2)
    across = (np.arange(20) + 0.5)[:, None] / 20
    base = (1 - across) * a + across * b
    points = apex + along[:, None, None] * (base - apex)
    density = metric(points.reshape(-1, 2)).reshape(len(along), 20).mean(axis=1) ** -2
    u, v = a - apex, b - apex
    area = 0.5 * abs(u[0] * v[1] - u[1] * v[0]) * (weights @ density)
    x = np.linspace(0, 1, 4001)[:, None]
    squares = 0.0
    for i in range(3):
        start, end = p[i], p[(i + 1) % 3]
        sizes = metric((1 - x) * start + x * end)
        squares += (np.linalg.norm(end - start) * np.mean(1 / sizes)) ** 2
    return min(1.0, 4 * 3**0.5 * area / squares)


def test_most_triangles_across_a_jump_are_good_where_their_area_is_measured_right():
    metric = jump(in_disc, 0.008, 0.4)
    mesh = am.generate(SQUARE, metric)
    found = np.array([strip_quality(mesh, mesh.triangles[t], metric) for t in across(mesh)])
    assert np.mean(found < 0.2) < 0.1
    assert np.median(found) > 0.8


def test_constraints_beside_a_jump_are_kept():
    """A jump along an internal segment, and one a little beside it."""
    points = [(0, 0), (1, 0), (1, 1), (0, 1), (0.5, 0), (0.5, 1)]
    segments = [(0, 4), (4, 1), (1, 2), (2, 5), (5, 3), (3, 0), (4, 5)]
    domain = am.Domain(points, segments, names={"wall": [6]})
    for x in (0.5, 0.503):
        metric = lambda p, x=x: np.where(p[:, 0] < x, 0.008, 0.2)  # noqa: E731
        mesh = am.generate(domain, metric)
        assert am.validate(mesh)
        wall = mesh.points[mesh.edges[mesh.edge_tags == mesh.names["wall"]]]
        assert (wall[..., 0] == 0.5).all()
        assert np.linalg.norm(wall[:, 1] - wall[:, 0], axis=1).sum() == pytest.approx(1)
