"""Triangle's .poly format."""

import numpy as np
import pytest

import adaptmesh as am
from adaptmesh.errors import DomainError, FormatError
from adaptmesh.io.domains.poly import read_poly

FRAME = """\
# a square with a square hole, and a line down the middle of its left part
8 2 0 1
1  0 0  0
2  3 0  0
3  3 3  0
4  0 3  0
5  1 1  0   # the hole
6  2 1  0
7  2 2  0
8  1 2  0
8 1
1  1 2  2
2  2 3  3
3  3 4  2
4  4 1  0
5  5 6  7
6  6 7  7
7  7 8  7
8  8 5  7
1
1  1.5 1.5
1
1  0.5 0.5  12.5 -1
"""


@pytest.fixture
def poly(tmp_path):
    def write(text, name="in.poly"):
        path = tmp_path / name
        path.write_text(text)
        return path

    return write


def test_holes_markers_and_regions(poly):
    domain = read_poly(poly(FRAME)).domain()
    assert domain.area == 8.0
    assert list(domain.names) == ["2", "3", "7"]
    assert (domain.segment_tags == domain.names["7"]).sum() == 4
    assert (domain.segment_tags == 0).sum() == 1
    assert list(domain.region_names) == ["12.5"]


def test_numbers_from_zero_points_in_a_node_file_and_no_regions(poly):
    poly("3 2 0 0\n0 0 0\n1 1 0\n2 0 1\n", "in.node")
    domain = read_poly(poly("0 2 0 0\n3 0\n0 0 1\n1 1 2\n2 2 0\n0\n")).domain()
    assert domain.area == 0.5
    assert not domain.names
    assert not domain.region_names


@pytest.mark.parametrize("n_lines", [*range(2, 21), 22])
def test_truncated_anywhere_is_an_error(poly, n_lines):
    text = "\n".join(FRAME.splitlines()[:n_lines])
    with pytest.raises(
        FormatError, match=r"in\.poly ends where .* should be: is the file complete"
    ):
        read_poly(poly(text))


@pytest.mark.parametrize(
    ("old", "new", "message"),
    [
        ("8 2 0 1", "8 3 0 1", "line 2: .* 3 coordinates"),
        ("8 2 0 1", "-8 2 0 1", "line 2: -8 is not a number of points"),
        ("5  1 1  0", "6  1 1  0", "line 7: the points are not numbered"),
        ("5  1 1  0", "5  1 one  0", "line 7: point 4 of 8 should be finite numbers"),
        ("5  1 1  0   #", "5  1   #", "line 7: point 4 of 8 needs at least 4"),
        ("5  5 6  7", "5  5 9  7", "line 16: segment 4 ends in point 9; there are points 1 to 8"),
        ("5  5 6  7", "5  5 6", "line 16: segment 4 of 8 needs at least 4"),
        ("1  0.5 0.5  12.5 -1", "1  0.5 0.5", "line 23: region 0 of 1 needs at least 4"),
    ],
)
def test_nonsense_is_an_error_with_its_line(poly, old, new, message):
    assert old in FRAME
    with pytest.raises(FormatError, match=message):
        read_poly(poly(FRAME.replace(old, new)))


def test_a_hole_outside_is_the_domains_error(poly):
    with pytest.raises(DomainError, match="hole 0"):
        read_poly(poly(FRAME.replace("1  1.5 1.5", "1  9 9"))).domain()


def test_missing_and_binary_files(tmp_path):
    with pytest.raises(FormatError, match="no such file"):
        read_poly(tmp_path / "absent.poly")
    (tmp_path / "binary.poly").write_bytes(bytes(range(256)))
    with pytest.raises(FormatError, match="not a text file"):
        read_poly(tmp_path / "binary.poly")


def test_names_that_we_wrote_come_back(tmp_path):
    mesh = am.generate(am.Domain.rectangle(0, 0, 1, 1), 0.3)
    am.write(tmp_path / "a.ele", mesh)
    domain = am.read_domain(tmp_path / "a.poly")
    assert domain.area == pytest.approx(1)
    assert dict(domain.names) == dict(mesh.names)


def test_the_poly_of_a_mesh_has_its_holes_and_regions(tmp_path):
    """It is the domain again, also without the triangles beside it."""
    square = [(0, 0), (3, 0), (3, 1), (0, 1)]
    hole = [(0.2, 0.2), (0.8, 0.2), (0.8, 0.8)]
    points = np.array([*square, *hole, (1, 0), (1, 1), (2, 0), (2, 1)], float)
    segments = [(0, 7), (7, 9), (9, 1), (1, 2), (2, 10), (10, 8), (8, 3), (3, 0)]
    segments += [(4, 5), (5, 6), (6, 4), (7, 8), (9, 10)]
    regions = {"steel": [(0.1, 0.5), (2.5, 0.5)], "air": [(1.5, 0.5)]}
    domain = am.Domain(points, segments, [(0.7, 0.5)], regions, {"hole": [8, 9, 10]})
    mesh = am.generate(domain, 0.3)
    am.write(tmp_path / "a.ele", mesh)
    (tmp_path / "a.ele").unlink()
    again = am.read_domain(tmp_path / "a.poly")
    assert again.area == pytest.approx(domain.area, rel=1e-12)
    assert dict(again.names) == dict(domain.names)
    assert dict(again.region_names) == dict(domain.region_names)
    new = am.generate(again, 0.3)
    for name, number in domain.region_names.items():
        area = mesh.areas[mesh.regions == number].sum()
        assert new.areas[new.regions == number].sum() == pytest.approx(area, rel=1e-12), name


LARGE = ["1e308", "9" * 25, "-1e300", "2147483648", "1.5"]


@pytest.mark.parametrize("number", LARGE)
def test_numbers_of_points_that_are_none(number, tmp_path):
    path = tmp_path / "a.poly"
    rows = "{} 0 0\n{} 1 0\n2 0 1\n"
    rest = "3 0\n0 0 1\n1 1 2\n2 2 0\n0\n"
    path.write_text("3 2 0 0\n" + rows.format(number, 1) + rest)
    with pytest.raises(am.FormatError, match=r"line 2: the points are not numbered"):
        am.read_domain(path)
    path.write_text("3 2 0 0\n" + rows.format(0, number) + rest)
    with pytest.raises(am.FormatError, match=r"line 3: the points are not numbered"):
        am.read_domain(path)
    (tmp_path / "a.node").write_text("3 2 0 0\n" + rows.format(number, 1))
    path.write_text("0 2 0 0\n" + rest)
    with pytest.raises(am.FormatError, match=r"a\.node, line 2: the points are not numbered"):
        am.read_domain(path)


@pytest.mark.parametrize("number", ["9" * 25, "1" * 500, "1e3", "x", "--1", "+", "- 1"])
def test_numbers_of_names_that_are_none(number, tmp_path):
    path = tmp_path / "a.poly"
    am.write(tmp_path / "a.ele", am.generate(am.Domain.rectangle(0, 0, 1, 1), 0.5))
    whole = path.read_text()
    assert "# edge_tags 3 " in whole
    path.write_text(whole.replace("# edge_tags 3 ", f"# edge_tags {number} "))
    with pytest.raises(am.FormatError, match="a comment on edge_tags has no number and name"):
        am.read_domain(path)
