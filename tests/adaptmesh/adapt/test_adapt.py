"""Remeshing for a nodal metric: the domain, its names and its regions stay."""

import re

import numpy as np
import pytest

import adaptmesh as am


def sizes(x):
    return 0.02 + 0.1 * abs(x[:, 0] - 1.5)


def lengths(mesh):
    out = {}
    for name in mesh.names:
        p = mesh.points[mesh.edges_named(name)]
        out[name] = np.linalg.norm(p[:, 1] - p[:, 0], axis=1).sum()
    return out


def areas(mesh):
    return {name: mesh.areas[mesh.triangles_in(name)].sum() for name in mesh.region_names}


def test_adapt_to_nodal_sizes(plate):
    mesh = am.generate(plate, 0.1)
    for _ in range(3):
        mesh = am.adapt(mesh, sizes(mesh.points))
    assert am.validate(mesh), am.validate(mesh)
    assert am.measure(mesh, sizes).unit_fraction > 0.99
    assert lengths(mesh) == pytest.approx({"bottom": 4, "interface": 2, "hole": 2})
    assert areas(mesh) == pytest.approx({"left": 3.75, "right": 4})
    assert mesh.domain is plate


def test_adapt_takes_tensors_and_callables(plate):
    mesh = am.generate(plate, 0.1)
    h = sizes(mesh.points)
    packed = np.stack([1 / (h * h), 0 * h, 1 / (h * h)], axis=1)
    one, two = am.adapt(mesh, h), am.adapt(mesh, packed)
    assert np.array_equal(one.points, two.points)
    assert len(am.adapt(mesh, sizes).points) == pytest.approx(len(one.points), rel=0.05)
    assert len(am.adapt(mesh, 0.3).points) < len(mesh.points)


def test_the_domain_is_found_again_from_the_mesh_alone(plate):
    mesh = am.generate(plate, 0.1)
    bare = am.Mesh(
        mesh.points,
        mesh.triangles,
        regions=mesh.regions,
        edges=mesh.edges,
        edge_tags=mesh.edge_tags,
        names=mesh.names,
        region_names=mesh.region_names,
    )
    domain = bare.to_domain()
    assert domain.area == pytest.approx(plate.area, abs=1e-12)
    assert len(domain.points) == len(plate.points)
    assert {tuple(p) for p in domain.points} == {tuple(p) for p in plate.points}
    again = am.adapt(bare, sizes(bare.points))
    assert lengths(again) == pytest.approx({"bottom": 4, "interface": 2, "hole": 2})
    assert areas(again) == pytest.approx({"left": 3.75, "right": 4})


def test_a_mesh_without_constrained_edges_is_bounded_by_its_border():
    square = am.generate(am.Domain.rectangle(0, 0, 1, 1), 0.2)
    domain = am.Mesh(square.points, square.triangles).to_domain()
    assert len(domain.points) == 4
    assert domain.area == pytest.approx(1)


def test_a_circle_of_many_short_edges_stays_a_circle():
    angle = np.linspace(0, 2 * np.pi, 2000, endpoint=False)
    disc = am.Domain.polygon(np.stack([np.cos(angle), np.sin(angle)], axis=1))
    mesh = am.generate(disc, 0.2)
    assert len(mesh.to_domain().points) == 2000


def test_nested_holes_and_islands_are_found_again():
    def ring(k):
        return [(k, k), (9 - k, k), (9 - k, 9 - k), (k, 9 - k)]

    domain = am.Domain.polygon(ring(0), [ring(1), ring(2), ring(3)])
    mesh = am.generate(domain, 0.5)
    again = am.Mesh(mesh.points, mesh.triangles).to_domain()
    assert again.area == pytest.approx(domain.area)


@pytest.mark.parametrize("seed", [603, 624, 790, 1119])  # where rounding puts it beside both
def test_no_hole_is_found_where_there_is_none(seed):
    """The triangle of the domain has its centroid on the line that parts those of the mesh."""
    corners = np.random.default_rng(seed).random((3, 2))
    u, v = corners[1] - corners[0], corners[2] - corners[0]
    if u[0] * v[1] < u[1] * v[0]:
        corners = corners[::-1]
    points = [*corners, (corners[1] + corners[2]) / 2]
    mesh = am.Mesh(points, [(0, 1, 3), (0, 3, 2)])
    domain = mesh.to_domain()
    assert len(domain.holes) == 0
    assert domain.area == pytest.approx(mesh.areas.sum(), rel=1e-12)


def test_holes_that_touch_in_the_middle_of_a_side_are_found_again():
    """The first hole begins and ends where the second touches its side: there stays a corner."""
    square = [(0, 0), (4, 0), (4, 4), (0, 4)]
    holes = [[(1, 1), (3, 1), (3, 2), (1, 2)], [(2, 2), (2.5, 2.5), (2, 3), (1.5, 2.5)]]
    domain, _ = am.repair([square, *holes])
    mesh = am.generate(domain, 0.9)
    again = am.Mesh(mesh.points, mesh.triangles).to_domain()
    assert again.area == pytest.approx(13.5, rel=1e-14)
    # whichever vertex the walk along the outline begins at
    for shift in range(len(mesh.points)):
        number = (np.arange(len(mesh.points)) + shift) % len(mesh.points)
        turned = am.Mesh(mesh.points[np.argsort(number)], number[mesh.triangles])
        assert turned.to_domain().area == pytest.approx(13.5, rel=1e-14)


def test_wrong_number_of_values(plate):
    mesh = am.generate(plate, 0.3)
    with pytest.raises(am.MetricError):
        am.adapt(mesh, np.ones(len(mesh.points) + 1))
    with pytest.raises(am.MetricError):
        am.adapt(mesh, np.full(len(mesh.points), -1.0))


def test_regions_part_without_constrained_edges_between_them(plate):
    mesh = am.generate(plate, 0.2)
    names = dict(mesh.region_names)
    bare = am.Mesh(mesh.points, mesh.triangles, regions=mesh.regions, region_names=names)
    again = am.adapt(bare, 0.2)
    for name in names:
        area = mesh.areas[mesh.triangles_in(name)].sum()
        assert again.areas[again.triangles_in(name)].sum() == pytest.approx(area)


def test_an_empty_mesh_covers_no_domain():
    with pytest.raises(am.DomainError, match="no triangles"):
        am.Mesh(np.empty((0, 2)), np.empty((0, 3))).to_domain()


TWO = {"points": [(0, 0), (1, 0), (1, 1), (0, 1)], "triangles": [(0, 1, 2), (0, 2, 3)]}


@pytest.mark.parametrize("keep", [False, True])
@pytest.mark.parametrize(
    ("changed", "message"),
    [
        ({"points": [(0, 0), (1, 0), (1, 1), (0, np.nan)]}, "point 3 (0.0, nan)"),
        ({"triangles": [(0, 1, 2), (0, 2, 4)]}, "triangle 1: [0, 2, 4], with 4 points"),
        ({"triangles": [(0, 1, 2), (0, 3, 2)]}, "triangle 1, [0, 3, 2], is clockwise"),
        ({"triangles": [(0, 1, 2), (0, 2, 3), (0, 2, 3)]}, "edges have more than two triangles"),
        ({"edges": [(0, 1), (1, 3)]}, "constrained edge 1 is no side of a triangle"),
        ({"edges": [(0, 1), (1, 4)]}, "constrained edge 1: [1, 4], with 4 points"),
    ],
)
def test_a_mesh_that_is_none_is_refused_with_the_place(changed, message, keep):
    with pytest.raises(am.DomainError, match=re.escape(message)):
        am.adapt(am.Mesh(**{**TWO, **changed}), 0.3, keep=keep)


def test_what_is_no_mesh_is_named(plate):
    for wrong in (None, plate):
        with pytest.raises(am.DomainError, match="expected a Mesh, got"):
            am.adapt(wrong, 0.3)


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        ({"points": [(0, 0, 0, 0)]}, "points must be an (n, 2) array, not one of shape"),
        ({"triangles": [0, 1, 2]}, "triangles must be an (n, 3) array, not one of shape (3,)"),
        (
            {"triangles": [(0, 1, 2), (0, 2.5, 3)]},
            "triangle 1 is [0.0, 2.5, 3.0]: expected whole numbers",
        ),
        (
            {"triangles": [(0, 1, 2**40)]},
            "triangle 0 is [0, 1, 1099511627776]: expected whole numbers",
        ),
        ({"regions": [1]}, "regions must be one number for each of 2 triangles"),
        ({"edges": [(0, 1)], "edge_tags": [1, 2]}, "edge_tags must be one number for each of 1"),
        ({"edges": [(0, 1)], "edge_tags": [np.nan]}, "edge tag 0 is nan"),
    ],
)
def test_arrays_that_would_change_in_a_mesh_are_refused(arguments, message):
    with pytest.raises(ValueError, match=re.escape(message)):
        am.Mesh(**{**TWO, **arguments})


@pytest.mark.parametrize("size", [1e76, 1e154, 1e200, 1.7e308])
def test_meshes_whose_areas_overflow(size):
    """They can be made and validated, and have no domain; nothing overflows on the way."""
    mesh = am.Mesh(**{**TWO, "points": size * np.array(TWO["points"], float)})
    exact = am.Mesh(**TWO).areas
    np.testing.assert_allclose(mesh.areas, exact * size * size if size < 1e155 else np.inf)
    for use in (am.Mesh.to_domain, lambda m: am.adapt(m, size), lambda m: am.adapt(m, 1.0)):
        with pytest.raises(am.DomainError, match=r"vertex .* overflow; choose another unit"):
            use(mesh)


def test_thin_triangles_with_coordinates_whose_products_overflow():
    mesh = am.Mesh([(0, 0), (1e200, 0), (1e200, 1e-200), (2e-200, 1e200)], [(0, 1, 2), (0, 2, 3)])
    np.testing.assert_allclose(mesh.areas, [0.5, np.inf])
