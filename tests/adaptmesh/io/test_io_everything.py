"""A mesh that has everything that a file may lose, through every format and back."""

import warnings

import numpy as np
import pytest
from reference.transforms import SIMILARITIES

import adaptmesh as am
from adaptmesh import io
from adaptmesh.errors import FormatError, FormatWarning

WAYS = {
    "vtu": ("a.vtu", {}),
    "vtk": ("a.vtk", {}),
    "vtk text": ("a.vtk", {"binary": False}),
    "msh 4.1": ("a.msh", {}),
    "msh 4.1 text": ("a.msh", {"binary": False}),
    "msh 2.2": ("a.msh", {"version": "2.2"}),
    "msh 2.2 text": ("a.msh", {"version": "2.2", "binary": False}),
    "mesh": ("a.mesh", {}),
    "meshb": ("a.meshb", {}),
    "xdmf": ("a.xdmf", {}),
    "ele": ("a.ele", {}),
}
KEEPS_FROZEN = ("mesh", "meshb")
LOSES_PERIODIC = ("meshb",)


def everything(place=lambda points: np.asarray(points, float), tags=None):
    """A square with a disc of another region, periodic sides, a frozen line and a point."""
    ring = np.arange(12) * np.pi / 6
    points = np.array([(0, 0), (4, 0), (4, 3), (0, 3), (0.5, 2.5), (1.5, 2.6)])
    points = np.concatenate([points, 0.7 * np.stack([np.cos(ring), np.sin(ring)], 1) + (2, 1.2)])
    lone = [(3.3, 2.4)]
    k = np.arange(12)
    segments = [(0, 1), (1, 2), (2, 3), (3, 0), (4, 5), *zip(6 + k, 6 + (k + 1) % 12, strict=True)]
    seeds = place([(2, 1.2), (0.3, 0.3)])
    domain = am.Domain(
        np.concatenate([place(points), place(lone)]),
        segments,
        names={
            'the "left" | side': [3], "right|Ä ∞": [1], "crack": [4], "left": [0], 17: [2],
        },
        regions={"Öl, heiß": seeds[0], "rest of | it": seeds[1]},
        tags=tags,
    )  # fmt: skip
    shift = place([(4, 0)])[0] - place([(0, 0)])[0]
    domain = domain.with_periodic('the "left" | side', "right|Ä ∞", translation=shift)
    size = 0.5 * float(np.hypot(*shift)) / 4
    return am.generate(domain.with_frozen("crack"), size)


def written_and_read(folder, way, mesh):
    name, options = WAYS[way]
    if name.endswith(".xdmf"):
        pytest.importorskip("h5py")
    with warnings.catch_warnings(record=True) as caught:
        warnings.simplefilter("always")
        io.write(folder / name, mesh, **options)
    return io.read(folder / name), " ".join(str(w.message) for w in caught)


def assert_same(mesh, back):
    for name in ("points", "triangles", "regions", "edges", "edge_tags"):
        np.testing.assert_array_equal(getattr(mesh, name), getattr(back, name), err_msg=name)
    assert dict(mesh.names) == dict(back.names)
    assert dict(mesh.region_names) == dict(back.region_names)


@pytest.mark.parametrize("place", SIMILARITIES, ids=str)
@pytest.mark.parametrize("way", WAYS)
def test_everything_comes_back_or_is_said(tmp_path, way, place):
    mesh = everything(place)
    back, said = written_and_read(tmp_path, way, mesh)
    assert_same(mesh, back)
    assert ("frozen" in said) == (way not in KEEPS_FROZEN)
    assert ("periodic" in said) == (way in LOSES_PERIODIC)
    if way in KEEPS_FROZEN:
        crack = mesh.edge_tags == mesh.names["crack"]
        assert set(back.required_edges.tolist()) == set(np.flatnonzero(crack).tolist())
    if way in LOSES_PERIODIC:
        return
    for pair, vertices in mesh.periodic_vertices().items():
        np.testing.assert_array_equal(back.periodic_vertices()[pair], vertices)
    again, _ = written_and_read(tmp_path, way, back)  # what is read is written as it was
    assert_same(mesh, again)
    assert again.periodic_vertices().keys() == mesh.periodic_vertices().keys()
    domain = back.to_domain()
    new = am.generate(domain, 0.4 * np.sqrt(domain.area / 12))
    (pairs,) = new.periodic_vertices().values()
    assert len(pairs) > 2
    shift = np.diff(new.points[pairs], axis=1)[:, 0]
    true = place(np.array([(4.0, 0.0)]))[0] - place(np.array([(0.0, 0.0)]))[0]
    np.testing.assert_allclose(
        shift, np.tile(true, (len(pairs), 1)), atol=1e-9 * np.abs(true).max()
    )
    assert new.validate()


@pytest.mark.parametrize("way", WAYS)
def test_tags_of_zero_and_below(tmp_path, way):
    mesh = everything(tags={"crack": 40})
    tags = np.where(mesh.edge_tags == 40, -5, mesh.edge_tags)
    given = {"edges": mesh.edges, "regions": mesh.regions, "region_names": mesh.region_names}
    names = {**mesh.names, "crack": -5, "nothing": 0}
    negative = am.Mesh(mesh.points, mesh.triangles, edge_tags=tags, names=names, **given)
    if way.startswith("msh"):
        with pytest.raises(FormatError, match=r"edge tag -5 is negative.*renumber it"):
            written_and_read(tmp_path, way, negative)
        negative = am.Mesh(
            mesh.points, mesh.triangles, edge_tags=mesh.edge_tags,
            names={**mesh.names, "nothing": 0}, **given,
        )  # fmt: skip
    back, _ = written_and_read(tmp_path, way, negative)
    assert_same(negative, back)


def test_periodic_boundaries_that_are_damaged(tmp_path):
    io.write(tmp_path / "a.mesh", everything())
    text = (tmp_path / "a.mesh").read_text()
    for old, new, says in (
        ("[1.0, 0.0, 0.0, 1.0,", "[2.0, 0.0, 0.0, 1.0,", "no rigid motion"),
        ("[1.0, 0.0, 0.0, 1.0,", "[0.0, 0.0, 1.0,", "not what adaptmesh writes"),
        ('adaptmesh periodic [["the', 'adaptmesh periodic [["no', "is called"),
        ("4.0, 0.0]", "1e999, 0.0]", "no rigid motion|not what|number"),
    ):
        assert old in text
        (tmp_path / "b.mesh").write_text(text.replace(old, new))
        with pytest.raises(FormatError, match=says):
            io.read(tmp_path / "b.mesh")


def test_periodic_boundaries_of_gmsh_are_named(tmp_path):
    io.write(tmp_path / "a.msh", am.Mesh([(0, 0), (1, 0), (0, 1)], [(0, 1, 2)]), binary=False)
    text = (tmp_path / "a.msh").read_text() + "$Periodic\n0\n$EndPeriodic\n"
    (tmp_path / "a.msh").write_text(text)
    with pytest.warns(FormatWarning, match="with_periodic"):
        io.read(tmp_path / "a.msh")


# ------------------------------------------------------------------------------------- without End

BAMG_MESH = """MeshVersionFormatted 0

Dimension
2

Identifier
"G=in.g;, Date: today"

Geometry
"in.g"

Vertices
4
0 0 1
1 0 1
1 1 1
0 1 1

Edges
4
1 2 -3
2 3 -3
3 4 2
4 1 2

Triangles
2
1 2 3 1
1 3 4 1

SubDomainFromMesh
1
3 1 1 1

VertexOnGeometricVertex
0
"""


def test_a_mesh_of_bamg_without_end(tmp_path):
    path = tmp_path / "a.mesh"
    path.write_text(BAMG_MESH)
    with pytest.warns(FormatWarning, match="has no End; taken for whole"):
        mesh = io.read(path)
    assert mesh.edge_tags.tolist() == [-3, -3, 2, 2]
    path.write_text(BAMG_MESH + "End\n")
    assert io.read(path).edge_tags.tolist() == [-3, -3, 2, 2]


@pytest.mark.filterwarnings("ignore::adaptmesh.errors.FormatWarning")
def test_no_edge_is_lost_where_a_mesh_without_end_is_cut(tmp_path):
    path = tmp_path / "a.mesh"
    for size in range(len(BAMG_MESH)):
        path.write_text(BAMG_MESH[:size])
        try:
            mesh = io.read(path)
        except FormatError:
            continue
        assert len(mesh.edges) == 4
