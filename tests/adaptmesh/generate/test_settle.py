"""The last rounds of a mesh: changes that are measured before they are made."""

import importlib

import numpy as np
import pytest

import adaptmesh as am

generate = importlib.import_module("adaptmesh.generate.generate")  # the module, not the function

SQUARE = am.Domain.rectangle(0, 0, 1, 1)
CENTRE, RADIUS = np.array([0.45, 0.55]), 0.2


def in_disc(x):
    return np.hypot(*(x - CENTRE).T) < RADIUS


def in_band(x):
    return abs(x[:, 1] - 0.37 - 0.3 * x[:, 0]) < 0.1


def jump(inside, fine, coarse):
    return lambda x: np.where(inside(x), fine, coarse)


def unsettled(metric, monkeypatch, domain=SQUARE):
    with monkeypatch.context() as patch:
        patch.setattr(generate, "settle", lambda *_: None)
        return am.generate(domain, metric)


@pytest.mark.parametrize("placement", ["front", "edges"])
@pytest.mark.parametrize("inside", [in_disc, in_band], ids=["disc", "band"])
@pytest.mark.parametrize("ratio", [5, 50])
def test_beside_a_jump_nearly_all_edges_are_unit(inside, ratio, placement):
    """Edges across it are unit if most of their length is spent where sizes are small."""
    metric = jump(inside, 0.008, 0.008 * ratio)
    mesh = am.generate(SQUARE, metric, placement=placement)
    assert am.validate(mesh)
    assert am.measure(mesh, metric).unit_fraction > 0.99


def test_settling_is_what_does_it(monkeypatch):
    metric = jump(in_disc, 0.008, 0.4)
    before = am.measure(unsettled(metric, monkeypatch), metric)
    after = am.measure(am.generate(SQUARE, metric), metric)
    assert 1 - after.unit_fraction < 0.3 * (1 - before.unit_fraction)


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


def test_smooth_metrics_are_left_as_they_are(monkeypatch):
    metric = lambda x: 0.01 + 0.05 * np.hypot(x[:, 0], x[:, 1])  # noqa: E731
    before, after = unsettled(metric, monkeypatch), am.generate(SQUARE, metric)
    assert np.array_equal(before.points, after.points)
    assert np.array_equal(before.triangles, after.triangles)


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


def ridge(x):
    """Anisotropic along a sine wave: axes turn within an edge where it bends."""
    t = x[:, 1] - 0.5 - 0.2 * np.sin(2 * np.pi * x[:, 0])
    slope = -0.4 * np.pi * np.cos(2 * np.pi * x[:, 0])
    normal = np.stack([slope, np.ones(len(x))], axis=1) / np.hypot(slope, 1)[:, None]
    fine, coarse = (0.004 + 0.1 * t**2) ** -2, 0.08**-2
    a, b = normal.T
    extra = np.maximum(fine - coarse, 0)
    return np.stack([coarse + extra * a * a, extra * a * b, coarse + extra * b * b], axis=1)


def test_the_worst_triangles_are_lifted(monkeypatch):
    """In every mesh, in the mean well, and edges are not given up for that: but for chance."""
    fields = [lambda x, c=c: ridge(x) / c for c in (0.8, 1.0, 1.2, 1.5, 1.8, 2.2)]
    after = [am.measure(am.generate(SQUARE, metric), metric) for metric in fields]
    options = generate.Settling(lifts=0)
    monkeypatch.setattr(generate, "Settling", lambda: options)
    before = [am.measure(am.generate(SQUARE, metric), metric) for metric in fields]
    gains = [a.quality_min - b.quality_min for a, b in zip(after, before, strict=True)]
    assert min(gains) > 0
    assert np.mean(gains) > 0.03
    assert np.mean([r.unit_fraction for r in after]) >= np.mean([r.unit_fraction for r in before])


def test_where_most_edges_are_off_nothing_is_tried(monkeypatch):
    """A metric that turns by far more than a right angle within each edge."""

    def metric(x):
        c, s = np.cos(100 * x[:, 0]), np.sin(100 * x[:, 0])
        a, b = 0.05**-2, 0.01**-2
        return np.stack([a * c * c + b * s * s, (a - b) * c * s, a * s * s + b * c * c], axis=1)

    before, after = unsettled(metric, monkeypatch), am.generate(SQUARE, metric)
    assert am.measure(before, metric).unit_fraction < 0.95
    assert np.array_equal(before.triangles, after.triangles)
