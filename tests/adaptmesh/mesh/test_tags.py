"""Numbers of names: given, kept through adaptation, and kept by files that know nothing else."""

import numpy as np
import pytest

import adaptmesh as am
from adaptmesh.curves import Circle, Line
from adaptmesh.errors import DomainError

CORNERS = [(0, 0), (2, 0), (2, 1), (0, 1), (1, 0), (1, 1)]
SEGMENTS = [(0, 4), (4, 1), (1, 2), (2, 5), (5, 3), (3, 0), (4, 5)]


def a_domain(**options):
    return am.Domain(CORNERS, SEGMENTS, **options)


def lengths(mesh):
    """Length of the constrained edges of each tag."""
    a, b = mesh.points[mesh.edges].transpose(1, 0, 2)
    return {
        tag: pytest.approx(np.hypot(*(b - a)[mesh.edge_tags == tag].T).sum(), rel=1e-12)
        for tag in np.unique(mesh.edge_tags).tolist()
    }


def areas(mesh):
    return {
        region: pytest.approx(mesh.areas[mesh.regions == region].sum(), rel=1e-12)
        for region in np.unique(mesh.regions).tolist()
    }


def test_tags_are_given_and_others_are_the_least_that_are_free():
    domain = a_domain(
        names={"a": [0], "b": [1], 2: [2], "c": [3], np.int64(9): [4]},
        tags={"b": 1, "elsewhere": 40},
    )
    assert domain.names == {"a": 3, "b": 1, "c": 4, "elsewhere": 40}
    assert domain.segment_tags.tolist() == [3, 1, 2, 4, 9, 0, 0]


def test_numbers_of_regions():
    regions = {7: (0.5, 0.5), "right": (1.5, 0.5)}
    domain = a_domain(regions=regions, region_tags={"right": 23})
    assert domain.region_names == {"right": 23}
    assert set(domain.triangle_regions) == {7, 23}
    mesh = am.generate(domain, 0.5)
    assert areas(mesh) == {7: 1.0, 23: 1.0}


def test_two_names_of_one_tag():
    domain = a_domain(names={"a": [0], "b": [1]}, tags={"a": 5, "b": 5})
    assert domain.segment_tags.tolist() == [5, 5, 0, 0, 0, 0, 0]


def test_a_name_whose_number_is_0_would_name_all_that_has_none():
    for options in (
        {"names": {"a": [0]}, "tags": {"a": 0}},
        {"names": {"a": [0], "b": lambda x: x[:, 0] < 1e-9}, "tags": {"b": 0}},
    ):
        with pytest.raises(DomainError, match=r"tag 0 for '[ab]': 0 is the tag of all"):
            a_domain(**options)
        with pytest.raises(DomainError, match=r"tag 0 for '[ab]'"):
            circle = Circle((0, 0), 1)
            am.Domain.from_curves([circle], names={"a": [0], "b": []}, tags=options["tags"])
    with pytest.raises(DomainError, match="region 0 for 'A': 0 is the region of all"):
        a_domain(regions={"A": (0.5, 0.5)}, region_tags={"A": 0})


def test_tags_of_curves():
    curves = [Circle((0, 0), 2), Circle((0, 0), 1), Line((-0.5, 0), (0.5, 0))]
    domain = am.Domain.from_curves(
        curves,
        names={"outer": [0], 17: [1]},
        tags={"outer": 4},
        holes=(),
        regions={"ring": (1.5, 0), 6: (0, 0.5)},
        region_tags={"ring": 3},
    )
    mesh = am.generate(domain, 0.4)
    assert set(mesh.edge_tags) == {0, 4, 17}
    assert set(mesh.regions) == {3, 6}
    assert dict(mesh.names) == {"outer": 4}


@pytest.mark.parametrize(
    ("options", "message"),
    [
        ({"names": {17: [0], "a": [0]}}, "segment 0 is named both 17 and 'a'"),
        ({"tags": {"a": 1.5}}, r"tag 1\.5: expected a whole number"),
        ({"tags": {"a": 2**31}}, "tag 2147483648: expected a whole number of 32 bits"),
        (
            {"regions": {2**40: (0.5, 0.5)}},
            "region 1099511627776: expected a whole number of 32 bits",
        ),
        ({"names": {17: [7]}}, "name 17 is given to segment 7"),
    ],
)
def test_what_is_no_tag(options, message):
    with pytest.raises(DomainError, match=message):
        a_domain(**options)


WAYS = {
    "a.vtu": {},
    "a.msh": {},
    "b.msh": {"version": "2.2", "binary": False},
    "a.mesh": {},
    "a.meshb": {},
    "a.ele": {},
    "a.xdmf": {},
}


@pytest.mark.parametrize("name", WAYS)
def test_tags_stay_through_read_adapt_and_write(tmp_path, name):
    if name.endswith(".xdmf"):
        pytest.importorskip("h5py")
    made = am.generate(
        a_domain(
            names={"inlet": [5], 17: [0, 1], "middle": [6]},
            tags={"inlet": 23, "middle": 2},
            regions={40: (0.5, 0.5), "right": (1.5, 0.5)},
            region_tags={"right": 8},
        ),
        0.3,
    )
    mesh = made
    for size in (0.2, 0.4):
        am.write(tmp_path / name, mesh, **WAYS[name])
        read = am.read(tmp_path / name)
        assert read.domain is None
        mesh = am.adapt(read, size)
        assert lengths(mesh) == lengths(made) == {0: 3.0, 2: 1.0, 17: 2.0, 23: 1.0}
        assert areas(mesh) == areas(made) == {8: 1.0, 40: 1.0}
        assert dict(mesh.names) == {"inlet": 23, "middle": 2}
        assert dict(mesh.region_names) == {"right": 8}


def test_a_name_of_untagged_edges_and_two_names_stay():
    names = {"a": 3, "b": 3, "rest": 0}
    mesh = am.generate(a_domain(names={3: [0]}), 0.5)
    read = am.Mesh(
        mesh.points, mesh.triangles, mesh.regions, mesh.edges, mesh.edge_tags, names=names
    )
    assert dict(am.adapt(read, 0.4).names) == names


def test_tags_stay_through_repair_and_simplify():
    domain = a_domain(
        names={17: [0, 1], "middle": [6]}, tags={"middle": 2},
        regions={40: (0.5, 0.5), "right": (1.5, 0.5)}, region_tags={"right": 8},
    )  # fmt: skip
    for clean in (am.repair(domain)[0], am.simplify(domain, 0.1)[0]):
        mesh = am.generate(clean, 0.5)
        assert lengths(mesh) == {0: 4.0, 2: 1.0, 17: 2.0}
        assert areas(mesh) == {8: 1.0, 40: 1.0}
        assert dict(mesh.names) == {"middle": 2}


def test_markers_and_physical_numbers_are_tags(tmp_path):
    (tmp_path / "a.poly").write_text(
        "4 2 0 0\n1 0 0\n2 1 0\n3 1 1\n4 0 1\n4 1\n1 1 2 17\n2 2 3 5\n3 3 4 0\n4 4 1 17\n0\n"
        "1\n1 0.5 0.5 9 -1\n"
    )
    domain = am.read_domain(tmp_path / "a.poly")
    assert domain.names == {"17": 17, "5": 5}
    assert domain.region_names == {"9": 9}
    (tmp_path / "a.geo").write_text(
        "Point(1) = {0,0,0}; Point(2) = {1,0,0}; Point(3) = {0,1,0};\n"
        "Line(1) = {1,2}; Line(2) = {2,3}; Line(3) = {3,1}; Curve Loop(1) = {1,2,3};\n"
        'Plane Surface(1) = {1}; Physical Curve("wall", 17) = {1,2}; Physical Curve(4) = {3};\n'
        'Physical Surface("steel", 6) = {1};\n'
    )
    domain = am.read_domain(tmp_path / "a.geo")
    assert domain.names == {"wall": 17, "4": 4}
    assert domain.region_names == {"steel": 6}
