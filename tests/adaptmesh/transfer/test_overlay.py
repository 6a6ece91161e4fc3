"""Two meshes laid over each other, and the L² projection from one to the other."""

import itertools

import numpy as np
import pytest
import shapely
from hypothesis import given, settings
from hypothesis import strategies as st
from reference.mesh_pairs import random_pair
from reference.meshes import delaunay, irregular_square, regular_square
from reference.transforms import TRANSFORMS

import adaptmesh as am
from adaptmesh.transfer.flux_limiter import bounds_on_triangles
from adaptmesh.transfer.l2_projection import mass_matrix, solve_mass
from adaptmesh.transfer.spaces import Space, basis

SQUARE = am.Domain.rectangle(0, 0, 1, 1)
SPACES = ("P0", "P1", "P2")


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


@pytest.fixture
def moved_pair(pair, transform):
    """The pair in every position; rounding moves the vertices of its border."""
    return tuple(carried(mesh, transform) for mesh in pair)


def integral(mesh, values, space):
    """Of nodal values, each column."""
    on_triangles = values[Space(mesh, space).nodes_of_triangles]
    if space == "P2":
        on_triangles = on_triangles[:, 3:]
    return mesh.areas @ on_triangles.mean(axis=1)


def error(mesh, values, space, exact):
    """The L² distance of a field from a function, by a rule of degree 8 (3 x 3 x 2 halves)."""
    x, w = np.polynomial.legendre.leggauss(6)
    x, w = 0.5 * (x + 1), 0.5 * w
    s, t = np.meshgrid(x, x, indexing="ij")
    weights = np.stack([s * (1 - t), s * t, 1 - s], axis=-1).reshape(-1, 3)
    share = (2 * np.outer(w * x, w)).ravel()
    shape = basis(int(space[1]), weights)
    at = np.einsum("qi,mij->mqj", weights, mesh.points[mesh.triangles])
    ours = values[Space(mesh, space).nodes_of_triangles] @ shape.T
    theirs = exact(at.reshape(-1, 2)).reshape(ours.shape)
    return np.sqrt(np.sum(mesh.areas * (((ours - theirs) ** 2) @ share)))


def smooth(points):
    return np.sin(4 * points[:, 0]) * np.cos(3 * points[:, 1]) + 0.5


def shapely_areas(old, new):
    """Areas of common parts by (old, new), by a library of polygons."""
    olds, news = (shapely.polygons(m.points[m.triangles]) for m in (old, new))
    i, j = shapely.STRtree(olds).query(news, predicate="intersects")
    areas = shapely.area(shapely.intersection(news[i], olds[j]))
    return {(int(b), int(a)): area for a, b, area in zip(i, j, areas, strict=True)}


def turned(mesh, angle, offset=(0.0, 0.0), scale=1.0, stretch=1.0):
    c, s = np.cos(angle), np.sin(angle)
    points = (mesh.points * [1, stretch]) @ np.array([[c, s], [-s, c]]) * scale + offset
    return am.Mesh(points, mesh.triangles)


def test_areas_are_those_of_a_polygon_library(pair):
    old, new = pair
    overlay = am.Overlay(old, new)
    known = shapely_areas(old, new)
    found = dict(zip(map(tuple, overlay.pairs.tolist()), overlay.areas, strict=True))
    for key in known.keys() | found.keys():
        assert found.get(key, 0) == pytest.approx(known.get(key, 0), abs=1e-15)
    assert (np.diff(overlay.pairs[:, 1]) >= 0).all()
    assert overlay.area == pytest.approx(1, rel=1e-14)
    assert abs(overlay.uncovered).max() < 1e-15
    assert abs(overlay.lost).max() < 1e-15


def grid(n, jitter=0.0, seed=0):
    points, triangles = irregular_square(n, jitter, seed) if jitter else regular_square(n)
    return am.Mesh(points, triangles)


ZOO = {
    "nested grids": (grid(5), grid(9)),
    "grids that touch": (grid(4), grid(5)),
    "other diagonals": (grid(6), grid(6, 1e-300, 3)),
    "nearly the same": (grid(6), grid(6, 1e-14, 3)),
    "jittered": (grid(8, 0.2, 1), grid(7, 0.2, 2)),
    "one triangle over many": (
        am.Mesh([(-1, -1), (3, -1), (-1, 3)], [(0, 1, 2)]),
        grid(6, 0.2),
    ),
}


@pytest.mark.parametrize("case", ZOO, ids=str)
@pytest.mark.parametrize("scale", [1e-9, 1.0, 1e9])
@pytest.mark.parametrize("offset", [0.0, 1.0])
def test_parts_add_up(case, scale, offset):
    old, new = (turned(m, 0.0, offset, scale) for m in ZOO[case])
    if not ((old.areas > 0).all() and (new.areas > 0).all()):
        pytest.skip("triangles vanish in the rounding")
    overlay = am.Overlay(old, new)
    assert overlay.area == pytest.approx(new.areas.sum(), rel=1e-9)
    np.testing.assert_allclose(overlay.uncovered / new.areas, 0, atol=1e-9)
    if case != "one triangle over many":
        np.testing.assert_allclose(overlay.lost / old.areas, 0, atol=1e-13)
    ones = np.ones(len(old.points))
    np.testing.assert_allclose(overlay.project(ones, space="P1"), 1, rtol=1e-8)


@given(seed=st.integers(0, 2**32 - 1), coarse=st.sampled_from([0, 4, 16]))
@settings(max_examples=40, deadline=None)
def test_random_meshes_with_common_coordinates(seed, coarse):
    """On a coarse lattice many vertices and edges of the two coincide or touch."""
    rng = np.random.default_rng(seed)
    meshes = []
    for _ in range(2):
        inner = rng.random((20, 2))
        if coarse:
            inner = np.round(inner * coarse) / coarse
        points = np.unique(np.vstack([inner, [(0, 0), (1, 0), (1, 1), (0, 1)]]), axis=0)
        triangles = am.delaunay(points)
        meshes.append(am.Mesh(points, triangles))
    overlay = am.Overlay(*meshes)
    known = shapely_areas(*meshes)
    found = dict(zip(map(tuple, overlay.pairs.tolist()), overlay.areas, strict=True))
    for key in known.keys() | found.keys():
        assert found.get(key, 0) == pytest.approx(known.get(key, 0), abs=1e-13)


@pytest.mark.parametrize("space", SPACES)
@pytest.mark.parametrize("keep_bounds", [False, True])
def test_the_integral_stays(moved_pair, transform, space, keep_bounds):
    old, new = moved_pair
    rng = np.random.default_rng(0)
    values = rng.random((Space(old, space).size, 3)) ** 4
    moved = am.transfer(
        values, old, new, method="conservative", space=space, keep_bounds=keep_bounds
    )
    assert moved.shape == (Space(new, space).size, 3)
    rounding = 1e-13 + 2 * transform.rounding
    np.testing.assert_allclose(
        integral(new, moved, space), integral(old, values, space), rtol=rounding
    )


@pytest.mark.fast_cases(6)
@pytest.mark.parametrize("space", SPACES)
def test_there_and_back_many_times(moved_pair, transform, space):
    values = np.random.default_rng(1).random(Space(moved_pair[0], space).size)
    before = integral(moved_pair[0], values, space)
    there, back = am.Overlay(*moved_pair), am.Overlay(*moved_pair[::-1])
    for _ in range(20):
        values = back.project(there.project(values, space=space), space=space)
    rounding = 1e-12 + 40 * transform.rounding
    assert integral(moved_pair[0], values, space) == pytest.approx(before, rel=rounding)


@pytest.mark.parametrize(("space", "degree"), [("P0", 0), ("P1", 1), ("P2", 2)])
@pytest.mark.parametrize("keep_bounds", [False, True])
def test_what_both_spaces_hold_is_exact(moved_pair, transform, space, degree, keep_bounds):
    old, new = moved_pair

    def polynomial(points):
        x, y = transform.inverse(points).T
        return 1 + (degree > 0) * (x - 2 * y) + (degree > 1) * (3 * x * x - x * y + y * y)

    moved = am.transfer(
        polynomial(Space(old, space).nodes),
        old,
        new,
        method="conservative",
        space=space,
        keep_bounds=keep_bounds,
    )
    exact = polynomial(Space(new, space).nodes)
    if keep_bounds and degree:
        # At its extremes on the border, a field may lose what the bounds around do not allow.
        assert np.mean(abs(moved - exact) > 1e-12 + 10 * transform.rounding) < 0.2
        assert abs(moved - exact).max() < 0.02
    else:
        np.testing.assert_allclose(moved, exact, atol=1e-12 + 10 * transform.rounding)


@pytest.mark.parametrize("space", SPACES)
def test_the_projection_is_that_of_a_finite_element_library(space):
    """On a refinement, where the old field is a field of the new space."""
    skfem = pytest.importorskip("skfem")
    element = {"P0": skfem.ElementTriP0, "P1": skfem.ElementTriP1, "P2": skfem.ElementTriP2}[space]
    new = mesh_of(0.2)
    theirs = skfem.MeshTri(new.points.T, new.triangles.T.astype(np.int64))
    base = skfem.Basis(theirs, element(), intorder=4)

    @skfem.BilinearForm
    def mass(u, v, w):
        return u * v

    ours, others = mass_matrix(Space(new, space)), mass.assemble(base)
    assert ours.shape == others.shape
    order = np.lexsort(np.round(base.doflocs, 9)) if space != "P0" else np.arange(ours.shape[0])
    mine = np.lexsort(np.round(Space(new, space).nodes.T, 9)) if space != "P0" else order
    difference = ours[mine][:, mine] - others[order][:, order]
    assert abs(difference).max() < 1e-15


@pytest.mark.parametrize("space", SPACES)
def test_moments_against_cutting_each_pair(space):
    """Every old with every new triangle, cut by shapely, integrated on a fan."""
    old, new = grid(4, 0.2, 5), grid(5, 0.2, 6)
    before, after = Space(old, space), Space(new, space)
    values = np.random.default_rng(3).random(before.size)
    moments = np.zeros(after.size)
    x, w = np.polynomial.legendre.leggauss(4)
    x, w = 0.5 * (x + 1), 0.5 * w
    s, t = (a.ravel() for a in np.meshgrid(x, x, indexing="ij"))
    fan = np.stack([s * (1 - t), s * t, 1 - s], axis=1)
    share = 2 * np.outer(w * x, w).ravel()

    def at(mesh, k, points):
        corners = np.column_stack([mesh.points[mesh.triangles[k]], np.ones(3)])
        weights = np.column_stack([points, np.ones(len(points))]) @ np.linalg.inv(corners)
        return basis(before.degree, weights)

    for k, K in enumerate(shapely.polygons(new.points[new.triangles])):
        for j, T in enumerate(shapely.polygons(old.points[old.triangles])):
            part = shapely.intersection(K, T)
            if part.area == 0:
                continue
            ring = shapely.get_coordinates(part.exterior)[:-1]
            for b, c in itertools.pairwise(ring[1:]):
                points = fan @ np.array([ring[0], b, c])
                u = at(old, j, points) @ values[before.nodes_of_triangles[j]]
                area = abs(np.linalg.det([b - ring[0], c - ring[0]])) / 2
                phi = at(new, k, points)
                moments[after.nodes_of_triangles[k]] += area * (share * u) @ phi
    expected = solve_mass(mass_matrix(after), moments[:, None], after.degree)[:, 0]
    moved = am.transfer(values, old, new, method="conservative", space=space)
    np.testing.assert_allclose(moved, expected, atol=1e-11)


@pytest.mark.parametrize(("space", "order"), [("P0", 1), ("P1", 2), ("P2", 3)])
def test_order_of_the_projection(space, order):
    errors = []
    for size in (0.1, 0.05, 0.025):
        old = mesh_of(size)
        new = mesh_of(lambda x, size=size: size * (0.7 + 0.6 * x[:, 1]))
        values = smooth(Space(old, space).nodes)
        moved = am.transfer(values, old, new, method="conservative", space=space)
        errors.append(error(new, moved, space, smooth))
    rates = np.log2(np.divide(errors[:-1], errors[1:]))
    assert (rates > order - 0.2).all(), rates


def test_order_with_bounds():
    """Clipped only where the old field has its extremes, the limited P1 field is nearly as near."""
    for size in (0.1, 0.05, 0.025):
        old = mesh_of(size)
        new = mesh_of(lambda x, size=size: size * (0.7 + 0.6 * x[:, 1]))
        values = smooth(old.points)
        free, kept = (
            error(
                new,
                am.transfer(values, old, new, method="conservative", keep_bounds=keep),
                "P1",
                smooth,
            )
            for keep in (False, True)
        )
        assert kept < 1.5 * free


def step(points):
    return np.where(points[:, 0] + 0.3 * points[:, 1] < 0.6, 0.0, 1.0)


@pytest.mark.parametrize("space", ["P1", "P2"])
def test_a_step_overshoots_unless_bounds_are_kept(moved_pair, transform, space):
    old, new = moved_pair
    values = step(transform.inverse(Space(old, space).nodes))
    free = am.transfer(values, old, new, method="conservative")
    kept = am.transfer(values, old, new, method="conservative", keep_bounds=True)
    assert free.min() < -0.05
    assert free.max() > 1.05
    low, high = 0.0, 1.0
    if space == "P2":  # a quadratic through zeros and ones leaves them in between
        low, high = -0.125, 1.125
    assert kept.min() >= low
    assert kept.max() <= high
    rounding = 1e-14 + 2 * transform.rounding
    assert integral(new, kept, space) == pytest.approx(integral(old, values, space), rel=rounding)
    lumped_is_worse = np.abs(kept - step(transform.inverse(Space(new, space).nodes))).mean()
    assert lumped_is_worse < 0.12


def test_bounds_are_local(moved_pair):
    old, new = moved_pair
    values = np.random.default_rng(0).random(len(old.points))
    kept = am.transfer(values, old, new, method="conservative", keep_bounds=True)
    overlay = am.Overlay(old, new)
    low, high = np.full(len(new.points), np.inf), np.full(len(new.points), -np.inf)
    for t, k in overlay.pairs:
        low[new.triangles[k]] = np.minimum(low[new.triangles[k]], values[old.triangles[t]].min())
        high[new.triangles[k]] = np.maximum(high[new.triangles[k]], values[old.triangles[t]].max())
    assert (kept >= low).all()
    assert (kept <= high).all()


@pytest.mark.parametrize("space", SPACES)
def test_extremes_of_a_quadratic_are_found(pair, space):
    where = Space(pair[0], space)
    columns = np.random.default_rng(4).random((where.size, 2))
    low, high = bounds_on_triangles(where, columns)
    a, b = np.meshgrid(np.linspace(0, 1, 41), np.linspace(0, 1, 41))
    inside = a + b <= 1 + 1e-12
    weights = np.stack([1 - a - b, a, b], axis=-1)[inside]
    shape = basis(where.degree, weights)
    sampled = np.einsum("qi,mik->mqk", shape, columns[where.nodes_of_triangles])
    assert (sampled.min(axis=1) >= low - 1e-14).all()
    assert (sampled.max(axis=1) <= high + 1e-14).all()
    np.testing.assert_allclose(sampled.min(axis=1), low, atol=4e-3)
    np.testing.assert_allclose(sampled.max(axis=1), high, atol=4e-3)


@pytest.mark.parametrize("angle", [0.0, 0.4])
def test_thin_triangles(angle):
    """A million times longer than wide, along the axes and slanted."""
    rng = np.random.default_rng(7)
    meshes = []
    for _ in range(2):
        points = np.vstack([rng.random((150, 2)), [(0, 0), (1, 0), (1, 1), (0, 1)]])
        meshes.append(turned(am.Mesh(points, delaunay(points)), angle, stretch=1e-6))
    old, new = meshes
    values = rng.random(len(old.points))
    for keep in (False, True):
        moved = am.transfer(values, old, new, method="conservative", keep_bounds=keep, space="P1")
        assert integral(new, moved, "P1") == pytest.approx(integral(old, values, "P1"), rel=1e-12)
    ones = am.transfer(np.ones(len(old.points)), old, new, method="conservative", space="P1")
    np.testing.assert_allclose(ones, 1, atol=1e-8)


def test_regions_that_jump_stay_apart(transform):
    """P0 on two regions whose interface is in both meshes: no value leaks across.

    But by the rounding of the interface, which is slanted, beside the least height of a triangle.
    """
    domain = am.Domain(
        [(0, 0), (1, 0), (2, 0), (2, 1), (1, 1), (0, 1)],
        [(0, 1), (1, 2), (2, 3), (3, 4), (4, 5), (5, 0), (1, 4)],
        regions={"iron": (0.5, 0.5), "air": (1.5, 0.5)},
    )
    old, new = mesh_of(0.2, domain), mesh_of(lambda x: 0.05 + 0.1 * x[:, 1], domain)
    permeability = np.where(old.regions == old.region_names["iron"], 5000.0, 1.0)
    meshes = carried(old, transform), carried(new, transform)
    moved = am.transfer(permeability, *meshes, method="conservative")
    expected = np.where(new.regions == new.region_names["iron"], 5000.0, 1.0)
    np.testing.assert_allclose(moved, expected, atol=5000 * (1e-13 + 100 * transform.rounding))


def ring(n):
    angles = np.linspace(0, 2 * np.pi, n, endpoint=False)
    return am.Domain.polygon(np.stack([np.cos(angles), np.sin(angles)], axis=1))


@pytest.mark.parametrize(("old_sides", "new_sides"), [(17, 40), (40, 17), (8, 31)])
@pytest.mark.parametrize("space", SPACES)
@pytest.mark.parametrize("keep_bounds", [False, True])
def test_chords_of_a_curved_boundary_differ(old_sides, new_sides, space, keep_bounds, transform):
    old = carried(mesh_of(0.3, ring(old_sides)), transform)
    new = carried(mesh_of(0.3, ring(new_sides)), transform)
    overlay = am.Overlay(old, new)
    assert overlay.area < min(old.areas.sum(), new.areas.sum())
    assert overlay.area + overlay.uncovered.sum() == pytest.approx(new.areas.sum(), rel=1e-14)
    assert overlay.area + overlay.lost.sum() == pytest.approx(old.areas.sum(), rel=1e-14)
    sevens = np.full(Space(old, space).size, 7.0)
    moved = overlay.project(sevens, space=space, keep_bounds=keep_bounds)
    np.testing.assert_allclose(moved, 7, rtol=1e-13)


@pytest.mark.parametrize("kind", ["curved", "chords"])
@pytest.mark.parametrize("space", SPACES)
def test_extensions_keep_bounds_and_are_not_cut_off(kind, space, transform):
    """The integral is that of the extended field: what exceeds bounds is not merely left out."""
    rng = np.random.default_rng(5)
    old, new = random_pair(rng, kind, lambda mesh: carried(mesh, transform))
    overlay = am.Overlay(old, new)
    before, after = Space(old, space), Space(new, space)
    values = rng.random((before.size, 1)) ** 6
    low, high = bounds_on_triangles(before, values)
    nodes = before.nodes_of_triangles, after.nodes_of_triangles
    moments = overlay._supermesh.moments(values, *nodes, after.size, 0.25, low, high)
    kept = overlay.project(values, space=space, keep_bounds=True)
    np.testing.assert_allclose(integral(new, kept, space), moments.sum(), rtol=1e-14)
    new_low, new_high = bounds_on_triangles(after, kept)
    assert new_low.min() >= low.min() - 1e-14
    assert new_high.max() <= high.max() + 1e-14


def test_what_is_conserved_where_domains_differ():
    """P0: the old field on the common part, and on the rest of a new triangle its mean there."""
    old, new = mesh_of(0.3, ring(12)), mesh_of(0.02, ring(200))
    overlay = am.Overlay(old, new)
    values = np.random.default_rng(0).random(len(old.triangles))
    moved = overlay.project(values)
    olds, news = overlay.pairs.T
    mass = np.bincount(news, overlay.areas * values[olds], len(new.triangles))
    covered = np.bincount(news, overlay.areas, len(new.triangles))
    some = covered > 0
    assert not some.all()
    expected = mass[some] + overlay.uncovered[some] * mass[some] / covered[some]
    np.testing.assert_allclose((moved * new.areas)[some], expected, rtol=1e-12)


def test_a_slit_in_the_old_mesh():
    """The parts of the old mesh under one new triangle do not hang together."""
    slit = am.Domain.polygon(
        [(0, 0), (1, 0), (1, 1), (0, 1)],
        holes=[[(0.1, 0.49), (0.9, 0.49), (0.9, 0.51), (0.1, 0.51)]],
    )
    old = mesh_of(0.1, slit)
    new = am.Mesh([(0, 0), (1, 0), (1, 1), (0, 1)], [(0, 1, 2), (0, 2, 3)])
    overlay = am.Overlay(old, new)
    assert overlay.area == pytest.approx(slit.area, rel=1e-14)
    assert overlay.uncovered.sum() == pytest.approx(0.016, rel=1e-12)


def test_meshes_that_do_not_overlap():
    old, new = mesh_of(0.3), mesh_of(0.3, am.Domain.rectangle(5, 0, 6, 1))
    with pytest.raises(am.TransferError, match="do not overlap"):
        am.transfer(old.points[:, 0], old, new, method="conservative")
    touching = mesh_of(0.3, am.Domain.rectangle(1, 0, 2, 1))
    with pytest.raises(am.TransferError, match="do not overlap"):
        am.transfer(old.points[:, 0], old, touching, method="conservative")


def test_a_new_mesh_that_goes_on_far_outside():
    old, new = mesh_of(0.2), mesh_of(0.2, am.Domain.rectangle(0, 0, 2, 1))
    with pytest.raises(am.TransferError, match=r"\d+ triangles of the new mesh lie far outside"):
        am.Overlay(old, new)
    moved = am.Overlay(old, new, outside=np.inf).project(old.points[:, 0])
    assert moved.max() < 1.2


def test_a_new_mesh_that_leaves_out_much():
    old, new = mesh_of(0.2, am.Domain.rectangle(0, 0, 2, 1)), mesh_of(0.2)
    with pytest.raises(am.TransferError, match=r"\d+ triangles of the old mesh lie far outside"):
        am.Overlay(old, new)
    moved = am.Overlay(old, new, outside=np.inf).project(old.points[:, 0])
    np.testing.assert_allclose(moved, new.points[:, 0], atol=1e-13)


@pytest.mark.parametrize("scale", [1e-150, 1e150])
def test_coordinates_whose_areas_underflow_or_overflow_are_refused(scale):
    old, new = (turned(mesh_of(h), 0.4, scale=scale) for h in (0.5, 0.3))
    with pytest.raises(am.TransferError, match=r"triangle 0 .* expected a size between"):
        am.Overlay(old, new)


def test_a_mesh_that_overlaps_itself_is_refused(pair):
    """It would give an integral twice, or have it twice."""
    good = pair[0]
    n = len(good.points)
    twice = am.Mesh(
        np.tile(good.points, (2, 1)), np.concatenate([good.triangles, good.triangles + n])
    )
    with pytest.raises(am.TransferError, match="triangles of the new mesh overlap each other"):
        am.Overlay(good, twice)
    with pytest.raises(am.TransferError, match="triangles of the old mesh overlap each other"):
        am.Overlay(twice, good)


def test_a_new_mesh_with_a_point_in_no_triangle_is_refused(pair):
    old, new = pair
    loose = am.Mesh(np.concatenate([new.points, [(0.3, 0.4)]]), new.triangles)
    number = len(new.points)
    with pytest.raises(am.TransferError, match=rf"point {number} of the new mesh, at \(0.3, 0.4\)"):
        am.Overlay(old, loose)
    moved = am.transfer(old.points[:, 0], old, loose)
    np.testing.assert_allclose(moved, loose.points[:, 0], atol=1e-14)
    back = am.transfer(loose.points[:, 0], loose, old, method="conservative")
    np.testing.assert_allclose(back, old.points[:, 0], atol=1e-13)


def test_many_fields_and_one_overlay(pair):
    old, new = pair
    rng = np.random.default_rng(0)
    fields = {
        "u": rng.random((len(old.points), 2)),
        "p": rng.random(len(old.triangles)),
        "wave": rng.random(len(old.points)) + 1j,
        "q": rng.random(Space(old, "P2").size),
    }
    moved = am.transfer(fields, old, new, method="conservative")
    assert list(moved) == list(fields)
    for name, values in fields.items():
        alone = am.transfer(values, old, new, method="conservative")
        np.testing.assert_allclose(moved[name], alone, atol=1e-12)
    np.testing.assert_allclose(moved["wave"].imag, 1, rtol=1e-12)
    assert am.transfer({}, old, new, method="conservative") == {}
