"""Polygons that share borders, made into one domain."""

import json

import numpy as np
import pytest
import shapely
from reference.transforms import TRANSFORMS

from adaptmesh import Domain, FormatWarning, read_domain, repair
from adaptmesh.domain.polygons.shared_borders import given_of_polygons
from adaptmesh.errors import DomainError


def domain_of_polygons(polygons, names):
    return Domain.of_given(given_of_polygons(polygons, names))


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


def test_a_polygon_may_lie_in_a_plane_at_any_height():
    square = shapely.from_wkt("POLYGON Z ((0 0 5, 1 0 5, 1 1 5, 0 1 5, 0 0 5))")
    assert domain_of_polygons([square], [None]).points.shape == (4, 2)
    assert Domain.polygon(square).points.shape == (4, 2)


def test_points_at_different_heights_are_refused_or_repaired():
    roof = shapely.from_wkt("POLYGON Z ((0 0 5, 1 0 5, 1 1 7, 0 1 7, 0 0 5))")
    with pytest.raises(DomainError, match=r"heights at \(0, 0\): .*'roof'.* from 5 to 7"):
        domain_of_polygons([roof], ["roof"])
    with pytest.raises(DomainError, match=r"heights from 5 to 7.*force_2d.*adaptmesh.repair"):
        Domain.polygon(roof)
    domain, repairs = repair({"roof": roof})
    assert repairs.counts == {"heights": 1}
    assert domain.area == 1.0


@pytest.mark.parametrize("scale", [1e-9, 1.0, 1e9])
def test_a_bowtie_is_refused_by_place(scale):
    bowtie = shapely.Polygon(scale * np.array([(0, 0), (2, 2), (2, 0), (0, 2)]))
    with pytest.raises(DomainError, match=r"crossing at \(.*polygon 0 \('bow'\).*adaptmesh.repair"):
        domain_of_polygons([bowtie], ["bow"])


def test_overlaps_are_refused():
    polygons = [shapely.box(0, 0, 2, 1), shapely.box(1, 0, 3, 1)]
    with pytest.raises(DomainError, match=r"overlap at \(1.*polygon 0 \('a'\).*polygon 1 \('b'\)"):
        domain_of_polygons(polygons, ["a", "b"])


def test_borders_that_nearly_coincide_are_refused():
    nearly = np.nextafter(1.0, 2.0)
    polygons = [shapely.box(0, 0, 1, 1), shapely.box(nearly, 0, 2, 1), shapely.box(0, 1, 2, 2)]
    with pytest.raises(DomainError, match=r"nearly the same point at \(1, 0\): point \d of"):
        domain_of_polygons(polygons, [None, None, None])


def test_borders_are_named_after_the_regions_beside_them():
    a, b, c = shapely.box(0, 0, 1, 1), shapely.box(1, 0, 2, 1), shapely.box(2, 0, 3, 1)
    domain = domain_of_polygons([a, b, c], ["a", "b", None])

    def length(name):
        mine = domain.segments[domain.segment_tags == domain.names[name]]
        return np.hypot(*(domain.points[mine[:, 1]] - domain.points[mine[:, 0]]).T).sum()

    assert list(domain.names) == ["a", "b", "a|b"]
    assert {name: length(name) for name in domain.names} == {"a": 3.0, "a|b": 1.0, "b": 3.0}


def test_lines_between_parts_of_one_region_have_no_name():
    domain = domain_of_polygons([shapely.box(0, 0, 1, 1), shapely.box(1, 0, 2, 1)], ["a", "a"])
    assert len(domain.segments) == 7
    assert (domain.segment_tags == 0).sum() == 1


def test_two_borders_of_one_name_are_refused():
    names = ["a", "b", "a|b"]
    polygons = [shapely.box(i, 0, i + 1, 1) for i in range(3)]
    with pytest.raises(DomainError, match=r"'a\|b'.*without '\|'"):
        domain_of_polygons(polygons, names)


@pytest.mark.parametrize(
    ("polygons", "message"),
    [
        ([], "no polygons"),
        ([shapely.Polygon()], "polygon 0 is empty"),
        ([shapely.Polygon([(0, 0), (1, 0), (np.inf, 1)])], "point 2 .*not finite"),
        ([shapely.Polygon([(0, 0), (1, 0), (1e80, 1)])], "point 2 .*another unit"),
        ([shapely.Polygon([(0, 0), (1e-80, 0), (0, 1e-80)])], "areas underflow"),
        ([shapely.Polygon([(1, 2), (1, 2), (1, 2)])], r"ring without area at \(1, 2\)"),
        ([shapely.Polygon([(0, 0), (1, 0), (2, 0)])], r"nothing to mesh: .* at \(0, 0\)"),
        ([shapely.LineString([(0, 0), (1, 0)])], "polygon 0 is a LineString"),
    ],
)
def test_what_is_no_polygon_is_refused(polygons, message):
    with pytest.raises(DomainError, match=message):
        domain_of_polygons(polygons, [None] * len(polygons))


@pytest.mark.parametrize("transform", TRANSFORMS, ids=str)
def test_features_without_geometry_are_passed_over_as_in_files(transform, tmp_path):
    ring = transform([(0, 0), (1, 0), (1, 1), (0, 1)])
    square = {"type": "Polygon", "coordinates": [[*ring.tolist(), ring[0].tolist()]]}
    empty = dict(square, coordinates=[])
    features = [
        {"type": "Feature", "geometry": geometry, "properties": {"name": name}}
        for geometry, name in (
            (None, "none"),
            (square, "land"),
            (empty, "no"),
        )
    ]
    collection = {"type": "FeatureCollection", "features": features}
    path = tmp_path / "some.geojson"
    path.write_text(json.dumps(collection))
    for read in (lambda: Domain.polygon(collection), lambda: read_domain(path)):
        with pytest.warns(FormatWarning, match="'none'.*, .*'no'.*: without geometry") as caught:
            domain = read()
        assert caught[0].filename == __file__
        area = domain.area / abs(transform.determinant)
        assert area == pytest.approx(1, rel=1e-12 + 20 * transform.rounding)
        assert list(domain.region_names) == ["land"]
    with pytest.raises(DomainError, match="is empty"):
        Domain.polygon(dict(collection, features=features[::2]))
