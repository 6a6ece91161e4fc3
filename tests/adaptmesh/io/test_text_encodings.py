"""Text files in every encoding that programs write: each format, read as in UTF-8."""

import codecs

import numpy as np
import pytest
from reference.whole_files import WHOLE, wheel

import adaptmesh as am
from adaptmesh import io
from adaptmesh.errors import FormatError
from adaptmesh.files.encodings import text_of
from adaptmesh.io.formats import OUTLINES

MARKED = {
    "utf-8 with a mark": lambda text: codecs.BOM_UTF8 + text.encode(),
    "utf-16, little end first": lambda text: codecs.BOM_UTF16_LE + text.encode("utf-16-le"),
    "utf-16, big end first": lambda text: codecs.BOM_UTF16_BE + text.encode("utf-16-be"),
}
NO_XML = {
    "utf-32": lambda text: codecs.BOM_UTF32_LE + text.encode("utf-32-le"),
    "lines of Windows": lambda text: text.replace("\n", "\r\n").encode(),
    "lines of old Macs": lambda text: text.replace("\n", "\r").encode(),
}
COMMENTS = {
    ".geo": "// {}\n", ".poly": "# {}\n", ".ele": "# {}\n", ".mesh": "# {}\n", ".g": "# {}\n",
    ".gmesh": "# {}\n", ".sol": "# {}\n", ".svg": "<!-- {} -->", ".vtu": "<!-- {} -->",
    ".xdmf": "<!-- {} -->", ".msh": "$Comments\n{}\n$EndComments\n",
}  # fmt: skip
"""How a comment is added to the end of a text; in Gmsh's as a section."""


def texts():
    """Every way to write a file of text, and the encodings that its reader has to take."""
    for suffix, ways in WHOLE.items():
        if suffix in (".shp", ".dxf", ".meshb", ".solb") or suffix.startswith("history"):
            continue  # binary, or only ours; DXF says its encoding in its header
        for way in ways:
            if way in ("ours", "4.1", "2.2", "5.1", "raw") and suffix in (".vtk", ".msh", ".vtu"):
                continue
            xml = suffix in (".vtu", ".xdmf", ".svg")
            for name in MARKED if xml else {**MARKED, **NO_XML}:
                yield pytest.param(suffix, way, name, id=f"{suffix} {way}, {name}")


def read(path):
    """Arrays and names that a file holds."""
    if path.suffix in (".sol", ".solb"):
        return [io.read_sol(path)], {}
    if path.suffix == ".mtr":
        carried = io.read_metric(path)
        return [carried(carried.points)], {}
    if path.suffix in OUTLINES:
        domain = am.read_domain(path)
        return [domain.points, domain.segments, domain.segment_tags], domain.names
    mesh = io.read(path)
    fields = io.read_fields(path)
    arrays = [mesh.points, mesh.triangles, mesh.edges, mesh.edge_tags, *fields.values()]
    return arrays, {**mesh.names, **mesh.region_names, **dict.fromkeys(fields, 0)}


def assert_same(found, expected):
    assert found[1] == expected[1]
    for a, b in zip(found[0], expected[0], strict=True):
        np.testing.assert_array_equal(a, b)


def text_files(folder):
    for path in folder.iterdir():
        if path.suffix != ".h5":
            yield path, path.read_bytes().decode()


@pytest.mark.parametrize(("suffix", "way", "encoding"), list(texts()))
def test_every_text_format_in_every_encoding(tmp_path, suffix, way, encoding):
    path = WHOLE[suffix][way](tmp_path)
    expected = read(path)
    for file, text in text_files(tmp_path):
        text = text.replace(' encoding="utf-8"', "")
        file.write_bytes({**MARKED, **NO_XML}[encoding](text))
    assert_same(read(path), expected)


@pytest.mark.parametrize("suffix", COMMENTS)
@pytest.mark.parametrize("comment", ["Gerät", "«à» – naïve", "100 µm €"])
def test_comments_in_latin_1(tmp_path, suffix, comment):
    way = {".msh": "4.1 text", ".vtu": "text"}.get(suffix, next(iter(WHOLE[suffix])))
    path = WHOLE[suffix][way](tmp_path)
    expected = read(path)
    text = path.read_bytes().decode().replace(' encoding="utf-8"', "")
    end = "# end\n" if suffix == ".ele" else "</svg>" if suffix == ".svg" else ""
    end = "</VTKFile>" if suffix == ".vtu" else "</Xdmf>" if suffix == ".xdmf" else end
    where = text.rindex(end) if end else len(text)
    added = text[:where] + COMMENTS[suffix].format(comment) + text[where:]
    path.write_bytes(added.encode("cp1252"))
    assert_same(read(path), expected)


def test_names_in_latin_1(tmp_path):
    mesh = wheel()
    renamed = am.Mesh(
        mesh.points, mesh.triangles, mesh.regions, mesh.edges, mesh.edge_tags,
        {"Einlaß": 1}, {"Öl – fœtal": 4},
    )  # fmt: skip
    for name, options in (("a.msh", {"binary": False}), ("b.msh", {"version": "2.2"})):
        am.write(tmp_path / name, renamed, **options)
        data = (tmp_path / name).read_bytes()
        for text in (*renamed.names, *renamed.region_names):
            data = data.replace(text.encode(), text.encode("cp1252"))
        (tmp_path / name).write_bytes(data)
        found = am.read(tmp_path / name)
        assert found.names == renamed.names
        assert found.region_names == renamed.region_names


@pytest.mark.parametrize(
    ("cpg", "language", "encoding"),
    [
        (None, 0, "latin-1"), (None, 0, "utf-8"), (None, 0x03, "cp1252"), (None, 0x57, "latin-1"),
        (None, 0x02, "cp850"), (None, 0x01, "cp437"), (None, 0xC9, "cp1251"), ("", 0, "latin-1"),
        ("UTF-8", 0, "utf-8"), ("ISO-8859-1", 0, "latin-1"), ("88591", 0, "latin-1"),
        ("ANSI 1252", 0, "cp1252"), ("OEM 850", 0, "cp850"), ("65001", 0, "utf-8"),
        ("UTF-8", 0, "latin-1"), ("none such", 0, "latin-1"), ("1251", 0, "cp1251"),
    ],
)  # fmt: skip
def test_names_in_shapefiles(tmp_path, cpg, language, encoding):
    pyshp = pytest.importorskip("shapefile")
    names = ["Дон", "Днепр"] if encoding == "cp1251" else ["Nürnberg", "Besançon"]
    path = tmp_path / "a.shp"
    with pyshp.Writer(str(path), shapeType=pyshp.POLYGON, encoding=encoding) as writer:
        writer.field("Name", "C")
        for i, name in enumerate(names):
            writer.poly([[[i, 0], [i, 1], [i + 1, 1], [i + 1, 0], [i, 0]]])
            writer.record(name)
    path.with_suffix(".cpg").unlink(missing_ok=True)
    if cpg is not None:
        path.with_suffix(".cpg").write_text(cpg)
    data = bytearray(path.with_suffix(".dbf").read_bytes())
    data[29] = language
    path.with_suffix(".dbf").write_bytes(data)
    assert set(am.read_domain(path).region_names) == set(names)


def test_what_is_no_text():
    assert text_of(b"") == ""
    assert text_of(bytes(range(1, 256)))[0x80 - 1] == "\x80"  # some have no meaning in 1252
    for data in (b"a\0b", "text".encode("utf-16-le"), b"\xff\xfe\x00", b"\xff\xfe\x00\xd8"):
        with pytest.raises(ValueError, match="is not a text file"):
            text_of(data)


@pytest.mark.parametrize("suffix", [".geo", ".poly", ".mesh", ".wkt", ".geojson", ".g", ".ele"])
def test_binary_data_is_named(tmp_path, suffix):
    path = tmp_path / f"a{suffix}"
    path.write_bytes(b"\x89PNG\n\n\x1a\n\0\0\0")
    with pytest.raises(FormatError, match="is not a text file: character 8 is a zero byte"):
        am.read_domain(path)
