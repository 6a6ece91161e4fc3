"""Files made to do harm: small ones that would cost gigabytes or minutes, or read another file.

Each is refused, by an error that a reader raises on purpose and that names the file, within little
memory and time. `test_io_damage.py` has files that were damaged by accident.
"""

import base64
import json
import lzma
import os
import time
import zlib

import numpy as np
import pytest
from reference.damage import little_memory, little_time

import adaptmesh as am
from adaptmesh.files import bounded

SECONDS = 5  # of processor time; most take milliseconds


def refused(read, path, match=None):
    """Check that reading ends in an error of ours that was foreseen, soon, and in little memory."""
    began = time.process_time()
    with little_memory(), little_time(), pytest.raises(am.AdaptmeshError, match=match) as caught:
        read(path)
    assert path.stem in str(caught.value)
    assert caught.value.__cause__ is None, "only the last line of defence has caught it"
    assert time.process_time() - began < SECONDS


@pytest.fixture
def file(tmp_path):
    def write(name, content):
        path = tmp_path / name
        path.write_bytes(content if isinstance(content, bytes) else content.encode())
        return path

    return write


# ------------------------------------------------------------------------------------ any file


@pytest.mark.skipif(not hasattr(os, "mkfifo"), reason="no pipes with names here")
def test_a_pipe_is_not_waited_for(tmp_path):
    path = tmp_path / "a.wkt"
    os.mkfifo(path)
    refused(am.read_domain, path, "no regular file")


# ---------------------------------------------------------------------------------- numbers, JSON

LONG = "1" * 5000  # Python's `int` takes 4300 digits


@pytest.mark.parametrize("text", ["", " ", "-1", "+1", "1.0", "1_0", "²", "٣", "0x1", LONG])
def test_whole_numbers(text):
    assert bounded.whole_number(" 17\n") == 17
    assert bounded.whole_number(b"17") == 17
    with pytest.raises(am.FormatError, match="expected a count"):
        bounded.whole_number(text)


@pytest.mark.parametrize(
    "text",
    [
        "[" * 100_000,
        "[" * 100_000 + "]" * 100_000,
        '{"a":' * 100_000,
        '{"type":"Polygon","coordinates":' + "[" * 100_000 + "]" * 100_000 + "}",
        r'["\\", ' + "[" * 1000,
        r'["]]]]\"]]]", ' + "[" * 1000,
    ],
)
def test_deep_json(file, text):
    refused(am.read_domain, file("a.geojson", text), "nested more than 200 levels")


def test_brackets_in_strings_are_not_levels():
    text = json.dumps(["[" * 1000, '\\"' + "{" * 1000, [1]] * 3)
    assert bounded.read_json(text) == json.loads(text)
    assert bounded.read_json("[" * 200 + "]" * 200)


def test_json_of_long_numbers(file):
    ring = '{"type":"Polygon","coordinates":[[[%s,0],[1,0],[1,1],[%s,0]]]}'
    refused(am.read_domain, file("a.geojson", ring % (LONG, LONG)))
    digits = "1" * 25
    domain = am.read_domain(file("b.geojson", ring % (f"0.{LONG}", f"0.{LONG}")))
    assert domain.area == pytest.approx(0.5 * (1 - 1 / 9))
    assert bounded.read_json(digits) == float(digits)


# ------------------------------------------------------------------------------------------- XML


@pytest.mark.parametrize(
    ("inner", "body", "why"),
    [
        ('<!ENTITY a "b">' + '<!ENTITY c "&a;&a;">', "&c;", "other entities"),
        (f'<!ENTITY a "{"x" * 10_000}">', "&a;" * 10_000, "expand"),
        (f'<!ATTLIST g b CDATA "{"x" * 10_000}">', "<g/>" * 10_000, "expand"),
        ('<!ENTITY a SYSTEM "file:///etc/passwd">', "&a;", "another file"),
        ('<!ENTITY % a SYSTEM "other.dtd"> %a;', "", "another file"),
        ("", "<g>" * 1000 + "</g>" * 1000, "nested more than 200"),
    ],
)
@pytest.mark.parametrize("suffix", [".svg", ".vtu", ".xdmf"])
def test_xml_that_expands(file, inner, body, why, suffix):
    pytest.importorskip("svgelements")
    path = file(f"a{suffix}", f"<!DOCTYPE svg [{inner}]>\n<svg>{body}</svg>")
    refused(am.read_domain, path, why)


def test_entities_of_illustrator():
    text = b'<!DOCTYPE svg [<!ENTITY ns "http://www.w3.org/2000/svg">]><svg xmlns="&ns;"/>'
    assert bounded.read_xml(text).tag == "{http://www.w3.org/2000/svg}svg"


# ------------------------------------------------------------------------------------------ .geo


@pytest.mark.fast_cases(1)
@pytest.mark.parametrize(
    "text",
    [
        "a[]={1,2};\nFor i In {1:60}\na[]+=a[];\nEndFor\n",
        "For i In {1:100000000}\nEndFor\n",
        "For i In {1:1000}\nFor j In {1:1000}\nFor k In {1:1000}\nEndFor\nEndFor\nEndFor\n",
        "For i In {1:400000}\n If(0) " + "a=1;" * 10_000 + " EndIf EndFor\n",
        "For i In {1:400000}\n For j In {1:0} " + "a=1;" * 10_000 + " EndFor EndFor\n",
        "For i In {1:400000}\n Point(i)={i,0,0}; EndFor\n",
        "a[]={1:500000}; b[]=a[]; c[]={a[],b[]};",
        "/*" * 200_000,
        "a=" + "(" * 50_000,
        "a=" + "2^" * 50_000 + "1;",
        "a=" + "9" * 500_000 + ";",
    ],
)
def test_geo_that_grows(file, text):
    refused(am.read_domain, file("a.geo", text))


@pytest.mark.parametrize(
    ("expression", "why"),
    [
        ("(-8)^0.5", "not a real number"),
        ("Sqrt(1, 2, 3)", "Sqrt is not a function of 3 numbers"),
        ("Round(1, 2)", "Round is not a function of 2 numbers"),
        ("Max(1)", "Max is not a function of 1 numbers"),
        ("Cos({})", "Cos is not a function"),
        ("2^1e308", "line 1"),
        ("0^-1", "line 1"),
        ("Exp(1e4)", "line 1"),
        ("Fmod(1, 0)", "line 1"),
    ],
)
def test_geo_of_impossible_numbers(file, expression, why):
    refused(am.read_domain, file("a.geo", f"a = {expression};"), why)


@pytest.mark.parametrize("tiny", ["1e-310", "-1e-310", "5e-324", "1e-300", "0"])
def test_geo_of_nearly_upright_lines(file, tiny):
    """dy/dx overflows in the search for a point inside."""
    text = (
        f"Point(1) = {{{tiny}, 0, 0}}; Point(2) = {{2, 0, 0}}; Point(3) = {{2, 1, 0}};"
        "Point(4) = {0, 1, 0}; Line(1) = {1, 2}; Line(2) = {2, 3}; Line(3) = {3, 4};"
        "Line(4) = {4, 1}; Curve Loop(1) = {1:4}; Plane Surface(1) = {1};"
        'Physical Surface("a") = {1};'
    )
    domain = am.read_domain(file("a.geo", text))
    assert domain.area == pytest.approx(2)
    assert list(domain.region_names) == ["a"]


def test_geo_loops_of_some_size_are_read(file):
    text = """
    n = 500;
    For k In {1:n} Point(k) = {Cos(2*Pi*k/n), Sin(2*Pi*k/n), 0}; EndFor
    For k In {1:n} Line(k) = {k, k % n + 1}; EndFor
    Line Loop(1) = {1:n}; Plane Surface(1) = {1};
    """
    area = 250 * np.sin(2 * np.pi / 500)
    assert am.read_domain(file("a.geo", text)).area == pytest.approx(area, rel=1e-12)


# ------------------------------------------------------------------------------------ .vtu, .vtk


def vtu(arrays, attributes="", points=3, appended=""):
    """A file of one triangle with the points, or whatever `arrays` says instead."""
    return (
        f'<VTKFile type="UnstructuredGrid" byte_order="LittleEndian" {attributes}>'
        f'<UnstructuredGrid><Piece NumberOfPoints="{points}" NumberOfCells="1">{arrays}'
        f"</Piece></UnstructuredGrid>{appended}</VTKFile>"
    )


def zeros(megabytes, how="zlib"):
    """So many MiB of zeros, as one compressed block with its header in base64."""
    compressed = (zlib if how == "zlib" else lzma).compress(bytes(megabytes << 20))
    head = np.array([1, megabytes << 20, 0, len(compressed)], "<u8").tobytes()
    return (base64.b64encode(head) + base64.b64encode(compressed)).decode()


COMPRESSED = 'header_type="UInt64" compressor="vtkZLibDataCompressor"'
REAL = '<DataArray type="Float64" Name="{}" NumberOfComponents="{}" format="{}"{}>{}</DataArray>'


@pytest.mark.slow
@pytest.mark.parametrize("how", ["zlib", "lzma"])
def test_vtu_of_zeros(file, how):
    name = COMPRESSED.replace("ZLib", "LZMA" if how == "lzma" else "ZLib")
    points = "<Points>" + REAL.format("Points", 3, "binary", "", zeros(70, how)) + "</Points>"
    refused(am.read, file("a.vtu", vtu(points, name)), "more than 64 MiB")
    points = "<PointData>" + REAL.format("u", 1, "binary", "", zeros(10, how)) * 10
    refused(am.read, file("a.vtu", vtu(points + "</PointData>", name)), "more than 64 MiB")


def test_vtu_that_uses_one_block_again_and_again(file):
    appended = f'<AppendedData encoding="base64">_{zeros(1)}</AppendedData>'
    arrays = REAL.format("u", 1, "appended", ' offset="0"', "") * 1000
    text = vtu(f"<PointData>{arrays}</PointData>", COMPRESSED, appended=appended)
    refused(am.read, file("a.vtu", text), "more than 64 MiB")


def test_vtu_of_many_arrays_takes_the_time_of_its_size(file):
    raw = np.array(8, "<u4").tobytes() + bytes(8)
    arrays = REAL.format("u", 1, "appended", ' offset="0"', "") * 20_000
    head, tail = vtu(f"<PointData>{arrays}</PointData>", appended="|").encode().split(b"|")
    data = b'<AppendedData encoding="raw">_' + raw + bytes(5_000_000) + b"</AppendedData>"
    refused(am.read, file("a.vtu", head + data + tail), "Cells")
    refused(am.read, file("b.vtu", "<AppendedData" * 200_000), "not closed")


@pytest.mark.parametrize("number", [LONG, "-1", "1.5", "²", "99999999999999999999", "0"])
def test_vtu_numbers(file, number):
    points = REAL.format("Points", number, "ascii", "", "0 0 0 1 0 0 0 1 0")
    refused(am.read, file("a.vtu", vtu(f"<Points>{points}</Points>")), "components|rows of")
    points = REAL.format("Points", 3, "appended", f' offset="{number}"', "")
    end = '<AppendedData encoding="raw">_abc</AppendedData>'
    refused(am.read, file("a.vtu", vtu(f"<Points>{points}</Points>", appended=end)))


def test_what_compresses_well_is_read(tmp_path):
    x = np.linspace(0, 1, 201)
    points = np.stack(np.meshgrid(x, x), axis=-1).reshape(-1, 2)
    corner = (np.arange(200)[:, None] * 201 + np.arange(200)).ravel()
    lower = np.stack([corner, corner + 1, corner + 201], axis=1)
    upper = np.stack([corner + 1, corner + 202, corner + 201], axis=1)
    mesh = am.Mesh(points, np.concatenate([lower, upper]))
    fields = {f"u{k}": np.zeros(len(points)) for k in range(100)}
    path = tmp_path / "a.vtu"
    am.write(path, mesh, **fields)
    assert path.stat().st_size < 3_000_000
    assert (am.read(path).points == points).all()
    assert len(am.io.read_fields(path)) == 100


VTK = "# vtk DataFile Version {}\nx\n{}\nDATASET UNSTRUCTURED_GRID\n{}"
POINTS = "POINTS 3 double\n0 0 0 1 0 0 0 1 0\n"
CELLS = "CELLS 1 4\n3 0 1 2\nCELL_TYPES 1\n5\n"
OFFSETS = "CELLS {} 3\nOFFSETS vtktypeint64\n{}\nCONNECTIVITY int\n0 1 2\nCELL_TYPES {}\n{}\n"


@pytest.mark.parametrize(
    "text",
    [
        VTK.format("5.1", "BINARY", "\x1d\n"),
        VTK.format("3.0", "ASCII", f"\x1c\x1d\x1e\n{POINTS}"),
        VTK.format("3.0", "ASCII", f"{POINTS}{CELLS}CELL_DATA 1\nFIELD F 1\nu 1 2 int\n1 2\n"),
        VTK.format("3.0", "ASCII", f"{POINTS}{CELLS}POINT_DATA 3\nFIELD F 1\nu 1 2 int\n1 2\n"),
        VTK.format("5.1", "ASCII", POINTS + OFFSETS.format(2, "9 12", 1, "5")),
        VTK.format("5.1", "ASCII", POINTS + OFFSETS.format(3, "0 9 3", 2, "5 5")),
        VTK.format("5.1", "ASCII", POINTS + OFFSETS.format(3, f"0 {2**63 - 1} 3", 2, "5 5")),
        VTK.format("5.1", "ASCII", POINTS + OFFSETS.format(2, "-3 3", 1, "5")),
        VTK.format("3.0", "ASCII", f"POINTS {LONG} double\n0 0 0\n"),
        VTK.format("3.0", "ASCII", f"{POINTS}CELLS 0 0\nCELL_TYPES 0\n"),
        VTK.format("1" * 500_000 + ".0", "ASCII", POINTS),
        VTK.format("1." + "0" * 500_000, "ASCII", POINTS),
        "# vtk DataFile Version 3.0\nx\nASCII\nDATASET " + "x" * 500_000,
        VTK.format("3.0", "ASCII", "FIELD F 50000\n" + "u 1 1 int\n1\n" * 50_000 + " " * 3_000_000),
        VTK.format("3.0", "ASCII", "POINTS 1 double\n" + " " * 3_000_000),
    ],
)  # fmt: skip
def test_vtk_that_does_not_fit_together(file, text):
    refused(am.read, file("a.vtk", text))


# ------------------------------------------------------------------------------------------ HDF5


@pytest.fixture
def xdmf(tmp_path):
    """Write a mesh of two triangles whose points are whatever `fill` puts into its .h5 as G."""
    h5py = pytest.importorskip("h5py")

    def write(fill, reference="a.h5:/G", attributes=1):
        folder = tmp_path / "folder"
        folder.mkdir(exist_ok=True)
        with h5py.File(folder / "a.h5", "w") as file:
            file["T"] = np.array([[0, 1, 2], [0, 2, 3]])
            fill(file)
        triangles = '<DataItem Format="HDF">a.h5:/T</DataItem>'
        points = f'<DataItem Format="HDF">{reference}</DataItem>'
        field = f'<Attribute Name="u">{points}</Attribute>'
        path = folder / "a.xdmf"
        path.write_text(
            '<Xdmf><Domain><Grid Name="m"><Topology TopologyType="Triangle">'
            f"{triangles}</Topology><Geometry>{points}</Geometry>{field * attributes}"
            "</Grid></Domain></Xdmf>"
        )
        return path

    return write


SQUARE = np.array([[0.0, 0], [1, 0], [1, 1], [0, 1]])


def outside(tmp_path):
    """An HDF5 file in another folder, and one of bare numbers."""
    h5py = pytest.importorskip("h5py")
    with h5py.File(tmp_path / "secret.h5", "w") as file:
        file["G"] = SQUARE
    (tmp_path / "secret.bin").write_bytes(SQUARE.tobytes())
    return tmp_path / "secret.h5", tmp_path / "secret.bin"


def by_external_storage(file, hdf5, binary):
    file.create_dataset("G", (4, 2), "f8", external=[(str(binary), 0, 64)])


def by_external_link(file, hdf5, binary):
    import h5py

    file["G"] = h5py.ExternalLink(str(hdf5), "/G")


def by_links_to_an_external_link(file, hdf5, binary):
    import h5py

    file["far"] = h5py.ExternalLink(str(hdf5), "/")
    file["group/soft"] = h5py.SoftLink("/far")
    file["G"] = h5py.SoftLink("group/soft/G")


def by_a_virtual_dataset(file, hdf5, binary):
    import h5py

    layout = h5py.VirtualLayout((4, 2), "f8")
    layout[:] = h5py.VirtualSource(str(hdf5), "G", (4, 2))
    file.create_virtual_dataset("G", layout)


@pytest.mark.parametrize(
    "lead",
    [by_external_storage, by_external_link, by_links_to_an_external_link, by_a_virtual_dataset],
)
def test_hdf5_does_not_read_another_file(lead, xdmf, tmp_path):
    files = outside(tmp_path)
    refused(am.read, xdmf(lambda file: lead(file, *files)), "another file")


@pytest.mark.parametrize("name", ["../secret.h5", "..", ".", "", "{}", "C:secret.h5", "..\\x.h5"])
def test_xdmf_names_files_beside_it_only(name, xdmf, tmp_path):
    hdf5, _ = outside(tmp_path)
    path = xdmf(lambda file: None, f"{name.format(hdf5)}:/G")
    refused(am.read, path, "not to a file beside it")


def test_links_within_the_file_are_followed(xdmf):
    import h5py

    def fill(file):
        file["x/y/G"] = SQUARE
        file["x/z"] = h5py.SoftLink("y")
        file["G"] = h5py.SoftLink("/x/z/G")

    assert (am.read(xdmf(fill)).points == SQUARE).all()

    def loop(file):
        file["G"] = h5py.SoftLink("/H")
        file["H"] = h5py.SoftLink("/G")

    refused(am.read, xdmf(loop))


def overfull(file, **options):
    """A block that has more zeros than the array needs: what HDF5 unpacks is without bound."""
    G = file.create_dataset("G", (4, 2), "f8", chunks=(4, 2), compression="gzip", **options)
    G.id.write_direct_chunk((0, 0), zlib.compress(bytes(200 << 20)))


@pytest.mark.fast_cases(2)
@pytest.mark.parametrize(
    ("fill", "why"),
    [
        (lambda file: file.create_dataset("G", (1 << 40, 2), "f8", chunks=(4, 2)), "64 MiB"),
        (lambda file: file.create_dataset("G", (10_000_000, 2), "f8", chunks=True), "64 MiB"),
        (lambda file: file.create_dataset("G", data=np.zeros((5 << 20, 2)), compression=9), "MiB"),
        (overfull, "larger than it should be"),
        (lambda file: overfull(file, shuffle=True, fletcher32=True), "larger than it should be"),
        (lambda file: file.create_dataset("G", data=["x" * 100]), "not numbers"),
        (lambda file: file.create_group("G"), "does not have"),
        (lambda file: file.create_dataset("G", data=[1.0], dtype="f8").resize, "shape"),
    ],
)
def test_hdf5_that_grows(fill, why, xdmf):
    refused(am.read, xdmf(fill), why)


def test_one_array_used_again_and_again(xdmf):
    path = xdmf(lambda file: file.create_dataset("G", data=np.zeros((100_000, 2))), attributes=2000)
    refused(am.read, path, "MiB")


@pytest.mark.parametrize(
    "options", [{"compression": 4}, {"compression": "lzf"}, {"chunks": (3, 1)}]
)
@pytest.mark.parametrize("more", [{}, {"shuffle": True}, {"fletcher32": True}])
def test_compressed_hdf5_is_read(options, more, xdmf):
    path = xdmf(lambda file: file.create_dataset("G", data=SQUARE, **options, **more))
    assert (am.read(path).points == SQUARE).all()


@pytest.mark.parametrize(
    ("dimensions", "numbers"),
    [("4 2", "0 " * 7), ("-1 2", "0 " * 8), (LONG, "0"), ("4 2", "0 " * 7 + "x" * 100_000)],
)
def test_xdmf_of_wrong_dimensions(dimensions, numbers, file):
    item = f'<DataItem Format="XML" Dimensions="{dimensions}">{numbers}</DataItem>'
    grid = f'<Grid Name="m"><Geometry>{item}</Geometry></Grid>'
    refused(am.read, file("a.xdmf", f"<Xdmf><Domain>{grid}</Domain></Xdmf>"), "Geometry")


# ------------------------------------------------------------------------------------------- WKT


@pytest.mark.parametrize(
    "text",
    [
        "a" + " " * 500_000,
        "a b" + " " * 500_000,
        "POLYGON" + "(" * 500_000,
        "GEOMETRYCOLLECTION(" * 50_000 + "POINT(0 0)" + ")" * 50_000,
        "SRID=" + "1" * 500_000,
        "POLYGON((" + "1" * 500_000 + " 0, 1 0, 1 1))",
        "POLYGON EMPTY " * 20_000 + "!",
    ],
)
def test_wkt(file, text):
    refused(am.read_domain, file("a.wkt", text))


@pytest.mark.parametrize("kind", ["POLYGON", "POLYGON Z", "polygon\n z", "POLYGONZ"])
def test_wkt_words(file, kind):
    assert am.read_domain(file("a.wkt", f"{kind} ((0 0 1,1 0 1,1 1 1,0 0 1))")).area == 0.5


# ------------------------------------------------------------------------------------------- SVG


def svg(body):
    return f'<svg xmlns="http://www.w3.org/2000/svg">{body}</svg>'


def doubled(count):
    groups = (f'<g id="a{i + 1}"><use href="#a{i}"/><use href="#a{i}"/></g>' for i in range(count))
    return '<circle id="a0" r="1"/>' + "".join(groups)


@pytest.mark.parametrize(
    "body",
    [
        '<g id="a"><use href="#a"/><circle r="1"/></g>',
        doubled(40),
        doubled(150),
        '<g id="a">' + '<circle r="1"/>' * 2000 + "</g>" + '<use href="#a"/>' * 2000,
        '<path id="a" d="M0 0' + "L1 1" * 50_000 + '"/>' + '<use href="#a"/>' * 2000,
        "".join(f'<use id="a{i}" href="#a{i + 1}"/>' for i in range(5000)),
        "<style>" + "a," * 100_000 + "</style>",
        "<style>" + "a{" * 100_000 + "</style>",
        "<style>" + "/*" * 100_000 + "</style>",
        "<style>a{fill:rgb(" + "1" * 20_000 + "}</style>",
        '<circle r="1" fill="rgb(' + "1" * 20_000 + '"/>',
        '<circle r="1" style="fill:rgb(' + "1" * 20_000 + '"/>',
        '<circle r="1' + " " * 500_000 + '!"/>',
        '<circle r="1" transform="' + "matrix(" * 50_000 + '"/>',
    ],
)
def test_svg(file, body):
    pytest.importorskip("svgelements")
    refused(am.read_domain, file("a.svg", svg(body)))


def test_svg_images_are_not_opened(file, tmp_path):
    pytest.importorskip("svgelements")
    (tmp_path / "secret.svg").write_text(svg('<circle r="5"/>'))
    image = '<image href="secret.svg" width="1" height="1"/><circle r="1"/>'
    assert am.read_domain(file("a.svg", svg(image))).area < 4
    refused(am.read_domain, file("b.svg", svg('<use href="secret.svg#a"/>')), "cannot be drawn")


def test_svg_uses_and_styles_in_good_faith(file):
    pytest.importorskip("svgelements")
    style = "<style>/* { */ .a, .b { fill: none } circle{stroke:rgb(1,2,3)} </style>"
    uses = "".join(f'<use href="#a" x="{3 * k}"/>' for k in range(20))
    shown = f'{style}<defs><circle id="a" r="1" style="fill:#fff"/></defs>{uses}'
    assert am.read_domain(file("a.svg", svg(shown))).area == pytest.approx(21 * np.pi, rel=0.1)


# ------------------------------------------------------------------------------------------- DXF


@pytest.fixture
def dxf(tmp_path):
    ezdxf = pytest.importorskip("ezdxf")

    def write(fill):
        document = ezdxf.new("R2000")
        fill(document, document.modelspace())
        path = tmp_path / "a.dxf"
        document.saveas(path)
        return path

    return write


def doubled_blocks(document, space):
    document.blocks.new("b0").add_circle((0, 0), 1)
    for k in range(40):
        block = document.blocks.new(f"b{k + 1}")
        block.add_blockref(f"b{k}", (0, 0))
        block.add_blockref(f"b{k}", (5, 0))
    space.add_blockref("b40", (0, 0))


def doubled_empty_blocks(document, space):
    doubled_blocks(document, space)
    document.blocks.get("b0").delete_all_entities()


def array_of_blocks(document, space, spacing=1.0):
    document.blocks.new("b").add_circle((0, 0), 0.1)
    counts = {"row_count": 30_000, "column_count": 30_000}
    spacings = {"row_spacing": spacing, "column_spacing": spacing}
    space.add_blockref("b", (0, 0), dxfattribs=counts | spacings)


def long_polyline_again_and_again(document, space):
    document.blocks.new("b").add_lwpolyline([(x, x % 2) for x in range(2000)])
    for x in range(2000):
        space.add_blockref("b", (x, 0))


def block_in_itself(document, space):
    block = document.blocks.new("b")
    block.add_circle((0, 0), 1)
    block.add_blockref("b", (5, 0))
    space.add_blockref("b", (0, 0))


def another_file(document, space):
    document.add_xref_def("secret.dxf", "b")
    space.add_blockref("b", (0, 0))


@pytest.mark.parametrize(
    ("fill", "why"),
    [
        (doubled_blocks, "copies"),
        (doubled_empty_blocks, "copies"),
        (array_of_blocks, "copies"),
        (lambda document, space: array_of_blocks(document, space, 0), "copies"),
        (long_polyline_again_and_again, "copies"),
        (block_in_itself, "in themselves"),
        (another_file, "is another file"),
        (lambda document, space: space.add_blockref("nowhere", (0, 0)), "is not in the file"),
    ],
)
def test_dxf(dxf, fill, why):
    refused(am.read_domain, dxf(fill), why)


def test_dxf_blocks_in_good_faith(dxf):
    def fill(document, space):
        document.blocks.new("b").add_circle((0, 0), 1)
        document.blocks.new("c").add_blockref("b", (0, 0))
        attributes = {"row_count": 3, "column_count": 4, "row_spacing": 5, "column_spacing": 5}
        space.add_blockref("c", (0, 0), dxfattribs=attributes)
        space.add_linear_dim((0, 20), (0, 0), (1, 0)).render()  # annotation

    assert am.read_domain(dxf(fill)).area == pytest.approx(12 * np.pi, rel=0.1)


# ----------------------------------------------------------------------------------- Gmsh, Medit


@pytest.mark.parametrize(
    "section",
    [
        "$NodeData\n900000\n" + "\n" * 800_000 + "$EndNodeData\n",
        f'$PhysicalNames\n1\n{LONG} 1 "a"\n$EndPhysicalNames\n',
        f'$PhysicalNames\n1\n1 {LONG} "a"\n$EndPhysicalNames\n',
        "$PhysicalNames\n1\n" + " " * 800_000 + "\n$EndPhysicalNames\n",
        '$PhysicalNames\n1\n1 1 "' + '" ' * 400_000 + "x\n$EndPhysicalNames\n",
        "$Adaptmesh\n" + "[" * 100_000 + "\n$EndAdaptmesh\n",
        f'$Adaptmesh\n{{"edges": {{"a": {LONG}}}}}\n$EndAdaptmesh\n',
        f"$Nodes\n{LONG}\n$EndNodes\n",
        "$" + "a" * 800_000,
    ],
)
def test_gmsh(file, section):
    refused(am.read, file("a.msh", "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n" + section))


@pytest.mark.parametrize(
    "text",
    [
        '# adaptmesh edge 1 "' * 40_000 + "x",
        '# adaptmesh edge 1 "a',
        "# adaptmesh region 1",
        f'# adaptmesh region {LONG} "a"',
        '"' * 400_001,
        "Vertices\n" + LONG,
    ],
)
def test_medit(file, text):
    refused(am.read, file("a.mesh", f"MeshVersionFormatted 2\nDimension 2\n{text}\nEnd\n"))


def test_a_view_of_few_rows_is_not_spread_over_many_nodes(file):
    nodes = "".join(f"{i + 1} {i % 100} {i // 100} 0\n" for i in range(5000))
    view = '$NodeData\n1\n"u"\n1\n0\n3\n0\n9000\n1\n1' + " 0" * 9000 + "\n$EndNodeData\n"
    mesh = f"$Nodes\n5000\n{nodes}$EndNodes\n$Elements\n1\n1 2 0 1 2 101\n$EndElements\n"
    path = file("a.msh", "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n" + mesh + view)
    refused(am.io.read_fields, path, "MiB")


def test_rows_longer_than_any():
    from adaptmesh.files.records import BinaryCursor

    for width in (1 << 29, 1 << 40, 10**17):
        with pytest.raises(am.FormatError, match="a count is wrong"):
            BinaryCursor(bytes(100)).rows(0, ("f8", width))
