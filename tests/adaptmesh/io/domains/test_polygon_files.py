"""Polygons in WKT and in shapefiles: what is read, and what is refused with its place."""

import json

import pytest

import adaptmesh as am
from adaptmesh.errors import DomainError, FormatError

SQUARE = [(0, 0), (0, 3), (3, 3), (3, 0), (0, 0)]  # clockwise, as shells of shapefiles are
HOLE = [(1, 1), (2, 1), (2, 2), (1, 2), (1, 1)]
NEXT = [(3, 0), (3, 3), (5, 3), (5, 0), (3, 0)]


def write(path, content):
    path.write_bytes(content.encode() if isinstance(content, str) else content)
    return path


# -------------------------------------------------------------------------------------------- WKT

WITH_HOLE = "POLYGON ((0 0, 0 3, 3 3, 3 0, 0 0), (1 1, 2 1, 2 2, 1 2, 1 1))"


@pytest.mark.parametrize(
    ("text", "area"),
    [
        (WITH_HOLE, 8.0),
        (f"\ufeff\n SRID=4326; {WITH_HOLE.lower()}\n", 8.0),
        (WITH_HOLE.replace(" ", "\n"), 8.0),
        ("Polygon Z((0 0 7,3 0 7,3 3 7,0 0 7))", 4.5),
        (f"{WITH_HOLE}\nPOLYGON ((3 0, 3 3, 5 3, 5 0, 3 0))", 14.0),
        ("MULTIPOLYGON (((0 0, 1 0, 0 1, 0 0)), ((5 5, 6 5, 5 6, 5 5)))", 1.0),
        (f"GEOMETRYCOLLECTION ({WITH_HOLE}, POLYGON ((3 0, 3 3, 5 3, 5 0, 3 0)))", 14.0),
    ],
)
def test_wkt(tmp_path, text, area):
    assert am.read_domain(write(tmp_path / "a.wkt", text)).area == pytest.approx(area, rel=1e-14)


def test_dirty_wkt_is_repaired(tmp_path):
    path = write(tmp_path / "a.WKT", "POLYGON ((0 0, 2 2, 2 0, 0 2, 0 0))")
    with pytest.raises(DomainError, match=r"a\.WKT: crossing at \(1, 1\).*repair"):
        am.read_domain(path)
    domain, _ = am.repair(path)
    assert domain.area == 2.0


@pytest.mark.parametrize(
    ("text", "error", "message"),
    [
        ("", DomainError, "holds no geometry"),
        (f"{WITH_HOLE}\n\nhello", FormatError, "line 3: expected POLYGON or the like, got 'hello'"),
        (f"{WITH_HOLE}\n{WITH_HOLE[:-1]}", FormatError, "line 2: the brackets of this POLYGON"),
        (f"{WITH_HOLE}\nPOLYGON ((0 0, 1 x, 0 0))", FormatError, "line 2: .*'x'"),
        ("POLYGON ((0 0, 1 0, 1 1))", FormatError, "line 1: .*closed"),
        ("TRIANGULAR ((0 0, 1 0, 1 1, 0 0))", FormatError, "line 1: .*TRIANGULAR"),
        ("CURVEPOLYGON(CIRCULARSTRING(0 0, 1 1, 2 0, 1 -1, 0 0))", FormatError, "line 1"),
        (f"{WITH_HOLE} POINT (1 1)", DomainError, "polygon 1 is a Point"),
        ("POLYGON EMPTY", DomainError, "polygon 0 is empty"),
        ("POLYGON ((0 0, 1 nan, 1 1, 0 0))", DomainError, "polygon 0.*finite"),
        ("POLYGON ((0 0, 1 1e400, 1 1, 0 0))", DomainError, "polygon 0.*finite"),
        (b"\xff\xfe\x00", FormatError, "not a text file"),
    ],
)
def test_wkt_that_is_wrong(tmp_path, text, error, message):
    with pytest.raises(error, match=rf"a\.wkt.*{message}"):
        am.read_domain(write(tmp_path / "a.wkt", text))


def test_a_missing_file(tmp_path):
    for name in ("a.wkt", "a.shp", "a.geojson"):
        with pytest.raises(FormatError, match="no such file"):
            am.read_domain(tmp_path / name)


# -------------------------------------------------------------------------------------- shapefiles


@pytest.fixture
def shapefile(tmp_path):
    pyshp = pytest.importorskip("shapefile")

    def written(polygons, names=None, field="NAME", kind=pyshp.POLYGON):
        with pyshp.Writer(str(tmp_path / "a.shp"), shapeType=kind, encoding="utf-8") as writer:
            writer.field("id", "N")
            if names is not None:
                writer.field(field, "C")
            for i, rings in enumerate(polygons):
                getattr(writer, {pyshp.POLYGON: "poly", pyshp.POLYLINE: "line"}[kind])(rings)
                writer.record(i, *([] if names is None else [names[i]]))
        return tmp_path / "a.shp"

    return written


def test_shapes_are_regions(shapefile):
    domain = am.read_domain(shapefile([[SQUARE, HOLE], [NEXT]], ["Land", "Größe"]))
    assert domain.area == 14.0
    assert list(domain.region_names) == ["Land", "Größe"]
    assert "Land|Größe" in domain.names


def test_shapes_without_names_and_without_dbf(shapefile):
    assert not am.read_domain(shapefile([[SQUARE, HOLE]], ["a"], "TITLE")).region_names
    path = shapefile([[SQUARE, HOLE], [NEXT]], ["", "b"])
    assert list(am.read_domain(path).region_names) == ["b"]
    path.with_suffix(".dbf").unlink()
    path.with_suffix(".shx").unlink()
    domain = am.read_domain(path)
    assert domain.area == 14.0
    assert not domain.region_names


def test_islands_of_one_shape(shapefile):
    island = [(1.25, 1.25), (1.25, 1.75), (1.75, 1.75), (1.75, 1.25), (1.25, 1.25)]
    assert am.read_domain(shapefile([[SQUARE, HOLE, island]])).area == 8.25


def test_other_shapes_and_none(shapefile):
    with pytest.raises(DomainError, match="no shapes"):
        am.read_domain(shapefile([]))
    pyshp = pytest.importorskip("shapefile")
    with pytest.raises(DomainError, match=r"a\.shp: polygon 0 is a LineString"):
        am.read_domain(shapefile([[SQUARE]], kind=pyshp.POLYLINE))


def test_records_of_another_shapefile(shapefile):
    path = shapefile([[SQUARE]], ["a"])
    other = path.with_suffix(".dbf").read_bytes()
    shapefile([[SQUARE], [NEXT]], ["a", "b"]).with_suffix(".dbf").write_bytes(other)
    with pytest.raises(FormatError, match=r"2 shapes, and the \.dbf beside it 1 records"):
        am.read_domain(path)


def test_shapefiles_cut_short(shapefile):
    path = shapefile([[SQUARE, HOLE], [NEXT]], ["a", "b"])
    whole = path.read_bytes()
    for size in (0, 3, 99, 100, 150, len(whole) - 1):
        with pytest.raises(FormatError, match=r"a\.shp"):
            am.read_domain(write(path, whole[:size]))


def test_heights_are_refused_with_the_polygon(tmp_path):
    pyshp = pytest.importorskip("shapefile")
    with pyshp.Writer(str(tmp_path / "a.shp"), shapeType=pyshp.POLYGONZ) as writer:
        writer.field("id", "N")
        writer.polyz([[(x, y, x) for x, y in SQUARE]])
        writer.record(0)
    corners = [[0, 0, 0], [3, 0, 3], [3, 3, 3], [0, 0, 0]]
    (tmp_path / "a.geojson").write_text(json.dumps({"type": "Polygon", "coordinates": [corners]}))
    (tmp_path / "a.wkt").write_text("POLYGON Z ((0 0 0, 3 0 3, 3 3 3, 0 0 0))")
    for name in ("a.shp", "a.geojson", "a.wkt"):
        with pytest.raises(DomainError, match=rf"{name}: heights at .*polygon 0 .* from 0 to 3"):
            am.read_domain(tmp_path / name)
        assert am.repair(tmp_path / name)[1].counts == {"heights": 1}


def test_a_height_that_is_no_number(tmp_path):
    corners = [[0, 0, 0], [3, 0, "high"], [3, 3, 3], [0, 0, 0]]
    (tmp_path / "a.geojson").write_text(json.dumps({"type": "Polygon", "coordinates": [corners]}))
    with pytest.raises(FormatError, match=r"a\.geojson: polygon 0 .*'high'"):
        am.read_domain(tmp_path / "a.geojson")
