"""A whole file of every format, with everything that its reader looks at.

`WHOLE` has one or more ways to write each suffix, by name; each puts its files into a folder of
their own, and gives the path that is to be read.
"""

import base64
import json

import numpy as np
import pytest

import adaptmesh as am
from adaptmesh import io

# ------------------------------------------------------------------------------------------ meshes


def wheel():
    """Six triangles around a point, with three tags, a region each, and names."""
    angle = np.arange(6) * np.pi / 3
    points = np.concatenate([np.stack([np.cos(angle), np.sin(angle)], axis=1), [[0, 0]]])
    ring = np.arange(6)
    border = np.stack([ring, (ring + 1) % 6], axis=1)
    triangles = np.column_stack([np.full(6, 6), border])
    return am.Mesh(points, triangles, ring, border, ring % 3, {"in": 1, 'o"ut': 2}, {"steel": 4})


def of_mesh(name, **options):
    def write(folder):
        if name.endswith(".xdmf"):
            pytest.importorskip("h5py")
        mesh = wheel()
        x = mesh.points
        io.write(
            folder / name,
            mesh,
            u=x[:, 0],
            v=x,
            q=np.arange(6),
            metric=0.1 + x[:, 1] ** 2,
            **options,
        )
        return folder / name

    return write


def of_solution(name):
    def write(folder):
        io.write_sol(folder / name, wheel().points)
        return folder / name

    return write


def of_bytes(name, content):
    def write(folder):
        path = folder / name
        path.write_bytes(content.encode() if isinstance(content, str) else content)
        return path

    return write


def vtu(encoding):
    """A .vtu file whose arrays are not compressed, so that damage goes deep."""
    mesh, appended = wheel(), b"_"

    def array(name, values, kind, columns=1):
        nonlocal appended
        head = f'<DataArray type="{kind}" Name="{name}" NumberOfComponents="{columns}" '
        if encoding == "ascii":
            return (
                f'{head}format="ascii">{" ".join(map(repr, values.ravel().tolist()))}</DataArray>'
            )
        data = values.astype(kind.lower()).tobytes()
        data = np.array(len(data), "<u8").tobytes() + data
        if encoding == "base64":
            return f'{head}format="binary">{base64.b64encode(data).decode()}</DataArray>'
        out = f'{head}format="appended" offset="{len(appended) - 1}"/>'
        appended += data
        return out

    x = np.column_stack([mesh.points, np.zeros(7)])
    vertices = np.concatenate([mesh.triangles.ravel(), mesh.edges.ravel()])
    ends = np.concatenate([np.arange(3, 19, 3), np.arange(20, 31, 2)])
    grid = (
        '<?xml version="1.0"?>\n<VTKFile type="UnstructuredGrid" version="1.0" '
        'byte_order="LittleEndian" header_type="UInt64">\n<UnstructuredGrid>\n<FieldData>\n'
        '<DataArray type="Int32" Name="edge_tags: in" NumberOfTuples="1" format="ascii">1'
        '</DataArray>\n</FieldData>\n<Piece NumberOfPoints="7" NumberOfCells="12">\n<PointData>\n'
        f"{array('u', mesh.points[:, 0], 'Float32')}\n{array('v', x, 'Float64', 3)}\n</PointData>\n"
        f"<CellData>\n{array('regions', np.arange(12), 'Int32')}\n</CellData>\n"
        f"<Points>\n{array('Points', x, 'Float64', 3)}\n</Points>\n"
        f"<Cells>\n{array('connectivity', vertices, 'Int64')}\n"
        f"{array('offsets', ends, 'Int32')}\n{array('types', np.repeat([5, 3], 6), 'UInt8')}\n"
        "</Cells>\n</Piece>\n</UnstructuredGrid>\n"
    ).encode()
    if encoding == "raw":
        grid += b'<AppendedData encoding="raw">\n' + appended + b"\n</AppendedData>\n"
    return of_bytes("a.vtu", grid + b"</VTKFile>\n")


def vtk_by_vtk(binary):
    """A .vtk file that VTK itself has written."""

    def write(folder):
        pyvista = pytest.importorskip("pyvista")
        io.write(folder / "a.vtu", wheel(), u=np.arange(7.0), v=wheel().points)
        grid = pyvista.read(folder / "a.vtu")
        grid.field_data["words"] = ["one", "two words"]
        (folder / "a.vtu").unlink()
        grid.save(folder / "a.vtk", binary=binary)
        return folder / "a.vtk"

    return write


VTK_POLYGONS = """\
# vtk DataFile Version 2.0
a square of two triangles, and its sides
ASCII
DATASET POLYDATA
POINTS 4 float
0 0 0  1 0 0  1 1 0  0 1 0
LINES 4 12
2 0 1  2 1 2  2 2 3  2 3 0
POLYGONS 2 8
3 0 1 2
3 0 2 3
CELL_DATA 6
SCALARS edge_tags int 1
LOOKUP_TABLE default
1 1 2 3 0 0
SCALARS regions int 1
LOOKUP_TABLE default
0 0 0 0 1 2
POINT_DATA 4
SCALARS u double
LOOKUP_TABLE mine
0 1 2 3
LOOKUP_TABLE mine 2
0 0 0 1  1 1 1 1
VECTORS w float
0 0 1  0 0 2  0 0 3  0 0 4
TENSORS t float
1 0 0 0 1 0 0 0 1  1 0 0 0 1 0 0 0 1  1 0 0 0 1 0 0 0 1  1 0 0 0 1 0 0 0 1
TEXTURE_COORDINATES xy 2 float
0 0 1 0 1 1 0 1
COLOR_SCALARS c 1
0 0.5 0.5 1
FIELD more 1
q 1 4 long
5 6 7 8
"""


def inline_xdmf():
    mesh = wheel()

    def item(values, kind):
        rows = "\n".join(
            " ".join(map(repr, row)) for row in values.reshape(len(values), -1).tolist()
        )
        shape = " ".join(map(str, values.shape))
        return f'<DataItem Dimensions="{shape}" NumberType="{kind}" Format="XML">{rows}</DataItem>'

    mixed = np.concatenate(
        [np.column_stack([np.full(6, 4), mesh.triangles]).ravel(), [2, 2, 0, 1, 2, 2, 1, 2]]
    )
    return of_bytes(
        "a.xdmf",
        '<Xdmf Version="3.0"><Domain>\n'
        '<Information Name="region_names" Value="{&quot;a&quot;: 1}"/>'
        '<Grid Name="mesh">\n<Topology TopologyType="Mixed" NumberOfElements="8">'
        f"{item(mixed, 'Int')}</Topology>\n"
        f'<Geometry GeometryType="XY">{item(mesh.points, "Float")}</Geometry>\n'
        f'<Attribute Name="u" Center="Node">{item(mesh.points[:, 0], "Float")}</Attribute>\n'
        "</Grid>\n"
        '<Grid Name="tags"><Topology TopologyType="Triangle">'
        f"{item(mesh.triangles, 'Int')}</Topology>\n"
        f'<Attribute Name="regions" Center="Cell">{item(mesh.regions, "Int")}</Attribute></Grid>'
        "</Domain></Xdmf>",
    )


# ------------------------------------------------------------------------------------- domains

FRAME = """\
# a square with a square hole, and a line down the middle of its left part
8 2 0 1
1  0 0  0\n2  3 0  0\n3  3 3  0\n4  0 3  0
5  1 1  0   # the hole
6  2 1  0\n7  2 2  0\n8  1 2  0
8 1
1  1 2  2\n2  2 3  3\n3  3 4  2\n4  4 1  0
5  5 6  7\n6  6 7  7\n7  7 8  7\n8  8 5  7
1
1  1.5 1.5
1
1  0.5 0.5  12.5 -1
"""


def poly_and_node(folder):
    nodes, _, rest = FRAME.partition("8 1\n")
    (folder / "a.node").write_text(nodes)
    (folder / "a.poly").write_text(f"0 2 0 1\n8 1\n{rest}")
    return folder / "a.poly"


SQUARE = [[0, 0], [3, 0], [3, 3], [0, 3], [0, 0]]
HOLE = [[1, 1], [1, 2], [2, 2], [2, 1], [1, 1]]
NEXT = [[3, 0], [5, 0], [5, 3], [3, 3], [3, 0]]

GEOJSON = {
    "type": "FeatureCollection",
    "features": [
        {
            "type": "Feature",
            "properties": {"name": "land"},
            "geometry": {"type": "Polygon", "coordinates": [SQUARE, HOLE]},
        },
        {
            "type": "Feature",
            "properties": {},
            "geometry": {"type": "MultiPolygon", "coordinates": [[[[*p, 7.5] for p in NEXT]]]},
        },
    ],
}

WKT = """\
SRID=4326; POLYGON ((0 0, 0 3, 3 3, 3 0, 0 0), (1 1, 2 1, 2 2, 1 2, 1 1))
MULTIPOLYGON Z (((3 0 7.5, 3 3 7.5, 5 3 7.5, 5 0 7.5, 3 0 7.5)))
"""

GEO = """\
lc = 0.1; r = 0.25; /* over
two lines */ SetFactory("Built-in");
Point(1) = {0, 0, 0, lc}; Point(2) = {2, 0, 0}; Point(3) = {2, 1, 0}; Point(4) = {0, 1, 0};
Line(1) = {1, 2}; Line(2) = {2, 3}; Spline(3) = {3, 4}; Line(4) = {4, 1};
Curve Loop(1) = {1:4};
c = newp; Point(c) = {1, .5, 0};
p[] = {};
For k In {0:3}
  q = newp; Point(q) = {1 + r*Cos(k*Pi/2), .5 + r*Sin(k*Pi/2), 0};
  p[] += q;
EndFor
cs[] = {};
For k In {0:#p[]-1}
  l = newl; Circle(l) = {p[k], c, p[(k+1) % 4]}; cs[] += l;
EndFor
Line Loop(2) = {cs[]};
Plane Surface(1) = {1, 2};
Plane Surface(2) = {2};
Point(30) = {1, .5, 0}; Point{30} In Surface{2};
Physical Curve("wall", 7) = {1, -3}; Physical Line(9) = {2};
Physical Surface("plate", 3) = {1}; Physical Surface("disc") = {2};
Mesh.Algorithm = 6; Transfinite Curve{1} = 10 Using Progression 1.2;
If (r > 1)
  nonsense
ElseIf (r > .2)
  Field[1] = Distance;
Else
  more nonsense
EndIf
"""


def bamg():
    angle = np.arange(8) * np.pi / 4
    octagon = np.stack([np.cos(angle), np.sin(angle)], axis=1)
    vertices = "".join(f"{x!r} {y!r} 1\n" for x, y in octagon.tolist())
    edges = "".join(f"{i + 1} {(i + 1) % 8 + 1} {i % 3}\n" for i in range(8))
    return (
        "MeshVersionFormatted 0\nAngleOfCornerBound 46\nDimension 2\n# by hand\n"
        f"Vertices 8\n{vertices}Edges 8\n{edges}hVertices\n{'0.1 ' * 8}\nCorners 1\n1\n"
        "RequiredVertices 1\n2\nTangentAtEdges 2\n1 1 0 5\n4 2 -1 -2\nSubDomain 1\n2 1 1 7\nEnd\n"
    )


SVG = """\
<svg xmlns="http://www.w3.org/2000/svg" width="100" height="100" viewBox="0 0 100 100">
<g transform="rotate(30) scale(1, -1)">
<path id="outer" d="M0,0 L10,0 A5,5 0 0 1 10,10 Q 5 12 0 10 C 1 9 2 5 0 0 Z"/>
<circle id="hole" cx="5" cy="5" r="2"/></g><text>label</text>
<rect id="box" x="40" y="40" width="10" height="20" rx="1"/>
<polygon points="60,60 70,60 70,75"/>
</svg>
"""


def dxf(folder):
    ezdxf = pytest.importorskip("ezdxf")
    document = ezdxf.new("R12")
    document.layers.add("wall")
    space = document.modelspace()
    space.add_polyline2d([(0, 0, 0.3), (4, 0, 0.5), (4, 2, 0), (0, 2, -0.3)], "xyb", close=True)
    space.add_circle((1, 1), 0.4, dxfattribs={"layer": "wall"})
    space.add_line((2, 0.5), (3, 1.5))
    space.add_arc((3.5, 1), 0.2, 350, 10)
    document.saveas(folder / "a.dxf")
    # Of the file as it is only every hundredth byte says where a line goes.
    text = (folder / "a.dxf").read_text()
    at = text.index("  0\nSECTION\n  2\nENTITIES")
    (folder / "a.dxf").write_text(text[at:])
    return folder / "a.dxf"


def dxf_of_splines(folder):
    ezdxf = pytest.importorskip("ezdxf")
    document = ezdxf.new("R2000")
    space = document.modelspace()
    space.add_ellipse((2.5, -1), (0.5, 0.2), 0.4)
    space.add_rational_spline([(1, 0), (1.5, 1), (2, 0), (3, 1)], [1, 2, 1, 3])
    space.add_lwpolyline([(0, -2, 0.3), (4, -2, 0.5), (4, 2, 0), (0, 2, -0.3)], "xyb", close=True)
    document.saveas(folder / "a.dxf")
    return folder / "a.dxf"


def shapefile(folder):
    pyshp = pytest.importorskip("shapefile")
    with pyshp.Writer(str(folder / "a.shp"), shapeType=pyshp.POLYGON, encoding="utf-8") as writer:
        writer.field("id", "N")
        writer.field("NAME", "C")
        for i, rings in enumerate([[SQUARE, HOLE], [NEXT]]):
            writer.poly([ring[::-1] for ring in rings])
            writer.record(i, "ab"[i])
    return folder / "a.shp"


# --------------------------------------------------------------------------------------- histories


def history(folder):
    mesh = am.generate(am.Domain.rectangle(0, 0, 1, 1), 0.5)
    solve = lambda m: {"u": m.points[:, 0] ** 2, "v": m.points[:, 1]}  # noqa: E731
    am.adapt_loop(solve, mesh, target_vertices=40, max_iterations=1, save=folder)
    return folder / "history.json"


def history_in_time(folder):
    mesh = am.generate(am.Domain.rectangle(0, 0, 1, 1), 0.5)
    am.transient_loop(
        lambda m, u, start, end: u,
        lambda m: m.points[:, 0] ** 2,
        mesh,
        [0, 1],
        sweeps=1,
        target_vertices=40,
        save=folder,
    )
    return folder / "transient.json"


def sizes_of_bamg(folder):
    io.write(folder / "a.mesh", wheel())
    (folder / "a.mtr").write_text("7 1\n" + "0.5\n" * 7)
    return folder / "a.mtr"


WHOLE = {
    ".vtu": {
        "ours": of_mesh("a.vtu"),
        "text": vtu("ascii"),
        "base64": vtu("base64"),
        "raw": vtu("raw"),
    },
    ".vtk": {
        "ours": of_mesh("a.vtk"),
        "our text": of_mesh("a.vtk", binary=False),
        "5.1": vtk_by_vtk(True),
        "5.1 text": vtk_by_vtk(False),
        "polygons": of_bytes("a.vtk", VTK_POLYGONS),
    },
    ".msh": {
        "4.1": of_mesh("a.msh"),
        "4.1 text": of_mesh("a.msh", binary=False),
        "2.2": of_mesh("a.msh", version="2.2"),
        "2.2 text": of_mesh("a.msh", version="2.2", binary=False),
    },
    ".mesh": {"ours": of_mesh("a.mesh")},
    ".meshb": {"ours": of_mesh("a.meshb")},
    ".xdmf": {"ours": of_mesh("a.xdmf"), "inline": inline_xdmf()},
    ".ele": {"ours": of_mesh("a.ele")},
    ".sol": {"ours": of_solution("a.sol")},
    ".solb": {"ours": of_solution("a.solb")},
    ".poly": {"points": of_bytes("a.poly", FRAME), "node": poly_and_node},
    ".geojson": {"features": of_bytes("a.geojson", json.dumps(GEOJSON, indent=1))},
    ".json": {"geometry": of_bytes("a.json", json.dumps(GEOJSON["features"][0]["geometry"]))},
    ".wkt": {"polygons": of_bytes("a.wkt", WKT)},
    ".geo": {"plate": of_bytes("a.geo", GEO)},
    ".g": {"octagon": of_bytes("a.g", bamg())},
    ".gmesh": {"octagon": of_bytes("a.gmesh", bamg())},
    ".svg": {"shapes": of_bytes("a.svg", SVG)},
    ".dxf": {"R12": dxf, "R2000": dxf_of_splines},
    ".shp": {"polygons": shapefile},
    ".mtr": {"sizes": sizes_of_bamg},
    "history": {"two fields": history},
    "history in time": {"one field": history_in_time},
}
"""Ways to write each suffix, by name; each takes a folder and gives the path of the file."""
