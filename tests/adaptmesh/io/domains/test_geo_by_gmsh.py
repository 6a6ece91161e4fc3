"""Scripts that Gmsh opens: its curves, names and regions, and that they reach no other file."""

import os
import sys

import numpy as np
import pytest

from adaptmesh import generate, read_domain
from adaptmesh.errors import DomainError, FormatError, FormatWarning
from adaptmesh.io.domains.geo import by_gmsh, model
from adaptmesh.io.domains.geo.gmsh_script import included_name, safe_script
from adaptmesh.io.domains.geo.script import script_of

needs_gmsh = pytest.mark.skipif(not by_gmsh.is_installed(), reason="gmsh is not there")

SQUARE = """
Point(1) = {0, 0, 0}; Point(2) = {1, 0, 0}; Point(3) = {1, 1, 0}; Point(4) = {0, 1, 0};
Line(1) = {1, 2}; Line(2) = {2, 3}; Line(3) = {3, 4}; Line(4) = {4, 1};
Curve Loop(1) = {1:4}; Plane Surface(1) = {1};
"""
RING = """
Point(1) = {1, 0, 0}; Point(2) = {2, 0, 0}; Line(1) = {1, 2};
a() = Extrude {{0, 0, 1}, {0, 0, 0}, Pi/2} {Line{1};};
"""

SCRIPTS = {
    "Translate a copy": (
        SQUARE + "b() = Translate {1, 0, 0} {Duplicata {Surface{1};}};\n"
        'Physical Surface("left") = {1}; Physical Surface("right") = {b(0)};',
        2.0,
        {"left": 1.0, "right": 1.0},
    ),
    "Rotate and Dilate": (
        SQUARE + "Rotate {{0, 0, 1}, {.3, .2, 0}, 1} {Surface{1};}\n"
        "Dilate {{5, 5, 0}, 3} {Surface{1};}",
        9.0,
        {},
    ),
    "Symmetry": (
        SQUARE + "c() = Symmetry {1, 0, 0, 0} {Duplicata {Surface{1};}};\n"
        'Physical Surface("all", 7) = {1, c()};',
        2.0,
        {"all": 2.0},
    ),
    "Extrude a line": (
        "Point(1) = {0, 0, 0}; Point(2) = {2, 0, 0}; Line(1) = {1, 2};\n"
        'o[] = Extrude {.5, 3, 0} {Line{1};}; Physical Curve("top") = {o[0]};',
        6.0,
        {},
    ),
    "Extrude around an axis": (RING, 0.75 * np.pi, {}),
    "Macro and Call": (
        """Macro Plate
  p = newp; Point(p) = {x, 0, 0}; Point(p+1) = {x+1, 0, 0}; Point(p+2) = {x+1, 2, 0};
  Point(p+3) = {x, 2, 0}; l = newl; Line(l) = {p, p+1}; Line(l+1) = {p+1, p+2};
  Line(l+2) = {p+2, p+3}; Line(l+3) = {p+3, p};
  k = newll; Curve Loop(k) = {l:l+3}; s = news; Plane Surface(s) = {k};
  all() += s;
Return
all() = {};
For i In {0:2}
  x = 3*i; Call Plate;
EndFor
Physical Surface("boxes") = {all()};""",
        6.0,
        {"boxes": 6.0},
    ),
    "Delete": (
        SQUARE + "Delete {Surface{1};} Line(5) = {1, 3}; Curve Loop(2) = {1, 2, -5};\n"
        "Plane Surface(2) = {2};",
        0.5,
        {},
    ),
    "Difference": (
        'SetFactory("OpenCASCADE"); Rectangle(1) = {0, 0, 0, 4, 2}; Disk(2) = {4, 1, 0, .5};\n'
        'BooleanDifference(3) = {Surface{1}; Delete;}{Surface{2}; Delete;}; Printf("a") > "b";',
        8 - np.pi / 8,
        {},
    ),
    "Union": (
        'SetFactory("OpenCASCADE"); Rectangle(1) = {0, 0, 0, 4, 2}; Disk(2) = {4, 1, 0, .5};\n'
        "BooleanUnion(3) = {Surface{1}; Delete;}{Surface{2}; Delete;};",
        8 + np.pi / 8,
        {},
    ),
    "Fragments": (
        'SetFactory("OpenCASCADE"); Rectangle(1) = {0, 0, 0, 4, 2}; Disk(2) = {2, 1, 0, .5, .25};\n'
        "f() = BooleanFragments{Surface{1}; Delete;}{Surface{2}; Delete;};\n"
        'Physical Surface("in") = {2}; Physical Surface("out") = {3};',
        8.0,
        {"in": np.pi / 8, "out": 8 - np.pi / 8},
    ),
    "Compound and structs": (
        SQUARE + "Compound Curve {1, 2}; Compound Surface {1}; Periodic Curve {1} = {-3};\n"
        "Color Red {Surface{1};} Coherence; Geometry.AutoCoherence = 0;",
        1.0,
        {},
    ),
    "ways of lists": (
        "p() = {1, 2}; p() -= {2}; q = p(0); v() = LinSpace(0, 1, 3);\n"
        "Point(q) = {v(0), 0, 0}; Point(2) = {v(2), 0, 0}; Point(3) = {v(1), 1, 0};\n"
        "l() = {}; For k In {1 : 3}\n l() += newl; Line(l(k-1)) = {k, k % 3 + 1};\nEndFor\n"
        "Curve Loop(9) = l(); Plane Surface(9) = {9};",
        0.5,
        {},
    ),
    "a surface by its corners": (SQUARE.replace("Plane Surface", "Surface"), 1.0, {}),
    "a plane at another height": (
        SQUARE.replace(", 0}; P", ", 5}; P").replace("0, 1, 0}", "0, 1, 5}")
        + "Rotate {{0, 0, 1}, {0, 0, 0}, 1} {Surface{1};}",
        1.0,
        {},
    ),
}


def written(folder, text, name="a.geo"):
    path = folder / name
    path.write_text(text)
    return path


@needs_gmsh
@pytest.mark.filterwarnings("ignore:.*periodic")
@pytest.mark.parametrize("name", SCRIPTS)
def test_what_our_reader_does_not_know(tmp_path, name, capfd):
    text, area, regions = SCRIPTS[name]
    path = written(tmp_path, text)
    with pytest.raises(FormatError):
        model._Model.of(script_of(text)).plane(tmp_path).domain()
    domain = read_domain(path)
    assert domain.area == pytest.approx(area, rel=1e-9)
    assert set(domain.region_names) == set(regions)
    mesh = generate(domain, 0.1)
    assert mesh.validate()
    for region, size in regions.items():
        found = mesh.areas[mesh.triangles_in(region)].sum()
        assert found == pytest.approx(size, rel=0.05)
    assert list(tmp_path.iterdir()) == [path]  # nothing was written
    assert capfd.readouterr() == ("", "")


@needs_gmsh
def test_names_and_tags(tmp_path):
    domain = read_domain(
        written(
            tmp_path,
            RING + 'Physical Curve("start of it", 5) = {1}; Physical Curve(17) = {a(0)};\n'
            'Physical Surface("Öl", 40) = {a(1)};',
        )
    )
    assert dict(domain.names) == {"start of it": 5, "17": 17}
    assert dict(domain.region_names) == {"Öl": 40}
    mesh = generate(domain, 0.1)
    ends = mesh.points[mesh.edges_named("17")]
    np.testing.assert_allclose(ends[..., 0], 0, atol=1e-12)


@needs_gmsh
def test_a_curve_in_two_groups_bears_both_names(tmp_path):
    path = written(tmp_path, RING + 'Physical Curve("a") = {1, a(0)}; Physical Curve("b") = {1};')
    with pytest.warns(FormatWarning, match=r"several physical groups.*a\|b"):
        domain = read_domain(path)
    assert set(domain.names) == {"a", "a|b"}


KERNELS = {
    "Built-in": """
Point(1) = {0, 0, 0}; Point(2) = {1, 0.5, 0}; Point(3) = {1.5, 1.5, 0}; Point(4) = {0.2, 1.4, 0};
Point(5) = {-1, 1, 0}; Point(6) = {3, 3, 0}; Point(7) = {5, 3, 0}; Point(8) = {3, 5, 0};
Point(9) = {6, 3, 0}; a = 0.4; c = Cos(a); s = Sin(a);
Point(10) = {3 + 3*c*Cos(.3) - 1*s*Sin(.3), 3 + 3*s*Cos(.3) + 1*c*Sin(.3), 0};
Point(11) = {3 + 3*c*Cos(2) - 1*s*Sin(2), 3 + 3*s*Cos(2) + 1*c*Sin(2), 0};
Point(12) = {3 + 4*c, 3 + 4*s, 0}; Point(13) = {3 + 2*Cos(Pi/180), 3 + 2*Sin(Pi/180), 0};
Line(1) = {1, 2}; Circle(2) = {7, 6, 8}; Circle(3) = {7, 6, 13}; Ellipse(4) = {10, 6, 12, 11};
Spline(5) = {1, 2, 3, 4, 5}; Spline(6) = {1, 2, 3, 4, 1}; BSpline(7) = {1, 2, 3, 4, 5};
BSpline(8) = {1, 2, 3, 4, 1}; Bezier(9) = {1, 2, 3, 4};
""",
    "OpenCASCADE": """SetFactory("OpenCASCADE");
Point(21) = {0, 0, 0}; Point(22) = {1, 2, 0}; Point(23) = {2, 1, 0}; Point(24) = {4, 1, 0};
Line(1) = {21, 22}; Circle(2) = {.5, 1, 0, 2, 0.2, 4}; Circle(3) = {.5, 1, 0, 2, 0, Pi/180};
Ellipse(4) = {0, 1, 0, 2, 1, 1, 5}; Spline(5) = {21:24}; Ellipse(6) = {0, 1, 0, 2, 1};
BSpline(7) = {21:24}; Nurbs(8) = {21:24} Knots {0, 0, 0, 0, 1, 1, 1, 1} Order 3;
Bezier(9) = {21:24};
""",
}
"""Curves 1 to 9 of every kind."""

PLACES = {
    "as it is": "",
    "turned": "Rotate {{0, 0, 1}, {1, 2, 0}, 0.7} {Curve{1:9};}",
    "reflected": "Symmetry {1, 2, 0, -1} {Curve{1:9};}",
    "small": "Dilate {{0, 0, 0}, 1e-3} {Curve{1:9};}",
    "large": "Dilate {{0, 0, 0}, 1e5} {Curve{1:9};}",
    "far": "Translate {1e5, -1e5, 0} {Curve{1:9};}",
}


@needs_gmsh
@pytest.mark.parametrize("place", PLACES)
@pytest.mark.parametrize("kernel", KERNELS)
def test_curves_are_where_gmsh_has_them(tmp_path, kernel, place):
    gmsh = pytest.importorskip("gmsh", exc_type=ImportError)
    path = written(tmp_path, KERNELS[kernel] + PLACES[place] + "\n")
    said = by_gmsh._opened(path, safe_script(path))
    t = np.linspace(0, 1, 101)
    gmsh.initialize(["gmsh"], readConfigFiles=False, interruptible=False)
    try:
        gmsh.option.setNumber("General.Terminal", 0)
        gmsh.open(str(path))
        tags = [tag for _, tag in gmsh.model.getEntities(1)]
        true = {}
        for tag in tags:
            (low,), (high,) = gmsh.model.getParametrizationBounds(1, tag)
            at = gmsh.model.getValue(1, tag, low + (high - low) * t)
            true[tag] = at.reshape(-1, 3)[:, :2]
    finally:
        gmsh.finalize()
    assert len(tags) == 9
    for tag in tags:
        found = by_gmsh._curve(path, tag, said["curves"][str(tag)]).point(t)
        size, largest = np.ptp(true[tag], axis=0).max(), np.abs(true[tag]).max()
        # OpenCASCADE makes rational curves of circles that it dilates, and has knots anywhere.
        share = 2e-9 if kernel == "OpenCASCADE" else 2e-12
        assert np.abs(found - true[tag]).max() <= share * size + 1e-14 * largest, tag


@needs_gmsh
@pytest.mark.parametrize(
    ("text", "says"),
    [
        (SQUARE + "Extrude {0, 0, 1} {Surface{1};}", "volumes"),
        (SQUARE + "Translate {0, 0, 1} {Point{3};}", "not plane: point"),
        (SQUARE + "Translate {1, 0, 0} {Point{33};}", "unknown|Unknown|Error"),
        ("Macro A\n Call A;\nReturn\nCall A;", "ended without a result|Error|after 4 s"),
        ("Translate {1, 0, 0} {\n\n", "line 3|line 2|syntax error"),
    ],
)
def test_what_is_no_plane_domain(tmp_path, monkeypatch, text, says):
    monkeypatch.setattr(by_gmsh, "SECONDS", 2)
    with pytest.raises(FormatError, match=says) as caught:
        read_domain(written(tmp_path, text))
    assert "a.geo" in str(caught.value)


@needs_gmsh
def test_a_loop_without_end_is_ended(tmp_path, monkeypatch):
    monkeypatch.setattr(by_gmsh, "SECONDS", 2)
    with pytest.raises(FormatError, match=r"more than 2 s|after 4 s"):
        read_domain(written(tmp_path, "v() = LinSpace(0, 1, 3); For i In {1:1e9}\n a = i;\nEndFor"))


@needs_gmsh
def test_gmsh_stays_outside(tmp_path):
    before = "gmsh" in sys.modules
    read_domain(written(tmp_path, RING))
    assert ("gmsh" in sys.modules) == before


def test_without_gmsh_the_error_says_so(tmp_path, monkeypatch):
    monkeypatch.setattr(by_gmsh, "is_installed", lambda: False)
    with pytest.raises(FormatError, match=r"a\.geo, line 3: .*Extrude.*pip install .*\[gmsh\]"):
        read_domain(written(tmp_path, RING))


# ------------------------------------------------------------------------------ what is handed over


def test_included_files(tmp_path):
    (tmp_path / "inner").mkdir()
    written(tmp_path / "inner", "b = 2; // last\n\nc = 3;", "more.geo")
    written(tmp_path, 'Include "inner/more.geo"; a = 1;\n', "first.geo")
    path = written(tmp_path, '\nInclude "first.geo";\nMerge "inner/more.geo";\nd = 4;')
    script = safe_script(path)
    assert [file.name for file, _ in script.included] == ["more.geo", "first.geo", "more.geo"]
    assert [text.split() for _, text in script.included[::2]] == 2 * [
        ["b", "=", "2;", "c", "=", "3;"]
    ]
    assert script.included[1][1].startswith(f'Include "{included_name(0)}";')
    lines = [line.strip() for line in script.text.split("\n")]
    assert lines[1:4] == [f'Include "{included_name(k)}";' for k in (1, 2)] + ["d = 4;"]


TILES = """
Function Tile
  p = newp; Point(p) = {x, y, 0}; Point(p+1) = {x+1, y, 0}; Point(p+2) = {x+1, y+1, 0};
  Point(p+3) = {x, y+1, 0}; l = newl;
  For i In {0:3}
    Line(l+i) = {p+i, p+(i+1)%4};
  EndFor
  k = newll; Line Loop(k) = {l:l+3}; s = news; Plane Surface(s) = {k}; tiles() += s;
Return
"""


@needs_gmsh
def test_included_macros_and_loops(tmp_path):
    """Gmsh finds them again by their lines: to put all in one line lost what followed."""
    written(tmp_path, TILES, "tile.inc")
    row = "For j In {0:2}\n  x = 2*j;\n  Call Tile;\nEndFor\n"
    written(tmp_path, row, "row.inc")
    written(tmp_path, row, "row.geo")
    path = written(
        tmp_path,
        'tiles() = {};\nInclude "tile.inc";\ny = 0;\nInclude "row.inc";\ny = 5;\n'
        'Merge "row.geo";\nPhysical Surface("all") = tiles();',
    )
    domain = read_domain(path)
    assert domain.area == pytest.approx(6, rel=1e-12)
    assert list(domain.region_names) == ["all"]
    extent = domain.points.min(axis=0).tolist() + domain.points.max(axis=0).tolist()
    assert extent == pytest.approx([0, 0, 5, 6])


@needs_gmsh
def test_errors_name_the_included_file(tmp_path):
    written(tmp_path, "a = 1;\n\nb = nowhere;\n", "parts.inc")
    path = written(tmp_path, SQUARE + 'Include "parts.inc";')
    with pytest.raises(FormatError, match=r"'parts\.inc', line 3"):
        read_domain(path)


@needs_gmsh
def test_a_loop_of_several_closed_lines(tmp_path):
    """The outline and a hole in one loop: our reader passes it on."""
    hole = (
        SQUARE.split("Curve Loop")[0]
        + """
Point(5) = {.25, .25, 0}; Point(6) = {.75, .25, 0}; Point(7) = {.5, .75, 0};
Line(5) = {5, 6}; Line(6) = {6, 7}; Line(7) = {7, 5};
Curve Loop(1) = {1:7}; Plane Surface(1) = {1};
"""
    )
    assert read_domain(written(tmp_path, hole)).area == pytest.approx(0.875, rel=1e-12)


@needs_gmsh
def test_a_loop_with_a_slit(tmp_path):
    """A line there and back is no end of the boundary; it stays a line of the domain."""
    slit = (
        SQUARE.split("Curve Loop")[0]
        + """
Point(5) = {.5, .5, 0}; Line(5) = {1, 5};
Curve Loop(1) = {5, -5, 1:4}; Plane Surface(1) = {1}; Physical Curve("slit") = {5};
"""
    )
    domain = read_domain(written(tmp_path, slit))
    assert domain.area == pytest.approx(1, rel=1e-12)
    assert list(domain.names) == ["slit"]


@needs_gmsh
@pytest.mark.parametrize("more", ["", "Translate {1, 0, 0} {Point{1:7};}"])
def test_a_loop_with_a_line_that_ends(tmp_path, more):
    open_end = (
        SQUARE.split("Curve Loop")[0]
        + f"""
Point(5) = {{.25, .25, 0}}; Point(6) = {{.75, .25, 0}}; Point(7) = {{.5, .75, 0}};
Line(5) = {{5, 6}}; Line(6) = {{6, 7}};
Curve Loop(1) = {{1:6}}; Plane Surface(1) = {{1}}; {more}
"""
    )
    with pytest.raises(FormatError, match="surface 1 is not closed: a curve ends at"):
        read_domain(written(tmp_path, open_end))


OUTSIDE = "outside.geo"
REFUSED = {
    "a program": 'SystemCall "touch made";',
    "a program, after a name": 'Macro A SystemCall "touch made"; Return Call A;',
    "in a condition": 'If (1) SystemCall "touch made"; EndIf',
    "behind a number": '1SystemCall "touch made";',
    "after a text that Gmsh cuts off": f"a = \"{'x' * 1023}SystemCall 'touch made';\";",
    "in a text": 'S2N["SystemCall"] "touch made";',
    "in another case": 'NonBlockingSystemCall "touch made";',
    "a file above": f'Include "../{OUTSIDE}";',
    "a file above, merged": f'Merge "../{OUTSIDE}";',
    "a file by its whole path": f'Include "{os.sep}etc{os.sep}passwd";',
    "a computed name": 'Include StrCat("../", "outside.geo");',
    "a hidden Merge": f'Macro Merge "../{OUTSIDE}"; Return',
    "an object": 'Merge "a.step";',
    "a shape": 'v() = ShapeFromFile("a.step");',
    "a list": 'v() = ListFromFile("/etc/passwd");',
    "an unknown command": 'Frobnicate "a";',
    "a hidden Save": 'a = 1 + Save "made";',
    "a field that runs": 'Field[1] = ExternalProcess; Field[1].CommandLine = "touch made";',
    "an open comment": "/* a",
    "an open text": 'a = "b',
    "a folder": 'Include ".";',
    "itself": 'Include "a.geo";',
}


@pytest.mark.parametrize("name", REFUSED)
def test_what_reaches_out_is_refused(tmp_path, name):
    folder = tmp_path / "folder"
    folder.mkdir()
    written(tmp_path, "x = 1;", OUTSIDE)
    path = written(folder, REFUSED[name])
    with pytest.raises(FormatError, match=r"a\.geo|folder"):
        safe_script(path)
    with pytest.raises((FormatError, DomainError)):
        read_domain(path)
    assert not (folder / "made").exists()


def test_a_link_out_of_the_folder_is_refused(tmp_path):
    folder = tmp_path / "folder"
    folder.mkdir()
    (folder / "link.geo").symlink_to(written(tmp_path, "x = 1;", OUTSIDE))
    with pytest.raises(FormatError, match="not in the folder"):
        safe_script(written(folder, 'Include "link.geo";'))


def test_includes_that_double_are_bounded(tmp_path):
    for k in range(12):
        written(tmp_path, f'Include "{k + 1}.geo";\n' * 10, f"{k}.geo")
    written(tmp_path, "x = 1;" * 100, "12.geo")
    with pytest.raises(FormatError, match="over 2,000,000 characters, or over 200"):
        safe_script(tmp_path / "0.geo")


def test_what_is_left_out(tmp_path):
    path = written(
        tmp_path,
        'Printf("a; }") >> "made"; Save "made";\nPrint.Background = 1; Mesh 2;'
        " Mesh.Algorithm = 6;\n"
        'View "v" {\n SP(0, 0, 0){1}; };\nPlugin(Skin).Run; Background Field = 1; '
        "General.Terminal = 1; /* Save */ Levelset Sphere (2) = {{0, 0, 0}, -10};\n"
        "Levelset CutMeshTri {2}; x = 1;",
    )
    script = safe_script(path)
    assert script.text.split() == ["Mesh.Algorithm", "=", "6;", "x", "=", "1;"]
    assert script.left_out["Save"] == 1
    assert script.left_out["View"] == 3
    assert script.text.count("\n") == 6


@needs_gmsh
@pytest.mark.parametrize("turn", [0.002, 0.02, 0.2])
def test_short_arcs_that_miss_their_ends_meet(tmp_path, turn):
    """A short arc tells little of its radius: it was taken for one of an ellipse, unjoined."""
    x, y = 1.00003 * np.array([np.cos(turn), np.sin(turn)])
    path = written(
        tmp_path,
        f"""Point(1) = {{0, 0, 0}}; Point(2) = {{1, 0, 0}}; Point(3) = {{{x:.17g}, {y:.17g}, 0}};
Point(4) = {{.5, 0, 0}}; Circle(1) = {{2, 1, 3}}; Line(2) = {{3, 4}}; Line(3) = {{4, 2}};
Curve Loop(1) = {{1:3}}; Plane Surface(1) = {{1}}; Translate {{2, 1, 0}} {{Point{{1:4}};}}""",
    )
    with pytest.warns(FormatWarning, match="not equally far"):
        domain = read_domain(path)
    assert domain.area == pytest.approx(turn / 2 - np.sin(turn) / 4, rel=1e-3)


@needs_gmsh
def test_arcs_that_miss_their_ends(tmp_path):
    """Of points that are not on one circle; the arc goes through both, as without Gmsh."""
    circle = """
    Point(1) = {3, 4, 0}; Point(2) = {4, 4, 0}; Point(3) = {3, 5.004, 0}; Point(9) = {0, 0, 7};
    Circle(1) = {2, 1, 3}; Line(2) = {3, 1}; Line(3) = {1, 2};
    Curve Loop(1) = {1, 2, 3}; Plane Surface(1) = {1};
    """
    domains = []
    for more in ("", "Macro M\nReturn\n"):
        text = circle if more else circle.replace("Point(9) = {0, 0, 7};", "")
        with pytest.warns(FormatWarning, match="arcs? through both"):
            domains.append(read_domain(written(tmp_path, text + more)))
    own, other = (domain.area for domain in domains)
    assert other == pytest.approx(own, rel=1e-9)


@needs_gmsh
def test_show_and_hide_take_a_text(tmp_path):
    text = SQUARE + 'Show "*"; Macro M\nReturn\nHide "*"; Physical Surface("s", 3) = {1};'
    assert dict(read_domain(written(tmp_path, text)).region_names) == {"s": 3}
