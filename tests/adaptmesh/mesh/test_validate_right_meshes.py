"""Right meshes of every kind are valid: by `validate`, and by the exact oracle where it can judge.

More of them: ``ADAPTMESH_RIGHT_MESHES=2000 pytest`` with this file.
"""

from __future__ import annotations

import os
import time

import numpy as np
import pytest
from reference.exact_domain import faults_against_domain
from reference.exact_mesh import faults_of_mesh
from reference.planted import FAULTS
from reference.random_meshes import right_mesh
from reference.transforms import TRANSFORMS

import adaptmesh as am
from adaptmesh.curves import Arc, Line

COUNT = int(os.environ.get("ADAPTMESH_RIGHT_MESHES", "40"))
LARGEST_EXACT = 100  # triangles: the oracle looks at every pair


@pytest.mark.slow
def test_right_meshes_are_valid_and_the_exact_oracle_agrees():
    seen = 0
    for number in range(COUNT):
        try:
            mesh, what = right_mesh(number)
        except am.AdaptmeshError:
            continue  # the domain was refused
        validity = mesh.validate()
        assert validity.ok, f"{what}\n{validity}"
        seen += 1
        if len(mesh.triangles) <= LARGEST_EXACT:
            assert faults_of_mesh(mesh) == [], what
            if not mesh.domain.curved.paths:
                assert faults_against_domain(mesh, mesh.domain) == [], what
    assert seen >= 0.9 * COUNT


@pytest.mark.fast_cases(1)
@pytest.mark.parametrize("transform", TRANSFORMS[::2], ids=str)
def test_the_oracle_finds_what_validate_finds(transform):
    points = transform([(0, 0), (2, 0), (2, 1), (0, 1), (1, 0), (1, 1)])
    domain = am.Domain(
        points,
        [(0, 4), (4, 1), (1, 2), (2, 5), (5, 3), (3, 0), (4, 5)],
        regions={"a": transform([0.5, 0.5]), "b": transform([1.5, 0.5])},
        names={"left": [5], "between": [6]},
    )
    tensor = transform.metric([[1 / 0.3**2, 0.0, 1 / 0.3**2]])
    mesh = am.generate(domain, lambda x: np.repeat(tensor, len(x), axis=0))
    assert mesh.validate().ok
    # what an oracle without curves, periodic sides, frozen segments and histories can see
    unseen = {"coordinate not a number", "coordinate infinite", "no triangles", "vertex kept twice"}
    for name, plant in FAULTS.items():
        planted = None if name in unseen else plant(mesh)
        if planted is None or not planted[0].validate()["indices in range"].ok:
            continue
        broken = planted[0]
        assert not broken.validate().ok, name
        assert faults_of_mesh(broken) or faults_against_domain(broken, broken.domain), name


def star(arms):
    """Arms that all but meet in the middle."""
    angle = np.pi * np.arange(2 * arms) / arms
    radius = np.where(np.arange(2 * arms) % 2, 1.0, 0.02)
    return np.stack([radius * np.cos(angle), radius * np.sin(angle)], axis=1)


@pytest.mark.slow
def test_a_star_takes_n_log_n():
    """Long sides beside each other, each in the bounding boxes of a thousand others."""

    def seconds(arms):
        mesh = am.generate(am.Domain.polygon(star(arms)), 10.0)
        times = []
        for _ in range(3):
            start = time.process_time()
            assert mesh.validate().ok
            times.append(time.process_time() - start)
        return min(times)

    few, many = seconds(1000), seconds(4000)
    assert many < 10 * few + 0.1  # with all pairs of boxes it was 16 times as much


def holes_of_arcs(k):
    """A square with k² round holes, each of two arcs, turned by half a radian."""
    a = np.pi / 2 * np.arange(4)
    circle = 0.3 * np.stack([np.cos(a), np.sin(a)], axis=1)
    turn = np.array([[np.cos(0.5), np.sin(0.5)], [-np.sin(0.5), np.cos(0.5)]])
    corners = k * np.array([(0, 0), (1, 0), (1, 1), (0, 1)]) @ turn
    curves = [Line(p, q) for p, q in zip(corners, np.roll(corners, -1, axis=0), strict=True)]
    for centre in np.stack(np.meshgrid(*2 * [np.arange(k) + 0.5]), axis=-1).reshape(-1, 2):
        p = (centre + circle) @ turn
        curves += [Arc.through(p[0], p[1], p[2]), Arc.through(p[2], p[3], p[0])]
    return am.Domain.from_curves(curves)


def test_many_round_holes_take_n_log_n():
    """The two arcs of a hole join the same two points: distances tell which polyline is which."""

    def seconds(k):
        mesh = am.generate(holes_of_arcs(k), 10.0)
        times = []
        for _ in range(2):
            start = time.process_time()
            assert mesh.validate().ok
            times.append(time.process_time() - start)
        return min(times)

    few, many = seconds(7), seconds(14)
    assert many < 8 * few  # 4 times as many; with each arc held against all of them 16 times
