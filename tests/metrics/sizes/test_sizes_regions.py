"""One size for each region, the smaller one on interfaces."""

from types import SimpleNamespace

import numpy as np
import pytest

from metrics import MetricError, RegionSizes, tensor


def strip(regions, names):
    """Squares in a row, [k, k + 1] x [0, 1], two triangles each."""
    n = len(regions)
    points = np.array([(k, y) for k in range(n + 1) for y in (0.0, 1.0)], float)
    triangles = [
        t for k in range(n) for t in ((2 * k, 2 * k + 2, 2 * k + 3), (2 * k, 2 * k + 3, 2 * k + 1))
    ]
    return SimpleNamespace(
        points=points,
        triangles=np.array(triangles, np.int32),
        regions=np.repeat(np.array(regions, np.int32), 2),
        region_names=names,
    )


MESH = strip([1, 2, 0, 1], {"steel": 1, "air": 2})


def sizes(field, points):
    return tensor.sizes(field(points))[:, 0]


def test_by_name_by_number_and_by_default():
    points = [[0.5, 0.3], [1.5, 0.3], [2.5, 0.3], [3.5, 0.8]]
    for field in (
        RegionSizes(MESH, {"steel": 0.1, "air": 0.5, 0: 0.3}, growth=None),
        RegionSizes(MESH, {1: 0.1, "air": 0.5}, default=0.3, growth=None),
    ):
        np.testing.assert_allclose(sizes(field, points), [0.1, 0.5, 0.3, 0.1])


def test_the_smaller_on_an_interface():
    field = RegionSizes(MESH, {"steel": 0.1, "air": 0.5}, default=0.3, growth=None)
    y = np.linspace(0, 1, 11)
    for x, wanted in ((1.0, 0.1), (2.0, 0.3), (3.0, 0.1)):
        points = np.stack([np.full(11, x), y], axis=1)
        np.testing.assert_allclose(sizes(field, points), wanted)
        order = np.random.default_rng(0).permutation(11)
        np.testing.assert_allclose(sizes(field, points[order]), wanted)


def test_the_smallest_at_a_vertex_of_three_regions():
    mesh = SimpleNamespace(
        points=[(0, 0), (1, 0), (0, 1), (-1, 0), (0, -1)],
        triangles=[(0, 1, 2), (0, 2, 3), (0, 3, 4), (0, 4, 1)],
        triangle_regions=np.array([1, 2, 3, 3]),
        region_names={"a": 1, "b": 2, "c": 3},
    )
    field = RegionSizes(mesh, {"a": 0.3, "b": 0.1, "c": 0.2}, growth=None)
    points = [[0, 0], [0.5, 0], [-0.5, 0], [0, 0.5], [0.1, -0.1]]
    np.testing.assert_allclose(sizes(field, points), [0.1, 0.2, 0.1, 0.1, 0.2])


def test_outside():
    np.testing.assert_allclose(
        sizes(RegionSizes(MESH, {"steel": 0.1}, 1.0, growth=None), [[-3, 0.5]]), 0.1
    )
    with pytest.raises(MetricError, match="outside"):
        RegionSizes(MESH, {"steel": 0.1}, 1.0, outside="error", growth=None)([[-3, 0.5]])


def test_one_region_has_no_interfaces():
    np.testing.assert_allclose(
        sizes(RegionSizes(strip([0, 0], {}), {}, default=0.2), [[1.0, 0.5]]), 0.2
    )


@pytest.mark.parametrize(
    ("sizes_", "default", "message"),
    [
        ({"steel": 0.1}, None, "region number 0 has no size: add it"),
        ({"steel": 0.1, 0: 1}, None, "region 'air' has no size"),
        (
            {"copper": 0.1},
            1,
            r"no region 'copper'; the names are 'steel', 'air', the numbers \[0, ",
        ),
        ({7: 0.1}, 1, "no region 7"),
        ({"steel": -1}, 1, "the size of region 'steel' must be positive, not -1"),
        ({"steel": 1}, 0, "default must be positive"),
    ],
)
def test_refused(sizes_, default, message):
    with pytest.raises(MetricError, match=message):
        RegionSizes(MESH, sizes_, default)


def test_a_mesh_without_regions():
    bare = SimpleNamespace(points=MESH.points, triangles=MESH.triangles, region_names={})
    with pytest.raises(MetricError, match="neither triangle_regions nor regions"):
        RegionSizes(bare, {}, 1.0)
