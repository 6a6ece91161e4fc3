"""Our files in the programs that they are for, and theirs here."""

import contextlib

import numpy as np
import pytest

import metrics
from adaptmesh import io
from adaptmesh.errors import FormatError
from adaptmesh.mesh.mesh import Mesh

NAMES = {"in let": 3, "Größe": 5}


def a_mesh(zero=0):
    """A 5 x 5 grid in two regions, border and interface constrained; `zero` tags the rest."""
    n = 5
    x, y = np.meshgrid(np.arange(n), np.arange(n))
    points = np.stack([x.ravel(), y.ravel()], axis=1) / 3
    low = (np.arange(n - 1)[:, None] * n + np.arange(n - 1)).ravel()
    triangles = np.stack([low, low + 1, low + n + 1, low, low + n + 1, low + n], axis=1)
    triangles = triangles.reshape(-1, 3)[::-1]  # in no order that a program would choose
    i = np.arange(n - 1)
    rest = [(i + n * (n - 1), zero), (i * n, zero)]
    sides = [(i, 3), (i * n + n - 1, 5), *rest, (i * n + 2, 8)]
    edges = [[a, a + step] for (b, _), step in zip(sides, (1, n, 1, n, n), strict=True) for a in b]
    tags = [tag for b, tag in sides for _ in b]
    regions = np.where(points[triangles].mean(axis=1)[:, 0] < 2 / 3, 1, 2)
    return Mesh(points, triangles, regions, edges, tags, NAMES, {"left": 1, "right": 2})


def placed(cells, tags, points):
    """Each cell as the set of its corners to 12 digits, and its tag."""
    corners = np.round(points[cells], 12).tolist()
    return {(frozenset(map(tuple, c)), int(t)) for c, t in zip(corners, tags, strict=True)}


def assert_same_up_to_order(first, second):
    """The same triangles and edges, whatever their numbers and those of the points."""
    assert len(first.points) == len(second.points)
    for cells, tags in (("triangles", "regions"), ("edges", "edge_tags")):
        one, two = (placed(getattr(m, cells), getattr(m, tags), m.points) for m in (first, second))
        assert one == two


# ------------------------------------------------------------------------------- DOLFINx and XDMF

BY_DOLFINX = """
import sys
from mpi4py import MPI
from dolfinx.io import XDMFFile

with XDMFFile(MPI.COMM_SELF, sys.argv[1], "r") as file:
    mesh = file.read_mesh(name="mesh")
    cells = file.read_meshtags(mesh, name="cell_tags")
    mesh.topology.create_connectivity(1, 2)
    facets = file.read_meshtags(mesh, name="facet_tags")
with XDMFFile(MPI.COMM_SELF, sys.argv[2], "w") as file:
    file.write_mesh(mesh)
    file.write_meshtags(cells)
    file.write_meshtags(facets)
"""


@pytest.mark.slow
def test_dolfinx_reads_and_writes_xdmf(tmp_path, python_with_dolfinx):
    mesh = a_mesh()
    ours, theirs = tmp_path / "ours.xdmf", tmp_path / "theirs.xdmf"
    io.write(ours, mesh)
    done = python_with_dolfinx("-c", BY_DOLFINX, ours, theirs)
    assert done.returncode == 0, done.stderr
    assert_same_up_to_order(io.read(theirs), mesh)


def test_meshio_writes_xdmf(tmp_path):
    meshio, mesh = pytest.importorskip("meshio"), a_mesh()
    cells = [("triangle", mesh.triangles), ("line", mesh.edges)]
    for k in (1, 2):  # one kind of cell, and two
        tags = [mesh.regions, mesh.edge_tags][:k]
        path = tmp_path / f"{k}.xdmf"
        meshio.Mesh(mesh.points, cells[:k], {"u": mesh.points[:, 0]}, {"cell_tags": tags}).write(
            path
        )
        read = io.read(path)
        np.testing.assert_array_equal(read.triangles, mesh.triangles)
        np.testing.assert_array_equal(read.regions, mesh.regions)
        np.testing.assert_array_equal(read.edges, mesh.edges[: len(read.edges)])
        np.testing.assert_array_equal(io.read_fields(path)["u"], mesh.points[:, 0])


def test_inline_numbers_and_time_series(tmp_path):
    path = tmp_path / "a.xdmf"
    grid = """<Grid Name="g" GridType="Uniform"><Topology TopologyType="Triangle">
        <DataItem Dimensions="1 3" NumberType="Int" Format="XML">0 1 2</DataItem></Topology>
        <Geometry GeometryType="XY"><DataItem Dimensions="3 2" Format="XML">0 0 1 0 0 1</DataItem>
        </Geometry></Grid>"""
    path.write_text(f"<Xdmf><Domain>{grid}</Domain></Xdmf>")
    assert io.read(path).points.tolist() == [[0, 0], [1, 0], [0, 1]]
    series = f'<Grid GridType="Collection" CollectionType="Temporal">{grid}</Grid>'
    path.write_text(f"<Xdmf><Domain>{series}</Domain></Xdmf>")
    with pytest.raises(FormatError, match="Temporal"):
        io.read(path)
    outside = grid.replace(">0 1 2<", ">../b.h5:/x<").replace("XML", "HDF", 1)
    path.write_text(f"<Xdmf><Domain>{outside}</Domain></Xdmf>")
    with pytest.raises(FormatError, match="not to a file beside it"):
        io.read(path)


# ------------------------------------------------------------------------------------------- Gmsh


@pytest.fixture
def gmsh():
    module = pytest.importorskip("gmsh", exc_type=ImportError)
    module.initialize(interruptible=False)
    module.option.setNumber("General.Terminal", 0)
    yield module
    module.finalize()


@pytest.mark.parametrize("version", ["4.1", "2.2"])
@pytest.mark.parametrize("binary", [True, False])
def test_gmsh_opens_names_elements_and_views(tmp_path, gmsh, version, binary):
    mesh = a_mesh()
    u, q = mesh.points[:, 0] ** 2, np.arange(32.0)
    metric = np.tile([4.0, 1.0, 9.0], (25, 1))
    path = str(tmp_path / "a.msh")
    io.write(path, mesh, u=u, v=mesh.points, q=q, metric=metric, version=version, binary=binary)
    gmsh.open(path)

    tags, coordinates, _ = gmsh.model.mesh.getNodes()
    np.testing.assert_array_equal(coordinates.reshape(-1, 3)[np.argsort(tags), :2], mesh.points)
    groups = {
        (dim, tag, gmsh.model.getPhysicalName(dim, tag)): sum(
            len(gmsh.model.mesh.getElements(dim, e)[1][0])
            for e in gmsh.model.getEntitiesForPhysicalGroup(dim, tag)
        )
        for dim, tag in gmsh.model.getPhysicalGroups()
    }
    assert groups == {
        (1, 3, "in let"): 4, (1, 5, "Größe"): 4, (1, 8, ""): 4,
        (2, 1, "left"): 16, (2, 2, "right"): 16,
    }  # fmt: skip
    views = {gmsh.view.option.getString(t, "Name"): t for t in gmsh.view.getTags()}
    assert views.keys() == {"u", "v", "q", "metric"}
    kind, at, values, *_ = gmsh.view.getModelData(views["u"], 0)
    assert kind == "NodeData"
    np.testing.assert_array_equal(np.ravel(values)[np.argsort(at)], u)
    kind, at, values, *_ = gmsh.view.getModelData(views["q"], 0)
    assert kind == "ElementData"
    by_element = dict(zip(at.tolist(), np.ravel(values), strict=True))
    for element, value in by_element.items():
        _, nodes, _, _ = gmsh.model.mesh.getElement(element)
        assert sorted(nodes - 1) == sorted(mesh.triangles[int(value)])
    assert len(gmsh.view.getModelData(views["metric"], 0)[2][0]) == 9


@pytest.mark.parametrize("version", [4.1, 2.2])
@pytest.mark.parametrize("binary", [1, 0])
def test_what_gmsh_saves_is_read(tmp_path, gmsh, version, binary):
    io.write(tmp_path / "a.msh", a_mesh())
    gmsh.open(str(tmp_path / "a.msh"))
    gmsh.option.setNumber("Mesh.MshFileVersion", version)
    gmsh.option.setNumber("Mesh.Binary", binary)
    # without SaveAll edges of no group would be left out, with it 2.2 would lose the groups
    gmsh.option.setNumber("Mesh.SaveAll", int(version > 4))
    gmsh.write(str(tmp_path / "b.msh"))
    back = io.read(tmp_path / "b.msh")
    expected = a_mesh()
    if version < 4:
        kept = expected.edge_tags > 0
        expected = Mesh(
            expected.points, expected.triangles, expected.regions,
            expected.edges[kept], expected.edge_tags[kept],
        )  # fmt: skip
    assert_same_up_to_order(back, expected)
    assert dict(back.names) == NAMES
    assert dict(back.region_names) == {"left": 1, "right": 2}


def test_a_mesh_of_gmsh_is_read(tmp_path, gmsh):
    disk = gmsh.model.occ.addDisk(0, 0, 0, 1, 1)
    gmsh.model.occ.synchronize()
    gmsh.model.addPhysicalGroup(2, [disk], 4, "disk")
    gmsh.model.addPhysicalGroup(1, [1], 9, "rim")
    gmsh.model.mesh.generate(2)
    for binary in (0, 1):
        gmsh.option.setNumber("Mesh.Binary", binary)
        gmsh.write(str(tmp_path / "disk.msh"))
        mesh = io.read(tmp_path / "disk.msh")
        assert mesh.areas.sum() == pytest.approx(np.pi, rel=0.02)
        assert set(mesh.regions) == {4}
        radius = np.hypot(*mesh.points[mesh.edges_named("rim")].reshape(-1, 2).T)
        np.testing.assert_allclose(radius, 1)


# ------------------------------------------------------------------------------------------ Medit


@pytest.mark.parametrize("suffix", ["", "b"])
def test_mmg_reads_mesh_and_metric(tmp_path, suffix):
    mmgpy = pytest.importorskip("mmgpy")
    mesh = a_mesh()
    metric = np.random.default_rng(0).random((25, 3)) / 7 + [1, 0, 1]
    io.write(tmp_path / f"a.mesh{suffix}", mesh, metric=metric)
    theirs = mmgpy.MmgMesh2D(str(tmp_path / f"a.mesh{suffix}"))
    np.testing.assert_array_equal(theirs.get_vertices(), mesh.points)
    triangles, regions = theirs.get_triangles_with_refs()
    np.testing.assert_array_equal(triangles, mesh.triangles)
    np.testing.assert_array_equal(regions, mesh.regions)
    edges, tags = theirs.get_edges_with_refs()
    np.testing.assert_array_equal(edges, mesh.edges)
    np.testing.assert_array_equal(tags, mesh.edge_tags)
    theirs.load_sol(str(tmp_path / f"a.sol{suffix}"))
    np.testing.assert_array_equal(theirs.get_field("tensor"), metric)

    theirs.save(str(tmp_path / f"b.mesh{suffix}"))
    back = io.read(tmp_path / f"b.mesh{suffix}")
    assert_same_up_to_order(back, mesh)


def test_solutions_of_mmg_are_read(tmp_path):
    # text only: of tensors Mmg puts line breaks between the bytes of a .solb
    mmgpy = pytest.importorskip("mmgpy")
    metric = np.random.default_rng(0).random((25, 3)) / 7 + [1, 0, 1]
    io.write(tmp_path / "a.mesh", a_mesh(), metric=metric)
    theirs = mmgpy.MmgMesh2D(str(tmp_path / "a.mesh"))
    theirs.load_sol(str(tmp_path / "a.sol"))
    theirs.save_sol(str(tmp_path / "b.sol"))
    np.testing.assert_allclose(io.read_sol(tmp_path / "b.sol"), metric, rtol=1e-14)


# -------------------------------------------------------------------------------------------- VTK


@pytest.mark.parametrize(
    ("name", "options"), [("a.vtu", {}), ("a.vtk", {}), ("a.vtk", {"binary": False})]
)
def test_pyvista_shows_everything(tmp_path, name, options):
    pyvista = pytest.importorskip("pyvista")
    mesh = a_mesh()
    metric = metrics.tensor.pack(np.tile([4.0, 1.0, 9.0], (25, 1)))
    fields = {"v": mesh.points, "q": np.arange(32.0), "with blank": np.arange(25)}
    io.write(tmp_path / name, mesh, metric=metric, **fields, **options)
    grid = pyvista.read(tmp_path / name)
    np.testing.assert_array_equal(grid.points[:, :2], mesh.points)
    np.testing.assert_array_equal(grid.cells_dict[5], mesh.triangles)
    np.testing.assert_array_equal(grid.cells_dict[3], mesh.edges)
    np.testing.assert_array_equal(grid["regions"], [*mesh.regions, *[0] * 20])
    np.testing.assert_array_equal(grid["edge_tags"], [*[0] * 32, *mesh.edge_tags])
    np.testing.assert_array_equal(grid["v"][:, :2], mesh.points)
    assert grid["v"].shape == (25, 3)
    np.testing.assert_array_equal(grid["with blank"], np.arange(25))
    assert grid["metric"][0].reshape(3, 3).tolist() == [[4, 1, 0], [1, 9, 0], [0, 0, 0]]
    assert grid.field_data["edge_tags: in let"].tolist() == [3]
    assert grid.field_data["regions: right"].tolist() == [2]


@pytest.mark.parametrize("mode", ["Ascii", "Binary", "Appended"])
@pytest.mark.parametrize("compressor", ["NONE", "ZLIB", "LZMA"])
def test_what_vtk_saves_is_read(tmp_path, mode, compressor):
    pyvista = pytest.importorskip("pyvista")
    vtk = pytest.importorskip("vtkmodules.vtkIOXML")
    mesh = Mesh(
        *[getattr(a_mesh(), f) for f in ("points", "triangles", "regions", "edges", "edge_tags")],
        names={'"a" & <b> 50 %': 3},
        region_names={"left": 1},
    )
    metric = np.random.default_rng(0).random((25, 3)) / 7 + [1, 0, 1]
    fields = {"u": np.full(25, np.nan), "v": mesh.points, "q": np.arange(32)}
    io.write(tmp_path / "a.vtu", mesh, metric=metric, **fields)
    grid = pyvista.read(tmp_path / "a.vtu")
    for raw, header, order in ((0, 32, 0), (1, 64, 1)):
        writer = vtk.vtkXMLUnstructuredGridWriter()
        writer.SetInputData(grid)
        writer.SetFileName(str(tmp_path / "b.vtu"))
        getattr(writer, f"SetDataModeTo{mode}")()
        writer.SetCompressorType(getattr(writer, compressor))
        writer.SetEncodeAppendedData(1 - raw)
        writer.SetHeaderType(header)
        writer.SetByteOrder(order)
        writer.SetBlockSize(256)
        writer.Write()
        back = io.read(tmp_path / "b.vtu")
        for part in ("points", "triangles", "regions", "edges", "edge_tags"):
            np.testing.assert_array_equal(getattr(back, part), getattr(mesh, part))
        assert dict(back.names) == dict(mesh.names)
        for name, values in io.read_fields(tmp_path / "b.vtu").items():
            np.testing.assert_array_equal(values, {**fields, "metric": metric}[name])


@pytest.mark.parametrize("binary", [True, False])
@pytest.mark.parametrize("version", [42, 51])
def test_legacy_files_of_vtk_are_read(tmp_path, version, binary):
    pyvista = pytest.importorskip("pyvista")
    vtk = pytest.importorskip("vtkmodules.vtkIOLegacy")
    mesh = Mesh(
        *[getattr(a_mesh(), f) for f in ("points", "triangles", "regions", "edges", "edge_tags")],
        names={'"a" & <b> 50 %': 3, "Größe": 5},
        region_names={"left": 1},
    )
    metric = np.random.default_rng(0).random((25, 3)) / 7 + [1, 0, 1]
    fields = {"u": np.arange(25) / 8, "v": mesh.points, "q": np.arange(32), "one two": mesh.points}
    io.write(tmp_path / "a.vtu", mesh, metric=metric, **fields)
    grid = pyvista.read(tmp_path / "a.vtu")
    grid.field_data["words"] = ["one", "two words\nin two lines" * 9]
    grid.point_data.active_scalars_name = "u"  # SCALARS, VECTORS and TENSORS, the rest in a FIELD
    grid.point_data.active_vectors_name = "v"
    grid.GetPointData().SetActiveTensors("metric")
    writer = vtk.vtkUnstructuredGridWriter()
    writer.SetInputData(grid)
    writer.SetFileName(str(tmp_path / "b.vtk"))
    writer.SetFileVersion(version)
    (writer.SetFileTypeToBinary if binary else writer.SetFileTypeToASCII)()
    writer.Write()
    back = io.read(tmp_path / "b.vtk")
    digits = 0 if binary else 1e-10  # what VTK writes in text
    np.testing.assert_allclose(back.points, mesh.points, rtol=0, atol=digits)
    for part in ("triangles", "regions", "edges", "edge_tags"):
        np.testing.assert_array_equal(getattr(back, part), getattr(mesh, part))
    assert dict(back.names) == dict(mesh.names)
    assert dict(back.region_names) == dict(mesh.region_names)
    found = io.read_fields(tmp_path / "b.vtk")
    assert found.keys() == {*fields, "metric"}
    for name, values in found.items():
        np.testing.assert_allclose(values, {**fields, "metric": metric}[name], atol=digits)


def test_polygons_of_vtk_are_read(tmp_path):
    pyvista = pytest.importorskip("pyvista")
    surface = pyvista.PolyData(
        np.array([[0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0.0]]),
        faces=[3, 0, 1, 2, 3, 0, 2, 3],
        lines=[2, 0, 1, 2, 1, 2],
    )
    surface.cell_data["edge_tags"] = np.array([7, 8, 0, 0])
    for binary in (True, False):
        surface.save(tmp_path / "a.vtk", binary=binary)
        mesh = io.read(tmp_path / "a.vtk")
        assert mesh.triangles.tolist() == [[0, 1, 2], [0, 2, 3]]
        assert mesh.edges.tolist() == [[0, 1], [1, 2]]
        assert mesh.edge_tags.tolist() == [7, 8]


# ----------------------------------------------------------------------------------------- meshio

MESHIO = {
    "vtu": ("a.vtu", {}),
    "vtk": ("a.vtk", {}),
    "vtk text": ("a.vtk", {"binary": False}),
    "msh41": ("a.msh", {}),
    "msh41 text": ("a.msh", {"binary": False}),
    "msh22": ("a.msh", {"version": "2.2"}),
    "mesh": ("a.mesh", {}),
}


@pytest.mark.parametrize("way", MESHIO)
def test_meshio_reads_our_meshes(tmp_path, way):
    # where it can: it wants a physical group for each edge of a 4.1 file or for none, and stops
    # at the keyword ReferenceStrings of a .meshb with names
    meshio = pytest.importorskip("meshio")
    name, options = MESHIO[way]
    mesh = a_mesh(zero=1)
    io.write(tmp_path / name, mesh, **options)
    theirs = meshio.read(tmp_path / name)
    points = {tuple(p) for p in theirs.points[:, :2].tolist()}
    assert points == {tuple(p) for p in mesh.points.tolist()}
    corners = {
        tuple(sorted(map(tuple, theirs.points[t, :2].tolist())))
        for block in theirs.cells
        if block.type == "triangle"
        for t in block.data
    }
    assert corners == {tuple(sorted(map(tuple, t))) for t in mesh.points[mesh.triangles].tolist()}
    if name == "a.msh":
        assert theirs.field_data["in let"].tolist() == [3, 1]
        assert theirs.field_data["right"].tolist() == [2, 2]


@pytest.mark.parametrize("options", [{}, {"binary": False}, {"version": "2.2"}])
def test_meshio_never_mistakes_our_fields(tmp_path, capsys, options):
    # it takes values in the order of the file, whatever tags they bear; where our order of the
    # nodes is not that of the tags, it reads the text and gives up on the bytes
    meshio = pytest.importorskip("meshio")
    mesh = a_mesh(zero=1)
    io.write(tmp_path / "a.msh", mesh, u=mesh.points[:, 0] + 100 * mesh.points[:, 1], **options)
    with contextlib.suppress(SystemExit):
        theirs = meshio.read(tmp_path / "a.msh")
        x, y, _ = theirs.points.T
        np.testing.assert_allclose(theirs.point_data["u"], x + 100 * y)


@pytest.mark.parametrize("name", ["b.vtu", "b.vtk", "b.mesh", "b.meshb", "b.msh"])
def test_what_meshio_writes_is_read(tmp_path, name):
    meshio = pytest.importorskip("meshio")
    mesh = a_mesh()
    cells = [("triangle", mesh.triangles), ("line", mesh.edges)]
    refs = [mesh.regions, mesh.edge_tags]
    data = {"b.msh": {"gmsh:physical": refs, "gmsh:geometrical": refs}, "b.vtu": {}, "b.vtk": {}}
    u = np.random.default_rng(0).random(25)
    # the points are given with z, for meshio warns if it has to add it
    points = mesh.points if "mesh" in name else np.column_stack([mesh.points, np.zeros(25)])
    point_data = {} if "mesh" in name else {"u": u}
    theirs = meshio.Mesh(points, cells, point_data, data.get(name, {"medit:ref": refs}))
    options = {"file_format": "gmsh22"} if name == "b.msh" else {}
    theirs.write(tmp_path / name, **options)
    back = io.read(tmp_path / name)
    for part in ("points", "triangles", "edges"):
        np.testing.assert_array_equal(getattr(back, part), getattr(mesh, part))
    if name not in ("b.vtu", "b.vtk"):
        np.testing.assert_array_equal(back.regions, mesh.regions)
        np.testing.assert_array_equal(back.edge_tags, mesh.edge_tags)
    if point_data:
        np.testing.assert_array_equal(io.read_fields(tmp_path / name)["u"], u)


# --------------------------------------------------------------------------------------- Triangle


def test_triangle_reads_our_mesh(tmp_path):
    triangle, mesh = pytest.importorskip("triangle"), a_mesh()
    path = tmp_path / "a.ele"
    io.write(path, mesh, u=mesh.points[:, 0])
    texts = {end: path.with_suffix(f".{end}").read_text() for end in ("node", "ele", "poly")}
    read = triangle.loads(**texts)
    np.testing.assert_array_equal(read["vertices"], mesh.points)
    np.testing.assert_array_equal(read["triangles"], mesh.triangles)
    np.testing.assert_array_equal(read["triangle_attributes"][:, 0], mesh.regions)
    np.testing.assert_array_equal(read["vertex_attributes"][:, 0], mesh.points[:, 0])
    np.testing.assert_array_equal(read["segments"], mesh.edges)
    np.testing.assert_array_equal(read["segment_markers"][:, 0], mesh.edge_tags)


def test_files_by_triangle(tmp_path):
    """As Triangle writes them: numbers from 1, attributes without names, its own comments."""
    path = tmp_path / "a.ele"
    path.with_suffix(".node").write_text(
        "4  2  1  1\n   1    0  0    1.5   1\n   2    1  0    2.5   1\n   3    1  1    3.5   1\n"
        "   4    0  1    4.5   0\n# Generated by triangle -pqA a\n"
    )
    path.write_text("2  3  1\n 1   1 2 3   5\n 2   1 3 4   6\n# Generated by triangle -pqA a\n")
    path.with_suffix(".poly").write_text("0 2 1 1\n1 1\n 1   1 2  9\n0\n")
    read = io.read(path)
    assert read.triangles.tolist() == [[0, 1, 2], [0, 2, 3]]
    assert read.regions.tolist() == [5, 6]
    assert (read.edges.tolist(), read.edge_tags.tolist()) == ([[0, 1]], [9])
    assert io.read_fields(path)["attribute_0"].tolist() == [1.5, 2.5, 3.5, 4.5]
    path.with_suffix(".poly").unlink()
    assert len(io.read(path).edges) == 0
