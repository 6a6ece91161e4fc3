"""Required vertices and edges: from files to domains, through meshes, and to files again."""

import numpy as np
import pytest

import adaptmesh as am
from adaptmesh import io
from adaptmesh.errors import FormatError
from adaptmesh.io.required import required_items

SUFFIXES = [".mesh", ".meshb"]


def plate():
    """A square with a point in the middle, one on its bottom, and a top that is not cut."""
    points = [(0, 0), (0.3, 0), (1, 0), (1, 1), (0.6, 1), (0, 1), (0.5, 0.5)]
    ring = [(k, (k + 1) % 6) for k in range(6)]
    names = {"top": [3, 4], "rest": [0, 1, 2, 5]}
    return am.Domain(points, ring, names=names).with_frozen("top")


def places(points):
    return set(map(tuple, points.tolist()))


def edge_places(mesh, edges):
    return {frozenset(map(tuple, e)) for e in mesh.points[edges].tolist()}


@pytest.mark.parametrize("suffix", SUFFIXES)
def test_there_and_back(tmp_path, suffix):
    domain = plate()
    mesh = am.generate(domain, 0.1)
    path = tmp_path / f"a{suffix}"
    io.write(path, mesh)
    back = io.read(path)
    assert places(back.points[back.required_points]) == places(domain.points)
    top = edge_places(back, back.edges[back.required_edges])
    assert top == edge_places(mesh, mesh.edges_named("top"))

    again = am.read_domain(path)
    assert places(again.points) == places(domain.points)
    assert len(again.segments) == 6
    assert again.names == domain.names
    np.testing.assert_array_equal(again.segment_is_frozen, again.segment_tags == again.names["top"])
    for coarse in (am.generate(again, 0.25), am.adapt(back, 0.25)):
        assert coarse.validate().ok
        assert places(domain.points) <= places(coarse.points)
        assert edge_places(coarse, coarse.edges_named("top")) == top

    io.write(tmp_path / f"b{suffix}", back)  # a mesh without domain keeps them
    third = io.read(tmp_path / f"b{suffix}")
    np.testing.assert_array_equal(third.required_points, back.required_points)
    np.testing.assert_array_equal(third.required_edges, back.required_edges)


def test_borders_as_curves_stop_at_required_vertices(tmp_path):
    circle = am.Domain.from_curves([am.curves.Circle((0, 0), 1)])
    mesh = am.generate(circle, 0.2)
    rim = mesh.edges[::7]
    marked = am.Mesh(
        mesh.points,
        mesh.triangles,
        edges=mesh.edges,
        required_edges=np.arange(0, len(mesh.edges), 7),
    )
    io.write(tmp_path / "a.mesh", marked)
    domain = io.read(tmp_path / "a.mesh").to_domain(corner_angle=40)
    assert domain.segment_is_frozen.sum() == len(rim)
    for size in (0.05, 0.5):
        new = am.generate(domain, size)
        assert new.validate().ok
        assert edge_places(mesh, rim) <= edge_places(new, new.edges)


def test_only_points_of_the_domain_are_required_of_a_curved_one():
    mesh = am.generate(am.Domain.from_curves([am.curves.Circle((0, 0), 1)]), 0.2)
    points, edges = required_items(mesh)
    assert mesh.points[points].tolist() == [[1, 0]]  # where the circle starts
    assert not len(edges)


SQUARE = """MeshVersionFormatted 2
Dimension 2
Vertices 6
0 0 0\n0.5 0 0\n1 0 0\n1 1 0\n0 1 0\n9 9 0
Edges 5
1 2 1\n2 3 1\n3 4 1\n4 5 1\n5 1 1
Triangles 3
1 2 5 0\n2 4 5 0\n2 3 4 0
{}
End
"""


def read_square(tmp_path, keyword):
    (tmp_path / "a.mesh").write_text(SQUARE.format(keyword))
    return am.read_domain(tmp_path / "a.mesh")


def test_corners_are_points_and_ridges_say_nothing(tmp_path):
    assert len(read_square(tmp_path, "Ridges 1\n1").points) == 4
    assert len(read_square(tmp_path, "Corners 1\n2").points) == 5
    assert len(read_square(tmp_path, "RequiredVertices 1\n2\nCorners 2\n1 2").points) == 5
    # the sixth belongs to no triangle
    assert len(read_square(tmp_path, "RequiredVertices 1\n6").points) == 4


@pytest.mark.parametrize(
    ("keyword", "says"),
    [
        ("RequiredVertices 1\n7", "required vertex 0 has number 6; there are 0 to 5"),
        ("Corners 1\n0", "required vertex 0 has number -1"),
        ("RequiredEdges 2\n1 6", "required edge 1 has number 5; there are 0 to 4"),
    ],
)
def test_numbers_that_are_not_there(tmp_path, keyword, says):
    with pytest.raises(FormatError, match=rf"a\.mesh: {says}"):
        read_square(tmp_path, keyword)


@pytest.mark.parametrize("suffix", SUFFIXES)
def test_mmg_keeps_them(tmp_path, suffix):
    mmgpy = pytest.importorskip("mmgpy")
    domain = plate()
    mesh = am.generate(domain, 0.1)
    io.write(tmp_path / f"a{suffix}", mesh)
    theirs = mmgpy.MmgMesh2D(str(tmp_path / f"a{suffix}"))
    theirs.remesh(hsiz=0.4, verbose=-1)
    theirs.save(str(tmp_path / "b.mesh"))
    new = io.read(tmp_path / "b.mesh")
    assert len(new.points) < len(mesh.points) / 4
    assert places(domain.points) <= places(new.points)
    assert edge_places(mesh, mesh.edges_named("top")) <= edge_places(new, new.edges)
