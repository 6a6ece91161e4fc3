"""Editing a mesh where it does not fit a metric: `adapt(..., keep=True)`."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

import adaptmesh as am
from adaptmesh.adapt.sub_polylines import unit_parts
from adaptmesh.mesh.boundary_polylines import find_polylines


def box():
    """Two regions, a hole, an inner line, a lone point; a name on each kind of line."""
    points = [(0, 0), (2, 0), (2, 1), (0, 1), (1, 0), (1, 1)]
    points += [(0.4, 0.4), (0.6, 0.4), (0.6, 0.6), (0.4, 0.6)]
    points += [(1.3, 0.3), (1.7, 0.6), (1.5, 0.8)]
    segments = [(0, 4), (4, 1), (1, 2), (2, 5), (5, 3), (3, 0), (4, 5)]
    segments += [(6, 7), (7, 8), (8, 9), (9, 6), (10, 11)]
    return am.Domain(
        points,
        segments,
        holes=[(0.5, 0.5)],
        regions={"left": (0.1, 0.1), "right": (1.9, 0.1)},
        names={"in": [5], "out": [2], "hole": [7, 8, 9, 10], "between": [6], "fin": [11]},
    )


def front(t, finest=0.01):
    """Fine across a slanted line at t, coarse along it."""

    def metric(x):
        n = np.array([1, 0.3]) / np.hypot(1, 0.3)
        d = np.abs((x - [t, 0.5]) @ n)
        across = np.minimum(0.08, finest + 0.4 * np.maximum(d - 0.01, 0)) ** -2
        along = 0.08**-2
        return np.stack(
            [
                across * n[0] ** 2 + along * n[1] ** 2,
                (across - along) * n[0] * n[1],
                across * n[1] ** 2 + along * n[0] ** 2,
            ],
            axis=1,
        )

    return metric


def lengths(mesh):
    p = {name: mesh.points[mesh.edges_named(name)] for name in mesh.names}
    return {name: np.linalg.norm(q[:, 1] - q[:, 0], axis=1).sum() for name, q in p.items()}


def areas(mesh):
    return {name: mesh.areas[mesh.triangles_in(name)].sum() for name in mesh.region_names}


LENGTHS = {"in": 1, "out": 1, "hole": 0.8, "between": 1, "fin": 0.5}
AREAS = {"left": 0.96, "right": 1.0}


def check(mesh):
    assert am.validate(mesh), am.validate(mesh)
    assert lengths(mesh) == pytest.approx(LENGTHS, abs=1e-12)
    assert areas(mesh) == pytest.approx(AREAS, abs=1e-12)


def test_the_same_metric_keeps_nearly_all():
    mesh = am.generate(box(), front(0.7))
    edited = am.adapt(mesh, front(0.7), keep=True)
    assert np.mean(edited.kept >= 0) > 0.99
    assert am.measure(edited, front(0.7)).unit_fraction > 0.999
    check(edited)


def test_a_coast_that_is_too_fine_is_not_meshed_again_and_again():
    """Where the domain forces short edges, no mesh is unit; what is there is left as it is."""
    rng = np.random.default_rng(0)
    angles = np.linspace(0, 2 * np.pi, 300, endpoint=False)
    radii = 1 + 0.02 * rng.random(300)
    coast = am.Domain.polygon(np.stack([radii * np.cos(angles), radii * np.sin(angles)], axis=1))
    mesh = am.generate(coast, 0.1)
    unit = am.measure(mesh, 0.1).unit_fraction
    assert unit < 0.8
    edited = am.adapt(mesh, 0.1, keep=True)
    assert np.mean(edited.kept >= 0) > 0.97
    assert am.measure(edited, 0.1).unit_fraction > unit - 0.005


def test_kept_vertices_are_where_they_were():
    mesh = am.generate(box(), front(0.7))
    edited = am.adapt(mesh, front(0.71), keep=True)
    old = edited.kept[edited.kept >= 0]
    np.testing.assert_array_equal(edited.points[edited.kept >= 0], mesh.points[old])
    assert len(np.unique(old)) == len(old)
    assert 0.5 < len(old) / len(edited.points) < 1
    values = np.random.default_rng(0).random(len(mesh.points))
    moved = am.transfer(values, mesh, edited)
    np.testing.assert_array_equal(moved[edited.kept >= 0], values[old])
    assert mesh.kept is None


@pytest.mark.slow
def test_fifty_steps_of_a_moving_front():
    mesh = am.generate(box(), front(0.4))
    kept, units, ratios = [], [], []
    for k in range(1, 51):
        metric = front(0.4 + 0.001 * k)
        mesh = am.adapt(mesh, metric, keep=True)
        kept.append(np.mean(mesh.kept >= 0))
        if k % 5 == 0:
            check(mesh)
            fresh = am.generate(mesh.domain, metric)
            units.append(
                am.measure(mesh, metric).unit_fraction - am.measure(fresh, metric).unit_fraction
            )
            ratios.append(len(mesh.points) / len(fresh.points))
    assert np.mean(kept) > 0.85
    assert min(units) >= -0.001
    assert min(ratios) > 0.97
    assert max(ratios) < 1.04
    report = am.measure(mesh, metric)
    assert report.quality_min > 0.5
    assert report.quality_mean > 0.96


def test_steps_in_which_most_changes_are_as_good_as_new_meshes():
    mesh = am.generate(box(), front(0.3))
    for k in range(1, 8):
        metric = front(0.3 + 0.2 * k)
        mesh = am.adapt(mesh, metric, keep=True)
        check(mesh)
        fresh = am.measure(am.generate(mesh.domain, metric), metric)
        report = am.measure(mesh, metric)
        assert report.unit_fraction > fresh.unit_fraction - 0.002
        assert report.quality_mean > fresh.quality_mean - 0.02
        assert report.count_ratio == pytest.approx(fresh.count_ratio, rel=0.05)


@pytest.mark.parametrize("factor", [0.2, 5.0])
def test_a_metric_that_changes_everywhere_gives_the_new_mesh(factor):
    mesh = am.generate(box(), 0.06)
    edited, fresh = am.adapt(mesh, 0.06 * factor, keep=True), am.generate(box(), 0.06 * factor)
    np.testing.assert_array_equal(edited.points, fresh.points)
    corners = (edited.points[:, None] == box().points).all(axis=2).any(axis=1)
    assert corners.sum() == len(box().points)
    assert (edited.kept[corners] >= 0).all()


def test_fine_in_one_place_and_nowhere_else():
    """A spot between all vertices, that only the prediction meets, far from what is kept."""
    mesh = am.generate(box(), 0.1)

    def spot(x):
        return 0.002 + 0.3 * np.hypot(x[:, 0] - 1.62, x[:, 1] - 0.21)

    def metric(x):
        return np.minimum(0.1, spot(x))

    edited = am.adapt(mesh, metric, keep=True)
    check(edited)
    assert am.measure(edited, metric).unit_fraction > 0.998
    far = np.hypot(*(mesh.points - [1.62, 0.21]).T) > 0.8
    assert np.isin(np.flatnonzero(far), edited.kept).mean() > 0.97


def test_the_outline_is_cut_anew_where_it_is_not_unit():
    square = am.Domain.rectangle(0, 0, 1, 1)
    mesh = am.generate(square, lambda x: 0.05 + 0 * x[:, 0])
    for h in (0.02, 0.09, 0.05):

        def graded(x, h=h):
            return h + (0.05 - h) * np.clip(2 * x[:, 1] - 0.3, 0, 1)

        mesh = am.adapt(mesh, graded, keep=True)
        assert am.validate(mesh), am.validate(mesh)
        p = mesh.points[mesh.edges_named("bottom")]
        sides = np.abs(p[:, 1, 0] - p[:, 0, 0])
        assert sides.min() > h / 1.42
        assert sides.max() < h * 1.42


def test_a_mesh_without_its_domain():
    mesh = am.generate(box(), front(0.7))
    bare = am.Mesh(
        mesh.points,
        mesh.triangles,
        np.where(mesh.regions == 1, 7, 3),
        mesh.edges,
        mesh.edge_tags,
        mesh.names,
        {"left": 7, "right": 3},
    )
    edited = am.adapt(bare, front(0.702), keep=True)
    assert np.mean(edited.kept >= 0) > 0.5
    check(edited)


def test_values_at_the_vertices_and_a_budget():
    mesh = am.generate(box(), front(0.7))
    edited = am.adapt(mesh, front(0.702)(mesh.points), keep=True)
    check(edited)
    with pytest.raises(am.BudgetError, match="max_vertices"):
        am.adapt(mesh, front(0.7, 0.001), keep=True, max_vertices=len(mesh.points))
    # A mesh larger than allowed may be made smaller.
    smaller = am.adapt(mesh, front(0.7, 0.03), keep=True, max_vertices=len(mesh.points) - 1)
    assert len(smaller.points) < len(mesh.points)


def test_progress_grows_from_0_to_1():
    seen = []
    mesh = am.generate(box(), front(0.7))
    am.adapt(mesh, front(0.71), keep=True, progress=lambda stage, f: seen.append(f))
    assert seen == sorted(seen)
    assert seen[-1] == 1


@pytest.mark.fast_cases(4)
@pytest.mark.parametrize("scale", [1e-9, 1.0, 1e9])
@pytest.mark.parametrize("aspect", [1.0, 1e3])
def test_scales_and_anisotropy(scale, aspect):
    h = 0.1 * scale

    def metric(t):
        def tensors(x):
            along = (h * (1 + 0.5 * np.sin((x[:, 0] / scale - t) * 4))) ** -2
            return np.stack([along, 0 * along, along * aspect**2], axis=1)

        return tensors

    plate = am.Domain.rectangle(0, 0, scale, scale / aspect)
    mesh = am.generate(plate, metric(0))
    for k in range(1, 5):
        mesh = am.adapt(mesh, metric(0.05 * k), keep=True)
        assert am.validate(mesh), am.validate(mesh)
    report = am.measure(mesh, metric(0.2))
    assert report.unit_fraction > 0.99
    assert report.count_ratio == pytest.approx(
        am.measure(am.generate(plate, metric(0.2)), metric(0.2)).count_ratio, rel=0.08
    )


@pytest.mark.slow
@given(seed=st.integers(0, 2**32 - 1))
@settings(max_examples=15, deadline=None)
def test_random_metrics_on_random_domains(seed):
    rng = np.random.default_rng(seed)
    angles = np.sort(rng.random(9)) * 2 * np.pi
    radii = rng.uniform(0.5, 1, 9)
    domain = am.Domain.polygon(np.stack([radii * np.cos(angles), radii * np.sin(angles)], axis=1))
    mesh = am.generate(domain, 0.15)
    for _ in range(3):
        centre, least = rng.uniform(-0.7, 0.7, 2), rng.uniform(0.02, 0.1)

        def metric(x, centre=centre, least=least):
            return np.minimum(0.15, least + 0.3 * np.linalg.norm(x - centre, axis=1))

        mesh = am.adapt(mesh, metric, keep=True)
        assert am.validate(mesh), am.validate(mesh)
        assert am.measure(mesh, metric).count_ratio < 1.3


def test_the_same_input_gives_the_same_bits():
    mesh = am.generate(box(), front(0.7))
    one, two = (am.adapt(mesh, front(0.703), keep=True) for _ in range(2))
    np.testing.assert_array_equal(one.points, two.points)
    np.testing.assert_array_equal(one.triangles, two.triangles)
    np.testing.assert_array_equal(one.kept, two.kept)


def test_meshes_that_are_not_of_their_domain_are_made_anew():
    mesh = am.generate(box(), 0.2)
    leaky = am.Mesh(
        mesh.points, mesh.triangles, np.arange(len(mesh.triangles)) % 2, mesh.edges, domain=box()
    )
    assert find_polylines(leaky, box()) is None
    other = am.Domain.rectangle(0, 0, 2, 1)
    assert find_polylines(am.Mesh(mesh.points, mesh.triangles, domain=other), other) is None
    short = am.Mesh(mesh.points, mesh.triangles, mesh.regions, mesh.edges[1:], domain=box())
    assert find_polylines(short, box()) is None
    edited = am.adapt(short, 0.2, keep=True)
    assert am.validate(edited)


def test_frozen_edges_stay():
    mesh = am.generate(box(), front(0.7))
    edited = am.adapt(mesh, front(0.72), keep=True, frozen=["hole", "in"])
    for name in ("hole", "in"):
        old = {tuple(p) for p in mesh.points[mesh.edges_named(name)].reshape(-1, 2)}
        new = {tuple(p) for p in edited.points[edited.edges_named(name)].reshape(-1, 2)}
        assert old == new
    assert edited.domain is mesh.domain
    assert np.mean(edited.kept >= 0) > 0.3
    check(edited)


def test_a_broken_mesh():
    square = am.Domain.rectangle(0, 0, 1, 1)
    mesh = am.generate(square, 0.3)
    twice = am.Mesh(
        mesh.points,
        np.vstack([mesh.triangles, mesh.triangles[:1]]),
        edges=mesh.edges,
        edge_tags=mesh.edge_tags,
        domain=square,
    )
    with pytest.raises(am.DomainError, match=r"triangles \d+ and \d+ overlap"):
        am.adapt(twice, lambda x: np.full(len(x), 0.3), keep=True)
    turned = am.Mesh(
        mesh.points,
        np.vstack([mesh.triangles[1:], mesh.triangles[:1, ::-1]]),
        edges=mesh.edges,
        edge_tags=mesh.edge_tags,
        domain=square,
    )
    with pytest.raises(am.DomainError, match="cannot be adapted"):
        am.adapt(turned, lambda x: np.full(len(x), 0.3), keep=True)


@pytest.mark.parametrize("length", [0.1, 0.8, 1.41, 1.42, 2.4, 2.5, 37.0])
def test_parts_are_as_near_to_unit_as_they_can_be(length):
    parts, part = unit_parts(length)
    assert part == length / parts
    others = [abs(np.log(length / n)) for n in range(1, 60)]
    assert abs(np.log(part)) == pytest.approx(min(others))
