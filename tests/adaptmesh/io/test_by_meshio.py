"""Formats of meshio: what comes back, what is said to be lost, and files that are damaged."""

import gzip
import os
import random
import re
import warnings
from pathlib import Path

import h5py
import meshio
import numpy as np
import pytest
from meshio._helpers import extension_to_filetypes, reader_map
from reference import by_fork
from reference.damage import damaged, little_memory, little_time
from reference.transforms import TRANSFORMS

import adaptmesh as am
from adaptmesh import io
from adaptmesh.io.domains.read import OUTLINES
from adaptmesh.io.formats import SOLIDS
from adaptmesh.io.meshes import meshio_process
from adaptmesh.io.meshes.by_meshio import KINDS

SUFFIXES = [suffix for suffix, of in io.FORMATS.items() if of.reader == "by_meshio"]
ONE_OF_A_KIND = {KINDS[suffix].name: suffix for suffix in reversed(SUFFIXES)}.values()
NEEDS = {"exodus": "netCDF4"}
DAMAGES = int(os.environ.get("ADAPTMESH_DAMAGES", "6"))
PAGE = Path(__file__).parents[3] / "docs" / "files.md"


@pytest.fixture
def forked(monkeypatch):
    """Processes without the time to start them."""
    if not hasattr(os, "fork"):
        pytest.skip("no fork here")
    monkeypatch.setattr(meshio_process, "_run", by_fork.run)


@pytest.fixture(scope="module")
def mesh():
    domain = am.Domain(
        [(0, 0), (1, 0), (2, 0), (2, 1), (1, 1), (0, 1)],
        [(0, 1), (1, 2), (2, 3), (3, 4), (4, 5), (5, 0), (1, 4)],
        regions={"steel": (0.5, 0.5), "air": (1.5, 0.5)},
        names={"inlet": [5], "wall": [0, 1, 3, 4], "middle": [6]},
    )
    return am.generate(domain, 0.4)


def need(suffix):
    pytest.importorskip(NEEDS.get(KINDS[suffix].name, "meshio"))


def in_the_frame(mesh, transform):
    points = transform(mesh.points)
    triangles = mesh.triangles
    p = points[triangles]
    u, v = p[:, 1] - p[:, 0], p[:, 2] - p[:, 0]
    if (u[:, 0] * v[:, 1] < u[:, 1] * v[:, 0]).any():
        triangles = triangles[:, ::-1]
    return am.Mesh(
        points, triangles, regions=mesh.regions, edges=mesh.edges, edge_tags=mesh.edge_tags,
        names=mesh.names, region_names=mesh.region_names,
    )  # fmt: skip


def fields_on(mesh):
    x = mesh.points[:, 0]
    return {
        "metric": np.column_stack([25 + 0 * x, 1 + 0 * x, 100 + 0 * x]),
        "u": np.linspace(0, 1, len(x)) / 3,
        "v": np.column_stack([np.linspace(1, 2, len(x)) / 7, np.linspace(5, 1, len(x))]),
    }, {"q": np.arange(len(mesh.triangles)) / 7}


def write(path, mesh, **more):
    """Write the mesh with fields of every kind; what is said to be lost."""
    at_points, of_triangles = fields_on(mesh)
    with warnings.catch_warnings(record=True) as caught:
        warnings.simplefilter("always")
        am.write(path, mesh, fields={**at_points, **more}, triangle_fields=of_triangles)
    assert {w.category for w in caught} <= {am.FormatWarning}
    said = " ".join(str(w.message) for w in caught)
    assert not said or said.startswith(f"{path}: {path.name[1:]} does not keep ")
    return said.partition("does not keep ")[2].split(", nor ") if said else []


def labels(cells, points, numbers, names):
    """Cells by the coordinates of their corners, and the name or number of each."""
    name_of = {number: name for name, number in names.items()}
    where = [tuple(sorted(map(tuple, np.round(points[c], 12).tolist()))) for c in cells]
    return {w: name_of.get(n, n) for w, n in zip(where, numbers.tolist(), strict=True)}


def test_every_suffix_of_meshio_is_read_in_some_way():
    """By us, by meshio, or refused with a reason; all that meshio writes only are outlines."""
    theirs = {suffix for suffix, kinds in extension_to_filetypes.items() if kinds[0] in reader_map}
    assert theirs <= {*io.FORMATS, *OUTLINES, *SOLIDS}
    assert {s for s, of in io.FORMATS.items() if of.reader == "by_meshio"} == set(KINDS) <= theirs
    for suffix, kind in KINDS.items():
        assert extension_to_filetypes[suffix] == [kind.name]


@pytest.mark.parametrize("suffix", SUFFIXES)
def test_all_that_is_not_said_to_be_lost_comes_back(suffix, mesh, tmp_path, forked):
    need(suffix)
    path = tmp_path / f"a{suffix}"
    lost = write(path, mesh)
    row = table_row(suffix, lost)
    back, found = am.read(path), am.read_fields(path)
    regions = labels(mesh.triangles, mesh.points, mesh.regions, mesh.region_names)
    digits = 8 if row["coordinates"] != "exact" else 12
    there = labels(back.triangles, back.points, back.regions, back.region_names)
    if row["coordinates"] == "exact":
        assert regions.keys() == there.keys()
        if row["regions"] == "names":
            assert regions == there
        if row["regions"] == "numbers":
            assert len(set(there.values())) == 2
        tags = labels(mesh.edges, mesh.points, mesh.edge_tags, mesh.names)
        their_tags = labels(back.edges, back.points, back.edge_tags, back.names)
        if row["edges"] != "no":
            assert tags.keys() == their_tags.keys()
        if row["edges"] == "names":
            assert tags == their_tags
        if row["edges"] == "numbers":
            assert len(set(their_tags.values())) == len(set(tags.values()))
    assert sorted(map(len, (back.points, back.triangles))) == sorted(
        map(len, (mesh.points, mesh.triangles))
    )
    at_points, of_triangles = fields_on(mesh)
    for name, values in {**at_points, **of_triangles}.items():
        gone = any(re.match(r"fields \(", text) and f"'{name}'" in text for text in lost)
        if not gone and row["order"] == "kept":
            np.testing.assert_allclose(found[name], values, rtol=10.0**-digits)
    page = PAGE.read_text(encoding="utf-8")
    assert row["line"] in page, f"docs/files.md should have the row\n{row['line']}"


def table_row(suffix, lost):
    """What the page says of a suffix, made from what is said to be lost."""

    def is_lost(*starts):
        return any(text.startswith(starts) for text in lost)

    without_names = "numbers" if is_lost("names of regions") else "names"
    regions = "no" if is_lost("regions with") else without_names
    edges = (
        "no" if is_lost("edges with") else "lines" if is_lost("edge tags with")
        else "numbers" if is_lost("names of edge tags") else "names"
    )  # fmt: skip
    gone = next((text for text in lost if text.startswith("fields (")), "")
    kept = [name for name in ("metric", "u", "v", "q") if f"'{name}'" not in gone]
    fields = {
        "": "no", "u": "scalars at points", "uq": "scalars", "metricuv": "at points",
        "metricuvq": "all",
    }["".join(kept)]  # fmt: skip
    coordinates = "rounded" if is_lost("all digits of coordinates") else "exact"
    order = "of points" if is_lost("the order of the points") else (
        "of triangles" if is_lost("the order of the triangles") else "kept"
    )  # fmt: skip
    cells = [f"`{suffix}`", KINDS[suffix].name, regions, edges, fields, coordinates, order]
    return {
        "regions": regions, "edges": edges, "coordinates": coordinates, "order": order,
        "line": f"| {' | '.join(cells)} |",
    }  # fmt: skip


@pytest.mark.parametrize("transform", TRANSFORMS, ids=str)
@pytest.mark.parametrize("suffix", [".inp", ".med", ".su2", ".vol"])
def test_in_any_frame(suffix, transform, mesh, tmp_path, forked):
    there = in_the_frame(mesh, transform)
    path = tmp_path / f"a{suffix}"
    write(path, there)
    back = am.read(path)
    np.testing.assert_array_equal(back.points, there.points)
    np.testing.assert_array_equal(np.sort(back.triangles), np.sort(there.triangles))
    assert labels(back.edges, back.points, back.edge_tags, back.names) == labels(
        there.edges, there.points, there.edge_tags, there.names
    )


def test_coordinates_that_a_format_would_round_away_are_refused(mesh, tmp_path, forked):
    """Text of UGRID is read in single precision: far from the origin, points would move."""
    far = in_the_frame(mesh, lambda points: points + 1e6)
    with pytest.raises(am.FormatError, match=r"a\.ugrid: would hold other points"):
        am.write(tmp_path / "a.ugrid", far)
    assert not list(tmp_path.iterdir())


@pytest.mark.parametrize("suffix", [".inp", ".med"])
def test_numbers_without_a_name_and_names_of_any_kind(suffix, mesh, tmp_path, forked):
    """Tag 2 and region 7 have no name; blanks cannot be in names of Abaqus."""
    odd = am.Mesh(
        mesh.points, mesh.triangles, regions=np.where(mesh.regions == 1, 7, 3), edges=mesh.edges,
        edge_tags=mesh.edge_tags, names={"inlet": 1, "ein Name": 3}, region_names={"air": 3},
    )  # fmt: skip
    path = tmp_path / f"a{suffix}"
    with warnings.catch_warnings(record=True) as caught:
        warnings.simplefilter("always")
        am.write(path, odd)
    back = am.read(path)
    np.testing.assert_array_equal(back.regions == 7, odd.regions == 7)
    np.testing.assert_array_equal(back.edge_tags == 2, odd.edge_tags == 2)
    np.testing.assert_array_equal(back.triangles_in("air"), odd.triangles_in("air"))
    if suffix == ".inp":
        assert "'ein Name'" in str(caught[-1].message)
    else:
        np.testing.assert_array_equal(back.edges_named("ein Name"), odd.edges_named("ein Name"))


def test_periodic_and_frozen_sides_are_said_to_be_lost(tmp_path, forked):
    domain = am.Domain.rectangle(0, 0, 1, 1).with_periodic("left", "right").with_frozen("top")
    with pytest.warns(am.FormatWarning, match=r"edges are frozen .*, nor .* are periodic"):
        am.write(tmp_path / "a.inp", am.generate(domain, 0.5))


ABAQUS = """*HEADING
by hand
*NODE
10, 0., 0., 0.
20, 1., 0., 0.
30, 1., 1., 0.
40, 0., 1., 0.
*ELEMENT, TYPE=CPS3, ELSET=plate
1, 10, 20, 30
2, 10, 30, 40
*ELEMENT, TYPE=T2D2, ELSET=rim
5, 10, 20
6, 20, 30
*ELSET, ELSET=soft
2
*NSET, NSET=corner
10
"""


def test_abaqus_of_others(tmp_path):
    """In a process of its own: two sets for one triangle, and a set of points."""
    path = tmp_path / "part.inp"
    path.write_text(ABAQUS)
    with pytest.warns(am.FormatWarning) as caught:
        mesh = am.read(path)
    said = " ".join(str(w.message) for w in caught)
    assert "passed over the sets of points 'corner'" in said
    assert "'soft|plate'" in said or "'plate|soft'" in said
    assert mesh.edges_named("rim").tolist() == [[0, 1], [1, 2]]
    assert mesh.triangles_in("plate").tolist() == [0]


@pytest.mark.parametrize("number", ["inf", "nan", "1e300", "0.5"])
def test_numbers_of_regions_that_are_none_are_a_field_or_refused(number, tmp_path, forked):
    text = f"""VARIABLES = "X", "Y", "regions"
ZONE NODES = 3, ELEMENTS = 1, DATAPACKING = BLOCK, ZONETYPE = FETRIANGLE,
VARLOCATION = ([3] = CELLCENTERED)
0.0 1.0 0.0
0.0 0.0 1.0
{number}
1 2 3
"""
    path = tmp_path / "a.dat"
    path.write_text(text)
    assert am.read(path).regions.tolist() == [0]
    path.write_text(text.replace(number, "7.0"))
    assert am.read(path).regions.tolist() == [7]


SU2 = """% by hand
NDIME = 2
NELEM= 2
5 0 1 2 0
5 0 2 3 1
NPOIN= 4
0. 0. 0
1. 0. 1
1. 1. 2
0. 1. 3
NMARK= 2
MARKER_TAG= lower wall
MARKER_ELEMS= 1
3 0 1
MARKER_TAG = 5
MARKER_ELEMS= 2
3 1 2
3 2 3
"""


def test_su2_of_others(tmp_path, forked):
    path = tmp_path / "part.su2"
    path.write_text(SU2.replace("lower wall", "lower_wall"))
    mesh = am.read(path)
    assert mesh.edges_named("lower_wall").tolist() == [[0, 1]]
    assert sorted(mesh.edge_tags.tolist()) == [1, 5, 5]
    np.testing.assert_array_equal(mesh.points, [[0, 0], [1, 0], [1, 1], [0, 1]])


def test_second_order_and_solids(tmp_path, forked):
    points = [[0, 0], [1, 0], [0, 1], [0.5, 0], [0.5, 0.5], [0, 0.5]]
    spatial = np.column_stack([points, np.zeros(6)])
    path = tmp_path / "a.inp"
    meshio.write(path, meshio.Mesh(spatial, [("triangle6", [[0, 1, 2, 3, 4, 5]])]))
    with pytest.warns(am.FormatWarning, match="cells of higher order"):
        assert am.read(path).points.tolist() == points[:3]
    spatial[3, 2] = 1
    meshio.write(path, meshio.Mesh(spatial, [("tetra", [[0, 1, 2, 3]])]), file_format="abaqus")
    with pytest.raises(am.FormatError, match=r"a\.inp: holds 1 tetra"):
        am.read(path)
    for suffix in SOLIDS:
        with pytest.raises(am.FormatError, match="tetrahedra only"):
            am.read(tmp_path / f"a{suffix}")


def test_surfaces_are_refused(tmp_path, forked):
    path = tmp_path / "a.off"
    path.write_text("OFF\n4 2 0\n0 0 0\n1 0 0\n1 1 0.5\n0 1 0\n3 0 1 2\n3 0 2 3\n")
    with pytest.raises(am.FormatError, match=r"a\.off: point 2 .* z is not 0"):
        am.read(path)


# --------------------------------------------------------------------------- files not trusted


def test_a_file_does_not_read_another(tmp_path):
    """In a process of its own: Abaqus includes files by any path."""
    (tmp_path / "other.inp").write_text(ABAQUS)
    path = tmp_path / "a.inp"
    for name in (tmp_path / "other.inp", "other.inp", "/etc/passwd"):
        path.write_text(f"*INCLUDE, INPUT={name}\n")
        with pytest.raises(am.FormatError, match=r"a\.inp: meshio.*(another file|No such file)"):
            am.read(path)


def test_hdf5_does_not_lead_to_another_file(tmp_path, mesh, forked):
    path = tmp_path / "a.med"
    am.write(path, mesh)
    with h5py.File(path, "a") as file:
        file["FAS/more"] = h5py.ExternalLink("other.h5", "/x")
    with pytest.raises(am.FormatError, match="leads to another file"):
        am.read(path)


def test_time_and_memory_are_bounded(tmp_path, monkeypatch):
    """In a process of its own: a Nastran file that ends early keeps meshio busy for ever."""
    monkeypatch.setattr(meshio_process, "SECONDS", 2)
    path = tmp_path / "a.bdf"
    path.write_text("BEGIN BULK\n")
    with pytest.raises(am.FormatError, match=r"a\.bdf: meshio (ended without|has not done it)"):
        am.read(path)
    monkeypatch.setattr(meshio_process, "MEMORY", 1 << 26)
    path = tmp_path / "a.vol.gz"
    path.write_bytes(gzip.compress(b"mesh3d\ndimension\n2\npoints\n" + b" " * (1 << 27), 1))
    with pytest.raises(am.FormatError, match=r"a\.vol\.gz: meshio"):
        am.read(path)


@pytest.mark.parametrize("suffix", ONE_OF_A_KIND)
def test_damaged(suffix, mesh, tmp_path, forked):
    need(suffix)
    path = tmp_path / f"a{suffix}"
    write(path, mesh)
    data = path.read_bytes()
    with warnings.catch_warnings(), little_memory():
        warnings.simplefilter("ignore", am.FormatWarning)
        for seed in range(DAMAGES):
            path.write_bytes(damaged(data, random.Random(f"{suffix} {seed}"), [b"", b"x" * 99]))
            with little_time():
                try:
                    assert am.read(path).triangles.max() >= 0
                except am.AdaptmeshError as error:
                    assert path.name in str(error), error
                    assert isinstance(error.__cause__, (am.AdaptmeshError, type(None))), seed
