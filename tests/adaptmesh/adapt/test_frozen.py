"""Boundaries that are not cut, and boundaries of a mesh that stay as they are."""

import numpy as np
import pytest

import adaptmesh as am
from adaptmesh.curves import Arc, Circle, Line
from adaptmesh.errors import DomainError


def edges_of(mesh, name):
    """The edges of a name by their places."""
    return {frozenset(map(tuple, e)) for e in mesh.points[mesh.edges_named(name)].tolist()}


def test_segments_stay_whole():
    ring = np.linspace(0, 1, 8)[:-1]
    bottom = [(x, 0.0) for x in ring]
    points = [*bottom, (1, 0), (1, 1), (0, 1)]
    n = len(points)
    domain = am.Domain(
        points,
        [(k, (k + 1) % n) for k in range(n)],
        names={"bottom": list(range(7)), "top": [8]},
    )
    for size in (0.02, 0.5):
        mesh = am.generate(domain.with_frozen("bottom"), size)
        assert mesh.validate().ok
        assert len(mesh.edges_named("bottom")) == 7
    assert len(am.generate(domain, 0.02).edges_named("bottom")) > 40
    assert not domain.segment_is_frozen.any()
    both = domain.with_frozen("bottom").with_frozen("top")
    assert len(am.generate(both, 0.1).edges_named("top")) == 1


def test_adapting_beside_a_neighbour():
    mesh = am.generate(am.Domain.rectangle(0, 0, 1, 1), lambda x: 0.02 + 0.2 * x[:, 1])
    new = am.adapt(mesh, 0.1, frozen=["left", "bottom"])
    assert new.validate().ok
    for name in ("left", "bottom"):
        assert edges_of(new, name) == edges_of(mesh, name)
    assert edges_of(new, "right") != edges_of(mesh, "right")
    assert new.domain is mesh.domain
    assert len(am.adapt(new, 0.1).edges_named("left")) == 10  # free again


def test_a_curve_of_a_mesh_is_frozen():
    curves = [Circle((0, 0), 2), Circle((0.5, 0), 0.7)]
    domain = am.Domain.from_curves(curves, names={"outer": [0], "hole": [1]})
    mesh = am.generate(domain, 0.3)
    new = am.adapt(mesh, 0.1, frozen=["hole"])
    assert new.validate().ok
    assert edges_of(new, "hole") == edges_of(mesh, "hole")
    assert len(new.edges_named("outer")) > 2 * len(mesh.edges_named("outer"))
    far = np.hypot(*new.points[np.unique(new.edges_named("outer"))].T)
    np.testing.assert_allclose(far, 2, rtol=1e-14)
    assert dict(new.names) == dict(mesh.names)


def test_regions_interfaces_and_isolated_points_are_kept():
    points = [(0, 0), (2, 0), (2, 1), (0, 1), (1, 0), (1, 1), (0.5, 0.5)]
    domain = am.Domain(
        points,
        [(0, 4), (4, 1), (1, 2), (2, 5), (5, 3), (3, 0), (4, 5)],
        regions={"a": (0.2, 0.2), "b": (1.5, 0.5)},
        names={"interface": [6], "wall": [0, 1]},
    )
    mesh = am.generate(domain, 0.1)
    new = am.adapt(mesh, 0.25, frozen=["interface"])
    assert new.validate().ok
    assert edges_of(new, "interface") == edges_of(mesh, "interface")
    for name in ("a", "b"):
        assert new.areas[new.triangles_in(name)].sum() == pytest.approx(1)
    assert (new.points == [0.5, 0.5]).all(axis=1).any()
    assert new.region_names == mesh.region_names


@pytest.mark.parametrize("curved", [False, True])
def test_what_is_frozen_in_the_domain_stays_so_beside_others(curved):
    corners = [(0, 0), (1, 0), (1, 1), (0, 1)]
    names = {"bottom": [0], "right": [1], "left": [3]}
    if curved:
        lines = [Line(corners[k], corners[(k + 1) % 4]) for k in range(4)]
        domain = am.Domain.from_curves([*lines, Circle((0.5, 0.5), 0.2)], names=names)
    else:
        domain = am.Domain(corners, [(0, 1), (1, 2), (2, 3), (3, 0)], names=names)
    mesh = am.generate(domain.with_frozen("left"), 0.1)
    new = am.adapt(mesh, 0.2, frozen=["right"])
    assert [len(new.edges_named(n)) for n in ("left", "right", "bottom")] == [1, 10, 5]


def test_segments_are_frozen_by_number():
    square = am.Domain.rectangle(0, 0, 1, 1)
    mesh = am.generate(square.with_frozen("left", segments=[1]), 0.2)
    assert [len(mesh.edges_named(n)) for n in ("left", "right", "bottom")] == [1, 1, 5]
    with pytest.raises(DomainError, match="segment 4: they are numbered 0 to 3"):
        square.with_frozen(segments=[4])


def test_frozen_and_periodic_together():
    domain = am.Domain.rectangle(0, 0, 1, 1).with_periodic("left", "right")
    mesh = am.generate(domain, lambda x: 0.02 + 0.2 * x[:, 1])
    new = am.adapt(mesh, 0.1, frozen=["left", "right"])
    assert edges_of(new, "left") == edges_of(mesh, "left")
    pairs = new.periodic_vertices()["left", "right"]
    np.testing.assert_allclose(
        new.points[pairs[:, 1]] - new.points[pairs[:, 0]], [[1, 0]] * len(pairs)
    )


def test_a_frozen_side_freezes_the_one_that_is_periodic_with_it():
    domain = am.Domain.rectangle(0, 0, 1, 1).with_periodic("left", "right")
    whole = am.generate(domain.with_frozen("left"), 0.1)
    assert len(whole.edges_named("left")) == len(whole.edges_named("right")) == 1
    mesh = am.generate(domain, lambda x: 0.02 + 0.2 * x[:, 1])
    for frozen in (["left"], ["right"]):
        new = am.adapt(mesh, 0.3, frozen=frozen)
        assert new.validate().ok
        assert edges_of(new, "left") == edges_of(mesh, "left")
        assert edges_of(new, "right") == edges_of(mesh, "right")
    curves = [Arc((0, 0), 1, 0, 1), Arc((3, 0), 1, 0, 1)]
    ends = [c.point([0.0, 1.0]) for c in curves]
    curves += [Line(ends[0][0], ends[1][0]), Line(ends[0][1], ends[1][1])]
    wavy = am.Domain.from_curves(curves, names={"left": [0], "right": [1]})
    mesh = am.generate(wavy.with_periodic("left", "right"), 0.1)
    new = am.adapt(mesh, 0.3, frozen=["right"])
    assert edges_of(new, "left") == edges_of(mesh, "left")
    assert edges_of(new, "right") == edges_of(mesh, "right")


def test_a_mesh_from_a_file(tmp_path):
    mesh = am.generate(am.Domain.rectangle(0, 0, 1, 1), lambda x: 0.02 + 0.2 * x[:, 1])
    am.write(tmp_path / "a.vtu", mesh)
    read = am.read(tmp_path / "a.vtu")
    new = am.adapt(read, 0.1, frozen=["left"])
    assert edges_of(new, "left") == edges_of(mesh, "left")


def test_what_cannot_be_frozen_is_named():
    square = am.Domain.rectangle(0, 0, 1, 1)
    with pytest.raises(DomainError, match="no boundary is named 'wall'"):
        square.with_frozen("wall")
    with pytest.raises(TypeError, match=r"give a list of names, \['left'\]"):
        am.adapt(am.generate(square, 0.3), 0.2, frozen="left")
    with pytest.raises(DomainError, match="no boundary is named 'wall'"):
        am.adapt(am.generate(square, 0.3), 0.2, frozen=["wall"])
    disc = am.Domain.from_curves([Circle((0, 0), 1)], names={"rim": [0]})
    with pytest.raises(DomainError, match=r"curve 0 \(Circle .* is curved"):
        disc.with_frozen("rim")
    divided = am.Domain(
        [(0, 0), (1, 0), (1, 1), (0, 1), (0, 0.5)],
        [(0, 1), (1, 2), (2, 3), (3, 0)],
        names={"left": [3]},
    )
    with pytest.raises(DomainError, match="a point lies on it"):
        divided.with_frozen("left")
