"""Borders that were rounded and then turned, scaled or shifted: their digits tell nothing."""

import numpy as np
import pytest
from reference.transforms import SIMILARITIES

import adaptmesh as am
from adaptmesh.curves import Circle, Line
from adaptmesh.mesh.bend_noise import bend_noise

RING = np.array([(0, 0), (1, 0.2), (0.8, 0.9), (0.1, 0.7)])
ROUNDED = {
    "6 decimals": lambda p: np.round(p, 6),
    "float32": lambda p: p.astype(np.float32).astype(float),
    "9 digits": lambda p: np.array([[float(f"{v:.9g}") for v in row] for row in p]),
}


def of_bare(mesh, points):
    turned = am.Mesh(points, mesh.triangles, edges=mesh.edges).areas.sum() < 0
    triangles = mesh.triangles[:, ::-1] if turned else mesh.triangles
    return am.Mesh(points, triangles, edges=mesh.edges).to_domain()


@pytest.mark.parametrize("rounded", ROUNDED)
@pytest.mark.parametrize("transform", SIMILARITIES, ids=str)
def test_corners_of_what_was_rounded_first(transform, rounded):
    mesh = am.generate(am.Domain.polygon(RING), 0.02)
    points = ROUNDED[rounded](mesh.points)
    domain = of_bare(mesh, transform(points))
    assert domain.corners_found.corners == 4
    error = np.abs(points - mesh.points).max() * transform.scale
    far = 16 * np.finfo(float).eps * np.abs(transform.offset).max()
    assert domain.corners_found.tolerance < 50 * error + far


@pytest.mark.fast_cases(2)
@pytest.mark.parametrize("transform", SIMILARITIES, ids=str)
def test_true_corners_and_curves_beside_noise_stay(transform):
    """A side bent by 50 times the noise, a jog, and a half circle of short edges."""
    rng = np.random.default_rng(3)
    ring = np.array([(0, 0), (0.5, -5e-5), (1, 0), (1, 0.5), (1.0001, 0.503), (1, 1), (0, 1)])
    mesh = am.generate(am.Domain.polygon(ring), 0.02)
    noisy = mesh.points + rng.uniform(-1e-6, 1e-6, mesh.points.shape)
    found = of_bare(mesh, transform(noisy))
    assert found.corners_found.corners == 7
    half = am.generate(
        am.Domain.from_curves(
            [Circle((0, 0), 1).part(0, 0.5), Line((-1, 0), (-1, -1)), Line((-1, -1), (1, -1)),
             Line((1, -1), (1, 0))]
        ),
        0.02,
    )  # fmt: skip
    arc = np.hypot(*half.points.T) > 1 - 1e-9
    arc &= half.points[:, 1] >= -1e-9
    noisy = half.points + rng.uniform(-1e-7, 1e-7, half.points.shape)
    found = of_bare(half, transform(noisy))
    assert found.corners_found.corners == arc.sum() + 2


def test_what_is_no_noise():
    """Circles, zigzags of five digits, exact sides, few vertices: nothing is said of them."""
    t = np.linspace(0, 2 * np.pi, 3000, endpoint=False)
    circle = np.stack([np.cos(t), np.sin(t)], axis=1)
    zigzag = circle * (1 + 1e-5 * np.where(np.arange(3000) % 2, 1, -1))[:, None]
    ring = np.stack([np.arange(3000), np.roll(np.arange(3000), -1)], axis=1)
    line = np.stack([np.linspace(0, 1, 3000), np.linspace(0, 0.3, 3000)], axis=1)
    for points, edges in ((circle, ring), (zigzag, ring), (line, ring[:-1])):
        assert bend_noise(points, edges, 1e-13, 2e-3) is None
    few = np.stack([np.arange(20), 1e-7 * np.random.default_rng(0).normal(size=20)], axis=1)
    assert bend_noise(few, ring[:19], 1e-13, 1.0) is None
    many = np.stack([np.arange(90), 1e-7 * np.random.default_rng(0).normal(size=90)], axis=1)
    assert 3e-8 < bend_noise(many, ring[:89], 1e-11, 1.0) < 3e-7
