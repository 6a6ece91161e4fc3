"""What is written comes back; what cannot be written is refused and leaves the old file alone."""

import os
import warnings

import numpy as np
import pytest

from adaptmesh import io
from adaptmesh.errors import FormatError, MetricError
from adaptmesh.mesh.mesh import Mesh

WAYS = {
    "vtu": ("a.vtu", {}),
    "vtk": ("a.vtk", {}),
    "vtk text": ("a.vtk", {"binary": False}),
    "msh41": ("a.msh", {}),
    "msh41 text": ("a.msh", {"binary": False}),
    "msh22": ("a.msh", {"version": "2.2"}),
    "msh22 text": ("a.msh", {"version": "2.2", "binary": False}),
    "mesh": ("a.mesh", {}),
    "meshb": ("a.meshb", {}),
    "xdmf": ("a.xdmf", {}),
    "ele": ("a.ele", {}),
}


@pytest.fixture(params=WAYS)
def way(request, tmp_path):
    """Path and options of every way to write."""
    name, options = WAYS[request.param]
    return tmp_path / name, options


def a_mesh(**changes):
    """A square of eight triangles about its centre, with coordinates that need 17 digits.

    ::

        6---5---4        regions 0 and 7, bottom edge in two, a line from the
        | \\ | / |       centre 8 to the right, all other edges without a tag
        7---8---3
        | / | \\ |
        0---1---2
    """
    points = np.array(
        [[0, 0], [1, 0], [2, 0], [2, 1], [2, 2], [1, 2], [0, 2], [0, 1], [1, 1]], dtype=float
    )
    points = points / 3 + [1e-17, 1 / 7]
    ring = np.arange(8)
    triangles = np.stack([np.full(8, 8), ring, (ring + 1) % 8], axis=1)
    border = np.stack([ring, (ring + 1) % 8], axis=1)
    given = {
        "regions": [0, 7, 7, 0, 7, 0, 7, 7],
        "edges": [*border, [8, 3]],
        "edge_tags": [3, 5, 0, 0, 0, 0, 0, 0, 2],
        "names": {"inlet": 3, "out let": 5, "line": 2},
        "region_names": {"steel": 7},
    }
    return Mesh(points, triangles, **{**given, **changes})


def assert_same(first, second):
    for name in ("points", "triangles", "regions", "edges", "edge_tags"):
        np.testing.assert_array_equal(getattr(first, name), getattr(second, name), err_msg=name)
    assert dict(first.names) == dict(second.names)
    assert dict(first.region_names) == dict(second.region_names)


def some_fields(mesh, seed=0):
    random = np.random.default_rng(seed)
    n, m = len(mesh.points), len(mesh.triangles)
    return {
        "u": random.random(n),
        "velocity": random.random((n, 2)) * 1e-300,
        "colour of": random.random((n, 3)) * 1e300,
        "q": random.random(m),
        "flux": random.random((m, 2)),
    }


def test_a_mesh_comes_back_bit_for_bit(way):
    path, options = way
    mesh = a_mesh()
    io.write(path, mesh, **options)
    back = io.read(path)
    assert_same(mesh, back)
    assert back.domain is None
    assert io.read_fields(path) == {}


def test_fields_and_metric_come_back_bit_for_bit(way):
    path, options = way
    mesh = a_mesh()
    fields = some_fields(mesh)
    metric = np.random.default_rng(1).random((9, 3)) / 7 + [1, 0, 1]
    io.write(path, mesh, metric=metric, **fields, **options)
    assert_same(mesh, io.read(path))
    back = io.read_fields(path)
    assert back.keys() == {*fields, "metric"}
    for name, values in {**fields, "metric": metric}.items():
        np.testing.assert_array_equal(back[name], values, err_msg=name)


def test_a_file_is_copied_by_reading_and_writing(way):
    path, options = way
    mesh = a_mesh()
    io.write(path, mesh, metric=0.1, **some_fields(mesh), **options)
    copy = path.parent / "copy" / path.name  # .xdmf has the name of the file beside it inside
    copy.parent.mkdir()
    for metric_and_fields in (io.read_fields(path), {"fields": io.read_fields(path)}):
        io.write(copy, io.read(path), **metric_and_fields, **options)
        assert copy.read_bytes() == path.read_bytes()


def test_fields_may_have_the_names_of_options(way):
    path, options = way
    mesh = a_mesh()
    u = np.arange(9.0)
    names = ["version", "binary", "fields", "triangle_fields", "mesh", "path", "two words"]
    fields = {name: u + k for k, name in enumerate(names)}
    io.write(path, mesh, fields={**fields, "metric": 0.5}, v=u, **options)
    back = io.read_fields(path)
    assert back.keys() == {*fields, "v", "metric"}
    for name, values in fields.items():
        np.testing.assert_array_equal(back[name], values, err_msg=name)


@pytest.mark.parametrize(
    ("given", "message"),
    [
        ({"fields": {"u": np.zeros(9)}, "u": np.ones(9)}, "'u' is given twice"),
        ({"fields": {"metric": 0.1}, "metric": 0.2}, "'metric' is given twice"),
        ({"fields": np.zeros(9)}, "expected a mapping of names to arrays, got ndarray"),
        ({"fields": {"u": np.zeros(9)}, "triangle_fields": {"u": np.zeros(8)}}, "two fields"),
        ({"fields": {3: np.zeros(9)}}, "3 cannot be the name of a field"),
    ],
)
def test_fields_given_wrongly(tmp_path, given, message):
    with pytest.raises(FormatError, match=message):
        io.write(tmp_path / "a.vtu", a_mesh(), **given)


@pytest.mark.parametrize("large", [1e76, -1e155, 1.7e308])
def test_coordinates_whose_areas_overflow(way, large):
    """They are neither written nor read: no mesh of them can be adapted."""
    path, options = way
    mesh = a_mesh()
    points = mesh.points.copy()
    points[8, 1] = large
    with pytest.raises(FormatError, match=r"point 8 is .* overflow; choose another unit of length"):
        io.write(path, Mesh(points, mesh.triangles), **options)


AWKWARD = [
    'say "hi"',
    "a\nb",
    "Größe ∞ 漢字",
    "50 % < 3 & 4 > 2",
    "$EndPhysicalNames",
    "x" * 200,
    " a ",
]


@pytest.mark.parametrize("name", AWKWARD)
def test_awkward_names(way, name):
    path, options = way
    mesh = a_mesh(names={name: 3, "unused": 11}, region_names={name: 7})
    io.write(path, mesh, **options)
    assert_same(mesh, io.read(path))


def test_two_names_of_one_tag_and_a_name_of_tag_zero(way):
    path, options = way
    mesh = a_mesh(names={"a": 3, "b": 3, "rest": 0})
    io.write(path, mesh, **options)
    assert_same(mesh, io.read(path))


def test_without_edges_regions_and_names(way):
    path, options = way
    mesh = Mesh(a_mesh().points, a_mesh().triangles)
    io.write(path, mesh, u=mesh.points, **options)
    assert_same(mesh, io.read(path))
    np.testing.assert_array_equal(io.read_fields(path)["u"], mesh.points)


def test_a_point_without_triangle_stays(way):
    path, options = way
    mesh = a_mesh()
    mesh = Mesh([*mesh.points, [9, 9]], mesh.triangles)
    io.write(path, mesh, **options)
    assert_same(mesh, io.read(path))


def test_nan_and_infinity_in_fields_are_kept(way):
    path, options = way
    values = np.full(9, np.nan)
    values[3] = np.inf
    io.write(path, a_mesh(), u=values, **options)
    np.testing.assert_array_equal(io.read_fields(path)["u"], values)


def test_integers_stay_integers_in_vtu(tmp_path):
    numbers = np.arange(9) + 2**53
    io.write(tmp_path / "a.vtu", a_mesh(), i=numbers, mask=numbers % 2 == 0)
    back = io.read_fields(tmp_path / "a.vtu")
    assert back["i"].dtype == np.int64
    np.testing.assert_array_equal(back["i"], numbers)
    np.testing.assert_array_equal(back["mask"], numbers % 2 == 0)


def test_metric_of_every_kind(tmp_path):
    path, mesh = tmp_path / "a.vtu", a_mesh()
    packed = np.tile([4.0, 1.0, 9.0], (9, 1))
    matrices = np.tile([[4.0, 1.0], [1.0, 9.0]], (9, 1, 1))
    for metric in (packed, matrices, lambda points: np.tile([4.0, 1.0, 9.0], (len(points), 1))):
        io.write(path, mesh, metric=metric)
        np.testing.assert_array_equal(io.read_fields(path)["metric"], packed)
    for metric in (np.full(9, 0.5), 0.5):
        io.write(path, mesh, metric=metric)
        np.testing.assert_array_equal(io.read_fields(path)["metric"], [[4, 0, 4]] * 9)


def test_as_many_points_as_triangles(tmp_path):
    # a field by keyword is then at the points; `triangle_fields` says otherwise
    points = [[0, 0], [4, 0], [4, 4], [0, 4], [1, 2], [3, 2]]
    triangles = [[0, 1, 4], [1, 5, 4], [1, 2, 5], [2, 4, 5], [2, 3, 4], [3, 0, 4]]
    mesh = Mesh(points, triangles)
    io.write(tmp_path / "a.vtu", mesh, u=np.arange(6), triangle_fields={"q": np.arange(6)})
    text = (tmp_path / "a.vtu").read_text()
    assert text.index("<PointData>") < text.index('Name="u"') < text.index("<CellData>")
    assert text.index("<CellData>") < text.index('Name="q"')


@pytest.mark.parametrize(
    ("fields", "message"),
    [
        ({"u": np.zeros(10)}, r"'u' has 10 rows; the mesh has 9 points and 8 triangles"),
        ({"u": np.zeros((9, 0))}, r"'u': expected shape .*, got \(9, 0\)"),
        ({"u": np.zeros(())}, r"'u': expected shape .*, got \(\)"),
        ({"u": np.zeros(9, complex)}, r"'u' has values of type complex128"),
        ({"u": ["a"] * 9}, r"'u' has values of type"),
        ({"u": [[1], [2, 3]]}, r"'u' is not an array"),
        ({"regions": np.zeros(9)}, r"'regions' is the name of what the file holds anyway"),
        ({'a"b': np.zeros(9)}, r"cannot be the name of a field"),
        ({"triangle_fields": {"q": np.zeros(9)}}, r"'q' of the triangles has 9 rows"),
        ({"q": np.zeros(9), "triangle_fields": {"q": np.zeros(8)}}, r"two fields are called 'q'"),
        ({"version": "3"}, r"no version '3'|no option 'version'"),
    ],
)
def test_what_cannot_be_written_leaves_the_old_file(way, fields, message):
    path, options = way
    path.write_bytes(b"old")
    with pytest.raises(FormatError, match=message) as error:
        io.write(path, a_mesh(), **{**options, **fields})
    assert str(path) in str(error.value)
    assert path.read_bytes() == b"old"
    assert list(path.parent.iterdir()) == [path]


def test_metric_that_is_none(way):
    path, options = way
    with pytest.raises(MetricError, match="point 4"):
        io.write(path, a_mesh(), metric=np.where(np.arange(9) == 4, -1.0, 1.0), **options)
    assert not path.exists()


def test_broken_meshes_are_not_written(way):
    path, options = way
    mesh = a_mesh()
    with pytest.raises(FormatError, match=r"triangle 0 has vertices \[0, 1, 99\]"):
        io.write(path, Mesh(mesh.points, [[0, 1, 99]]), **options)
    with pytest.raises(FormatError, match=r"point 2 is \(nan, 0.0\)"):
        io.write(path, Mesh([[0, 0], [0, 1], [np.nan, 0]], [[0, 1, 2]]), **options)
    with pytest.raises(FormatError, match="not a text"):
        io.write(path, a_mesh(names={"\udc80": 3}), **options)
    with pytest.raises(FormatError, match="no triangles"):
        io.write(path, Mesh(mesh.points, np.empty((0, 3))), **options)
    assert not path.exists()


def test_format_limits(tmp_path):
    with pytest.raises(FormatError, match="edge tag -3 is negative"):
        io.write(tmp_path / "a.msh", a_mesh(edge_tags=[-3] * 9))
    with pytest.raises(FormatError, match=r"300 bytes; .meshb holds at most 255"):
        io.write(tmp_path / "a.meshb", a_mesh(names={"x" * 300: 3}))
    with pytest.raises(FormatError, match="would be a file of its own"):
        io.write(tmp_path / "a.mesh", a_mesh(), **{"dT/dx": np.zeros(9)})
    with pytest.raises(FormatError, match=r"\.vtu has no option 'binary'"):
        io.write(tmp_path / "a.vtu", a_mesh(), binary=True)
    assert not any(tmp_path.iterdir())


@pytest.mark.parametrize("path", ["a.step", "a", "a.msh.gz"])
def test_unknown_extension(tmp_path, path):
    for act in (lambda p: io.write(p, a_mesh()), io.read, io.read_fields):
        with pytest.raises(FormatError, match=r"known are \.vtu, \.vtk, \.msh, \.mesh, \.meshb"):
            act(tmp_path / path)


def test_extension_in_capitals_and_path_as_text(tmp_path):
    for name in ("A.VTU", "A.MeshB", "A.MSH"):
        io.write(str(tmp_path / name), a_mesh(), metric=0.1)
        assert_same(a_mesh(), io.read(str(tmp_path / name)))
        assert "metric" in io.read_fields(tmp_path / name)


def test_missing_files_and_folders(way):
    path, options = way
    with pytest.raises(FormatError, match="no such file"):
        io.read(path)
    with pytest.raises(FormatError, match=r"there is no folder .*nowhere"):
        io.write(path.parent / "nowhere" / path.name, a_mesh(), **options)
    path.mkdir()
    with pytest.raises(FormatError, match="is a folder"):
        io.write(path, a_mesh(), **options)
    with pytest.raises(FormatError, match="cannot be read"):
        io.read(path)


@pytest.mark.parametrize("error", [KeyboardInterrupt, OSError(28, "No space left on device")])
def test_interrupted_writing_leaves_nothing_behind(tmp_path, monkeypatch, error):
    # the second of two files fails: neither replaces its old one
    io.write(tmp_path / "a.mesh", a_mesh(), metric=1.0)
    before = {p.name: p.read_bytes() for p in tmp_path.iterdir()}
    calls = []

    def fsync(_):
        calls.append(1)
        if len(calls) == 2:
            raise error

    monkeypatch.setattr(os, "fsync", fsync)
    with pytest.raises((KeyboardInterrupt, FormatError)) as caught:
        io.write(tmp_path / "a.mesh", a_mesh(names={}), metric=2.0)
    if caught.type is FormatError:
        assert "a.sol: cannot be written: No space left" in str(caught.value)
    assert {p.name: p.read_bytes() for p in tmp_path.iterdir()} == before


def test_links_and_permissions_stay(tmp_path):
    target, link = tmp_path / "real.vtu", tmp_path / "link.vtu"
    target.write_bytes(b"old")
    target.chmod(0o640)
    link.symlink_to(target)
    io.write(link, a_mesh())
    assert link.is_symlink()
    assert target.stat().st_mode & 0o777 == 0o640
    assert_same(a_mesh(), io.read(target))


def test_nothing_is_printed_or_warned(way, capfd):
    path, options = way
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        io.write(path, a_mesh(), metric=0.1, **options)
        io.read_fields(path)
        path.write_bytes(path.read_bytes()[:-40])
        with pytest.raises(FormatError):
            io.read(path)
    assert capfd.readouterr() == ("", "")


@pytest.mark.parametrize("name", ["a.sol", "a.solb"])
@pytest.mark.parametrize("shape", [(5,), (5, 2), (5, 3), (0,)])
def test_solutions_come_back(tmp_path, name, shape):
    values = np.random.default_rng(0).normal(size=shape)
    io.write_sol(tmp_path / name, values)
    np.testing.assert_array_equal(io.read_sol(tmp_path / name), values)


def test_solutions_of_matrices_are_packed(tmp_path):
    io.write_sol(tmp_path / "a.sol", [[[1, 2], [2, 5]]])
    assert (tmp_path / "a.sol").read_text().split()[4:10] == [
        "SolAtVertices",
        "1",
        "1",
        "3",
        "1.0",
        "2.0",
    ]
    np.testing.assert_array_equal(io.read_sol(tmp_path / "a.sol"), [[1, 2, 5]])
    with pytest.raises(FormatError, match="not symmetric"):
        io.write_sol(tmp_path / "a.sol", [[[1, 2], [3, 5]]])
    with pytest.raises(FormatError, match=r"\.sol or \.solb"):
        io.write_sol(tmp_path / "a.txt", [1.0])


def test_a_solution_of_another_mesh(tmp_path):
    io.write(tmp_path / "a.mesh", a_mesh())
    io.write_sol(tmp_path / "a.sol", np.ones((4, 3)))
    assert_same(a_mesh(), io.read(tmp_path / "a.mesh"))
    with pytest.raises(FormatError, match=r"a\.sol: has 4 rows, the mesh a\.mesh has 9"):
        io.read_fields(tmp_path / "a.mesh")


def test_solutions_beside_other_meshes_are_not_taken(tmp_path):
    io.write(tmp_path / "run.mesh", a_mesh(), u=np.ones(9))
    io.write(tmp_path / "run.2.mesh", a_mesh(), metric=1.0)
    io.write(tmp_path / "runner.mesh", a_mesh(), metric=1.0)
    assert io.read_fields(tmp_path / "run.mesh").keys() == {"u"}
    assert io.read_fields(tmp_path / "run.2.mesh").keys() == {"metric"}
