"""`adapt(..., keep=True)` is as unit as a new mesh, however few vertices can be removed.

Random domains, most of them of so few triangles that no vertex lies within; random metrics, finer
and coarser than the mesh. ADAPTMESH_KEEP_CASES sets the number of random cases.
"""

import os

import numpy as np
import pytest
from reference.transforms import TRANSFORMS

import adaptmesh as am
from adaptmesh.adapt.adapt import TOLERANCE

CASES = int(os.environ.get("ADAPTMESH_KEEP_CASES", "30"))
SQUARE = np.array([(0, 0), (1, 0), (1, 1), (0, 1.0)])


def isotropic(transform, size):
    """A metric from sizes as a function of points before the transform."""

    def metric(x):
        h = size(transform.inverse(x)) ** -2.0
        return transform.metric(np.stack([h, 0 * h, h], axis=1))

    return metric


def check(mesh, metric):
    """The mesh, edited: its share of edges that are not unit is that of a new mesh, to 2 %."""
    edited, new = am.adapt(mesh, metric, keep=True), am.generate(mesh.domain, metric)
    assert am.validate(edited), am.validate(edited)
    share, of_new = (1 - am.measure(m, metric).unit_fraction for m in (edited, new))
    n, of_new = len(edited.unique_edges), of_new * len(new.unique_edges)
    # As a share, or as a number: edges that the domain forces to be short are among both.
    assert share * n <= max(of_new, n * of_new / len(new.unique_edges) + TOLERANCE * n) + 1e-6
    n, right = len(edited.triangles), len(new.triangles)
    assert abs(n - right) <= max(6, 0.25 * right)
    return edited


@pytest.mark.fast_cases(6)
@pytest.mark.parametrize("transform", TRANSFORMS, ids=str)
@pytest.mark.parametrize(
    ("outline", "before", "size"),
    [
        (SQUARE, 2.0, 0.08),
        ([(0, 0), (4, 0), (4, 0.1), (0, 0.1)], 0.1, 0.02),
        ([(0, 0), (1, 0), (0.5, 0.8)], 1.0, 0.06),
        ([(0, 0), (0.01, 0), (1, 0), (1, 1), (0, 1)], 2.0, 0.08),  # a short side
        ([(0, 0), (0.01, 0), (1, 0), (1, 1), (0, 1)], 0.08, 1.0),
    ],
    ids=["square", "channel", "triangle", "refined by a short side", "coarsened by a short side"],
)
def test_meshes_with_no_vertex_to_remove_are_filled(transform, outline, before, size):
    domain = am.Domain.polygon(transform(outline))
    mesh = am.generate(domain, isotropic(transform, lambda x: np.full(len(x), before)))
    check(mesh, isotropic(transform, lambda x: np.full(len(x), size)))


def test_curves_and_interfaces_are_filled():
    circles = [am.curves.Circle((0, 0), 1), am.curves.Circle((0.1, 0), 0.4)]
    for holes in ("nesting", []):
        domain = am.Domain.from_curves(circles, holes=holes)
        check(am.generate(domain, 3.0), lambda x: np.full(len(x), 0.05))


def random_domain(rng, transform):
    n = int(rng.integers(3, 9))
    angles = 2 * np.pi * (np.arange(n) + rng.uniform(-0.35, 0.35, n)) / n
    ring = rng.uniform(0.5, 1, n)[:, None] * np.stack([np.cos(angles), np.sin(angles)], axis=1)
    kind = rng.integers(4)
    if kind == 0:  # a short side
        ring = np.insert(ring, 1, ring[0] + 10 ** rng.uniform(-3, -1) * (ring[1] - ring[0]), axis=0)
    elif kind == 1:  # a channel
        ring = SQUARE * [1, 10 ** rng.uniform(-2, -0.5)]
    elif kind == 2:
        hole = rng.uniform(0.05, 0.6) * ring[::-1] / np.abs(ring).max()
        return am.Domain.polygon(transform(4 * SQUARE - 2), holes=[transform(hole)])
    return am.Domain.polygon(transform(ring))


def random_metric(rng, transform, h):
    kind, angle, centre = rng.integers(4), rng.uniform(0, 2 * np.pi), rng.uniform(-1, 1, 2)
    normal, growth = np.array([np.cos(angle), np.sin(angle)]), rng.uniform(0.1, 0.5)
    if kind == 0:
        return isotropic(transform, lambda x: np.full(len(x), h))
    if kind == 1:
        return isotropic(transform, lambda x: h / 3 + growth * np.hypot(*(x - centre).T))
    if kind == 2:
        return isotropic(transform, lambda x: np.minimum(0.5, h + growth * np.abs(x @ normal)))
    along = (h * rng.uniform(2, 20)) ** -2.0
    across = h**-2 - along
    packed = np.array([1.0, 0.0, 1.0]) * along
    packed += across * np.array([normal[0] ** 2, normal[0] * normal[1], normal[1] ** 2])
    return lambda x: transform.metric(np.tile(packed, (len(x), 1)))


@pytest.mark.fast_cases(2)
@pytest.mark.parametrize("seed", range(CASES))
def test_random_metrics_on_meshes_of_few_triangles(seed):
    rng = np.random.default_rng(seed)
    transform = TRANSFORMS[seed % len(TRANSFORMS)]
    domain = random_domain(rng, transform)
    mesh = am.generate(domain, random_metric(rng, transform, 10 ** rng.uniform(-0.9, 0.5)))
    for _ in range(3):
        metric = random_metric(rng, transform, 10 ** rng.uniform(-1.5, 0.3))
        if am.predict(domain, metric) < 1500:
            mesh = check(mesh, metric)
