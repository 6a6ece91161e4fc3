"""Files that others write: what is read, and what is refused with the place and a remedy."""

import base64
import struct
import zlib

import numpy as np
import pytest

from adaptmesh import io
from adaptmesh.errors import FormatError, FormatWarning

# a unit square of two triangles: 0 (0, 0), 1 (1, 0), 2 (1, 1), 3 (0, 1)
SQUARE = [[0, 0], [1, 0], [1, 1], [0, 1]]
TRIANGLES = [[0, 1, 2], [0, 2, 3]]


def words(rows):
    return "\n".join(" ".join(map(str, row)) for row in rows)


def vtu(points=SQUARE, cells=TRIANGLES, kinds=(5, 5), data="", grid="", piece=""):
    """A .vtu file in text, with cells of any VTK type."""
    ends = np.cumsum([len(c) for c in cells])
    spatial = [p if len(p) == 3 else [*p, 0] for p in points]
    return f"""<VTKFile type="UnstructuredGrid" version="0.1"><UnstructuredGrid>{grid}
        <Piece NumberOfPoints="{len(points)}" NumberOfCells="{len(cells)}">
        <Points>
        <DataArray type="Float32" NumberOfComponents="3">{words(spatial)}</DataArray></Points>
        <Cells><DataArray type="Int64" Name="connectivity">{words(cells)}</DataArray>
        <DataArray type="Int32" Name="offsets">{words([ends])}</DataArray>
        <DataArray type="UInt8" Name="types">{words([kinds])}</DataArray></Cells>{data}
        </Piece>{piece}</UnstructuredGrid></VTKFile>"""


def medit(points=SQUARE, tables=None, head="MeshVersionFormatted 2\nDimension 2\n", end="End\n"):
    tables = {"Triangles": [[1, 2, 3, 0], [1, 3, 4, 0]]} if tables is None else tables
    tables = {"Vertices": [[*p, 0] for p in points], **tables}
    return head + "".join(f"{k}\n{len(v)}\n{words(v)}\n" for k, v in tables.items()) + end


def msh22(points=SQUARE, elements=((1, 2, 2, 0, 1, 1, 2, 3), (2, 2, 2, 0, 1, 1, 3, 4)), more=""):
    nodes = words([i, *(p if len(p) == 3 else [*p, 0])] for i, p in enumerate(points, start=1))
    return (
        f"$MeshFormat\n2.2 0 8\n$EndMeshFormat\n{more}$Nodes\n{len(points)}\n{nodes}\n$EndNodes\n"
        f"$Elements\n{len(elements)}\n{words(elements)}\n$EndElements\n"
    )


def msh41(nodes=None, elements=None, before=""):
    nodes = nodes or "1 4 1 4\n2 1 0 4\n1\n2\n3\n4\n0 0 0\n1 0 0\n1 1 0\n0 1 0"
    elements = elements or "1 2 1 2\n2 1 2 2\n1 1 2 3\n2 1 3 4"
    return (
        f"$MeshFormat\n4.1 0 8\n$EndMeshFormat\n{before}$Nodes\n{nodes}\n$EndNodes\n"
        f"$Elements\n{elements}\n$EndElements\n"
    )


WRITERS = {".vtu": vtu, ".mesh": medit, ".msh": msh22}


@pytest.fixture
def file(tmp_path):
    """Put a text or bytes into a file of that extension."""

    def put(extension, content):
        path = tmp_path / f"in{extension}"
        path.write_bytes(content.encode() if isinstance(content, str) else content)
        return path

    return put


def assert_square(mesh):
    np.testing.assert_array_equal(mesh.points, SQUARE)
    np.testing.assert_array_equal(mesh.triangles, TRIANGLES)


@pytest.mark.parametrize("extension", WRITERS)
def test_only_triangles(file, extension):
    mesh = io.read(file(extension, WRITERS[extension]()))
    assert_square(mesh)
    assert not mesh.regions.any()
    assert len(mesh.edges) == len(mesh.names) == 0


@pytest.mark.parametrize("extension", WRITERS)
def test_z_not_zero(file, extension):
    points = [[0, 0, 0], [1, 0, 0], [1, 1, 0.5], [0, 1, 0]]
    options = {"head": "MeshVersionFormatted 2\nDimension\n3\n"} if extension == ".mesh" else {}
    with pytest.raises(FormatError, match=r"point 2 is \(1\.0, 1\.0, 0\.5\): z is not 0"):
        io.read(file(extension, WRITERS[extension](points, **options)))
    points[2][2] = 0
    assert_square(io.read(file(extension, WRITERS[extension](points, **options))))


def with_triangles(extension, triangles):
    if extension == ".vtu":
        return vtu(cells=triangles, kinds=[5] * len(triangles))
    rows = [[*(v + 1 for v in t)] for t in triangles]
    if extension == ".mesh":
        return medit(tables={"Triangles": [[*t, 0] for t in rows]})
    return msh22(elements=[(i, 2, 0, *t) for i, t in enumerate(rows, start=1)])


@pytest.mark.parametrize("extension", WRITERS)
def test_clockwise_triangles_are_turned(file, extension):
    assert_square(io.read(file(extension, with_triangles(extension, [[0, 2, 1], [0, 2, 3]]))))


@pytest.mark.parametrize("extension", WRITERS)
@pytest.mark.parametrize(
    ("triangles", "message"),
    [
        ([[0, 1, 2], [0, 2, 2]], r"triangle 1 has a vertex twice: \[0, 2, 2\]"),
        ([[0, 1, 2], [0, 2, 3], [2, 0, 1]], r"triangle 2 has the same vertices .* as triangle 0"),
        ([], "no triangles"),
    ],
)
def test_bad_triangles(file, extension, triangles, message):
    with pytest.raises(FormatError, match=message) as error:
        io.read(file(extension, with_triangles(extension, triangles)))
    assert "in" + extension in str(error.value)


@pytest.mark.parametrize("extension", [".vtu", ".mesh"])
def test_vertex_out_of_range(file, extension):
    content = with_triangles(extension, [[0, 1, 2], [0, 2, 4]])
    with pytest.raises(FormatError, match=r"triangle 1 has vertices \[0, 2, 4\].* from 0 to 3"):
        io.read(file(extension, content))


def test_flat_triangles_are_told_exactly(file):
    # 0.1, 0.2, 0.3 are not on one line with 0, 1 / 3, ... in floating point only nearly so
    flat = [[0, 0], [1, 1], [2, 2], [0, 1]]
    with pytest.raises(FormatError, match=r"triangle 0 .* has no area"):
        io.read(file(".vtu", vtu(flat)))
    sliver = [["1e6", "1e6"], ["1000001", "1000001"], ["1000000.5", "1000000.5000000001"], [0, 1]]
    mesh = io.read(file(".mesh", medit(sliver, {"Triangles": [[1, 2, 3, 0]]})))
    np.testing.assert_array_equal(mesh.triangles, [[0, 1, 2]])


# ------------------------------------------------------------------------------------------- .vtu


def test_vtu_other_cells_are_counted(file):
    content = vtu(cells=[[0, 1, 2, 3], [0], [0, 1, 2, 3]], kinds=[9, 1, 10])
    with pytest.raises(FormatError, match=r"holds 1 quadrilaterals, 1 tetrahedra; .*triangulate"):
        io.read(file(".vtu", content))


def test_vtu_vertices_are_passed_over_and_lines_are_edges(file):
    data = '<CellData><DataArray type="Int8" Name="edge_tags">9 4 0 0</DataArray></CellData>'
    content = vtu(cells=[[3], [1, 0], *TRIANGLES], kinds=[1, 3, 5, 5], data=data)
    mesh = io.read(file(".vtu", content))
    assert_square(mesh)
    assert mesh.edges.tolist() == [[1, 0]]
    assert mesh.edge_tags.tolist() == [4]


def test_vtu_edges_must_be_sides(file):
    content = vtu(cells=[*TRIANGLES, [1, 3]], kinds=[5, 5, 3])
    with pytest.raises(FormatError, match=r"edge 0 \(vertices \[1, 3\]\) is not a side"):
        io.read(file(".vtu", content))


def test_vtu_foreign_arrays(file):
    # a `regions` of reals and a `metric` of 3 columns are just fields; strings are passed over
    data = (
        '<PointData><DataArray type="Float32" Name="metric" NumberOfComponents="3">'
        f'{words([[1, 2, 3]] * 4)}</DataArray></PointData><CellData><DataArray type="Float32" '
        'Name="regions">0.5 1</DataArray></CellData>'
    )
    grid = '<FieldData><Array type="String" Name="note">104 105 0</Array></FieldData>'
    path = file(".vtu", vtu(data=data, grid=grid))
    assert not io.read(path).regions.any()
    assert io.read_fields(path)["metric"].shape == (4, 3)
    assert io.read_fields(path)["regions"].tolist() == [0.5, 1.0]


def test_vtu_one_name_at_points_and_cells(file):
    data = (
        '<PointData><DataArray type="Int8" Name="u">1 2 3 4</DataArray></PointData>'
        '<CellData><DataArray type="Int8" Name="u">1 2</DataArray></CellData>'
    )
    path = file(".vtu", vtu(data=data))
    assert_square(io.read(path))
    with pytest.raises(FormatError, match="two fields are called 'u'"):
        io.read_fields(path)


def test_vtu_several_pieces(file):
    # two squares side by side, each a piece; meshio reads only the second's cells
    piece = vtu(points=[[2, 0], [3, 0], [3, 1], [2, 1]]).split("<UnstructuredGrid>")[1]
    mesh = io.read(file(".vtu", vtu(piece=piece.split("</UnstructuredGrid>")[0])))
    assert mesh.triangles.tolist() == [*TRIANGLES, [4, 5, 6], [4, 6, 7]]


@pytest.mark.parametrize("tensor", [0, 1])
def test_vtu_pieces_with_different_arrays(file, tensor):
    columns = (("1", 1), ("9", 9))[tensor]
    data = (
        f'<PointData><DataArray type="Int8" Name="metric" NumberOfComponents="{columns[0]}">'
        f"{words([[0] * columns[1]] * 4)}</DataArray></PointData>"
    )
    for first, second in (("", data), (data, "")):
        piece = vtu(data=second).split("<UnstructuredGrid>")[1].split("</UnstructuredGrid>")[0]
        with pytest.raises(FormatError, match="'metric' is not alike in all pieces"):
            io.read(file(".vtu", vtu(data=first, piece=piece)))


@pytest.mark.parametrize("header", ["UInt32", "UInt64"])
@pytest.mark.parametrize("order", ["<", ">"])
@pytest.mark.parametrize("compressor", [None, "vtkZLibDataCompressor"])
@pytest.mark.parametrize("encoding", ["inline", "base64", "raw"])
def test_vtu_encodings(file, header, order, compressor, encoding):
    # the whole file once in text, its points once more in every encoding of VTK
    word = {"UInt32": "I", "UInt64": "Q"}[header]
    payload = np.array([[*p, 0] for p in SQUARE], order + "f8").tobytes()
    if compressor:
        blocks = [zlib.compress(payload[:64]), zlib.compress(payload[64:])]
        head = struct.pack(order + 5 * word, 2, 64, 32, *map(len, blocks))
        groups = [head, b"".join(blocks)]
    else:
        groups = [struct.pack(order + word, len(payload)) + payload]
    coded = b"".join(groups if encoding == "raw" else map(base64.b64encode, groups))
    name = {"<": "LittleEndian", ">": "BigEndian"}[order]
    array = '<DataArray type="Float64" NumberOfComponents="3" format='
    text = vtu().replace(
        'version="0.1"',
        f'byte_order="{name}" header_type="{header}"'
        + (f' compressor="{compressor}"' if compressor else ""),
    )
    start, rest = text.split('<DataArray type="Float32" NumberOfComponents="3">')
    rest = rest[rest.index("</DataArray>") :]
    if encoding == "inline":
        content = f'{start}{array}"binary">\n  {coded.decode()}\n{rest}'.encode()
    else:
        content = f'{start}{array}"appended" offset="3">{rest}'.encode()
        content = content.replace(
            b"</UnstructuredGrid></VTKFile>",
            b'</UnstructuredGrid><AppendedData encoding="%b">\n_xyz%b\n</AppendedData></VTKFile>'
            % (encoding.encode(), coded),
        )
    assert_square(io.read(file(".vtu", content)))


@pytest.mark.parametrize(
    ("change", "message"),
    [
        (("UnstructuredGrid", "PolyData"), "holds PolyData"),
        (('NumberOfPoints="4"', 'NumberOfPoints="5"'), "NumberOfPoints='5'"),
        (('NumberOfCells="2"', ""), "NumberOfCells"),
        (("Float32", "Float33"), "array '.*': type 'Float33' is unknown"),
        (("1 1 0", "1 x 0"), "expected a number, got b'x'"),
        (("3 6", "3 7"), "do not fit together"),
        (('Name="types"', 'Name="kinds"'), "no 'types' array"),
        (("</VTKFile>", ""), "cut short or not XML"),
        (('NumberOfComponents="3"', 'NumberOfComponents="5"'), "12 numbers are not rows of 5"),
    ],
)
def test_vtu_damage(file, change, message):
    with pytest.raises(FormatError, match=message):
        io.read(file(".vtu", vtu().replace(*change)))


def test_vtu_lz4_is_named(file):
    text = vtu().replace('version="0.1"', 'compressor="vtkLZ4DataCompressor"')
    text = text.replace(
        'NumberOfComponents="3">', 'NumberOfComponents="3" format="binary">AAAAAAAA'
    )
    with pytest.raises(FormatError, match="vtkLZ4DataCompressor; save the file with zlib"):
        io.read(file(".vtu", text))


# ------------------------------------------------------------------------------------------ Medit


def test_medit_text_as_others_lay_it_out(file):
    text = medit(
        [["0.", "0"], ["1E0", "0"], ["1", "+1.0"], ["0", "1e0"]],
        {
            "Corners": [[1], [2]],
            "Edges": [[1, 2, 5]],
            "RequiredEdges": [[1]],
            "NormalAtVertices": [["0.5", "-inf"]],
            "Triangles": [[1, 2, 3, 7], [1, 3, 4, 0]],
        },
        head="# by hand\nMeshVersionFormatted\n1 Dimension 2 # plane\n",
        end="End",
    )
    mesh = io.read(file(".mesh", text))
    assert_square(mesh)
    assert mesh.edge_tags.tolist() == [5]
    assert mesh.regions.tolist() == [7, 0]


@pytest.mark.parametrize("order", ["<", ">"])
@pytest.mark.parametrize("version", [1, 2, 3, 4])
@pytest.mark.parametrize("dim", [2, 3])
def test_medit_binary_of_every_version(file, order, version, dim):
    real, integer = "f" if version == 1 else "d", "q" if version == 4 else "i"
    place = "q" if version >= 3 else "i"

    def rows(form, values):
        return b"".join(struct.pack(order + form, *row) for row in values)

    vertices = [[*p, *[0] * (dim - 2), 9] for p in SQUARE]
    tables = [
        (3, struct.pack(order + "i", dim)),
        (4, rows(integer, [[4]]) + rows(real * dim + integer, vertices)),
        (14, rows(integer, [[1], [1]])),  # corners, of no interest
        (6, rows(integer, [[2]]) + rows(4 * integer, [[1, 2, 3, 7], [1, 3, 4, 0]])),
    ]
    out = struct.pack(order + "ii", 1, version)
    for keyword, body in tables:
        after = len(out) + 4 + struct.calcsize(place) + len(body)
        out += struct.pack(order + "i" + place, keyword, after) + body
    mesh = io.read(file(".meshb", out + struct.pack(order + "i", 54)))
    assert_square(mesh)
    assert mesh.regions.tolist() == [7, 0]


def test_medit_other_cells_are_counted(file):
    tables = {"Quadrilaterals": [[1, 2, 3, 4, 0]], "Tetrahedra": []}
    with pytest.raises(FormatError, match="holds 1 Quadrilaterals; only triangles"):
        io.read(file(".mesh", medit(tables=tables)))


@pytest.mark.parametrize(
    ("content", "message"),
    [
        (medit(end=""), "has no End"),
        (medit().replace("Dimension 2", ""), "come before Dimension"),
        (medit().replace("Dimension 2", "Dimension 4"), "Dimension: 4 is neither 2 nor 3"),
        (medit().replace("1 3 4 0", "1 3 4"), "Triangles: expected an integer, got b'End'"),
        (medit().replace("Triangles\n2", "Triangles\n1"), "expected a keyword, got b'1'"),
        (medit().replace("Triangles\n2", "Triangles\n-2"), "Triangles: cut short: -2 rows"),
        (medit().replace("Triangles\n2", "Triangles\n99999999999"), "Triangles: cut short"),
        (medit().replace("Vertices", "Points"), "has no Vertices"),
        (medit(head="hello\n"), "no Medit file"),
        (medit(head='MeshVersionFormatted 2\n# adaptmesh edge 3 "a\\q"\n'), "name .* is damaged"),
        ("", "no Medit file"),
    ],
)
def test_medit_damage(file, content, message):
    with pytest.raises(FormatError, match=message):
        io.read(file(".mesh", content))


def test_medit_region_number_too_large(file):
    tables = {"Triangles": [[1, 2, 3, 2**31], [1, 3, 4, 0]]}
    with pytest.raises(FormatError, match="region 2147483648 does not fit in 32 bits"):
        io.read(file(".mesh", medit(tables=tables)))


def test_solutions_as_others_lay_them_out(file, tmp_path):
    head = "MeshVersionFormatted 2 Dimension "
    sol = head + "3 SolAtVertices 2  2 2 3  1 2 0 10 11 12 0 0 99  3 4 0 20 21 22 0 0 99  End"
    both = [[1, 2, 10, 11, 12], [3, 4, 20, 21, 22]]
    np.testing.assert_array_equal(io.read_sol(file(".sol", sol)), both)
    with pytest.raises(FormatError, match=r"row 1 .* not in the plane"):
        io.read_sol(file(".sol", sol.replace("22 0 0", "22 0 1")))
    with pytest.raises(FormatError, match="type 7 is neither"):
        io.read_sol(file(".sol", head + "2 SolAtVertices 1 1 7 0 End"))
    with pytest.raises(FormatError, match="neither SolAtVertices nor SolAtTriangles"):
        io.read_sol(file(".sol", head + "2 End"))
    # a scalar beside a mesh is a solution, or sizes; only a tensor is surely a metric
    file(".sol", head + "2 SolAtVertices 4 1 1  1 2 3 4 End")
    fields = io.read_fields(file(".mesh", medit()))
    assert {name: a.tolist() for name, a in fields.items()} == {"sol": [1, 2, 3, 4]}


# ------------------------------------------------------------------------------------------- Gmsh


def test_msh22_tags_out_of_order(file):
    # nodes and elements in any order, with gaps; the physical group is the first tag
    text = msh22(
        elements=[(9, 2, 2, 5, 1, 70, 40, 30), (4, 2, 3, -6, 1, 0, 70, 30, 20), (5, 15, 0, 20)]
    )
    nodes = "$Nodes\n4\n70 0 0 0\n20 1 0 0\n30 1 1 0\n40 0 1 0\n$EndNodes\n"
    start, _, rest = text.partition("$Nodes")
    mesh = io.read(file(".msh", start + nodes + rest.split("$EndNodes\n")[1]))
    np.testing.assert_array_equal(mesh.points, [[1, 0], [1, 1], [0, 1], [0, 0]])
    np.testing.assert_array_equal(mesh.triangles, [[3, 0, 1], [3, 1, 2]])
    assert mesh.regions.tolist() == [6, 5]


def test_msh41_entities_and_parametric_nodes(file):
    before = (
        '$PhysicalNames\n3\n0 8 "corner"\n1 3 "in let"\n2 7 "steel"\n$EndPhysicalNames\n'
        "$Entities\n1 1 1 0\n1 0 0 0 1 8\n5 0 0 0 1 0 0 1 -3 2 1 -2\n"
        "1 0 0 0 1 1 0 1 7 1 5\n$EndEntities\n$Comments\nany thing\n$EndComments\n"
    )
    nodes = "2 4 1 40\n1 5 1 2\n10\n20\n0 0 0 0.5\n1 0 0 0.7\n2 1 0 2\n40\n30\n0 1 0\n1 1 0"
    elements = "3 4 1 9\n0 1 15 1\n1 10\n1 5 1 1\n2 10 20\n2 1 2 2\n8 10 20 30\n9 10 30 40"
    mesh = io.read(file(".msh", msh41(nodes, elements, before)))
    assert_square(mesh)
    assert mesh.edges.tolist() == [[0, 1]]
    assert mesh.edge_tags.tolist() == [3]
    assert mesh.regions.tolist() == [7, 7]
    assert dict(mesh.names) == {"in let": 3}
    assert dict(mesh.region_names) == {"steel": 7}


def test_msh_views_of_some_nodes(file):
    view = (
        '$NodeData\n2\n"u"\n"scheme"\n1\n0.5\n4\n0\n1\n2\n0\n2 0.25\n4 -1\n$EndNodeData\n'
        '$ElementData\n1\n"q"\n0\n3\n0\n1\n1\n2 5\n$EndElementData\n'
    )
    fields = io.read_fields(file(".msh", msh41() + view))
    np.testing.assert_array_equal(fields["u"], [np.nan, 0.25, np.nan, -1])
    np.testing.assert_array_equal(fields["q"], [np.nan, 5])


def test_msh_two_groups_of_one_surface(file):
    before = (
        '$PhysicalNames\n1\n2 7 "steel"\n$EndPhysicalNames\n'
        "$Entities\n0 0 1 0\n1 0 0 0 1 1 0 2 7 8 0\n$EndEntities\n"
    )
    with pytest.warns(FormatWarning, match=r"triangles that are in several.* 'steel\|8' \(9\)"):
        mesh = io.read(file(".msh", msh41(before=before)))
    assert dict(mesh.region_names) == {"steel": 7, "steel|8": 9}
    assert mesh.regions.tolist() == [9, 9]


@pytest.mark.parametrize(
    ("content", "message"),
    [
        ("", r"does not start with \$MeshFormat"),
        ("solid\n", r"does not start with \$MeshFormat .*JIGSAW"),
        ("$Mesh", r"expected a section \$Name"),
        (msh22().replace("2.2 0 8", "5 0 8"), "version 5; 1, 2 to 2.2, .*-format msh41"),
        (msh22().replace("2.2 0 8", "2.2 0 4"), "numbers of 4 bytes"),
        (msh22().replace("2.2 0 8", "2.2 1 8"), "tells the byte order is damaged"),
        (msh22().replace("$EndElements", ""), r"\$Elements has no \$EndElements"),
        (msh22().replace("$Nodes\n4", "$Nodes\n5"), r"\$Nodes: cut short: 5 rows"),
        (msh22().replace("$Nodes\n4", "$Nodes\n3"), r"\$Nodes: holds more than its counts say"),
        (
            msh22(elements=[(1, 2, 0, 1, 2, 8)]),
            r"element 1 has the node 8, which is not in \$Nodes",
        ),
        (msh22(elements=[(1, 3, 0, 1, 2, 3, 4)]), "quadrilaterals; only triangles"),
        (msh22().replace("\n4 0 1 0", "\n3 0 1 0"), "node 3 is there twice"),
        (
            msh41(nodes="1 5 1 4\n2 1 0 4\n1\n2\n3\n4\n" + "0 0 0\n" * 4),
            "expected 5 nodes, as announced, got 4",
        ),
        (msh41(before="$PartitionedEntities\n\n$EndPartitionedEntities\n"), "save it whole"),
        (msh41(before='$PhysicalNames\n2\n1 1 "a"\n$EndPhysicalNames\n'), "number of names"),
        (msh41(before="$PhysicalNames\n1\n1 1 a\n$EndPhysicalNames\n"), "dimension, tag,"),
    ],
)
def test_msh_damage(file, content, message):
    with pytest.raises(FormatError, match=message):
        io.read(file(".msh", content))


def test_medit_with_texts_as_bamg_and_freefem_write_them(tmp_path):
    head = 'MeshVersionFormatted 1\nDimension\n2\nIdentifier\n";2, Date: 26/11/25 # 1"\n'
    head += 'Geometry\n"b.mesh.gmsh"\n'
    (tmp_path / "a.mesh").write_text(medit(head=head))
    np.testing.assert_array_equal(io.read(tmp_path / "a.mesh").points, SQUARE)
