"""Domains from files."""

import json
from pathlib import Path

import numpy as np
import pytest

import adaptmesh as am
from adaptmesh.errors import DomainError, FormatError

ICELAND = Path(__file__).parents[4] / "examples" / "data" / "iceland.geojson"

SQUARE = {"type": "Polygon", "coordinates": [[[0, 0], [1, 0], [1, 1], [0, 1], [0, 0]]]}
NEXT = {"type": "Polygon", "coordinates": [[[1, 0], [2, 0], [2, 1], [1, 1], [1, 0]]]}


def feature(geometry, **properties):
    return {"type": "Feature", "properties": properties, "geometry": geometry}


def collection(*features):
    return {"type": "FeatureCollection", "features": list(features)}


@pytest.fixture
def geojson(tmp_path):
    def write(content):
        path = tmp_path / "in.geojson"
        path.write_text(content if isinstance(content, str) else json.dumps(content))
        return path

    return write


@pytest.mark.parametrize("content", [SQUARE, feature(SQUARE), collection(feature(SQUARE))])
def test_geometry_feature_or_collection(geojson, content):
    assert am.read_domain(geojson(content)).area == 1.0


def test_names_of_features_become_regions(geojson):
    path = geojson(collection(feature(SQUARE, name="steel"), feature(NEXT, name="air")))
    domain = am.read_domain(str(path))
    assert list(domain.region_names) == ["steel", "air"]
    assert len(domain.segments) == 7


def test_a_feature_may_have_no_properties(geojson):
    bare = {"type": "Feature", "properties": None, "geometry": SQUARE}
    assert not am.read_domain(geojson(bare)).region_names


def test_iceland_is_refused_by_place_and_repaired_on_request():
    with pytest.raises(
        DomainError,
        match=r"iceland\.geojson: crossing at \(123\.1\d*, -119\.6\d*\): segment \d+ of part 0 of "
        r"polygon 0 \('Iceland'\) and .* cross.*adaptmesh\.repair",
    ):
        am.read_domain(ICELAND)
    domain, repairs = am.repair(ICELAND)
    assert repairs.counts == {"crossing": 1}
    assert domain.area == pytest.approx(101716.802, abs=1e-2)
    assert list(domain.region_names) == ["Iceland"]


@pytest.mark.parametrize(
    ("content", "message"),
    [
        (collection(), "it has no features"),
        (collection(feature({"type": "Point", "coordinates": [0, 0]})), "polygon 0 is a Point"),
        (
            collection(
                feature(SQUARE), feature({"type": "LineString", "coordinates": []}, name="x")
            ),
            r"polygon 1 \('x'\) is a LineString.*remove that feature",
        ),
        (feature(None), "polygon 0 is empty"),
        ({"type": "Polygon", "coordinates": [[[0, 0], [1, 0]]]}, r"without area at \(0, 0\)"),
        (
            {"type": "Polygon", "coordinates": [[[0, 0], [1, 0], [0, 1]]]},
            r"ring not closed at \(0, 1\)",
        ),
        ({"type": "Polygon", "coordinates": []}, "polygon 0 is empty"),
        (collection(feature(SQUARE), feature(SQUARE)), "polygon 0, .*, and polygon 1 overlap"),
    ],
)
def test_what_is_no_polygon_is_a_domain_error(geojson, content, message):
    with pytest.raises(DomainError, match=r"in\.geojson: .*" + message):
        am.read_domain(geojson(content))


@pytest.mark.parametrize(
    ("content", "message"),
    [
        ("", "not valid JSON at line 1, column 1"),
        (json.dumps(collection(feature(SQUARE)))[:-30], "not valid JSON .* complete"),
        ("[1, 2]", "not GeoJSON"),
        ('{"type": "FeatureCollection"}', "no list of 'features'"),
        ('{"type": "FeatureCollection", "features": [7]}', "feature 0 is not an object"),
        ('{"type": "Polygon", "coordinates": [[[0], [1]]]}', "polygon 0 cannot be read"),
        ('{"type": "Polygon", "coordinates": "none"}', "polygon 0 cannot be read"),
    ],
)
def test_broken_files_are_format_errors(geojson, content, message):
    with pytest.raises(FormatError, match=message):
        am.read_domain(geojson(content))


def test_missing_and_binary_files(tmp_path):
    with pytest.raises(FormatError, match="no such file"):
        am.read_domain(tmp_path / "absent.geojson")
    (tmp_path / "binary.geojson").write_bytes(bytes(range(256)))
    with pytest.raises(FormatError, match="not a text file"):
        am.read_domain(tmp_path / "binary.geojson")


def test_the_domain_of_a_mesh(tmp_path):
    mesh = am.generate(am.Domain.rectangle(0, 0, 2, 1), 0.5)
    am.write(tmp_path / "a.vtu", mesh)
    assert am.read_domain(tmp_path / "a.vtu").area == pytest.approx(2.0)


def test_a_mesh_that_lies_over_itself_has_no_domain(tmp_path):
    points = np.array([[0, 0], [4, 0], [2, 3], [0, 2], [4, 2], [2, -1.0]])
    edges = np.array([[0, 1], [1, 2], [2, 0], [3, 4], [4, 5], [5, 3]])
    mesh = am.Mesh(points, np.array([[0, 1, 2], [3, 5, 4]]), edges=edges)
    am.write(tmp_path / "a.mesh", mesh)
    with pytest.raises(DomainError, match=r"a\.mesh: the mesh lies over itself near"):
        am.read_domain(tmp_path / "a.mesh")
