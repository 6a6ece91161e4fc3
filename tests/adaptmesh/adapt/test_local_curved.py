"""`adapt(..., keep=True)` on curves and on periodic boundaries: edited, not meshed again."""

import sys

import numpy as np
import pytest
from reference.curved import CASES, box
from reference.periodic import assert_periodic, by, sector, wavy_channel

import adaptmesh as am
import metrics
from adaptmesh.curves import Circle, Line, Parametric, Spline


def interface(t):
    return np.stack([4 * t, 1 + 0.3 * np.sin(4 * np.pi * t)], axis=1)


def plate():
    """Two regions that meet along a curve, a hole, a dangling curve; a name on each."""
    return am.Domain.from_curves(
        [
            *box(0, 0, 4, 2),
            Parametric(interface),
            Circle((3, 0.45), 0.25),
            Spline([(0.3, 0.4), (0.7, 0.6), (1.1, 0.4)]),
        ],
        names={"inflow": [3], "interface": [4], "hole": [5], "fin": [6]},
        holes=[(3, 0.45)],
        regions={"low": (0.1, 0.1), "high": (0.1, 1.9)},
    )


def front(t, finest=0.03):
    """Fine across a slanted line that passes (t, 1), coarse along it."""
    n = np.array([1.0, 0.4]) / np.hypot(1, 0.4)

    def metric(x):
        across = np.minimum(0.15, finest + 0.15 * np.abs((x - [t, 1]) @ n)) ** -2
        along = np.full(len(x), 0.15**-2)
        return np.stack(
            [
                across * n[0] ** 2 + along * n[1] ** 2,
                (across - along) * n[0] * n[1],
                across * n[1] ** 2 + along * n[0] ** 2,
            ],
            axis=1,
        )

    return metric


def fine_from_left_to_right(t):
    """Fine in x near x = t, and near all its images."""

    def metric(x):
        h = 0.08 - 0.06 * np.cos(np.pi * (x[:, 0] - t)) ** 2
        return np.stack([h**-2, 0 * h, np.full(len(x), 0.08**-2)], axis=1)

    return metric


def fine_between_the_blades(t):
    """Fine in a part of every sector of 60 degrees."""

    def sizes(x):
        angle = np.arctan2(x[:, 1], x[:, 0])
        return 0.09 - 0.05 * np.cos(3 * (angle - t)) ** 2

    return sizes


def sixty_degrees(x):
    c, s = 0.5, np.sqrt(0.75)
    return x @ np.array([[c, s], [-s, c]])


SQUARE = am.Domain.rectangle(0, 0, 1, 1)
PERIODIC = {
    "both ways": (
        SQUARE.with_periodic("left", "right").with_periodic("bottom", "top"),
        [("left", "right", by(1, 0)), ("bottom", "top", by(0, 1))],
        fine_from_left_to_right,
    ),
    "wavy": (
        wavy_channel().with_periodic("left", "right"),
        [("left", "right", by(1, 0))],
        fine_from_left_to_right,
    ),
    "sector": (
        sector().with_periodic("low", "high", rotation=60),
        [("low", "high", sixty_degrees)],
        fine_between_the_blades,
    ),
}


@pytest.fixture
def never_anew(monkeypatch):
    """An error where a new mesh would be made."""

    def refuse(*args, **kwargs):
        raise AssertionError("a new mesh was made")

    monkeypatch.setattr(sys.modules["adaptmesh.adapt.adapt"], "generate", refuse)


@pytest.mark.parametrize("name", ["plate", *PERIODIC])
def test_the_same_metric_keeps_nearly_all(name, never_anew):
    domain, _, metrics = PERIODIC.get(name, (plate(), [], front))
    mesh = am.generate(domain, metrics(1.1))
    edited = am.adapt(mesh, metrics(1.1), keep=True)
    assert np.mean(edited.kept >= 0) > 0.97
    assert am.measure(edited, metrics(1.1)).unit_fraction > 0.995
    assert am.validate(edited), am.validate(edited)


@pytest.mark.fast_cases(3)
@pytest.mark.parametrize("name", ["disc", "aerofoil", "dangling spiral", "slanted", "tiny"])
def test_where_the_curve_asks_for_more_than_the_metric_what_is_there_stays(name, never_anew):
    make, size = CASES[name]
    # An edge that is off, by chance, would be mended with all around it: the best of three meshes.
    fields = [metrics.as_control_space(size).scaled(scale) for scale in (1, 1.03, 1.06)]
    tries = [(am.generate(make(), metric), metric) for metric in fields]
    mesh, metric = max(tries, key=lambda pair: am.measure(*pair).unit_fraction)
    edited = am.adapt(mesh, metric, keep=True)
    assert np.mean(edited.kept >= 0) > 0.97
    assert am.validate(edited), am.validate(edited)


def areas(mesh):
    """Of the regions, with what lies between the chords and the interface."""
    return {name: mesh.areas[mesh.triangles_in(name)].sum() for name in mesh.region_names}


def off_the_circle(mesh):
    hole = mesh.points[np.unique(mesh.edges_named("hole"))]
    return np.abs(np.hypot(*(hole - [3, 0.45]).T) - 0.25).max()


def off_the_interface(mesh):
    x = mesh.points[np.unique(mesh.edges_named("interface"))]
    return np.abs(x - interface(x[:, 0] / 4)).max()


@pytest.mark.slow
def test_a_hundred_steps_to_and_fro_over_curves():
    """A front goes over the plate and back: no drift, and no worse than new meshes."""
    domain = plate()
    mesh = am.generate(domain, front(2))
    kept, units, ratios = [], [], []
    for k in range(100):
        metric = front(2 + np.sin(k * np.pi / 50))
        mesh = am.adapt(mesh, metric, keep=True)
        kept.append(np.mean(mesh.kept >= 0))
        assert max(off_the_circle(mesh), off_the_interface(mesh)) < 1e-12
        if k % 20 == 19:
            assert am.validate(mesh), am.validate(mesh)
            assert mesh.domain is domain
            fresh = am.generate(domain, metric)
            report, new = am.measure(mesh, metric), am.measure(fresh, metric)
            units.append(report.unit_fraction - new.unit_fraction)
            ratios.append(len(mesh.points) / len(fresh.points))
            assert areas(mesh) == pytest.approx(areas(fresh), rel=2e-3)
            assert report.quality_mean > new.quality_mean - 0.02
    assert np.mean(kept) > 0.6
    assert min(units) > -0.005
    assert 0.96 < min(ratios) <= max(ratios) < 1.04


@pytest.mark.slow
@pytest.mark.parametrize("name", PERIODIC)
def test_periodic_boundaries_correspond_after_a_hundred_steps(name):
    domain, pairs, metrics = PERIODIC[name]
    mesh = am.generate(domain, metrics(0))
    kept, units, ratios = [], [], []
    for k in range(100):
        metric = metrics(0.4 * np.sin(k * np.pi / 50))
        mesh = am.adapt(mesh, metric, keep=True)
        kept.append(np.mean(mesh.kept >= 0))
        if k % 20 == 19:
            for pair in pairs:
                assert_periodic(mesh, *pair)
            fresh = am.generate(domain, metric)
            units.append(
                am.measure(mesh, metric).unit_fraction - am.measure(fresh, metric).unit_fraction
            )
            ratios.append(len(mesh.points) / len(fresh.points))
    assert np.mean(kept) > 0.6
    assert min(units) > -0.01
    assert 0.95 < min(ratios) <= max(ratios) < 1.05


def test_one_side_is_cut_and_the_other_follows(never_anew):
    """Fine near the left side alone: the right one gets the same cuts."""
    domain, pairs, _ = PERIODIC["wavy"]
    mesh = am.generate(domain, 0.1)

    def sizes(x):
        return 0.03 + 0.07 * np.clip(np.hypot(x[:, 0], x[:, 1] - 0.5) / 0.3, 0, 1)

    edited = am.adapt(mesh, sizes, keep=True)
    assert_periodic(edited, *pairs[0])
    added = len(edited.edges_named("right")) - len(mesh.edges_named("right"))
    assert added >= 4
    far = mesh.points[:, 0] > 0.6
    assert np.isin(np.flatnonzero(far & (np.abs(mesh.points[:, 0] - 1) > 0.2)), edited.kept).any()


@pytest.mark.parametrize("name", ["hole", "interface", "inflow"])
def test_frozen_boundaries_stay(name, never_anew):
    domain = plate()
    mesh = am.generate(domain, front(2))
    edited = am.adapt(mesh, front(2.03), keep=True, frozen=[name])
    old = {tuple(p) for p in mesh.points[mesh.edges_named(name)].reshape(-1, 2)}
    new = {tuple(p) for p in edited.points[edited.edges_named(name)].reshape(-1, 2)}
    assert old == new
    assert np.mean(edited.kept >= 0) > 0.3
    assert edited.domain is domain
    assert am.validate(edited), am.validate(edited)


def test_a_frozen_side_and_the_one_that_is_periodic_with_it_stay(never_anew):
    domain, pairs, metrics = PERIODIC["wavy"]
    mesh = am.generate(domain, metrics(0.5))
    edited = am.adapt(mesh, metrics(0.52), keep=True, frozen=["left"])
    assert_periodic(edited, *pairs[0])
    for side in ("left", "right"):
        old, new = (m.points[np.unique(m.edges_named(side))] for m in (mesh, edited))
        assert {tuple(p) for p in old} == {tuple(p) for p in new}


def test_curves_that_begin_and_end_at_the_same_corners():
    """Rows are told apart by what their vertices lie on, where corners do not do it."""
    lens = am.Domain.from_curves(
        [
            Parametric(lambda t: np.stack([t, 0.5 * t * (1 - t)], axis=1)),
            Parametric(lambda t: np.stack([t, -0.3 * t * (1 - t)], axis=1)),
            Line((0, 0), (1, 0)),
        ],
        names={"up": [0], "down": [1], "middle": [2]},
    )
    mesh = am.generate(lens, 0.05)
    for h in (0.05, 0.046, 0.05):
        mesh = am.adapt(mesh, h, keep=True)
        assert am.validate(mesh), am.validate(mesh)
        x, y = mesh.points[np.unique(mesh.edges_named("up"))].T
        np.testing.assert_allclose(y, 0.5 * x * (1 - x), atol=1e-12)
        x, y = mesh.points[np.unique(mesh.edges_named("middle"))].T
        assert not y.any()


def test_a_mesh_that_has_left_its_curve_is_made_anew():
    domain = plate()
    mesh = am.generate(domain, 0.2)
    points = mesh.points.copy()
    rim = np.unique(mesh.edges_named("hole"))
    points[rim] = [3, 0.45] + (1 + 1e-6) * (points[rim] - [3, 0.45])
    moved = am.Mesh(
        points,
        mesh.triangles,
        mesh.regions,
        mesh.edges,
        mesh.edge_tags,
        mesh.names,
        mesh.region_names,
        domain,
    )
    edited = am.adapt(moved, 0.2, keep=True)
    assert off_the_circle(edited) < 1e-12
    assert am.validate(edited), am.validate(edited)


def test_the_same_input_gives_the_same_bits():
    domain, _, metrics = PERIODIC["sector"]
    mesh = am.generate(domain, metrics(0.5))
    one, two = (am.adapt(mesh, metrics(0.51), keep=True) for _ in range(2))
    np.testing.assert_array_equal(one.points, two.points)
    np.testing.assert_array_equal(one.triangles, two.triangles)
