"""Gmsh's scripts: the same curves as Gmsh has, names and regions, and what is refused."""

import warnings

import numpy as np
import pytest
import shapely
from reference.transforms import TRANSFORMS

import adaptmesh as am
from adaptmesh import generate, read_domain
from adaptmesh.errors import AdaptmeshError, DomainError, FormatError, FormatWarning
from adaptmesh.io.domains.geo import by_gmsh
from adaptmesh.io.domains.geo.model import _Model
from adaptmesh.io.domains.geo.script import script_of

PLATE = """
// a plate with a disc in it, and a hole
lc = 0.1; r = 0.25; /* over
two lines */ SetFactory("Built-in");
Point(1) = {0, 0, 0, lc}; Point(2) = {2, 0, 0}; Point(3) = {2, 1, 0}; Point(4) = {0, 1, 0};
Line(1) = {1, 2}; Line(2) = {2, 3}; Line(3) = {3, 4}; Line(4) = {4, 1};
Curve Loop(1) = {1:4};
c = newp; Point(c) = {1, .5, 0};
p[] = {};
For k In {0:3}
  q = newp; Point(q) = {1 + r*Cos(k*Pi/2), .5 + r*Sin(k*Pi/2), 0};
  p[] += q;
EndFor
cs[] = {};
For k In {0:#p[]-1}
  l = newl; Circle(l) = {p[k], c, p[(k+1) % 4]}; cs[] += l;
EndFor
Line Loop(2) = {cs[]};
Point(20) = {.3, .3, 0}; Point(21) = {.5, .3, 0}; Point(22) = {.3, .6, 0};
Line(20) = {20, 21, 22, 20}; Curve Loop(3) = {20};
Plane Surface(1) = {1, 2, 3};
Plane Surface(2) = {2};
Physical Curve("wall", 7) = {1, -3}; Physical Line(9) = {2};
Physical Surface("plate", 3) = {1}; Physical Surface("disc") = {2};
Mesh.Algorithm = 6; Transfinite Curve{1} = 10 Using Progression 1.2;
If (r > 1)
  nonsense
ElseIf (r > .2)
  Field[1] = Distance;
Else
  more nonsense
EndIf
"""


def written(tmp_path, text):
    path = tmp_path / "a.geo"
    path.write_text(text)
    return path


def test_a_plate_with_two_surfaces(tmp_path):
    domain = read_domain(written(tmp_path, PLATE))
    assert domain.area == pytest.approx(2 - 0.03, rel=1e-12)
    assert set(domain.names) == {"wall", "9"}
    mesh = generate(domain, 0.1)
    lengths = np.hypot(*(mesh.points[mesh.edges[:, 1]] - mesh.points[mesh.edges[:, 0]]).T)
    assert lengths[mesh.edge_tags == mesh.names["wall"]].sum() == pytest.approx(4)
    disc = mesh.areas[mesh.triangles_in("disc")].sum()
    assert disc == pytest.approx(np.pi / 16, rel=0.03)
    assert mesh.areas[mesh.triangles_in("plate")].sum() == pytest.approx(1.97 - disc)
    rim = mesh.points[np.unique(mesh.edges[mesh.edge_tags == 0])]
    far = np.abs(np.hypot(*(rim - [1, 0.5]).T) - 0.25)
    assert np.count_nonzero(far < 1e-12) > 10


CURVES = {
    "Line": "Line(1) = {1, 2};",
    "Circle": "Circle(1) = {7, 6, 8};",
    "Circle, backwards": "Circle(1) = {8, 6, 7};",
    "Ellipse": "Ellipse(1) = {9, 6, 9, 8};",
    "Ellipse from a tilt": "Ellipse(1) = {10, 6, 12, 11};",
    "Spline": "Spline(1) = {1, 2, 3, 4, 5};",
    "Spline, closed": "Spline(1) = {1, 2, 3, 4, 1};",
    "BSpline": "BSpline(1) = {1, 2, 3, 4, 5};",
    "BSpline of three": "BSpline(1) = {1, 2, 3};",
    "BSpline, closed": "BSpline(1) = {1, 2, 3, 4, 1};",
    "Bezier": "Bezier(1) = {1, 2, 3, 4, 5};",
}
POINTS = """
Point(1) = {0, 0, 0}; Point(2) = {1, 1, 0}; Point(3) = {2, 0, 0}; Point(4) = {3, 2, 0};
Point(5) = {4, 0, 0}; Point(6) = {1, 1, 0}; Point(7) = {2, 1, 0}; Point(8) = {1, 2, 0};
Point(9) = {3, 1, 0}; Point(10) = {1 + 2*Cos(.3)*Cos(.2) - Sin(.3)*Sin(.2),
                                   1 + 2*Cos(.3)*Sin(.2) + Sin(.3)*Cos(.2), 0};
Point(11) = {1 + 2*Cos(1)*Cos(.2) - Sin(1)*Sin(.2), 1 + 2*Cos(1)*Sin(.2) + Sin(1)*Cos(.2), 0};
Point(12) = {1 + Cos(.2), 1 + Sin(.2), 0};
"""


@pytest.mark.parametrize("kind", CURVES)
def test_curves_are_those_of_gmsh(tmp_path, kind):
    gmsh = pytest.importorskip("gmsh", exc_type=ImportError)
    path = written(tmp_path, POINTS + CURVES[kind])
    gmsh.initialize(interruptible=False)
    try:
        gmsh.option.setNumber("General.Terminal", 0)
        gmsh.open(str(path))
        low, high = (float(x[0]) for x in gmsh.model.getParametrizationBounds(1, 1))
        t = np.linspace(low, high, 50)
        theirs = np.array(gmsh.model.getValue(1, 1, t.tolist())).reshape(-1, 3)[:, :2]
    finally:
        gmsh.finalize()
    (curve,) = _Model.of(script_of(path.read_text())).curves[1]
    ours = curve.point(np.linspace(0, 1, 50))
    np.testing.assert_allclose(ours, theirs, atol=1e-9)


def test_opencascade_shapes(tmp_path):
    text = """SetFactory("OpenCASCADE"); Rectangle(1) = {0, 0, 0, 3, 2}; Disk(2) = {6, 1, 0, 2, 1};
    Physical Surface("box") = {1};"""
    domain = read_domain(written(tmp_path, text))
    assert domain.area == pytest.approx(6 + 2 * np.pi, rel=1e-12)
    assert set(domain.region_names) == {"box"}


def test_curves_without_surfaces_are_nested(tmp_path):
    text = """SetFactory("OpenCASCADE"); Circle(1) = {0, 0, 0, 2};
    Circle(2) = {0, 0, 0, 1, 0, 2*Pi};"""
    assert read_domain(written(tmp_path, text)).area == pytest.approx(3 * np.pi, rel=1e-12)


def test_points_and_curves_inside_a_surface(tmp_path):
    text = (
        PLATE
        + """Point(30) = {1.7, .5, 0}; Point(31) = {1.5, .2, 0}; Point(32) = {1.6, .4, 0};
    Line(30) = {31, 32}; Point{30} In Surface{1}; Curve{30} In Surface{1};
    Physical Curve("crack") = {30};"""
    )
    mesh = generate(read_domain(written(tmp_path, text)), 0.2)
    assert (np.hypot(*(mesh.points - [1.7, 0.5]).T) == 0).any()
    assert len(mesh.edges_named("crack"))


def test_expressions():
    text = """a = 2^3 - 1 + 4 / 2 * 3; b = -a + (a > 3 ? 10 : 20); c[] = {1, 2:4, 10:6:-2, a};
    d = #c[]; e = c[3] + c(1); f = Sqrt(16) + Max(2, 3) + Fmod(7, 4) + !0 + (1 < 2 && 3 == 3);
    DefineConstant[ g = {5, Name "size"}, a = 99, h = 1e1 ]; i = g + h; i += 1; i *= 2;
    Point(newp) = {a, b, 0}; Point(newp) = {d, e, 0}; Point(newp) = {f, i, 0};"""
    model = _Model.of(script_of(text))
    assert [p.tolist() for p in model.points.values()] == [[13, -3], [8, 6], [12, 32]]


@pytest.mark.parametrize(
    ("text", "says"),
    [
        ("", "no curves"),
        ("Point(1) = {0, 0", "line 1.*expected '}'"),
        (
            "Point(1) = {0, 0, 1}; Point(2) = {1, 0, 0}; Line(1) = {1, 2};",
            "line 1.*z = 1|not plane",
        ),
        ("\n\nPoint(1) = {0, 0, x};", "line 3.*'x' is neither"),
        ("Point(1) = {0, 0, 0}; Line(1) = {1, 2};", "point 2, which is not defined"),
        ("Extrude {0, 0, 1} { Surface{1}; }", "'?Extrude"),
        ('Merge "a.step";', "Merge"),
        ("For i In {1:3}\n", "For has no EndFor"),
        ("For i In {0:1e9}\nEndFor", "numbers"),
        ("For i In {0:99999}\nFor j In {0:9}\nEndFor\nEndFor", "lists of this script"),
        ("If (1)\n", "If has no EndIf"),
        ("a = 1/0;", "division"),
        ("a = Log(-1);", "line 1"),
        ("a = 9^9^9;", "line 1"),
        ("a = ((((((1", "expected"),
        ("@", "line 1"),
        (f"{POINTS} Circle(1) = {{1, 6, 7}};", "from its centre"),
        (
            f"{POINTS} Line(1) = {{1, 2}}; Line(2) = {{2, 3}}; Curve Loop(1) = {{1, 2}}; "
            "Plane Surface(1) = {1};",
            "not one closed line",
        ),
        (f"{POINTS} Line(1) = {{1, 2}}; Line(2) = {{2, 1}};", "a.geo"),
    ],
)
def test_what_cannot_be_read_is_named(tmp_path, text, says):
    with pytest.raises(AdaptmeshError, match=says) as caught:
        read_domain(written(tmp_path, text))
    assert "a.geo" in str(caught.value)


def test_deep_nesting_ends(tmp_path):
    path = written(tmp_path, "a = " + "(" * 100_000 + "1" + ")" * 100_000 + ";")
    with pytest.raises(FormatError, match="nested"):
        read_domain(path)


def test_scripts_cut_anywhere(tmp_path, monkeypatch):
    monkeypatch.setattr(by_gmsh, "is_installed", lambda: False)
    for size in range(0, len(PLATE), 23):
        path = written(tmp_path, PLATE[:size])
        try:
            read_domain(path)
        except (FormatError, DomainError) as error:
            assert "a.geo" in str(error)


def test_a_loop_without_a_step_does_not_count_down(tmp_path):
    (tmp_path / "a.geo").write_text(
        "n = 1; For k In {5:3}\n n += 1;\nEndFor\nFor k In {5:3:-1}\n n += 1;\nEndFor\n"
        "Point(1) = {0, 0, 0}; Point(2) = {n, 0, 0}; Point(3) = {0, 1, 0};\n"
        "Line(1) = {1, 2}; Line(2) = {2, 3}; Line(3) = {3, 1};\n"
    )
    assert read_domain(tmp_path / "a.geo").area == 2  # n is 4


def test_half_a_turn_is_anticlockwise(tmp_path):
    path = written(
        tmp_path,
        "Point(1) = {0, 0, 0}; Point(2) = {-1, 0, 0}; Point(3) = {1, 0, 0}; Point(4) = {0, 2, 0};\n"
        "Circle(1) = {2, 1, 3}; Line(2) = {3, 4}; Line(3) = {4, 2};",
    )  # by Gmsh: the lower half
    assert read_domain(path).area == pytest.approx(2 + np.pi / 2)


def test_new_numbers_count_all_but_points_together():
    text = (
        "Point(1) = {0, 0, 0}; Point(2) = {1, 0, 0}; Point(7) = {1, 1, 0};\n"
        "Line(1) = {1, 2}; Line(2) = {2, 7}; Line(3) = {7, 1}; b = newll; Curve Loop(b) = {1:3};\n"
        "s = news; Plane Surface(s) = {b}; Physical Curve(40) = {1};\n"
        "Point(100) = {b, s, 0}; Point(101) = {newl, newll, 0}; Point(102) = {news, newreg, 0};\n"
        "Point(newp) = {0, 0, 0};"
    )
    points = _Model.of(script_of(text)).points
    assert [points[k].tolist() for k in (100, 101, 102)] == [[4, 5], [41, 41], [41, 41]]
    assert max(points) == 103


SQUARE = """
Line(1) = {1, 2}; Line(2) = {2, 3}; Line(3) = {3, 4}; Line(4) = {4, 1};
Curve Loop(1) = {1:4}; Plane Surface(1) = {1};
"""


@pytest.fixture
def without_gmsh(monkeypatch):
    monkeypatch.setattr(by_gmsh, "is_installed", lambda: False)


def corners(z, angle=0.3):
    """Four points of a unit square that is turned, at one height."""
    c, s = float(np.cos(angle)), float(np.sin(angle))
    xy = [(0, 0), (c, s), (c - s, s + c), (-s, c)]
    return "".join(f"Point({k}) = {{{x!r}, {y!r}, {z}}};" for k, (x, y) in enumerate(xy, 1))


@pytest.mark.usefixtures("without_gmsh")
@pytest.mark.parametrize("z", [0, 0.5, -1e6])
def test_any_one_height(tmp_path, z):
    domain = read_domain(written(tmp_path, corners(z) + SQUARE))
    assert domain.area == pytest.approx(1, abs=1e-14)


@pytest.mark.usefixtures("without_gmsh")
def test_two_heights_are_refused(tmp_path):
    text = corners(0.5).replace("0.5};Point(4)", "0.25};Point(4)")
    with pytest.raises(FormatError, match=r"Point 3 has z = 0\.25 and Point 1 has z = 0\.5"):
        read_domain(written(tmp_path, text + SQUARE))


@pytest.mark.usefixtures("without_gmsh")
def test_what_is_in_several_groups_bears_all_names(tmp_path):
    groups = """
    Physical Curve("a") = {1, 2}; Physical Curve("b", 12) = {2, -3, 2}; Physical Curve("c") = {4};
    Physical Curve("a") += {2}; Physical Surface("s") = {1}; Physical Surface("t") = {1};
    """
    with pytest.warns(FormatWarning) as caught:
        domain = read_domain(written(tmp_path, corners(0) + SQUARE + groups))
    assert [str(w.message).split(": ", 1)[1] for w in caught] == [
        "curves that are in several physical groups have the names of all: a|b",
        "surfaces that are in several physical groups have the names of all: s|t",
    ]
    assert set(domain.names) == {"a", "a|b", "b", "c"}
    assert {name: domain.names[name] for name in "abc"} == {"a": 1, "b": 12, "c": 13}
    assert set(domain.region_names) == {"s|t"}


@pytest.mark.usefixtures("without_gmsh")
@pytest.mark.parametrize(
    "command", ["Hide { Point{1}; }", "Show {Line{1:4};}", "Color Red {Line{1};}"]
)
@pytest.mark.parametrize("end", ["", ";"])
def test_what_ends_with_a_brace_takes_no_more(tmp_path, command, end):
    """Statements without a semicolon once took the next one with them."""
    text = corners(0) + SQUARE + command + end + 'Physical Surface("s", 8) = {1};'
    assert dict(read_domain(written(tmp_path, text)).region_names) == {"s": 8}


@pytest.mark.usefixtures("without_gmsh")
@pytest.mark.parametrize(("radius", "warns"), [(1 + 1e-8, False), (1.004, True), (0.93, True)])
def test_an_arc_with_ends_on_two_circles(tmp_path, radius, warns):
    """An arc goes through both of its points, and a warning says so."""
    text = f"""
    Point(1) = {{3, 4, 0}}; Point(2) = {{4, 4, 0}}; Point(3) = {{3, {4 + radius!r}, 0}};
    Circle(1) = {{2, 1, 3}}; Line(2) = {{3, 1}}; Line(3) = {{1, 2}};
    """
    with warnings.catch_warnings(record=True) as caught:
        warnings.simplefilter("always")
        domain = read_domain(written(tmp_path, text))
    assert bool(caught) == warns
    assert np.pi / 4 * min(1, radius) ** 2 <= domain.area <= np.pi / 4 * max(1, radius) ** 2
    assert generate(domain, 0.2).validate()


def test_an_arc_with_ends_far_from_one_circle(tmp_path):
    text = "Point(1)={0,0,0}; Point(2)={1,0,0}; Point(3)={0,1.2,0}; Circle(1)={2,1,3};"
    with pytest.raises(FormatError, match=r"1 and 1\.2 from its centre"):
        read_domain(written(tmp_path, text))


# ------------------------------------------------------ surfaces that cross, overlap or touch


def script_of_polygons(polygons):
    """A surface for each polygon, in a physical group, with borders and points of its own."""
    out, n = [], 0
    for k, (name, corners) in enumerate(polygons, 1):
        m = len(corners)
        out += [f"Point({n + i}) = {{{x!r}, {y!r}, 0}};" for i, (x, y) in enumerate(corners, 1)]
        out += [f"Line({n + i}) = {{{n + i}, {n + i % m + 1}}};" for i in range(1, m + 1)]
        out += [f"Curve Loop({k}) = {{{n + 1}:{n + m}}}; Plane Surface({k}) = {{{k}}};"]
        if name:
            out += [f'Physical Surface("{name}", {10 + k}) = {{{k}}};']
            out += [f'Physical Curve("side of {name}", {20 + k}) = {{{n + 1}:{n + m}}};']
        n += m
    return "\n".join(out)


LOW = [(0, 0), (2, 0), (2, 1), (0, 1)]
TOWER = [(0.5, 1), (1.5, 1), (1.5, 2), (0.5, 2)]  # stands on LOW: T-joints
ACROSS = [(1.25, 0.5), (3, 0.25), (3, 1.5), (1.5, 1.75)]
WITHIN = [(0.25, 0.25), (0.75, 0.25), (0.5, 0.75)]
TABLES = {
    "touching": [("low", LOW), ("up", TOWER)],
    "crossing": [("low", LOW), ("across", ACROSS)],
    "within": [("small", WITHIN), ("low", LOW)],
    "all": [("small", WITHIN), ("low", LOW), ("up", TOWER), ("across", ACROSS)],
    "around a hole": [
        ("a", [(0, 0), (3, 0), (3, 1), (0, 1)]),
        ("b", [(0, 0.5), (1, 0.5), (1, 3), (0, 3)]),
        ("c", [(2, 0.5), (3, 0.5), (3, 3), (2, 3)]),
        ("a", [(0.5, 2), (2.5, 2), (2.5, 3.5), (0.5, 3.5)]),
    ],
}


@pytest.mark.parametrize("table", TABLES)
@pytest.mark.parametrize("transform", TRANSFORMS, ids=str)
def test_surfaces_that_do_not_fit_are_repaired(table, transform, tmp_path):
    """What several share is the first one's: areas by a polygon library, on the plain figure."""
    polygons = [(name, transform(corners).tolist()) for name, corners in TABLES[table]]
    path = written(tmp_path, script_of_polygons(polygons))
    if table != "within" and transform == TRANSFORMS[0]:  # else borders may miss each other
        with pytest.raises(DomainError, match=r"let adaptmesh\.repair (do it|give)"):
            read_domain(path)
    domain, repairs = am.repair(path)
    assert repairs
    areas, taken = {}, shapely.Polygon()
    for name, corners in TABLES[table]:
        face = shapely.Polygon(corners)
        areas[name] = areas.get(name, 0) + face.difference(taken).area
        taken = taken.union(face)
    scale = abs(transform.determinant)
    assert domain.area == pytest.approx(taken.area * scale, rel=1e-5)
    mesh = generate(domain, 0.3 * transform.scale)
    assert mesh.validate().ok
    for name, area in areas.items():
        found = mesh.areas[mesh.triangles_in(name)].sum()
        assert found == pytest.approx(area * scale, rel=1e-5), name
        assert f"side of {name}" in domain.names


def test_overlapping_surfaces_of_two_groups_are_refused(tmp_path):
    """The seed of the one may lie in the other."""
    path = written(tmp_path, script_of_polygons(TABLES["within"]))
    with pytest.raises(DomainError, match=r"surfaces 1 and 2 overlap, on an area of 0\.125, and"):
        read_domain(path)
    _, repairs = am.repair(path)
    assert [r.kind for r in repairs] == ["overlapping surfaces"]
    assert "surfaces 1 and 2 share an area of 0.125; 1 keeps it" in str(repairs)
    for name in (None, "one"):
        path = written(tmp_path, script_of_polygons([(name, LOW), (name, WITHIN)]))
        assert read_domain(path).area == pytest.approx(2)
        assert not am.repair(path)[1]


def test_curved_surfaces_that_overlap_are_repaired_if_their_curves_do_not_cross(tmp_path):
    discs = "Point(1) = {0, 0, 0};" + "".join(
        f"Point({k}1) = {{{k}, 0, 0}}; Point({k}2) = {{-{k}, 0, 0}};"
        f"Circle({k}1) = {{{k}1, 1, {k}2}}; Circle({k}2) = {{{k}2, 1, {k}1}};"
        f"Curve Loop({k}) = {{{k}1, {k}2}}; Plane Surface({k}) = {{{k}}};"
        f'Physical Surface("disc {k}") = {{{k}}};'
        for k in (2, 3)
    )
    path = written(tmp_path, discs)
    with pytest.raises(DomainError, match="surfaces 2 and 3 overlap"):
        read_domain(path)
    domain, repairs = am.repair(path)
    assert len(repairs) == 1
    mesh = generate(domain, 0.1)
    assert mesh.areas[mesh.triangles_in("disc 2")].sum() == pytest.approx(4 * np.pi, rel=1e-2)
    assert mesh.areas[mesh.triangles_in("disc 3")].sum() == pytest.approx(5 * np.pi, rel=1e-2)


def test_curves_drawn_twice_are_one(tmp_path):
    """As Coherence makes them."""
    left, right = [(0, 0), (1, 0), (1, 1), (0, 1)], [(1, 0), (2, 0), (2, 1), (1, 1)]
    path = written(tmp_path, script_of_polygons([("a", left), ("b", right)]) + "\nCoherence;")
    with pytest.warns(FormatWarning, match=r"side of a\|side of b"):
        domain = read_domain(path)
    assert domain.area == pytest.approx(2)
    assert {"side of a", "side of b", "side of a|side of b"} == set(domain.names)
    assert set(domain.region_names) == {"a", "b"}


def test_groups_of_number_zero_get_another(tmp_path):
    """In Gmsh 0 is a number like others, here that of all that has no name."""
    text = (
        script_of_polygons([(None, LOW)])
        + 'Physical Surface(0) = {1}; Physical Curve("a", 0) = {1};'
    )
    domain = read_domain(written(tmp_path, text))
    assert domain.region_names == {"0": 1}
    assert domain.names == {"a": 1}
