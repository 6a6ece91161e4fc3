"""Sharp angles, points where things touch, slits, and boundaries a hair apart: valid meshes."""

import numpy as np
import pytest
import shapely

import adaptmesh as am

SQUARE = [(0, 0), (4, 0), (4, 4), (0, 4)]
RING = [(0, 1), (1, 2), (2, 3), (3, 0)]

SIZES = {
    "coarse": 10.0,
    "fine": 0.3,
    "graded": lambda x: 0.02 + 0.2 * np.hypot(x[:, 0], x[:, 1]),
    "stretched": lambda x: np.broadcast_to([4.0, 15.0, 64.0], (len(x), 3)),
}


def meshed(domain, size, area):
    mesh = am.generate(domain, SIZES[size])
    assert mesh.validate().ok, str(mesh.validate())
    assert mesh.areas.sum() == pytest.approx(area, rel=1e-12)
    return mesh


def flattest(mesh):
    """The least height of a triangle, as a share of its longest side."""
    p = mesh.points[mesh.triangles]
    longest = np.hypot(*(p - np.roll(p, 1, axis=1)).transpose(2, 0, 1)).max(axis=1)
    return (2 * mesh.areas / longest**2).min()


def box(x0, y0, x1, y1):
    return [(x0, y0), (x1, y0), (x1, y1), (x0, y1)]


@pytest.mark.parametrize("size", SIZES)
@pytest.mark.parametrize("degrees", [30, 10, 3, 1, 0.1, 1e-3])
def test_sharp_corners(degrees, size):
    width = np.tan(np.radians(degrees))
    meshed(am.Domain.polygon([(0, 0), (1, 0), (1, width)]), size, width / 2)
    notch = [(0, 0), (2, -width), (2, -2), (-2, -2), (-2, 2), (2, 2), (2, width)]
    meshed(am.Domain.polygon(notch), size, 16 - 2 * width)


@pytest.mark.parametrize("size", SIZES)
@pytest.mark.parametrize("degrees", [5, 1, 0.1])
def test_segments_that_leave_a_corner_side_by_side(degrees, size):
    angles = np.radians(45 + degrees * np.arange(-3, 4))
    tips = np.stack([np.cos(angles), np.sin(angles)], axis=1) * 3
    points = [*SQUARE, *tips]
    meshed(am.Domain(points, [*RING, *((0, 4 + k) for k in range(7))]), size, 16.0)


@pytest.mark.parametrize("size", SIZES)
def test_parts_that_touch_in_a_point(size):
    polygons = shapely.multipolygons([shapely.box(0, 0, 1, 1), shapely.box(1, 1, 2, 2)])
    meshed(am.Domain.polygon(polygons), size, 2.0)
    domain, repairs = am.repair({"a": box(0, 0, 1, 1), "b": box(1, 1, 2, 2), "c": box(2, 2, 3, 3)})
    assert not repairs
    assert list(meshed(domain, size, 3.0).region_names) == ["a", "b", "c"]


@pytest.mark.parametrize("size", SIZES)
def test_slits(size):
    points = [*SQUARE, (2, 0), (2, 2), (1, 3), (3, 3), (0, 1), (0.5, 1.5)]
    segments = [(0, 4), (4, 1), (1, 2), (2, 3), (3, 8), (8, 0), (4, 5), (6, 7), (8, 9), (0, 9)]
    mesh = meshed(am.Domain(points, segments, names={"slit": [6]}), size, 16.0)
    slit = mesh.points[mesh.edges_named("slit")]
    assert np.hypot(*(slit[:, 1] - slit[:, 0]).T).sum() == pytest.approx(2.0)


@pytest.mark.parametrize("size", SIZES)
def test_a_slit_from_a_hole_to_the_boundary(size):
    hole = box(1, 1, 2, 2)
    points = [*SQUARE, *hole]
    segments = [*RING, *((a + 4, b + 4) for a, b in RING), (0, 4)]
    meshed(am.Domain(points, segments, holes=[(1.5, 1.5)]), size, 15.0)
    meshed(am.Domain(points, segments, holes="nesting"), size, 15.0)


TOUCHING = {
    "each other in a point": ([box(1, 1, 2, 2), box(2, 2, 3, 3)], 14.0),
    "each other along an edge": ([box(1, 1, 2, 2), box(2, 1, 3, 2)], 14.0),
    "each other along part of an edge": ([box(1, 1, 2, 2), box(2, 1.5, 3, 2.5)], 14.0),
    "the boundary in a point": ([[(0, 2), (1, 1), (1, 3)]], 15.0),
    "a corner in a point": ([[(0, 0), (2, 1), (1, 2)]], 14.5),
    "the boundary along an edge": ([box(0, 1, 1, 2)], 15.0),
    "the boundary on both sides": ([[(0, 2), (2, 1), (4, 2), (2, 3)]], 12.0),
}


@pytest.mark.parametrize("size", SIZES)
@pytest.mark.parametrize("name", TOUCHING)
def test_holes_that_touch(name, size):
    holes, area = TOUCHING[name]
    domain, _ = am.repair([SQUARE, *holes])
    meshed(domain, size, area)


def test_holes_that_touch_along_an_edge_are_refused_without_repair():
    for name in ("each other along an edge", "the boundary along an edge"):
        with pytest.raises(am.DomainError, match=r"overlap near \(.*adaptmesh\.repair"):
            am.Domain.polygon(SQUARE, TOUCHING[name][0])


@pytest.mark.parametrize("size", SIZES)
@pytest.mark.parametrize("gap", [1e-3, 1e-6, 1e-8])
def test_boundaries_a_hair_apart(gap, size):
    hole = box(gap, 1, 3, 3)
    mesh = meshed(am.Domain.polygon(SQUARE, [hole]), size, 16 - 2 * (3 - gap))
    assert len(mesh.points) < 20_000
    two = [box(1, 1, 2, 3), box(2 + gap, 1, 3, 3)]
    meshed(am.Domain.polygon(SQUARE, two), size, 16 - 2 - 2 * (1 - gap))


@pytest.mark.parametrize("gap", [1e-3, 1e-6])
def test_a_ring_around_a_ring_a_hair_apart(gap):
    angle = np.linspace(0, 2 * np.pi, 60, endpoint=False)
    circle = np.stack([np.cos(angle), np.sin(angle)], axis=1)
    domain = am.Domain.polygon(circle, [(1 - gap) * circle])
    meshed(domain, "fine", domain.area)


# Cuts of a straight side are off it by rounding, so that a triangle between three of them can be
# positive: two domains, found among thousands, where that happened.


def test_no_triangle_has_its_corners_on_one_side_of_a_strip():
    """Its edge along the side is unit, and the one across the strip is not."""
    strip = [
        (-0.2936804275838627, 0.5076697659779097),
        (-0.15664026192924696, 0.5076697659779097),
        (-0.2936794275838627, 0.5076707659779097),
        (-0.35872330117911355, 1.5076697659779097),
    ]

    def graded(x):
        return 1 / 75 + 0.3 * np.hypot(*(x - strip[1]).T)

    mesh = am.generate(am.Domain.polygon(strip), graded)
    mesh.validate().raise_if_invalid()
    assert flattest(mesh) > 1e-9


def test_no_triangle_has_its_corners_on_one_side_when_a_mesh_is_made_coarser():
    x = [0.5960642951203845, 0.5970642951203845, 0.5980642951203845]
    y = [0.011052516871096874, 0.012052516871096874, 0.013052516871096874]
    points = [(a, b) for a in x for b in y]
    pairs = [(3 * i + j, 3 * i + j + 1) for i in range(3) for j in range(2)]
    pairs += [(3 * i + j, 3 * i + j + 3) for i in range(2) for j in range(3)]
    mesh = am.generate(am.Domain(points, pairs), 0.002 / 3)
    coarse = am.adapt(mesh, 0.002, keep=True)
    coarse.validate().raise_if_invalid()
    assert flattest(coarse) > 0.1


def test_boundaries_nearer_than_the_tolerance_are_refused_as_polygons_and_joined_by_repair():
    polygons = {"a": box(0, 0, 1, 1), "b": box(1 + 1e-10, 0, 2, 1)}
    domain, repairs = am.repair(polygons)
    assert "a|b" in domain.names
    assert repairs.displacement == pytest.approx(1e-10)
    meshed(domain, "fine", 2.0)
