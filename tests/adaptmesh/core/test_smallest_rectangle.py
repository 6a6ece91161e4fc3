"""The smallest rectangle around points, against all directions tried one by one."""

import numpy as np
import pytest
from reference.transforms import SIMILARITIES

from adaptmesh.geometry.smallest_rectangle import longer_side


def by_trying(points):
    """Along each line through two points, of which the edges of the hull are some."""
    d = (points[:, None] - points[None]).reshape(-1, 2)
    d = d[np.hypot(*d.T) > 0]
    d /= np.hypot(*d.T)[:, None]
    along = np.ptp(points @ d.T, axis=0)
    across = np.ptp(points @ np.stack([-d[:, 1], d[:, 0]]), axis=0)
    areas = along * across
    return np.maximum(along, across)[areas <= areas.min() * (1 + 1e-9)].max()


@pytest.mark.parametrize("transform", SIMILARITIES, ids=str)
def test_it_is_the_smallest_of_all_directions(transform):
    for seed in range(40):
        rng = np.random.default_rng(seed)
        points = rng.random((rng.integers(3, 12), 2)) * [1, 10 ** rng.uniform(-2, 2)]
        got = longer_side(transform(points)) / transform.scale
        assert got == pytest.approx(by_trying(points), rel=1e-8)


@pytest.mark.parametrize("transform", SIMILARITIES, ids=str)
def test_rectangles_and_regular_polygons(transform):
    rectangle = [(0, 0), (3, 0), (3, 0.5), (3, 1), (0, 1), (1, 0.3)]
    assert longer_side(transform(rectangle)) == pytest.approx(3 * transform.scale, rel=1e-8)
    for n in (3, 4, 5, 6, 17, 1000):
        a = 2 * np.pi * np.arange(n) / n
        polygon = np.stack([np.cos(a), np.sin(a)], axis=1)
        got = longer_side(transform(polygon)) / transform.scale
        assert got == pytest.approx(longer_side(polygon), rel=1e-8)


def test_along_the_axes_it_is_the_larger_extent_to_the_bit():
    rng = np.random.default_rng(1)
    for _ in range(50):
        low, size = rng.normal(size=2), rng.random(2)
        corners = low + size * [(0, 0), (1, 0), (1, 1), (0, 1)]
        assert longer_side(corners) == np.ptp(corners, axis=0).max()
