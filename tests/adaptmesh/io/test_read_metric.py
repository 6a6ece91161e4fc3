"""Control spaces from files."""

import meshio
import numpy as np
import pytest
from reference.frames import frames
from reference.meshes import from_axes, irregular_square

import adaptmesh as am
from metrics import tensor

POINTS = np.array([[0, 0], [1, 0], [1, 1], [0, 1.0]])
TRIANGLES = np.array([[0, 1, 2], [0, 3, 2]])  # the second is clockwise
SIZES = np.array([0.1, 0.2, 0.3, 0.4])
TENSORS = np.array([[100, 1, 4], [50, 0, 5], [10, -2, 6], [7, 0, 7.0]])

MESH = """MeshVersionFormatted 2  # a comment
Dimension 2
Vertices
4
0 0 1
1 0 1
1 1 1
0 1 1
Edges 1  1 2 5
Triangles 2
1 2 3 0
1 4 3 0
hVertices 4  1 1 1 1
End
"""


def rows(values):
    return "\n".join(" ".join(map(str, row)) for row in np.atleast_2d(values.T).T)


def sol(values, kind, dimension=2):
    return (
        f"MeshVersionFormatted 2\nDimension {dimension}\nSolAtVertices\n{len(values)}\n1 {kind}\n"
        f"{rows(values)}\nEnd\n"
    )


@pytest.fixture
def folder(tmp_path):
    (tmp_path / "a.mesh").write_text(MESH)
    return tmp_path


def assert_is(field, values):
    np.testing.assert_allclose(field(POINTS), tensor.pack(values), rtol=1e-12)


@pytest.mark.parametrize(
    ("name", "text", "values"),
    [
        ("a.sol", sol(SIZES, 1), SIZES),
        ("a.sol", sol(TENSORS, 3), TENSORS),
        ("a.sol", sol(np.insert(TENSORS, [3, 3, 3], 0, axis=1), 3, 3), TENSORS),
        ("a.mtr", "4 1\n" + rows(SIZES), SIZES),
        ("a.mtr", "4 3\n" + rows(TENSORS), TENSORS),
    ],
)
def test_medit_and_bamg(folder, name, text, values):
    (folder / name).write_text(text)
    assert_is(am.read_metric(folder / "a.mesh"), values)
    assert_is(am.read_metric(folder / name), values)
    (folder / name).rename(folder / ("b" + name[1:]))
    assert_is(am.read_metric(folder / "a.mesh", field=folder / ("b" + name[1:])), values)


def as_nine(tensors):
    out = np.zeros((len(tensors), 3, 3))
    out[:, :2, :2] = tensor.unpack(tensors)
    return out.reshape(-1, 9)


@pytest.mark.parametrize("suffix", [".vtu", ".msh"])
@pytest.mark.parametrize(
    ("values", "wanted"),
    [(SIZES, SIZES), (TENSORS, TENSORS), (as_nine(TENSORS), TENSORS)],
)
def test_written_by_meshio(tmp_path, suffix, values, wanted):
    path = tmp_path / ("a" + suffix)
    spatial = np.insert(POINTS, 2, 0, axis=1)
    options = {"file_format": "gmsh22", "binary": True} if suffix == ".msh" else {}
    data = {"metric": values, "other": 2 * SIZES}
    meshio.Mesh(spatial, {"triangle": TRIANGLES}, data).write(path, **options)
    assert_is(am.read_metric(path), wanted)
    assert_is(am.read_metric(path, "other"), 2 * SIZES)
    with pytest.raises(
        am.AdaptmeshError,
        match=r"no field 'size' of .*; it has '(metric|other)', '",
    ):
        am.read_metric(path, "size")


def test_the_only_point_data_needs_no_name(tmp_path):
    path = tmp_path / "a.vtu"
    meshio.Mesh(np.insert(POINTS, 2, 0, axis=1), {"triangle": TRIANGLES}, {"h": SIZES}).write(path)
    assert_is(am.read_metric(path), SIZES)
    two = {"h": SIZES, "k": SIZES}
    meshio.Mesh(np.insert(POINTS, 2, 0, axis=1), {"triangle": TRIANGLES}, two).write(path)
    with pytest.raises(am.AdaptmeshError, match=r"got 'h', 'k'; choose one by field"):
        am.read_metric(path)


@pytest.mark.parametrize(
    ("suffix", "options"),
    [
        *((suffix, {}) for suffix in (".vtu", ".vtk", ".msh", ".mesh", ".meshb", ".ele")),
        (".msh", {"version": "2.2"}),
    ],
)
def test_what_adaptmesh_writes(tmp_path, suffix, options):
    mesh = am.generate(am.Domain.rectangle(0, 0, 1, 1), 0.5)
    values = tensor.pack(0.1 + mesh.points[:, 0]) * [1, 0.5, 3] + [0, 0.2, 0]
    path = tmp_path / ("a" + suffix)
    am.write(path, mesh, metric=values, **options)
    np.testing.assert_allclose(am.read_metric(path)(mesh.points), values, rtol=1e-12)


@pytest.mark.parametrize(
    ("name", "text", "message"),
    [
        ("a.sol", sol(SIZES[:3], 1), "has 3 values, the mesh .*a.mesh has 4 vertices"),
        ("a.sol", sol(TENSORS[:, :2], 2), "expected one field, .*, got types 2"),
        (
            "a.sol",
            sol(SIZES, 1).replace("SolAtVertices", "SolAtEdges"),
            "has neither SolAtVertices nor",
        ),
        ("a.sol", sol(SIZES, 1).replace("0.4", ""), "expected a number"),
        ("a.sol", sol(-SIZES, 1), r"a.sol: the value at point 0 \(0.0, 0.0\) is not positive"),
        ("a.sol", sol(SIZES, 1, dimension=4), "4 is neither 2 nor 3"),
        (
            "a.mtr",
            "4 2\n" + rows(TENSORS[:, :2]),
            "expected rows of 1 size or .*, got 2",
        ),
        ("a.mtr", "4 1\n0.1 0.2 0.3", "cut short: 4 rows of 1 numbers, 3 words left"),
        ("a.mtr", "4.5 1", "expected an integer, got b'4.5'"),
        ("a.mtr", "", "cut short"),
    ],
)
def test_damaged_values(folder, name, text, message):
    (folder / name).write_text(text)
    with pytest.raises(am.AdaptmeshError, match=message):
        am.read_metric(folder / name)


@pytest.mark.parametrize(
    ("text", "message"),
    [
        (
            MESH.replace("Triangles 2", "Quadrilaterals 2"),
            "expected an? integer",
        ),
        (
            MESH.replace("1 2 3 0", "1 2 9 0"),
            r"a.mesh: triangle 0 has vertices \[0, 1, 8\]",
        ),
        (MESH.replace("1 2 3 0", "1 2 0 0"), "triangle 0 has vertices"),
        (MESH.replace("1 2 3 0", "1 2 1 0"), "triangle 0 has a vertex twice"),
        (MESH.replace("1 0 1", "0 0 1"), "triangle 0 .* has no area"),
        (MESH.replace("1 0 1", "1 nan 1"), r"point 1 is \(1.0, nan\), not finite"),
        (MESH[:60], "Vertices: cut short"),
        ("", "does not start with MeshVersionFormatted"),
    ],
)
def test_damaged_mesh(tmp_path, text, message):
    (tmp_path / "a.mesh").write_text(text)
    (tmp_path / "a.sol").write_text(sol(SIZES, 1))
    with pytest.raises(am.AdaptmeshError, match=message):
        am.read_metric(tmp_path / "a.mesh")


def test_files_that_are_missing_or_of_another_kind(folder):
    with pytest.raises(am.AdaptmeshError, match=r"a.sol or a.mtr beside it, found neither"):
        am.read_metric(folder / "a.mesh")
    with pytest.raises(am.AdaptmeshError, match=r"none.mesh: there is no such file"):
        am.read_metric(folder / "none.mesh")
    with pytest.raises(am.AdaptmeshError, match=r"none.vtu: there is no such file"):
        am.read_metric(folder / "none.vtu")
    with pytest.raises(am.FormatError, match=r"the extension '.xyz' is not known; known are .vtu"):
        am.read_metric(folder / "a.xyz")
    (folder / "bad.vtu").write_text("<VTKFile")
    with pytest.raises(am.AdaptmeshError, match=r"bad.vtu: is cut short or not XML"):
        am.read_metric(folder / "bad.vtu")
    (folder / "bad.msh").write_bytes(b"\0\1\2")
    with pytest.raises(am.AdaptmeshError, match=r"bad.msh: does not start"):
        am.read_metric(folder / "bad.msh")
    with pytest.raises(am.FormatError, match=r"expected its mesh b.mesh .* beside it, found none"):
        am.read_metric(folder / "b.sol")
    (folder / "a.sol").write_text(sol(SIZES, 1))
    with pytest.raises(am.FormatError, match=r"no field 'u' beside it; there is 'metric'"):
        am.read_metric(folder / "a.mesh", field="u")
    with pytest.raises(am.AdaptmeshError, match="has the values itself"):
        am.read_metric(folder / "a.sol", field="x")


def test_a_mesh_that_is_not_flat(tmp_path):
    path = tmp_path / "a.vtu"
    bent = np.insert(POINTS, 2, [0, 0, 0.5, 0], axis=1)
    meshio.Mesh(bent, {"triangle": TRIANGLES}, {"h": SIZES}).write(path)
    with pytest.raises(am.AdaptmeshError, match=r"point 2 is \(1.0, 1.0, 0.5\): z is not 0"):
        am.read_metric(path)


@pytest.mark.parametrize(
    ("name", "text", "message"),
    [
        ("a.mesh", MESH.replace("Triangles 2", "Triangles 1"), "expected an? keyword"),
        ("a.mesh", MESH.replace("Triangles 2", "Triangles " + "1" * 5000), "expected a number"),
        ("a.mesh", MESH.replace("Triangles 2", "Triangles inf"), "expected an integer"),
        ("a.mesh", MESH.replace("Triangles 2", "Triangles 1e14"), "expected an integer"),
        ("a.mesh", MESH.replace("1 2 3 0", "1.9 2 3 0"), r"expected an integer, got b'1.9'"),
        ("a.mesh", MESH.replace("1 2 3 0", "1e300 2 3 0"), "expected an integer"),
        ("a.mesh", MESH.replace("1 2 3 0", "nan 2 3 0"), "expected an integer"),
        ("a.sol", sol(SIZES, 1).replace(" 1\n", " 1.5\n", 1), "expected an integer"),
        ("a.sol", sol(SIZES, 1).replace("\nEnd", "\n1 End"), "expected an? keyword"),
        ("a.mtr", "3 1\n0.1 0.2 0.3 0.4", "more than 3 rows"),
        ("a.mtr", "1e300 1\n0.1", "expected an integer"),
    ],
)
def test_counts_that_do_not_fit(folder, name, text, message):
    (folder / "a.sol").write_text(sol(SIZES, 1))
    (folder / name).write_text(text)
    with pytest.raises(am.AdaptmeshError, match=message) as caught:
        am.read_metric(folder / name)
    assert name in str(caught.value)


@pytest.mark.parametrize("name", frames(*irregular_square(7))[1])
def test_a_metric_that_is_read_is_the_same_in_any_frame(name, tmp_path):
    points, triangles = irregular_square(7)
    own, others = frames(points, triangles)
    n, m = len(points), len(triangles)
    values = from_axes(0.02 + points[:, 0], 0.3, points[:, 1])
    inside = points[triangles].mean(axis=1)

    def read(f):
        rows = f.at_vertices(f.metric(values)).tolist()
        head = ["MeshVersionFormatted 2", "Dimension 2"]
        vertices = [f"{x!r} {y!r} 0" for x, y in f.points.tolist()]
        triangles = [f"{a} {b} {c} 0" for a, b, c in (f.triangles + 1).tolist()]
        mesh = [*head, "Vertices", str(n), *vertices, "Triangles", str(m), *triangles, "End"]
        lines = [" ".join(map(repr, row)) for row in rows]
        solution = [*head, "SolAtVertices", str(n), "1 3", *lines, "End"]
        (tmp_path / "a.mesh").write_text("\n".join(mesh))
        (tmp_path / "a.sol").write_text("\n".join(solution))
        return f.old_tensors(am.read_metric(tmp_path / "a.sol")(f.transform(inside)))

    rounding = others[name].transform.rounding
    wanted = read(own)
    error = np.abs(read(others[name]) - wanted).max(axis=1) / np.abs(wanted).max(axis=1)
    assert error.max() < 1e3 * rounding


def test_one_of_several_fields_of_medit(folder):
    (folder / "a.u.sol").write_text(sol(SIZES, 1))
    assert_is(am.read_metric(folder / "a.mesh"), SIZES)
    (folder / "a.v.sol").write_text(sol(2 * SIZES, 1))
    assert_is(am.read_metric(folder / "a.mesh", field="v"), 2 * SIZES)
    with pytest.raises(am.FormatError, match="other fields: 'u', 'v'; choose one"):
        am.read_metric(folder / "a.mesh")
    (folder / "a.sol").write_text(sol(3 * SIZES, 1))
    assert_is(am.read_metric(folder / "a.mesh"), 3 * SIZES)
    assert_is(am.read_metric(folder / "a.mesh", field="metric"), 3 * SIZES)


def test_outside_of_the_mesh(folder):
    (folder / "a.sol").write_text(sol(SIZES, 1))
    assert_is(am.read_metric(folder / "a.sol", outside="clamp"), SIZES)
    with pytest.raises(am.MetricError, match="outside"):
        am.read_metric(folder / "a.sol", outside="error")([[2.0, 2.0]])
