"""Metrics carried by meshes: exact for affine fields, found on any mesh, the same in any thread."""

import copy
import pickle
from concurrent.futures import ThreadPoolExecutor
from types import SimpleNamespace

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.spatial import Delaunay, QhullError

from metrics import Background, MetricError, as_control_space, tensor


def cross(u, v):
    return u[..., 0] * v[..., 1] - u[..., 1] * v[..., 0]


def triangulated(points, keep):
    """The Delaunay triangles whose centroids satisfy `keep`, counter-clockwise."""
    t = Delaunay(points).simplices
    p = points[t]
    area = cross(p[:, 1] - p[:, 0], p[:, 2] - p[:, 0])
    t = np.where((area < 0)[:, None], t[:, ::-1], t)
    return t[(np.abs(area) > 1e-12) & keep(p.mean(axis=1))].astype(np.int32)


def grid(n):
    """A square of jittered points, those of the border exactly on it."""
    rng = np.random.default_rng(7)
    x, y = np.meshgrid(np.linspace(-1, 1, n), np.linspace(-1, 1, n))
    points = np.stack([x.ravel(), y.ravel()], 1)
    inner = (np.abs(points) < 1 - 1e-9).all(axis=1)
    points[inner] += rng.uniform(-0.3 / n, 0.3 / n, (inner.sum(), 2))
    return points


def radius(x):
    return np.hypot(x[:, 0], x[:, 1])


SHAPES = {
    "square": lambda x: np.ones(len(x), bool),
    "L": lambda x: (x[:, 0] < 0) | (x[:, 1] < 0),
    "ring": lambda x: (radius(x) < 0.95) & (radius(x) > 0.45),
    "two parts": lambda x: np.abs(x[:, 0]) > 0.2,
    "comb": lambda x: (x[:, 1] < -0.5) | (np.floor(4 * x[:, 0]) % 2 == 0),
}


def affine_logs(x):
    """Logarithms that are affine in x, hence reproduced exactly by P1."""
    return np.stack([1 + 2 * x[:, 0], 0.5 - x[:, 1], x[:, 0] + 3 * x[:, 1]], 1)


def affine(x):
    return tensor.exp(affine_logs(x))


def random_points_in(points, triangles, n, seed=0):
    """Points inside of triangles that are known: (points, triangles)."""
    rng = np.random.default_rng(seed)
    owners = rng.integers(0, len(triangles), n)
    weights = rng.dirichlet([1, 1, 1], n)
    return np.einsum("ki,kid->kd", weights, points[triangles[owners]]), owners


def layered(xs, ys):
    """The mesh of a grid of lines, each rectangle cut in two: (points, triangles)."""
    x, y = np.meshgrid(xs, ys)
    i = np.arange(x.size).reshape(x.shape)
    a, b, c, d = (v.ravel() for v in (i[:-1, :-1], i[:-1, 1:], i[1:, 1:], i[1:, :-1]))
    triangles = np.concatenate([np.stack([a, b, c], 1), np.stack([a, c, d], 1)])
    return np.stack([x.ravel(), y.ravel()], 1), triangles.astype(np.int32)


def barycentric(points, triangles, x, owners):
    p, q, r = (points[triangles[owners, k]] for k in range(3))
    parts = [cross(q - x, r - x), cross(r - x, p - x), cross(p - x, q - x)]
    return np.stack(parts, 1) / np.sum(parts, axis=0)[:, None]


@pytest.fixture(params=SHAPES)
def shape(request):
    points = grid(17)
    triangles = triangulated(points, SHAPES[request.param])
    return points, triangles, Background(points, triangles, affine(points))


# --- values and location -----------------------------------------------------------------------


def test_affine_logarithms_are_reproduced(shape):
    points, triangles, field = shape
    x, _ = random_points_in(points, triangles, 500)
    np.testing.assert_allclose(field(x), affine(x), rtol=1e-12)


def test_the_triangle_found_has_the_point(shape):
    points, triangles, field = shape
    x, owners = random_points_in(points, triangles, 500)
    found = field.evaluate(x)[1]
    assert found.dtype == np.int32
    assert barycentric(points, triangles, x, found).min() > -1e-12
    assert (found == owners).mean() > 0.99


def test_hints_of_any_quality_give_the_same(shape):
    points, triangles, field = shape
    x, owners = random_points_in(points, triangles, 500)
    wanted = field(x)
    rng = np.random.default_rng(1)
    for hints in (
        owners,
        rng.integers(0, len(triangles), len(x)),
        np.full(len(x), -1),
        np.full(len(x), 10**9),
        np.full(len(x), -(10**9)),
    ):
        got, found = field.evaluate(x, hints)
        np.testing.assert_allclose(got, wanted, rtol=1e-12)
        assert barycentric(points, triangles, x, found).min() > -1e-12


def test_vertices_and_midpoints_of_edges_are_inside(shape):
    points, triangles, _ = shape
    strict = Background(points, triangles, affine(points), outside="error")
    corners = points[triangles]
    x = np.concatenate([corners.reshape(-1, 2), 0.5 * (corners + np.roll(corners, 1, 1))[:, 0]])
    np.testing.assert_allclose(strict(x), affine(x), rtol=1e-12)


def nearest_on_border(points, triangles, x):
    """By trying every border edge."""
    sides = triangles[:, [[1, 2], [2, 0], [0, 1]]].reshape(-1, 2)
    _, index, count = np.unique(np.sort(sides, 1), axis=0, return_index=True, return_counts=True)
    p, q = points[sides[index[count == 1]]].transpose(1, 0, 2)
    e = q - p
    t = np.clip(((x[:, None] - p) * e).sum(-1) / (e**2).sum(-1), 0, 1)
    near = p + t[..., None] * e
    distance = np.linalg.norm(near - x[:, None], axis=-1)
    return near[np.arange(len(x)), distance.argmin(1)], distance.min(1)


def test_outside_is_clamped_to_the_nearest_point_of_the_border(shape):
    points, triangles, field = shape
    rng = np.random.default_rng(2)
    x = rng.uniform(-1.5, 1.5, (400, 2))
    pairs = np.repeat(x, len(triangles), axis=0), np.tile(np.arange(len(triangles)), len(x))
    inside = barycentric(points, triangles, *pairs).min(axis=1).reshape(len(x), -1) >= 0
    x = x[~inside.any(axis=1)]
    assert len(x) > 50
    near, _ = nearest_on_border(points, triangles, x)
    hints = rng.integers(-1, len(triangles), len(x))
    np.testing.assert_allclose(field(x), affine(near), rtol=1e-9)
    np.testing.assert_allclose(field.evaluate(x, hints)[0], affine(near), rtol=1e-9)


def test_outside_can_be_an_error():
    points = grid(9)
    triangles = triangulated(points, SHAPES["ring"])
    field = Background(points, triangles, affine(points), outside="error")
    with pytest.raises(MetricError, match=r"point 1 \(0.0, 0.0\) is outside .* by 0\.\d+; .*clamp"):
        field([[0.7, 0.0], [0.0, 0.0]])


@pytest.mark.parametrize("scale", [1e-9, 1.0, 1e9])
@pytest.mark.parametrize("offset", [0.0, 1e6])
def test_any_scale_and_offset(scale, offset):
    if scale < 1 and offset:
        pytest.skip("the points would coincide")
    points = scale * grid(9) + offset
    triangles = triangulated(grid(9), SHAPES["L"])
    h = 0.1 + np.arange(len(points)) / 100
    field = Background(points, triangles, h, outside="error")
    np.testing.assert_allclose(field(points[triangles[:, 0]]), tensor.pack(h[triangles[:, 0]]))


def test_thin_triangles_of_a_layer():
    """A million to one: walks along the layer would take thousands of steps."""
    x, y = np.meshgrid(np.linspace(0, 1, 5), np.r_[0, np.geomspace(1e-6, 1, 60)])
    points = np.stack([x.ravel(), y.ravel()], 1)
    k = np.arange(points.shape[0] - 5)
    k = k[k % 5 != 4]
    triangles = np.concatenate([np.stack([k, k + 1, k + 6], 1), np.stack([k, k + 6, k + 5], 1)])
    field = Background(points, triangles, affine(points), outside="error")
    x, owners = random_points_in(points, triangles, 2000)
    got, found = field.evaluate(x, np.roll(owners, 1))
    np.testing.assert_allclose(got, affine(x), rtol=1e-8)
    np.testing.assert_allclose(field(x), affine(x), rtol=1e-8)
    assert barycentric(points, triangles, x, found).min() > -1e-8


def test_one_triangle():
    field = Background([[0, 0], [1, 0], [0, 1]], [[0, 1, 2]], [1.0, 2.0, 4.0])
    np.testing.assert_allclose(tensor.sizes(field([[0.5, 0.5]]))[0, 0], 8**0.5)
    np.testing.assert_allclose(tensor.sizes(field([[5.0, 5.0]]))[0, 0], 8**0.5)
    np.testing.assert_allclose(tensor.sizes(field([[-3.0, -1.0]]))[0, 0], 1.0)


@settings(max_examples=50)
@given(st.integers(0, 2**32 - 1), st.integers(4, 40))
def test_random_meshes(seed, n):
    rng = np.random.default_rng(seed)
    points = rng.integers(0, 8, (n, 2)).astype(float)  # many collinear, cocircular, repeated
    try:
        triangles = triangulated(points, lambda x: rng.random(len(x)) < 0.7)
    except QhullError:  # all points on a line
        return
    if len(triangles) == 0:
        return
    field = Background(points, triangles, affine(points / 8))
    x, owners = random_points_in(points, triangles, 50, seed)
    np.testing.assert_allclose(field(x), affine(x / 8), rtol=1e-10)
    got, _ = field.evaluate(x, np.roll(owners, 1))
    np.testing.assert_allclose(got, affine(x / 8), rtol=1e-10)


def test_threads_give_the_same_bits():
    points = grid(33)
    triangles = triangulated(points, SHAPES["ring"])
    field = Background(points, triangles, affine(points))
    x = np.random.default_rng(3).uniform(-1.2, 1.2, (20_000, 2))
    wanted, found = field.evaluate(x)
    with ThreadPoolExecutor(4) as pool:
        for got, triangles_found in pool.map(lambda _: field.evaluate(x), range(8)):
            assert got.tobytes() == wanted.tobytes()
            assert triangles_found.tobytes() == found.tobytes()


# --- what it is made from ----------------------------------------------------------------------

SQUARE = np.array([[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]])
TWO = np.array([[0, 1, 2], [0, 2, 3]])


def test_values_of_the_three_shapes_are_the_same():
    h = np.array([0.1, 0.2, 0.3, 0.4])
    packed = tensor.pack(h)
    fields = [Background(SQUARE, TWO, v) for v in (h, packed, tensor.unpack(packed))]
    for field in fields:
        np.testing.assert_array_equal(field(SQUARE / 2), fields[0](SQUARE / 2))


def test_it_is_a_control_space():
    field = Background(SQUARE, TWO, [0.1] * 4)
    assert as_control_space(field) is field
    np.testing.assert_allclose(tensor.sizes((field & 0.05).scaled(2)(SQUARE)), 0.1)
    assert field(np.empty((0, 2))).shape == (0, 3)
    assert repr(field) == "<Background: 4 points, 2 triangles>"


def test_its_arrays_are_its_own():
    points, triangles, h = SQUARE.copy(), TWO.astype(np.int32), np.full(4, 0.1)
    field = Background(points, triangles, h)
    points[:], triangles[:], h[:] = 9, 0, 9
    np.testing.assert_allclose(tensor.sizes(field([[0.5, 0.5]])), 0.1)
    for array in (field.points, field.triangles, field.logs):
        with pytest.raises(ValueError, match="read-only"):
            array[0] = 0


def test_it_can_be_copied_and_pickled():
    field = Background(SQUARE, TWO, [0.1, 0.2, 0.3, 0.4], outside="error")
    for other in (copy.deepcopy(field), pickle.loads(pickle.dumps(field))):
        np.testing.assert_array_equal(other(SQUARE / 3), field(SQUARE / 3))
        with pytest.raises(MetricError, match="outside"):
            other([[5.0, 5.0]])


def test_on_a_mesh_like_object():
    h = [0.1, 0.2, 0.3, 0.4]
    wanted = Background(SQUARE, TWO, h)(SQUARE)
    ours = SimpleNamespace(points=SQUARE, triangles=TWO)
    meshio_like = SimpleNamespace(
        points=np.c_[SQUARE, np.zeros(4)], cells_dict={"triangle": TWO, "line": [[0, 1]]}
    )
    for mesh in (ours, meshio_like):
        np.testing.assert_array_equal(Background.on(mesh, h)(SQUARE), wanted)
    with pytest.raises(MetricError, match="neither triangles"):
        Background.on(SimpleNamespace(points=SQUARE), h)


@pytest.mark.parametrize(
    ("points", "triangles", "values", "message"),
    [
        (SQUARE, TWO, [0.1] * 3, r"shape \(3,\); it must be \(4,\)"),
        (SQUARE, TWO, [0.1, 0.1, np.nan, 0.1], r"point 2 \(1.0, 1.0\) is not finite"),
        (SQUARE, TWO, [0.1, -0.1, 0.1, 0.1], r"point 1 \(1.0, 0.0\) is not positive"),
        (SQUARE, TWO, np.tile([1.0, 2.0, 1.0], (4, 1)), "point 0 .* is not positive definite"),
        (SQUARE, [[0, 1, 4]], [0.1] * 4, r"triangle 0 = \(0, 1, 4\) is out of range: .* 4 points"),
        (SQUARE, [[0, 1, 2], [0, -1, 2]], [0.1] * 4, "triangle 1 .* out of range"),
        (SQUARE, [[0, 2, 1]], [0.1] * 4, r"triangle 0 .*\(0, 0\), \(1, 1\), \(1, 0\) is clockwise"),
        (SQUARE, [[0, 1, 1]], [0.1] * 4, "has no area"),
        (SQUARE, [[0.0, 1.0, 2.0]], [0.1] * 4, "integers"),
        (SQUARE, [[0, 1, 2, 3]], [0.1] * 4, r"\(m, 3\), not \(1, 4\)"),
        (SQUARE, np.empty((0, 3), int), [0.1] * 4, "at least one triangle"),
        (SQUARE, [[0, 1, 2], [0, 1, 3]], [0.1] * 4, r"triangles 0 and 1 overlap .* \(0, 1\)"),
        (SQUARE[:, :1], TWO, [0.1] * 4, "points must have the shape"),
        ([[0.0, np.inf]], TWO, [0.1], "point 0 is not finite"),
    ],
)
def test_what_is_not_a_mesh_is_refused(points, triangles, values, message):
    with pytest.raises(MetricError, match=message):
        Background(points, triangles, values)


def test_other_arguments_are_refused():
    field = Background(SQUARE, TWO, [0.1] * 4)
    for hints in ([0], [0.5] * 4, [[0] * 4]):
        with pytest.raises(MetricError, match="hints must be 4 integers"):
            field.evaluate(SQUARE, hints)
    with pytest.raises(MetricError, match='"clamp" or "error"'):
        Background(SQUARE, TWO, [0.1] * 4, outside="ignore")


@pytest.mark.parametrize(
    ("xs", "ys"),
    [
        (0.5 ** np.arange(300)[::-1], [0.0, 1.0]),  # each column half as wide as the next
        (0.5 ** np.arange(40)[::-1], 0.7 ** np.arange(90)[::-1]),
        (np.linspace(0, 1, 4), np.concatenate([np.linspace(0, 1e-9, 300), [1.0]])),
    ],
    ids=["geometric", "corner", "layer"],
)
def test_triangles_of_all_sizes_are_found(xs, ys):
    points, triangles = layered(xs, ys)
    field = Background(points, triangles, np.ones(len(points)))
    x = points[triangles].mean(axis=1)
    assert np.array_equal(field.evaluate(x)[1], np.arange(len(triangles)))
