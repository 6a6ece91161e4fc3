"""The cases of the demo, at coarse sizes."""

import numpy as np
import pytest

import adaptmesh as am
from adaptmesh.cli import demo


@pytest.mark.slow
def test_everything_is_written_and_reported(tmp_path):
    lines = []
    written = demo.make_demo(tmp_path, say=lines.append, coarsening=8.0)
    assert {path.suffix for path in written} == {".vtu", ".png"}
    assert all(path.stat().st_size > 1000 for path in written)
    assert sorted(tmp_path.iterdir()) == sorted(written)
    for name in ("iceland", "naca0012"):
        assert am.read(tmp_path / f"{name}.vtu").validate().ok
    assert sum(line.startswith("wrote ") for line in lines) == len(written)


def test_iceland_keeps_its_coast_between_land_and_sea():
    case = demo.iceland(coarsening=4.0)
    mesh = am.generate(case.domain, case.field)
    land = mesh.areas[mesh.triangles_in("land")].sum()
    assert land == pytest.approx(101_700, rel=0.02)  # simplified; the outline has 101 717 km²
    assert mesh.areas[mesh.triangles_in("sea")].sum() == pytest.approx(case.domain.area - land)
    assert am.measure(mesh, case.field).unit_fraction > 0.95


def test_the_size_around_iceland_grows_from_the_coast():
    size = demo.iceland().field
    distance_to_the_pole = np.array([[0.0, 1000.0]])
    assert size(distance_to_the_pole) == pytest.approx(1.5 + 0.2 * (1000.0 - 174.0), rel=0.05)


def test_the_aerofoil_is_a_naca_0012():
    wing = demo.Wing(h_edges=2e-4)
    x, y = wing.contour.T
    assert y.max() == pytest.approx(0.06, abs=1e-4)
    assert x[y.argmax()] == pytest.approx(0.3, abs=0.01)
    assert (wing.contour[[0, -1]] == (1.0, 0.0)).all()
    assert np.sum(x[:-1] * y[1:] - x[1:] * y[:-1]) > 0  # counter-clockwise


def test_points_on_the_wall_are_a_step_apart():
    wing = demo.Wing(h_edges=2e-4)
    points = wing.unit_spaced()
    step = np.linalg.norm(np.roll(points, -1, axis=0) - points, axis=1)
    _, _, spacing = wing.nearest(points + 0.5 * (np.roll(points, -1, axis=0) - points))
    assert np.abs(np.log(step / spacing)).max() < 0.1


def test_distance_and_direction_from_the_wall():
    import shapely

    rng = np.random.default_rng(3)
    wing = demo.Wing(h_edges=2e-4)
    outline = shapely.linestrings(wing.contour)
    i = rng.integers(len(wing.contour), size=500)
    x = wing.contour[i] + rng.uniform(1e-6, 0.5, 500)[:, None] * wing.normals[i]
    distance, direction, _ = wing.nearest(x)
    assert distance == pytest.approx(shapely.distance(outline, shapely.points(x)), abs=1e-12)
    assert np.linalg.norm(direction, axis=1) == pytest.approx(1.0)
    foot = x - distance[:, None] * direction
    assert shapely.distance(outline, shapely.points(foot)).max() < 1e-12


def test_the_metric_has_the_sizes_asked_for_across_and_along():
    normal = np.array([[0.6, 0.8], [1.0, 0.0]])
    across, along = np.array([1e-4, 0.5]), np.array([1e-2, 2.0])
    m11, m12, m22 = demo.packed_metric(normal, across, along).T
    tensors = np.stack([np.stack([m11, m12], 1), np.stack([m12, m22], 1)], 1)
    tangent = np.stack([-normal[:, 1], normal[:, 0]], axis=1)
    for direction, size in ((normal, across), (tangent, along)):
        length = np.sqrt(np.einsum("ni,nij,nj->n", direction, tensors, direction))
        assert length * size == pytest.approx(1.0)


@pytest.mark.slow
def test_thin_triangles_along_the_wall():
    case = demo.aerofoil(coarsening=4.0)
    mesh = am.generate(case.domain, case.field)
    assert mesh.validate().ok
    assert am.measure(mesh, case.field).unit_fraction > 0.95
    touching = np.isin(mesh.triangles, mesh.edges_named("wall")).sum(axis=1) == 2
    height = 2.0 * mesh.areas[touching]
    p = mesh.points[mesh.triangles[touching]]
    longest = np.linalg.norm(p - np.roll(p, 1, axis=1), axis=2).max(axis=1)
    assert np.median(longest**2 / height) > 5.0
