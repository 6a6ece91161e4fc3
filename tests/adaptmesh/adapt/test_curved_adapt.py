"""What stays the same over many adaptations of a domain of curves: curves, names and regions."""

import numpy as np
import pytest
from reference.curved import CASES, DISC

import adaptmesh as am


def polygon_area(p):
    return 0.5 * np.sum(p[:, 0] * np.roll(p[:, 1], -1) - p[:, 1] * np.roll(p[:, 0], -1))


def sizes_about(mesh, k):
    """Sizes at the vertices, between 0.1 and 0.5, another pattern for each k."""
    rng = np.random.default_rng(k)
    wave = np.sin(mesh.points @ rng.normal(0, 3, 2) + rng.uniform(0, 6))
    return 0.1 + (0.1 if k % 2 else 0.3) * (1 + wave) / 2 + 0.1 * (k % 2)


@pytest.mark.slow
def test_a_hundred_adaptations_do_not_leave_the_circle():
    mesh = am.generate(DISC, 0.3)
    for k in range(100):
        mesh = am.adapt(mesh, sizes_about(mesh, k))
        rim = mesh.points[np.unique(mesh.edges)]
        assert np.abs(np.hypot(*rim.T) - 1).max() <= 4e-16
        ring = rim[np.argsort(np.arctan2(rim[:, 1], rim[:, 0]))]
        assert mesh.areas.sum() == pytest.approx(polygon_area(ring), rel=1e-13)
        assert mesh.domain is DISC
    mesh.validate().raise_if_invalid()


def lengths_by_name(mesh):
    """Length of the edges that bear each name."""
    d = np.diff(mesh.points[mesh.edges], axis=1)[:, 0]
    return {name: np.hypot(*d[mesh.edge_tags == tag].T).sum() for name, tag in mesh.names.items()}


def areas_by_region(mesh):
    return {name: mesh.areas[mesh.triangles_in(name)].sum() for name in mesh.region_names}


@pytest.mark.fast_cases(2)
@pytest.mark.parametrize("name", ["two regions", "disc of two halves", "dangling spiral"])
def test_names_and_regions_stay_what_they_are(name, tmp_path):
    """A mesh written, read and adapted has the polygon of its chords for a domain, to rounding."""
    make, size = CASES[name]
    domain = make()
    mesh = am.generate(domain, size)
    for k in range(4):
        mesh = am.adapt(mesh, sizes_about(mesh, k))
        assert mesh.domain is domain
        mesh.validate().raise_if_invalid()
    lengths, areas = lengths_by_name(mesh), areas_by_region(mesh)
    assert set(lengths) == set(domain.names)
    assert set(areas) == set(domain.region_names)
    assert all(length > 0 for length in lengths.values())
    for k, suffix in enumerate([".msh", ".vtu"]):
        am.write(tmp_path / f"mesh{suffix}", mesh)
        mesh = am.read(tmp_path / f"mesh{suffix}")
        mesh = am.adapt(mesh, sizes_about(mesh, k))
        mesh.validate().raise_if_invalid()
        assert lengths_by_name(mesh) == pytest.approx(lengths, rel=1e-10)
        assert areas_by_region(mesh) == pytest.approx(areas, rel=1e-10)


def test_a_named_curve_is_as_long_as_its_chords():
    mesh = am.generate(DISC, 0.1)
    n = len(mesh.edges)
    assert lengths_by_name(mesh) == pytest.approx({"rim": 2 * n * np.sin(np.pi / n)}, rel=1e-14)
