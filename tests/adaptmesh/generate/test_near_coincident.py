"""Sides nearer to each other than coordinates are rounded: a right mesh, or a refusal with reasons.

What is right is decided by `reference.exact_mesh`; near_coincident_sides.py is a long run of it.
"""

import os

import numpy as np
import pytest
from reference.exact_mesh import area_of_rings, faults_of_mesh, faults_of_segments
from reference.near_coincident import check, faults
from reference.transforms import TRANSFORMS

import adaptmesh as am

SEEDS = int(os.environ.get("NEAR_COINCIDENT_SEEDS", "200"))
PARTS = 10


@pytest.mark.fast_cases(1)
@pytest.mark.parametrize("part", range(PARTS))
def test_random_domains_with_nearly_coincident_sides(part):
    wrong = {}
    for seed in range(part, SEEDS, PARTS):
        kind, outcome = check(seed)
        if outcome.startswith("FAILED"):
            wrong[seed, kind] = outcome
    assert not wrong


@pytest.mark.fast_cases(1)
@pytest.mark.parametrize("gap", [2.3e-16, 9e-16, 5e-15, 1e-13])
@pytest.mark.parametrize("slope", [0.3, 0.7234])
@pytest.mark.parametrize("h", [0.1, 0.03])
def test_slit(gap, slope, h):
    ring = [(0, 0), (2, 0), (2, 2), (0, 2), (0, 0.2 + gap), (1, 0.2 + slope), (0, 0.2)]
    domain = am.Domain.polygon(ring)
    assert not faults(domain, am.generate(domain, h))


@pytest.mark.fast_cases(3)
@pytest.mark.parametrize("transform", TRANSFORMS, ids=str)
def test_parts_that_touch_in_points_are_cut_on_all_sides(transform):
    """Both ends of each side are corners where two squares meet."""
    n = 4
    corners = np.stack(np.meshgrid(range(n + 1), range(n + 1), indexing="ij"), -1).reshape(-1, 2)
    number = np.arange((n + 1) ** 2).reshape(n + 1, n + 1)
    black = [(i, j) for i in range(n) for j in range(n) if (i + j) % 2 == 0]
    rings = [[number[i, j], number[i + 1, j], number[i + 1, j + 1], number[i, j + 1]]
             for i, j in black]  # fmt: skip
    used, segments = np.unique(
        [[r[k], r[(k + 1) % 4]] for r in rings for k in range(4)], return_inverse=True
    )
    domain = am.Domain(transform(corners[used]), segments.reshape(-1, 2), "nesting")
    metric = transform.metric(np.tile([16.0, 0.0, 16.0], (1, 1)))
    mesh = am.generate(domain, lambda x: np.tile(metric, (len(x), 1)))
    assert len(mesh.edges) == 4 * len(domain.segments)
    assert not faults(domain, mesh)
    again = am.adapt(mesh, lambda x: np.tile(4 * metric, (len(x), 1)), keep=True)
    assert len(again.edges) == 8 * len(domain.segments)
    assert not faults(domain, again)


def test_a_line_between_two_points_where_parts_touch_is_kept():
    """The square with a diagonal, and two more that touch its ends."""
    points = [(0, 0), (1, 0), (1, 1), (0, 1), (-1, 0), (-1, -1), (0, -1), (2, 1), (2, 2), (1, 2)]
    segments = [(0, 1), (1, 2), (2, 3), (3, 0), (0, 2)]
    segments += [(0, 4), (4, 5), (5, 6), (6, 0), (2, 7), (7, 8), (8, 9), (9, 2)]
    domain = am.Domain(points, segments, names={"line": [4]})
    mesh = am.generate(domain, 0.2)
    assert len(mesh.edges_named("line")) == 7
    again = am.adapt(mesh, lambda x: 0.2 - 0.1 * (x[:, 0] > 0.5), keep=True)
    assert again.kept.max() >= 0
    assert not faults(domain, again)
    ends = again.points[again.edges_named("line")]
    assert (ends[..., 0] == ends[..., 1]).all()
    np.testing.assert_allclose(np.hypot(*(ends[:, 1] - ends[:, 0]).T).sum(), np.sqrt(2))


def test_of_cuts_that_correspond_both_are_made_or_none():
    """A line a few units in the last place off one of the periodic sides."""
    for transform in TRANSFORMS:
        corners = transform(np.array([(0.0, 0), (1, 0), (1, 1), (0, 1)]))
        share = np.array([[0.3], [0.7]])
        line = corners[0] + share * (corners[3] - corners[0]) + 1e-15 * (corners[1] - corners[0])
        segments = [(0, 1), (1, 2), (2, 3), (3, 0), (4, 5)]
        try:
            domain = am.Domain(
                np.concatenate([corners, line]), segments, names={"left": [3], "right": [1]}
            ).with_periodic("left", "right")
        except am.DomainError:
            continue
        metric = transform.metric(np.array([[100.0, 0.0, 100.0]]))
        mesh = am.generate(domain, lambda x, m=metric: np.tile(m, (len(x), 1)))
        assert not faults(domain, mesh)


def test_editing_one_border_onto_another_is_noticed():
    """Two parts that are less than any number apart: their edited sides coincide."""
    left = [(0, 0), (1.0587497352553412, 0), (1.0531660965682903, 2), (0, 2)]
    right = [(1.0587497352553412, 5e-324), (2, 0), (2, 2), (1.0531660965685123, 2.0000000000000013)]
    sides = [(k + i, k + (i + 1) % 4) for k in (0, 4) for i in range(4)]
    domain = am.Domain([*left, *right], sides)
    coarse, fine = [0.8984174, 0.36243094, 0.14846945], [10.99378288, 4.76189228, 10.08878014]
    mesh = am.generate(domain, lambda x: np.tile(coarse, (len(x), 1)))
    again = am.adapt(mesh, lambda x: np.tile(fine, (len(x), 1)), keep=True)
    assert not faults(domain, again)


# --- the oracle itself -------------------------------------------------------------------------


def broken(mesh, **changes):
    arrays = {"points": mesh.points, "triangles": mesh.triangles, "edges": mesh.edges}
    return am.Mesh(**{**arrays, **changes})


def test_the_oracle_sees_what_is_wrong():
    mesh = am.generate(am.Domain.polygon([(0, 0), (2, 0), (2, 2), (0, 2)]), 0.5)
    assert not faults_of_mesh(mesh)
    p, t = mesh.points.copy(), mesh.triangles
    border = np.unique(mesh.edges)
    inner = np.setdiff1d(np.arange(len(p)), border)[0]
    far = p.copy()
    far[inner] += 1
    twice = p.copy()
    twice[border[0]] = twice[border[1]]
    for wrong in (
        broken(mesh, points=far),
        broken(mesh, points=twice),
        broken(mesh, triangles=t[:, ::-1]),
        broken(mesh, triangles=np.concatenate([t, t[:1]])),
        broken(mesh, triangles=t[1:]),
        broken(mesh, edges=mesh.edges[1:]),
        broken(mesh, edges=np.concatenate([mesh.edges, mesh.edges[:1]])),
        broken(mesh, points=np.concatenate([p, [[9, 9]]])),
    ):
        assert faults_of_mesh(wrong)
    triangle = [[0, 0], [9, 0], [0, 9], [1, 1], [2, 1], [1, 2]]
    inside = am.Mesh(triangle, [[0, 1, 2], [3, 4, 5]], edges=[[0, 1], [1, 2], [2, 0]])
    assert any("lies in triangle" in fault for fault in faults_of_mesh(inside))
    crossed = [[0, 0], [2, 0], [0, 2], [1, -1], [3, 1], [1, 1]]
    edges = [[0, 1], [1, 2], [2, 0], [3, 4], [4, 5], [5, 3]]
    overlapping = am.Mesh(crossed, [[0, 1, 2], [3, 4, 5]], edges=edges)
    assert any("meet" in fault for fault in faults_of_mesh(overlapping))


def test_the_oracle_sees_what_is_no_mesh_of_the_domain():
    domain = am.Domain.polygon([(0, 0), (2, 0), (2, 2), (0, 2)], [[(0.5, 0.5), (1, 0.5), (1, 1)]])
    area = area_of_rings(domain.points, domain.segments)
    assert area == 4 - 0.125
    mesh = am.generate(domain, 0.5)
    assert not faults_of_segments(mesh, domain.points, domain.segments, area)
    assert faults_of_segments(mesh, domain.points, domain.segments, area + 1)
    cross = [*domain.segments.tolist(), (0, 2)]
    assert faults_of_segments(mesh, domain.points, cross, area)
    other = domain.points + 1e-9
    assert faults_of_segments(mesh, other, domain.segments, area)
