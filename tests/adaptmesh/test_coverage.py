"""Polygons that share borders, made into one domain."""

import numpy as np
import pytest
import shapely

from adaptmesh.coverage import domain_of_polygons
from adaptmesh.errors import DomainError


def region_area(domain, name):
    number = domain.region_names[name]
    p = domain.points[domain.triangles[domain.triangle_regions == number]]
    u, v = p[:, 1] - p[:, 0], p[:, 2] - p[:, 0]
    return 0.5 * np.sum(u[:, 0] * v[:, 1] - u[:, 1] * v[:, 0])


def test_neighbours_share_one_interface():
    domain = domain_of_polygons([shapely.box(0, 0, 1, 1), shapely.box(1, 0, 2, 1)], ["a", "b"])
    assert len(domain.points) == 6
    assert len(domain.segments) == 7  # 2 x 4 sides, of which one is shared
    assert region_area(domain, "a") == region_area(domain, "b") == 1.0


def test_a_corner_on_a_neighbours_side_divides_it():
    left = shapely.box(0, 0, 1, 2)
    right = shapely.box(1, 0.5, 2, 1.5)
    domain = domain_of_polygons([left, right], ["left", "right"])
    assert len(domain.points) == 8
    assert domain.area == 3.0


def test_enclosed_by_polygons_but_in_none_is_a_hole():
    frame = shapely.difference(shapely.box(0, 0, 3, 3), shapely.box(1, 1, 2, 2))
    assert domain_of_polygons([frame], [None]).area == 8.0
    filled = domain_of_polygons([frame, shapely.box(1, 1, 2, 2)], [None, "core"])
    assert filled.area == 9.0
    assert region_area(filled, "core") == 1.0


def test_parts_of_one_name_are_one_region():
    islands = shapely.multipolygons([shapely.box(0, 0, 1, 1), shapely.box(3, 0, 4, 1)])
    domain = domain_of_polygons([islands, shapely.box(6, 0, 7, 1)], ["land", "land"])
    assert list(domain.region_names) == ["land"]
    assert region_area(domain, "land") == 3.0


def test_a_third_coordinate_is_ignored():
    square = shapely.from_wkt("POLYGON Z ((0 0 5, 1 0 5, 1 1 5, 0 1 5, 0 0 5))")
    assert domain_of_polygons([square], [None]).points.shape == (4, 2)


@pytest.mark.parametrize("scale", [1e-9, 1.0, 1e9])
def test_a_bowtie_is_refused_by_place_and_repaired_on_request(scale):
    bowtie = shapely.Polygon(scale * np.array([(0, 0), (2, 2), (2, 0), (0, 2)]))
    with pytest.raises(DomainError, match=r"polygon 0 \('bow'\).*self-intersection at \(.*valid"):
        domain_of_polygons([bowtie], ["bow"])
    repaired = domain_of_polygons([bowtie], ["bow"], make_valid=True)
    assert repaired.area == pytest.approx(2.0 * scale**2)
    assert len(repaired.points) == 5


def test_overlaps_are_refused_and_go_to_the_first_on_request():
    polygons = [shapely.box(0, 0, 2, 1), shapely.box(1, 0, 3, 1)]
    with pytest.raises(DomainError, match=r"polygon 0 \('a'\) and polygon 1 .* overlap at \(1\.5,"):
        domain_of_polygons(polygons, ["a", "b"])
    domain = domain_of_polygons(polygons, ["a", "b"], make_valid=True)
    assert region_area(domain, "a") == 2.0
    assert region_area(domain, "b") == 1.0


def test_borders_that_nearly_coincide_are_refused_and_snapped_on_request():
    nearly = np.nextafter(1.0, 2.0)
    polygons = [shapely.box(0, 0, 1, 1), shapely.box(nearly, 0, 2, 1), shapely.box(0, 1, 2, 2)]
    with pytest.raises(DomainError, match=r"the point \(1, 0\) is nearer than .* but not on it"):
        domain_of_polygons(polygons, [None, None, None])
    domain = domain_of_polygons(polygons, ["a", "b", "c"], make_valid=True)
    assert domain.area == pytest.approx(4.0)
    assert len(domain.points) == 8


@pytest.mark.parametrize(
    ("polygons", "message"),
    [
        ([], "no polygons"),
        ([shapely.Polygon()], "polygon 0 is empty"),
        ([shapely.Polygon([(0, 0), (1, 0), (np.inf, 1)])], "point 2 .*not finite"),
    ],
)
def test_what_is_no_polygon_is_refused(polygons, message):
    with pytest.raises(DomainError, match=message):
        domain_of_polygons(polygons, [None] * len(polygons), make_valid=True)


def test_a_polygon_without_area_cannot_be_repaired():
    flat = shapely.Polygon([(0, 0), (1, 0), (2, 0)])
    with pytest.raises(DomainError, match="has no area"):
        domain_of_polygons([flat], [None], make_valid=True)
