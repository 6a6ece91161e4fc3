"""Meshes with too much in them: loose points, double vertices, edges listed twice."""

import numpy as np
import pytest
from reference.transforms import TRANSFORMS

import adaptmesh as am
import metrics

NAMES = {"bottom": 1, "right": 2, "top": 3, "left": 4}


def two_blocks(transform, n=4):
    """The unit square in two blocks that do not share vertices, and a loose point between."""
    g = np.linspace(0, 1, n + 1)
    points = np.stack(np.meshgrid(g / 2, g, indexing="ij"), axis=-1).reshape(-1, 2)
    i, j = (k.ravel() for k in np.meshgrid(*2 * [np.arange(n)], indexing="ij"))
    a, b = i * (n + 1) + j, (i + 1) * (n + 1) + j
    c, d = b + 1, a + 1
    triangles = np.concatenate([np.stack([a, b, c], 1), np.stack([a, c, d], 1)])
    shift = len(points) + 1
    points = np.concatenate([points, [(7.0, 7.0)], points + np.array((0.5, 0))])
    return am.Mesh(
        transform(points),
        transform.triangles(np.concatenate([triangles, triangles + shift])),
        regions=np.repeat([1, 2], 2 * n * n),
    )


@pytest.mark.parametrize("transform", TRANSFORMS, ids=str)
def test_blocks_become_one_mesh(transform):
    mesh = two_blocks(transform)
    assert not mesh.validate().ok
    blur = np.random.default_rng(0).uniform(-1, 1, mesh.points.shape) * 1e-9 * transform.scale
    for points, merge in (
        (mesh.points, transform.rounding * 64 * transform.scale),
        (mesh.points + blur, 1e-8 * transform.scale),
    ):
        one = am.Mesh(points, mesh.triangles, regions=mesh.regions).cleaned(merge=merge)
        assert len(one.points) == 9 * 5
        assert [c.name for c in one.validate().broken] == ["border is constrained"]
        assert np.array_equal(one.points, points[one.kept])
        assert one.areas.sum() == pytest.approx(abs(transform.determinant), rel=1e-7)
        domain = one.to_domain()
        assert len(domain.seeds) == 2 and not len(domain.holes)
    with pytest.raises(am.DomainError, match="merge less"):
        mesh.cleaned(merge=0.3 * transform.scale)


def test_without_merging_only_loose_points_go():
    mesh = two_blocks(TRANSFORMS[0])
    less = mesh.cleaned()
    assert len(less.points) == len(mesh.points) - 1
    assert np.array_equal(less.points[less.triangles], mesh.points[mesh.triangles])
    with pytest.raises(metrics.MetricError, match=r"in no triangle.*mesh\.cleaned\(\)"):
        metrics.implied_metric(mesh.points, mesh.triangles)
    metrics.implied_metric(less.points, less.triangles)
    assert len(less.cleaned().points) == len(less.points)


def square(**options):
    points = [(0, 0), (1, 0), (1, 1), (0, 1)]
    return am.Mesh(points, [(0, 1, 2), (0, 2, 3)], names=NAMES, **options)


def test_an_edge_listed_twice_says_the_same_or_is_refused():
    edges = [(0, 1), (1, 2), (1, 0), (2, 3), (3, 0), (0, 3), (2, 1)]
    tags = [1, 2, 1, 3, 0, 4, 2]
    twice = square(edges=edges, edge_tags=tags, required_edges=[2, 4])
    once = twice.cleaned()
    assert once.edges.tolist() == [[0, 1], [1, 2], [2, 3], [3, 0]]
    assert once.edge_tags.tolist() == [1, 2, 3, 4]
    assert once.required_edges.tolist() == [0, 3]
    domain = twice.to_domain()
    assert domain == once.to_domain()
    for keep in (False, True):
        mesh = am.adapt(twice, 0.3, keep=keep)
        assert mesh.validate().ok and len(mesh.edges_named("left")) == 1
    other = square(edges=edges, edge_tags=[1, 2, 3, 3, 0, 4, 2])
    for use in (other.cleaned, lambda: other.to_domain(), lambda: am.adapt(other, 0.3)):
        with pytest.raises(am.DomainError, match=r"edges 0 and 2 .*'bottom' and the other 'top'"):
            use()


def test_what_is_asked_for_is_not_left_out():
    points = [(0, 0), (1, 0), (1, 1), (0, 1), (5, 5)]
    triangles = [(0, 1, 2), (0, 2, 3)]
    with pytest.raises(am.DomainError, match=r"edge 0, .* no triangle"):
        am.Mesh(points, triangles, edges=[(0, 4)]).cleaned()
    with pytest.raises(am.DomainError, match="point 4 is required"):
        am.Mesh(points, triangles, required_points=[4]).cleaned()
    with pytest.raises(ValueError, match="merge=-1"):
        am.Mesh(points, triangles).cleaned(merge=-1)
    with pytest.raises(am.DomainError, match="triangle 1 has vertices"):
        am.Mesh(points, [(0, 1, 2), (0, 2, 9)]).cleaned()


def test_none_is_as_if_not_given():
    nothing = dict.fromkeys(
        ("regions", "edges", "edge_tags", "names", "region_names", "domain", "kept",
         "required_points", "required_edges")
    )  # fmt: skip
    points, triangles = [(0, 0), (1, 0), (1, 1)], [(0, 1, 2)]
    assert am.Mesh(points, triangles, **nothing) == am.Mesh(points, triangles)


def test_heights_that_say_nothing():
    flat = np.array([(0, 0, 1e-17), (1, 0, 0), (1, 1, 0)])
    assert am.Mesh(flat, [(0, 1, 2)]).points.shape == (3, 2)
    assert am.Mesh(flat + np.array((0, 0, 5)), [(0, 1, 2)]).points.shape == (3, 2)
    with pytest.raises(ValueError, match=r"point 1 is at height 0\.1"):
        am.Mesh(flat + np.array([(0, 0, 0), (0, 0, 0.1), (0, 0, 0)]), [(0, 1, 2)])
