"""Points of lines far from the origin are rounded towards the line, by exact distances."""

from fractions import Fraction

import numpy as np
import pytest
from reference.exact_mesh import area_of_rings
from reference.transforms import TRANSFORMS

import adaptmesh as am
from adaptmesh.domain.sides.line_rounding import nearest_to_lines

TRIANGLE = np.array([(0.0, 0), (1, 0.1), (0.3, 0.8)])


def off_line(p, a, b):
    """The distance of a point from a line times the length of the line, exactly."""
    (px, py), (ax, ay), (bx, by) = ([Fraction(float(x)) for x in q] for q in (p, a, b))
    return abs((bx - ax) * (py - ay) - (by - ay) * (px - ax))


@pytest.mark.parametrize("offset", [(1e6, -1e6), (4.5e5, 5.4e6), (0.0, 1e7)])
def test_points_are_much_nearer_to_their_line_and_hardly_moved(offset):
    rng = np.random.default_rng(1)
    ends = rng.uniform(0, 1, (2, 50, 2)) + offset
    line = np.repeat(np.arange(50), 4)
    share = rng.uniform(0.1, 0.9, (200, 1))
    points = ends[0][line] + share * (ends[1] - ends[0])[line]
    moved = nearest_to_lines(points, ends[0], ends[1], line)
    assert np.abs(moved - points).max() <= 1e-3
    before, after = (
        np.array([float(off_line(q, ends[0][k], ends[1][k])) for q, k in zip(p, line, strict=True)])
        for p in (points, moved)
    )
    assert (after <= before * (1 + 1e-9)).all()
    assert after.sum() < 0.03 * before.sum()


def test_points_of_lines_near_the_origin_stay():
    points = TRIANGLE.mean(axis=0)[None]
    assert nearest_to_lines(points, TRIANGLE[:1], TRIANGLE[1:2], np.array([0])) is points


def test_nothing_to_round():
    none = np.empty((0, 2))
    assert nearest_to_lines(none, TRIANGLE[:1], TRIANGLE[1:2], np.empty(0, int)).shape == (0, 2)


@pytest.mark.parametrize("transform", TRANSFORMS, ids=str)
def test_the_area_of_a_domain_is_kept_to_nine_digits_and_more(transform):
    domain = am.Domain.polygon(transform(TRIANGLE))
    metric = transform.metric(np.array([[400.0, 0.0, 400.0]]))
    mesh = am.generate(domain, lambda x: np.tile(metric, (len(x), 1)))
    p = mesh.points[mesh.triangles]
    u, v = p[:, 1] - p[:, 0], p[:, 2] - p[:, 0]
    area = float(np.sum(u[:, 0] * v[:, 1] - u[:, 1] * v[:, 0])) / 2
    exact = float(area_of_rings(domain.points, domain.segments))
    assert area == pytest.approx(exact, rel=1e-11)
