"""Fields at the nodes of another mesh."""

import numpy as np
import pytest
from reference.transforms import TRANSFORMS

import adaptmesh as am
from adaptmesh.transfer.spaces import Space

SQUARE = am.Domain.rectangle(0, 0, 1, 1)


def mesh_of(size, domain=SQUARE):
    return am.generate(domain, size)


@pytest.fixture(scope="module")
def pair():
    return mesh_of(0.12), mesh_of(lambda x: 0.03 + 0.1 * x[:, 0])


@pytest.fixture(params=TRANSFORMS, ids=str)
def transform(request):
    return request.param


def carried(mesh, transform):
    return am.Mesh(transform(mesh.points), transform.triangles(mesh.triangles))


def linear(points):
    return 1 + points @ [2, -3]


def quadratic(points):
    x, y = points.T
    return 1 + x - 2 * y + 3 * x * x - x * y + 2 * y * y


@pytest.mark.parametrize(("space", "field"), [("P1", linear), ("P2", quadratic)])
def test_what_the_space_can_hold_is_exact(pair, transform, space, field):
    old, new = (carried(mesh, transform) for mesh in pair)
    moved = am.transfer(field(transform.inverse(Space(old, space).nodes)), old, new)
    expected = field(transform.inverse(Space(new, space).nodes))
    np.testing.assert_allclose(moved, expected, atol=1e-13 + 10 * transform.rounding)


@pytest.mark.parametrize("width", [1e-3, 1e-6, 1e-9, 1e-12])
def test_thin_triangles(pair, width):
    """Turned, and so thin: a linear field is exact, as points are located by exact signs."""
    c, s = np.cos(0.4), np.sin(0.4)
    matrix = np.array([[c, s], [-s * width, c * width]])
    old, new = (am.Mesh(mesh.points @ matrix, mesh.triangles) for mesh in pair)
    moved = am.transfer(linear(old.points), old, new)
    np.testing.assert_allclose(moved, linear(new.points), atol=2e-14)


def test_p0_takes_the_value_at_the_centroid(pair, transform):
    old, new = (carried(mesh, transform) for mesh in pair)
    numbers = np.arange(len(old.triangles))
    moved = am.transfer(numbers, old, new).astype(int)
    corners = old.points[old.triangles[moved]]
    centroids = new.points[new.triangles].mean(axis=1)
    for i in range(3):
        a, b = corners[:, i], corners[:, (i + 1) % 3]
        u, v = b - a, centroids - a
        rounding = 10 * transform.rounding * transform.scale**2
        assert (u[:, 0] * v[:, 1] - u[:, 1] * v[:, 0] >= -rounding).all()


def test_any_number_of_fields_at_once(pair):
    old, new = pair
    velocity = np.stack([linear(old.points), quadratic(old.points)], axis=1)
    given = {
        "velocity": velocity,
        "stress": np.ones((len(old.triangles), 2, 2)),
        "wave": linear(old.points) * (1 + 2j),
        "count": np.arange(len(old.points)),
    }
    moved = am.transfer(given, old, new)
    assert list(moved) == list(given)
    assert moved["velocity"].shape == (len(new.points), 2)
    alone = am.transfer(velocity[:, 1], old, new)
    np.testing.assert_allclose(moved["velocity"][:, 1], alone, atol=1e-14)
    assert moved["stress"].shape == (len(new.triangles), 2, 2)
    np.testing.assert_allclose(moved["wave"], linear(new.points) * (1 + 2j), atol=1e-13)
    assert moved["count"].dtype == np.float64


def test_interpolation_is_of_second_and_third_order():
    def field(points):
        return np.sin(4 * points[:, 0]) * np.cos(3 * points[:, 1])

    target = mesh_of(0.011)
    errors = {"P1": [], "P2": []}
    for size in (0.1, 0.05, 0.025):
        old = mesh_of(size)
        for space, found in errors.items():
            moved = am.transfer(field(Space(old, space).nodes), old, target, space=space)
            found.append(np.sqrt(np.mean((moved - field(Space(target, space).nodes)) ** 2)))
    for space, order in (("P1", 2), ("P2", 3)):
        rates = np.log2(np.divide(errors[space][:-1], errors[space][1:]))
        assert (rates > order - 0.25).all(), (space, rates)


@pytest.mark.parametrize("space", ["P0", "P1", "P2"])
def test_the_same_mesh_gives_the_same_bits(pair, space):
    old = pair[0]
    values = np.random.default_rng(0).random(Space(old, space).size)
    copy = am.Mesh(old.points, old.triangles)
    moved = am.transfer(values, old, copy, space=space)
    np.testing.assert_array_equal(moved, values)
    assert not np.shares_memory(moved, values)


def test_a_common_vertex_keeps_its_bits(pair):
    old = pair[0]
    values = np.random.default_rng(0).random(len(old.points))
    turned = am.Mesh(old.points, np.roll(old.triangles[::-1], 1, axis=1))
    np.testing.assert_array_equal(am.transfer(values, old, turned), values)


def ring(n):
    angles = np.linspace(0, 2 * np.pi, n, endpoint=False)
    return am.Domain.polygon(np.stack([np.cos(angles), np.sin(angles)], axis=1))


@pytest.mark.parametrize(("old_sides", "new_sides"), [(17, 40), (40, 17), (8, 31)])
@pytest.mark.parametrize("space", ["P0", "P1", "P2"])
def test_chords_of_a_curved_boundary_differ(old_sides, new_sides, space, transform):
    old = carried(mesh_of(0.3, ring(old_sides)), transform)
    new = carried(mesh_of(0.3, ring(new_sides)), transform)
    moved = am.transfer(np.full(Space(old, space).size, 7.0), old, new, space=space)
    np.testing.assert_allclose(moved, 7, rtol=1e-14)


def test_too_far_outside():
    old, new = mesh_of(0.2), mesh_of(0.2, am.Domain.rectangle(0, 0, 1.5, 1))
    values = old.points[:, 0]
    with pytest.raises(am.TransferError, match=r"P1 nodes lie far outside .* by 0.5"):
        am.transfer(values, old, new)
    assert am.transfer(values, old, new, outside=np.inf).max() == 1


BAD = {
    "length": (
        lambda m: np.ones(len(m.points) + 1),
        {},
        r"has \d+ values: expected .* on the old mesh",
    ),
    "no length": (lambda m: 3.0, {}, "single number"),
    "nan": (
        lambda m: np.where(np.arange(len(m.points)) == 5, np.nan, 1.0),
        {},
        r"value 5, at \(.*\), is nan",
    ),
    "infinite vector": (
        lambda m: np.where(np.arange(len(m.points)) == 5, np.inf, 1.0)[:, None],
        {},
        r"value 5, at",
    ),
    "text": (lambda m: ["a"] * len(m.points), {}, "array of numbers"),
    "ragged": (lambda m: [[1.0], [1.0, 2.0]], {}, "array of numbers"),
    "space": (lambda m: np.ones(len(m.points)), {"space": "P3"}, "'P3': expected one of"),
    "wrong space": (lambda m: np.ones(len(m.points)), {"space": "P0"}, "P0 on the old mesh takes"),
    "method": (lambda m: np.ones(len(m.points)), {"method": "magic"}, "'magic': expected one of"),
    "negative": (lambda m: np.ones(len(m.points)), {"outside": -1}, "outside=-1"),
    "not a number": (lambda m: np.ones(len(m.points)), {"outside": np.nan}, "outside=nan"),
    "no number": (lambda m: np.ones(len(m.points)), {"outside": None}, "outside=None"),
    "unknown name": (lambda m: {"u": np.ones(len(m.points))}, {"space": {"v": "P1"}}, "no such"),
}


@pytest.mark.parametrize("case", BAD, ids=str)
def test_bad_fields(pair, case):
    values, options, message = BAD[case]
    with pytest.raises(am.TransferError, match=message):
        am.transfer(values(pair[0]), *pair, **options)


def test_a_field_is_named(pair):
    with pytest.raises(am.TransferError, match="field 'pressure' has 3 values"):
        am.transfer({"pressure": [1, 2, 3]}, *pair)


def test_a_length_that_fits_two_spaces():
    ring = am.Mesh(  # around a hole: six points, six triangles
        [(0, 0), (4, 0), (0, 4), (1, 1), (2, 1), (1, 2)],
        [(0, 1, 3), (1, 4, 3), (1, 2, 4), (2, 5, 4), (2, 0, 5), (0, 3, 5)],
    )
    with pytest.raises(am.TransferError, match="fits P0 or P1: say space='P0' or space='P1'"):
        am.transfer(np.ones(6), ring, ring)
    assert am.transfer(np.ones(6), ring, ring, space="P0").shape == (6,)


TRIANGLE = [(0, 0), (1, 0), (0, 1)]
BROKEN = {
    "a number too large": (TRIANGLE, [(0, 1, 3)], r"triangle 0 = \(0, 1, 3\) .* from 0 to 2"),
    "a negative number": (TRIANGLE, [(0, 1, -1)], r"triangle 0 = \(0, 1, -1\) .* from 0 to 2"),
    "nan": ([*TRIANGLE[:2], (np.nan, 1)], [(0, 1, 2)], r"point 2 of the .* \(nan, 1.0\)"),
    "no triangle": (TRIANGLE, np.empty((0, 3), int), "has no triangles"),
}


@pytest.mark.parametrize("method", ["interpolation", "conservative"])
@pytest.mark.parametrize("case", BROKEN, ids=str)
def test_broken_meshes_are_refused_by_both_methods(case, method):
    points, triangles, message = BROKEN[case]
    good, broken = mesh_of(0.5), am.Mesh(points, triangles)
    for old, new, which in ((good, broken, "new"), (broken, good, "old")):
        with pytest.raises(am.TransferError, match=message) as caught:
            am.transfer(np.ones(len(old.points)), old, new, method=method, space="P1")
        assert f"the {which} mesh" in str(caught.value)
    with pytest.raises(am.TransferError, match="the old mesh: expected a Mesh, got NoneType"):
        am.transfer(np.ones(3), None, good, method=method)


@pytest.mark.parametrize(
    ("triangles", "message"),
    [
        ([(0, 2, 1)], "triangle 0 .* counter-clockwise"),
        ([(0, 1, 2), (0, 1, 2)], "the old mesh is not one: .* overlap"),
    ],
)
def test_a_broken_old_mesh(triangles, message):
    broken = am.Mesh([(0, 0), (1, 0), (0, 1)], triangles)
    with pytest.raises(am.TransferError, match=message):
        am.transfer(np.ones(3), broken, mesh_of(0.5), space="P1", outside=np.inf)
