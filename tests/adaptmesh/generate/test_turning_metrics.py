"""Metrics of thin ellipses whose axes turn within an edge: right lengths by few evaluations."""

import numpy as np
import pytest
from reference.transforms import TRANSFORMS

import adaptmesh as am
from adaptmesh.boundary.edge_lengths import straight_lengths
from metrics import as_control_space

TURN = np.pi / 2  # of the axes, per unit of x


def turning(ratio, transform):
    """Sizes 1 and 1/ratio with axes that turn, and the points at which it was evaluated."""
    asked = []

    def metric(points):
        asked.append(len(points))
        angle = TURN * transform.inverse(points)[:, 0]
        c, s, high = np.cos(angle), np.sin(angle), ratio**2
        packed = np.column_stack([c * c + high * s * s, (1 - high) * c * s, s * s + high * c * c])
        return transform.metric(packed)

    return metric, asked


def lengths_by_angle(ratio, starts, vectors, n=50_000):
    """The midpoint rule for the speed, with the angle between an edge and the axes."""
    t = (np.arange(n) + 0.5) / n
    out = []
    for start, vector in zip(starts, vectors, strict=True):
        angle = TURN * (start[0] + t * vector[0]) - np.arctan2(vector[1], vector[0])
        speed = np.hypot(np.cos(angle), ratio * np.sin(angle))
        out.append(np.hypot(*vector) * speed.mean())
    return np.array(out)


@pytest.mark.parametrize("transform", TRANSFORMS, ids=str)
@pytest.mark.parametrize("ratio", [1e2, 1e3, 1e4])
def test_lengths_of_edges_along_which_axes_turn(ratio, transform):
    random = np.random.default_rng(3)
    starts = random.random((30, 2))
    angle = TURN * starts[:, 0] + random.normal(0, 0.05, 30)
    size = np.minimum(0.3, 10 ** random.uniform(1.5, 3.5, 30) / ratio)
    vectors = size[:, None] * np.column_stack([np.cos(angle), np.sin(angle)])
    metric, asked = turning(ratio, transform)
    points = transform(np.concatenate([starts, starts + vectors]))
    edges = np.arange(60).reshape(2, 30).T
    lengths = straight_lengths(points, edges, as_control_space(metric))
    exact = lengths_by_angle(ratio, starts, vectors)
    np.testing.assert_allclose(lengths, exact, rtol=0.05)
    assert sum(asked) < 60 + 30 * exact.sum() + 30 * 30


MESHED = [t for t in TRANSFORMS if t.name in ("as it is", "offset by 1e6, turned", "sheared")]


@pytest.mark.parametrize("transform", MESHED, ids=str)
@pytest.mark.parametrize("ratio, side", [(1e3, 0.4), (1e4, 0.1)])
def test_evaluations_are_bounded_per_vertex(ratio, side, transform):
    metric, asked = turning(ratio, transform)
    corners = transform([(0, 0), (side, 0), (side, side), (0, side)])
    mesh = am.generate(am.Domain.polygon(corners), metric)
    assert mesh.validate().ok
    assert sum(asked) < 400 * len(mesh.points)
