"""Filled areas of DXF as regions, and features without geometry."""

import json

import numpy as np
import pytest
import shapely

import adaptmesh as am
from adaptmesh.errors import DomainError, FormatWarning

ezdxf = pytest.importorskip("ezdxf")


def saved(document, folder):
    document.saveas(folder / "a.dxf")
    return folder / "a.dxf"


@pytest.mark.parametrize("angle", [0.0, 33.0])
@pytest.mark.parametrize("scale", [1e-3, 1.0, 1e4])
def test_fills_are_regions(tmp_path, angle, scale):
    c, s = np.cos(np.radians(angle)) * scale, np.sin(np.radians(angle)) * scale

    def at(*points):
        return [(c * x - s * y + 7 * scale, s * x + c * y - 3 * scale) for x, y in points]

    document = ezdxf.new("R2010")
    space = document.modelspace()
    hatch = space.add_hatch(dxfattribs={"layer": "steel"})
    hatch.paths.add_polyline_path(at((0, 0), (4, 0), (4, 2), (0, 2)), is_closed=True)
    hatch.paths.add_edge_path().add_arc(at((1, 1))[0], 0.5 * scale, 0, 360)
    hatch = space.add_hatch(dxfattribs={"layer": "glass"})
    hatch.paths.add_polyline_path(at((4, 0), (6, 0), (6, 2), (4, 2)), is_closed=True)
    space.add_solid(at((6, 0), (7, 0), (6, 2), (7, 2)), dxfattribs={"layer": "wood"})
    domain = am.read_domain(saved(document, tmp_path))
    assert domain.area == pytest.approx((14 - np.pi / 4) * scale**2, rel=1e-9)
    mesh = am.generate(domain, 0.1 * scale)
    assert mesh.validate()
    areas = {
        name: mesh.areas[mesh.triangles_in(name)].sum() / scale**2 for name in domain.region_names
    }
    assert areas == {
        "steel": pytest.approx(8 - np.pi / 4, rel=1e-2),
        "glass": pytest.approx(4),
        "wood": pytest.approx(2),
    }


def edges_of(kind, path):
    if kind == "arc":
        path.add_line((0, 0), (2, 0))
        path.add_arc((1, 0), 1, 0, 180, ccw=True)
    elif kind == "arc, clockwise":
        path.add_line((0, 0), (2, 0))
        path.add_arc((1, 0), 1, 180, 360, ccw=False)
    elif kind == "ellipse":
        path.add_line((-2, 0), (2, 0))
        path.add_ellipse((0, 0), (2, 0), 0.4, 0, 180)
    else:
        path.add_line((3, 0), (0, 0))
        path.add_spline(
            control_points=[(0, 0), (1, 2), (2, 2), (3, 0)], degree=3, knot_values=[0] * 4 + [1] * 4
        )


@pytest.mark.parametrize("kind", ["arc", "arc, clockwise", "ellipse", "spline"])
def test_borders_of_every_kind(tmp_path, kind):
    document = ezdxf.new("R2010")
    hatch = document.modelspace().add_hatch()
    edges_of(kind, hatch.paths.add_edge_path())
    path = saved(document, tmp_path)
    (read,) = ezdxf.readfile(path).modelspace()
    (border,) = ezdxf.path.from_hatch(read)  # by ezdxf, as a polygon
    points = [(p.x, p.y) for p in border.flattening(1e-6)]
    domain = am.read_domain(path)
    assert domain.area == pytest.approx(shapely.Polygon(points).area, rel=1e-3)
    low = np.min(points, axis=0)
    np.testing.assert_allclose(domain.points.min(axis=0), low, atol=0.1)


def test_fills_beside_lines_are_passed_over_with_a_word(tmp_path):
    document = ezdxf.new("R2010")
    space = document.modelspace()
    corners = [(0, 0), (4, 0), (4, 2), (0, 2)]
    space.add_hatch().paths.add_polyline_path(corners, is_closed=True)
    space.add_lwpolyline(corners, close=True)
    with pytest.warns(FormatWarning, match="1 filled areas .* are passed over"):
        assert am.read_domain(saved(document, tmp_path)).area == 8


def test_a_fill_that_is_not_closed(tmp_path):
    document = ezdxf.new("R2010")
    document.modelspace().add_hatch().paths.add_edge_path().add_line((0, 0), (1, 0))
    with pytest.raises(DomainError, match=r"filled area 0 .* is not closed"):
        am.read_domain(saved(document, tmp_path))


# ------------------------------------------------------------------------ features without geometry

SQUARE = [[[0, 0], [1, 0], [1, 1], [0, 1], [0, 0]]]
FEATURES = {
    "null": None,
    "an empty polygon": {"type": "Polygon", "coordinates": []},
    "an empty collection": {"type": "GeometryCollection", "geometries": []},
}


@pytest.mark.parametrize("kind", FEATURES)
def test_features_without_geometry(tmp_path, kind):
    polygon = {"type": "Polygon", "coordinates": SQUARE}
    features = [
        {"type": "Feature", "properties": {"name": name}, "geometry": geometry}
        for name, geometry in (("none", FEATURES[kind]), ("some", polygon))
    ]
    path = tmp_path / "a.geojson"
    path.write_text(json.dumps({"type": "FeatureCollection", "features": features}))
    with pytest.warns(FormatWarning, match=r"polygon 0 \('none'\): without geometry"):
        domain = am.read_domain(path)
    assert domain.area == 1
    assert list(domain.region_names) == ["some"]
    path.write_text(json.dumps({"type": "FeatureCollection", "features": features[:1]}))
    with pytest.raises(DomainError, match="empty"):
        am.read_domain(path)


def test_empty_wkt_and_null_shapes(tmp_path):
    pyshp = pytest.importorskip("shapefile")
    path = tmp_path / "a.wkt"
    path.write_text("POLYGON EMPTY\nPOLYGON ((0 0, 1 0, 1 1, 0 1, 0 0))")
    with pytest.warns(FormatWarning, match="polygon 0: without geometry"):
        assert am.read_domain(path).area == 1
    with pyshp.Writer(str(tmp_path / "a.shp"), shapeType=pyshp.POLYGON) as writer:
        writer.field("name", "C")
        writer.null()
        writer.record("a")
        writer.poly([SQUARE[0][::-1]])
        writer.record("b")
    with pytest.warns(FormatWarning, match=r"polygon 0 \('a'\): without geometry"):
        assert am.read_domain(tmp_path / "a.shp").area == 1
