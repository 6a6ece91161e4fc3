"""Files of other programs and versions: what is read of them, and the words where it is not all."""

import contextlib
import re
import warnings

import numpy as np
import pytest
import shapely
from reference.transforms import TRANSFORMS

import adaptmesh as am
from adaptmesh import io
from adaptmesh.errors import FormatError, FormatWarning

# a square of two triangles, in two regions, its bottom in the group 7, its right side in 8
POINTS = np.array([[0, 0], [1, 0], [1, 1], [0, 1]], float)
TRIANGLES = [[0, 1, 2], [0, 2, 3]]

MSH = {
    "1": "$NOD\n4\n11 0 0 0\n12 1 0 0\n13 1 1 0\n14 0 1 0\n$ENDNOD\n"
    "$ELM\n5\n1 15 0 1 1 11\n2 1 7 1 2 11 12\n3 1 8 2 2 12 13\n4 2 3 1 3 11 12 13\n"
    "5 2 4 1 3 11 13 14\n$ENDELM\n",
    "2.0": '$MeshFormat\n2 0 8\n$EndMeshFormat\n$PhysicalNames\n1\n7 "in"\n$EndPhysicalNames\n'
    "$Nodes\n4\n1 0 0 0\n2 1 0 0\n3 1 1 0\n4 0 1 0\n$EndNodes\n"
    "$Elements\n4\n1 1 2 7 1 1 2\n2 1 3 8 1 0 2 3\n3 2 3 3 1 0 1 2 3\n4 2 2 4 1 1 3 4\n"
    "$EndElements\n",
    "3": '$MeshFormat\n3 0 8\n$EndMeshFormat\n$PhysicalNames\n1\n1 7 "in"\n$EndPhysicalNames\n'
    "$Entities\n1 2 2 0\n1 0\n1 2 1 2 1 7\n2 0 1 8\n1 1 1 1 3\n2 0 1 4\n$EndEntities\n"
    "$Nodes\n4\n1 0 0 0 0\n2 1 0 0 1 1 0.5\n3 1 1 0 0\n4 0 1 0 0\n$EndNodes\n"
    "$Elements\n4\n1 1 1 2 1 2\n2 1 2 2 2 3\n3 2 1 3 1 2 3\n4 2 2 3 1 3 4\n$EndElements\n",
    "4.0": '$MeshFormat\n4 0 8\n$EndMeshFormat\n$PhysicalNames\n1\n1 7 "in"\n$EndPhysicalNames\n'
    "$Entities\n1 2 2 0\n1 0 0 0 0 0 0 0\n1 0 0 0 1 0 0 1 7 2 1 -2\n2 1 0 0 1 1 0 1 8 0\n"
    "1 0 0 0 1 1 0 1 3 0\n2 0 0 0 1 1 0 1 4 0\n$EndEntities\n"
    "$Nodes\n2 4\n1 0 0 1\n1 0 0 0\n1 2 0 3\n2 1 0 0\n3 1 1 0\n4 0 1 0\n$EndNodes\n"
    "$Elements\n4 4\n1 1 1 1\n1 1 2\n2 1 1 1\n2 2 3\n1 2 2 1\n3 1 2 3\n2 2 2 1\n4 1 3 4\n"
    "$EndElements\n",
    "FreeFEM": "4 2 2\n0 0 1\n1 0 1\n1 1 2\n0 1 2\n1 2 3 3\n1 3 4 4\n1 2 7\n2 3 8\n",
    "JIGSAW": "# by JIGSAW\nMSHID=3;EUCLIDEAN-MESH\nNDIMS=2\nPOINT=4\n0;0;0\n1;0;0\n1;1;0\n0;1;0\n"
    "EDGE2=2\n0;1;7\n1;2;8\nTRIA3=2\n0;1;2;3\n0;2;3;4\nVALUE=4;1\n1\n2\n3\n4\nBOUND=1\n1;0;1\n",
}


def written(folder, text, name="in.msh"):
    path = folder / name
    path.write_bytes(text if isinstance(text, bytes) else text.encode())
    return path


def assert_square(mesh):
    np.testing.assert_array_equal(mesh.points, POINTS)
    np.testing.assert_array_equal(mesh.triangles, TRIANGLES)


@pytest.mark.parametrize("version", MSH)
def test_every_msh(tmp_path, version):
    path = written(tmp_path, MSH[version])
    mesh = io.read(path)
    assert_square(mesh)
    assert mesh.regions.tolist() == [3, 4]
    assert mesh.edges.tolist() == [[0, 1], [1, 2]]
    assert mesh.edge_tags.tolist() == [7, 8]
    assert mesh.names.get("in", 7) == 7
    if version == "JIGSAW":
        assert io.read_fields(path)["value"].tolist() == [1, 2, 3, 4]


@pytest.mark.parametrize("version", MSH)
def test_no_edge_is_lost_when_lines_of_a_msh_are(tmp_path, version):
    lines = MSH[version].splitlines(keepends=True)
    for k in range(len(lines)):
        path = written(tmp_path, "".join(lines[:k] + lines[k + 1 :]))
        with contextlib.suppress(FormatError):
            mesh = io.read(path)
            assert len(mesh.edges) == 2, (version, lines[k])


@pytest.mark.parametrize("version", [1, 2.2, 3, 4, 4.1])
@pytest.mark.parametrize("binary", [0, 1])
def test_what_gmsh_writes_in_every_version(tmp_path, version, binary):
    gmsh = pytest.importorskip("gmsh", exc_type=ImportError)
    if binary and version in (1, 3, 4):
        pytest.skip("Gmsh writes it in text only, or it is not read")
    gmsh.initialize(["gmsh"], readConfigFiles=False, interruptible=False)
    try:
        gmsh.option.setNumber("General.Terminal", 0)
        gmsh.model.occ.addRectangle(0, 0, 0, 2, 1)
        gmsh.model.occ.synchronize()
        for group, curves in ((17, [1, 2]), (18, [3])):
            gmsh.model.addPhysicalGroup(1, curves, group)
        gmsh.model.addPhysicalGroup(2, [1], 5)
        gmsh.model.mesh.generate(2)
        gmsh.option.setNumber("Mesh.MshFileVersion", version)
        gmsh.option.setNumber("Mesh.Binary", binary)
        gmsh.write(str(tmp_path / "a.msh"))
    finally:
        gmsh.finalize()
    mesh = io.read(tmp_path / "a.msh")
    assert mesh.areas.sum() == pytest.approx(2)
    assert set(mesh.regions.tolist()) == {5}
    lengths = np.hypot(*np.diff(mesh.points[mesh.edges], axis=1)[:, 0].T)
    found = {tag: lengths[mesh.edge_tags == tag].sum() for tag in set(mesh.edge_tags.tolist())}
    assert found == {17: pytest.approx(3), 18: pytest.approx(2)}


def test_an_edge_in_two_groups(tmp_path):
    text = (
        '$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$PhysicalNames\n1\n1 7 "in"\n$EndPhysicalNames\n'
        "$Nodes\n3\n1 0 0 0\n2 1 0 0\n3 0 1 0\n$EndNodes\n"
        "$Elements\n4\n1 1 2 7 1 1 2\n2 1 2 8 1 2 1\n3 1 2 8 2 2 3\n4 2 2 0 1 1 2 3\n$EndElements\n"
    )
    with pytest.warns(FormatWarning, match=r"edges that are in several .*'in\|8' \(9\)"):
        mesh = io.read(written(tmp_path, text))
    assert mesh.edges.tolist() == [[0, 1], [1, 2]]
    assert mesh.edge_tags.tolist() == [9, 8]


@pytest.mark.parametrize(
    ("text", "says"),
    [
        ("$NOD\n1\n1 0 0 0\n", r"\$NOD has no \$ENDNOD"),
        (MSH["1"].replace("2 1 7 1 2 11", "2 1 7 1 3 11"), "element 2 of type 1 has 3 nodes"),
        ("$MeshFormat\n3 1 8\n\1\0\0\0\n$EndMeshFormat\n$Entities\n1\n$EndEntities\n", "convert"),
        (MSH["FreeFEM"] + "1 2 3\n", "holds more than 4 vertices"),
        (MSH["FreeFEM"][:-6], "cut short"),
        (MSH["FreeFEM"].replace("1 2 3 3", "1 2 9 3"), "triangle 0 has vertices"),
        (MSH["JIGSAW"].replace("NDIMS=2", "NDIMS=3"), "3 dimensions; only plane"),
        (MSH["JIGSAW"].replace("EUCLIDEAN-MESH", "EUCLIDEAN-GRID"), "only a EUCLIDEAN-MESH"),
        (MSH["JIGSAW"].replace("POINT=4", "POINT=5"), "POINT: 5 rows are announced, 4 are"),
        (MSH["JIGSAW"].replace("TRIA3=2", "TRIA3=x"), "TRIA3: expected a count"),
        (MSH["JIGSAW"].replace("0;1;2;3", "0;1;2"), "TRIA3: row 0 has not 4 numbers"),
        (MSH["JIGSAW"] + "QUAD4=1\n0;1;2;3;0\n", "quadrilaterals; only triangles"),
        ("(0 grid written by Fluent)", "of another program"),
    ],
)
def test_msh_that_cannot_be_read(tmp_path, text, says):
    with pytest.raises(FormatError, match=says):
        io.read(written(tmp_path, text))


def test_negative_references(tmp_path):
    text = MSH["FreeFEM"].replace("1 2 7", "1 2 -7").replace("1 2 3 3", "1 2 3 -3")
    mesh = io.read(written(tmp_path, text))
    assert mesh.edge_tags.tolist() == [-7, 8]
    assert mesh.regions.tolist() == [-3, 4]
    assert mesh.validate()["tags"].ok
    for suffix in (".mesh", ".meshb", ".vtu", ".vtk", ".xdmf", ".ele"):
        io.write(tmp_path / f"out{suffix}", mesh)
        again = io.read(tmp_path / f"out{suffix}")
        assert again.edge_tags.tolist() == [-7, 8]
        assert again.regions.tolist() == [-3, 4]


# ----------------------------------------------------------------------------------- second order

MIDDLES = [[0.5, -0.1], [1, 0.5], [0.5, 0.5], [0.5, 1], [0, 0.5]]  # the first side is curved
NODES = np.concatenate([POINTS, MIDDLES])
CURVED = [[0, 1, 2, 4, 5, 6], [0, 2, 3, 6, 7, 8]]


def rows(*table):
    return "\n".join(" ".join(map(str, row)) for row in table) + "\n"


def gmsh_of_second_order(folder, version):
    n = [[k + 1, *p, 0] for k, p in enumerate(NODES.tolist())]
    t = [[v + 1 for v in cell] for cell in CURVED]
    if version == "2.2":
        cells = [[1, 8, 2, 7, 1, 1, 2, 5], [2, 9, 2, 3, 1, *t[0]], [3, 9, 2, 3, 1, *t[1]]]
        body = f"$Nodes\n9\n{rows(*n)}$EndNodes\n$Elements\n3\n{rows(*cells)}$EndElements\n"
        return written(folder, f"$MeshFormat\n2.2 0 8\n$EndMeshFormat\n{body}")
    nodes = rows([1, 9, 1, 9], [2, 1, 0, 9], *[[r[0]] for r in n], *[r[1:] for r in n])
    cells = rows([2, 3, 1, 3], [1, 1, 8, 1], [1, 1, 2, 5], [2, 1, 9, 2], [2, *t[0]], [3, *t[1]])
    entities = "0 1 1 0\n1 0 0 0 1 0 0 1 7 0\n1 0 0 0 1 1 0 1 3 0\n"
    return written(
        folder,
        f"$MeshFormat\n4.1 0 8\n$EndMeshFormat\n$Entities\n{entities}$EndEntities\n"
        f"$Nodes\n{nodes}$EndNodes\n$Elements\n{cells}$EndElements\n",
    )


def vtu_of_second_order(folder, name="a.vtu"):
    pyvista = pytest.importorskip("pyvista")
    cells = np.concatenate([[6, *CURVED[0], 6, *CURVED[1], 3, 0, 1, 4]])
    spatial = np.column_stack([NODES, np.zeros(9)])
    grid = pyvista.UnstructuredGrid(cells, np.array([22, 22, 21], np.uint8), spatial)
    grid.cell_data["regions"] = np.array([3, 3, 0])
    grid.cell_data["edge_tags"] = np.array([0, 0, 7])
    grid.point_data["u"] = NODES[:, 0]
    grid.save(folder / name)
    return folder / name


def medit_of_second_order(folder):
    text = "MeshVersionFormatted 2\nDimension 2\nVertices\n9\n"
    text += rows(*([*p, 0] for p in NODES.tolist()))
    text += "EdgesP2\n1\n1 2 5 7\nTrianglesP2\n2\n"
    text += rows(*([*(v + 1 for v in cell), 3] for cell in CURVED)) + "Corners\n2\n5\n3\nEnd\n"
    io.write_sol(folder / "a.u.sol", NODES[:, 0])
    return written(folder, text, "a.mesh")


def xdmf_of_second_order(folder):
    def item(values):
        kind = "Int" if values.dtype.kind == "i" else "Float"
        shape = " ".join(map(str, values.shape))
        numbers = " ".join(map(repr, values.ravel().tolist()))
        return f'<DataItem Dimensions="{shape}" NumberType="{kind}">{numbers}</DataItem>'

    cells, u, edge = np.array(CURVED), NODES[:, 0], np.array([[0, 1, 4]])
    text = f"""<Xdmf Version="3.0"><Domain><Grid Name="mesh">
<Topology TopologyType="Triangle_6" NodesPerElement="6">{item(cells)}</Topology>
<Geometry GeometryType="XY">{item(NODES)}</Geometry>
<Attribute Name="u" Center="Node">{item(u)}</Attribute>
<Attribute Name="cell_tags" Center="Cell">{item(np.array([3, 3]))}</Attribute></Grid>
<Grid Name="facet_tags">
<Topology TopologyType="PolyLine" NodesPerElement="3">{item(edge)}</Topology>
<Attribute Name="facet_tags" Center="Cell">{item(np.array([7]))}</Attribute></Grid>
</Domain></Xdmf>"""
    return written(folder, text, "a.xdmf")


def triangle_of_second_order(folder):
    written(
        folder, "9 2 1 0\n" + rows(*([k, *p, p[0]] for k, p in enumerate(NODES.tolist()))), "a.node"
    )
    written(folder, "0 2 0 0\n1 1\n0 0 1 7\n0\n", "a.poly")
    return written(
        folder, "2 6 1\n" + rows(*([k, *cell, 3] for k, cell in enumerate(CURVED))), "a.ele"
    )


SECOND_ORDER = {
    "Gmsh 2.2": lambda folder: gmsh_of_second_order(folder, "2.2"),
    "Gmsh 4.1": lambda folder: gmsh_of_second_order(folder, "4.1"),
    ".vtu": vtu_of_second_order,
    ".vtk": lambda folder: vtu_of_second_order(folder, "a.vtk"),
    "Medit": medit_of_second_order,
    "XDMF": xdmf_of_second_order,
    "Triangle": triangle_of_second_order,
}


@pytest.mark.parametrize("kind", SECOND_ORDER)
def test_second_order_is_read_as_its_corners_with_a_word(tmp_path, kind):
    path = SECOND_ORDER[kind](tmp_path)
    with pytest.warns(FormatWarning, match="5 nodes on sides and inside are left out"):
        mesh = io.read(path)
    assert_square(mesh)
    assert mesh.regions.tolist() == [3, 3]
    assert mesh.edges.tolist() == [[0, 1]]
    assert mesh.edge_tags.tolist() == [7]
    if kind == "Medit":
        assert mesh.required_points.tolist() == [2]
    with pytest.warns(FormatWarning, match="higher order"):
        fields = io.read_fields(path)
    for values in fields.values():
        assert values.tolist() == [0, 1, 1, 0]


@pytest.mark.parametrize("order", [2, 3, 4])
def test_meshes_of_gmsh_of_any_order(tmp_path, order):
    gmsh = pytest.importorskip("gmsh", exc_type=ImportError)
    gmsh.initialize(["gmsh"], readConfigFiles=False, interruptible=False)
    try:
        gmsh.option.setNumber("General.Terminal", 0)
        gmsh.model.occ.addDisk(3, 3, 0, 1, 1)
        gmsh.model.occ.synchronize()
        gmsh.model.mesh.generate(2)
        corners = len(gmsh.model.mesh.getElementsByType(2)[0])
        gmsh.model.mesh.setOrder(order)
        gmsh.write(str(tmp_path / "a.msh"))
    finally:
        gmsh.finalize()
    with pytest.warns(FormatWarning, match="higher order"):
        mesh = io.read(tmp_path / "a.msh")
    assert len(mesh.triangles) == corners
    assert len(np.unique(mesh.triangles)) == len(mesh.points)
    assert mesh.validate()


# --------------------------------------------------------------------------------- heights, fields


@pytest.mark.parametrize("scale", [1e-6, 1, 1e6])
@pytest.mark.parametrize("offset", [0, 1e6])
@pytest.mark.parametrize("z", [0, 1e-17, -3.7, 1e5])
def test_meshes_at_one_height(tmp_path, scale, offset, z):
    points = POINTS * scale + offset * scale
    noise = 1e-12 * scale * np.array([0, 1, -1, 0.5])
    heights = z * scale + noise

    def text(heights):
        table = ([*p, h, 0] for p, h in zip(points.tolist(), heights.tolist(), strict=True))
        head = "MeshVersionFormatted 2\nDimension 3\nVertices\n4\n"
        return f"{head}{rows(*table)}Triangles\n2\n1 2 3 0\n1 3 4 0\nEnd\n"

    mesh = io.read(written(tmp_path, text(heights), "a.mesh"))
    np.testing.assert_array_equal(mesh.points, points)
    heights[2] += 1e-3 * scale
    with pytest.raises(FormatError, match=r"point 2 is .*: z is not .*, as that of point 0"):
        io.read(written(tmp_path, text(heights), "b.mesh"))


SHAPES = [(), (2,), (3,), (4,), (6,), (2, 2), (3, 3), (1, 4), (2, 2, 2)]


@pytest.mark.parametrize(
    "name", ["a.vtu", "a.vtk", "a.xdmf", "a.msh", "a.ele", "a.mesh", "a.meshb"]
)
@pytest.mark.parametrize("shape", SHAPES)
def test_fields_of_any_shape(tmp_path, name, shape):
    if name == "a.xdmf":
        pytest.importorskip("h5py")
    mesh = am.generate(am.Domain.polygon(POINTS), 0.5)
    rng = np.random.default_rng(len(shape))
    u = rng.normal(size=(len(mesh.points), *shape))
    q = rng.normal(size=(len(mesh.triangles), *shape))
    io.write(tmp_path / name, mesh, u=u, triangle_fields={"q": q})
    fields = io.read_fields(tmp_path / name)
    for field, values in (("u", u), ("q", q)):
        if name in ("a.ele", "a.mesh", "a.meshb"):  # they have columns only
            values = values.reshape(len(values), -1) if shape else values
        np.testing.assert_array_equal(fields[field], values, err_msg=field)
    io.write(tmp_path / f"copy{name}", io.read(tmp_path / name), **fields)
    for field, values in io.read_fields(tmp_path / f"copy{name}").items():
        np.testing.assert_array_equal(values, fields[field])


def test_tensors_as_meshio_writes_them(tmp_path):
    meshio = pytest.importorskip("meshio")
    pytest.importorskip("h5py")
    stress = np.arange(36.0).reshape(4, 3, 3)
    spatial = np.column_stack([POINTS, np.zeros(4)])
    content = meshio.Mesh(spatial, [("triangle", TRIANGLES)], point_data={"stress": stress})
    for name in ("a.xdmf", "a.vtu"):
        meshio.write(tmp_path / name, content)
        assert_square(io.read(tmp_path / name))
        found = io.read_fields(tmp_path / name)["stress"]
        np.testing.assert_array_equal(found.reshape(4, 3, 3), stress)


def test_texts_in_a_vtu_are_passed_over_with_a_word(tmp_path):
    mesh = am.Mesh(POINTS, TRIANGLES)
    io.write(tmp_path / "a.vtu", mesh, u=np.arange(4))
    text = (tmp_path / "a.vtu").read_text()
    array = '<DataArray type="String" Name="words" format="ascii">97 0 98 0 99 0 100 0</DataArray>'
    (tmp_path / "a.vtu").write_text(text.replace("</PointData>", array + "</PointData>"))
    with pytest.warns(FormatWarning, match="'words' is passed over"):
        assert_square(io.read(tmp_path / "a.vtu"))


def test_fields_at_edges_of_an_xdmf_are_passed_over_with_a_word(tmp_path):
    pytest.importorskip("h5py")
    io.write(tmp_path / "a.xdmf", am.Mesh(POINTS, TRIANGLES), u=np.arange(4))
    text = (tmp_path / "a.xdmf").read_text()
    text = re.sub(
        r'<Information Name="counts".*/>', "", text
    )  # the counts, as of a file that is not ours
    (tmp_path / "a.xdmf").write_text(text.replace('Center="Node"', 'Center="Edge"'))
    with pytest.warns(FormatWarning, match="'u' is passed over: it is given at 'Edge'"):
        assert_square(io.read(tmp_path / "a.xdmf"))


def test_nothing_is_warned_of_what_is_kept(tmp_path):
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        for version, text in MSH.items():
            io.read(written(tmp_path, text, f"{version}.msh"))


# --------------------------------------------------------- edges without triangles: an outline

OUTER = [[0, 0], [2, 0], [2, 1], [0, 1]]
INNER = [[0.5, 0.25], [1.5, 0.25], [1.5, 0.75], [0.5, 0.75]]
RINGS = np.array([*OUTER, *INNER])
SIDES = [(0, 1), (1, 2), (2, 3), (3, 0), (4, 5), (5, 6), (6, 7), (7, 4)]


def jigsaw_geometry(transform, bounds=()):
    """A rectangle with another in it, of edges with the tags 1 and 2, perhaps in parts."""
    points = [f"{x!r};{y!r};0" for x, y in transform(RINGS).tolist()]
    edges = [f"{a};{b};{1 + k // 4}" for k, (a, b) in enumerate(SIDES)]
    tables = {"point": points, "edge2": edges}
    if bounds:
        tables["bound"] = [f"{part};{edge};20" for part, edge in bounds]
    head = "# of a program\nmshid=3;EUCLIDEAN-MESH\nndims=2\n"
    return head + "".join(f"{k}={len(v)}\n" + "\n".join(v) + "\n" for k, v in tables.items())


@pytest.mark.parametrize("transform", TRANSFORMS, ids=str)
def test_a_geometry_of_jigsaw_is_a_domain(tmp_path, transform):
    path = written(tmp_path, jigsaw_geometry(transform))
    domain = am.read_domain(path)
    size = shapely.Polygon(transform(RINGS[:4])).area
    assert domain.area == pytest.approx(0.75 * size, rel=1e-8)
    assert np.unique(domain.segment_tags).tolist() == [1, 2]
    with pytest.raises(FormatError, match="no triangles"):
        io.read(path)


@pytest.mark.parametrize("transform", TRANSFORMS, ids=str)
def test_parts_of_a_geometry_are_regions(tmp_path, transform):
    parts = [(5, k) for k in range(8)] + [(6, k) for k in range(4, 8)]
    domain = am.read_domain(written(tmp_path, jigsaw_geometry(transform, parts)))
    size = shapely.Polygon(transform(RINGS[:4])).area
    mesh = am.generate(domain, np.sqrt(size) / 3)
    areas = {r: mesh.areas[mesh.regions == r].sum() for r in np.unique(mesh.regions).tolist()}
    assert areas == {5: pytest.approx(0.75 * size, rel=1e-8), 6: pytest.approx(size / 4, rel=1e-8)}


@pytest.mark.parametrize(
    ("bounds", "says"),
    [
        ([(1, 0), (1, 8)], "BOUND: row 1 has edge 8, but the edges are numbered from 0 to 7"),
        ([(1, 0), (1, 1)], "BOUND: the edges of part 1 are not closed"),
    ],
)
def test_parts_that_are_none(tmp_path, bounds, says):
    with pytest.raises(FormatError, match=says):
        am.read_domain(written(tmp_path, jigsaw_geometry(lambda p: p, bounds)))


@pytest.mark.parametrize("suffix", [".msh", ".mesh", ".vtk", ".vtu"])
def test_meshes_of_lines_are_domains(tmp_path, suffix):
    """Of the border only, as meshio and others write it."""
    pairs = np.array(SIDES)
    texts = {
        ".msh": "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$Nodes\n8\n"
        + "".join(f"{k} {x} {y} 0\n" for k, (x, y) in enumerate(RINGS, 1))
        + "$EndNodes\n$Elements\n8\n"
        + "".join(f"{k} 1 2 {1 + (k > 4)} 1 {a + 1} {b + 1}\n" for k, (a, b) in enumerate(SIDES, 1))
        + "$EndElements\n",
        ".mesh": "MeshVersionFormatted 2\nDimension 2\nVertices\n8\n"
        + "".join(f"{x} {y} 0\n" for x, y in RINGS)
        + "Edges\n8\n"
        + "".join(f"{a + 1} {b + 1} {1 + k // 4}\n" for k, (a, b) in enumerate(SIDES))
        + "End\n",
    }
    path = tmp_path / f"a{suffix}"
    if suffix in texts:
        path.write_text(texts[suffix])
    else:
        meshio = pytest.importorskip("meshio")
        points = np.column_stack([RINGS, np.zeros(8)])
        meshio.Mesh(points, [("line", pairs)]).write(path)
    domain = am.read_domain(path)
    assert domain.area == pytest.approx(1.5)
    assert len(domain.segments) == 8
