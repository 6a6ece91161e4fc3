"""Meshes as objects of other libraries, and back; the solvers are in test_convert_solvers.py."""

from __future__ import annotations

import subprocess
import sys

import meshio
import numpy as np
import pytest
import pyvista as pv

import adaptmesh as am
from adaptmesh import convert
from adaptmesh.mesh.mesh import Mesh

MESH = Mesh(
    [[0, 0], [1, 0], [1, 1], [0, 1]],
    [[0, 1, 2], [0, 2, 3]],
    regions=[1, 2],
    edges=[[0, 1], [1, 2], [2, 3]],
    edge_tags=[5, 0, 5],
    names={"wall": 5},
    region_names={"steel": 1},
)


def labelled(mesh):
    """Named regions and edges by name, whatever their order and numbers."""
    pairs = np.sort(mesh.edges, axis=1).tolist()
    tag_name = {tag: name for name, tag in mesh.names.items()}
    region_name = {number: name for name, number in mesh.region_names.items()}
    edges = {
        tuple(p): tag_name[t] for p, t in zip(pairs, mesh.edge_tags.tolist(), strict=True) if t
    }
    return edges, [region_name.get(r) for r in mesh.regions.tolist()]


def assert_same(back, mesh):
    np.testing.assert_array_equal(back.points, mesh.points)
    np.testing.assert_array_equal(np.sort(back.triangles, axis=1), np.sort(mesh.triangles, axis=1))
    assert (back.areas > 0).all()
    assert labelled(back) == labelled(mesh)


@pytest.fixture
def mesh(plate):
    return am.generate(plate, 0.2)


def test_nothing_of_others_is_loaded_with_the_package():
    others = ["skfem", "netgen", "dolfinx", "meshio", "pyvista", "matplotlib", "mpi4py"]
    script = f"""
import sys, adaptmesh, adaptmesh.convert
print([name for name in {others} if name in sys.modules])
"""
    done = subprocess.run([sys.executable, "-c", script], capture_output=True, text=True)
    assert done.stdout.splitlines()[-1:] == ["[]"], done.stderr


# --- pyvista ---------------------------------------------------------------------------------


def test_grid_holds_triangles_lines_and_fields():
    grid = convert.to_pyvista(MESH, u=[0.0, 1.0, 2.0, 1.0], flux=[[1.0, 2.0], [3.0, 4.0]])
    assert (grid.n_points, grid.n_cells) == (4, 5)
    np.testing.assert_array_equal(grid.points[:, :2], MESH.points)
    assert grid.points.dtype == np.float64
    np.testing.assert_array_equal(grid.cell_data["region"], [1, 2, 0, 0, 0])
    np.testing.assert_array_equal(grid.cell_data["tag"], [0, 0, 5, 0, 5])
    np.testing.assert_allclose(grid.cell_data["quality"][:2], 3**0.5 / 2)
    np.testing.assert_array_equal(grid.point_data["u"], [0, 1, 2, 1])
    np.testing.assert_array_equal(grid.cell_data["flux"][:2], [[1, 2], [3, 4]])
    assert list(grid.field_data["names"]) == ["5 wall"]
    assert grid.compute_cell_sizes().cell_data["Area"].sum() == pytest.approx(1)


@pytest.mark.parametrize("to", [convert.to_pyvista, convert.to_meshio])
def test_field_that_does_not_fit_is_refused(to):
    with pytest.raises(ValueError, match="'u': expected"):
        to(MESH, u=np.zeros(3))


def test_field_with_a_name_that_is_taken_is_refused():
    with pytest.raises(ValueError, match="taken"):
        convert.to_pyvista(MESH, region=np.zeros(2))


def test_pyvista_there_and_back(mesh):
    back = convert.from_pyvista(convert.to_pyvista(mesh))
    assert_same(back, mesh)
    assert (dict(back.names), dict(back.region_names)) == (mesh.names, mesh.region_names)


def test_surface_of_pyvista_without_numbers():
    back = convert.from_pyvista(pv.Plane(i_resolution=2, j_resolution=3).triangulate())
    assert len(back.triangles) == 12
    assert len(back.edges) == 10  # the border is found
    assert am.adapt(back, 0.1).areas.sum() == pytest.approx(1)


def test_pyvista_with_other_cells_or_out_of_the_plane_is_refused():
    with pytest.raises(am.FormatError, match=r"grid of pyvista: point .* z is not 0"):
        convert.from_pyvista(pv.Sphere())
    with pytest.raises(am.FormatError, match="6 quad"):
        convert.from_pyvista(pv.Plane(i_resolution=2, j_resolution=3))


# --- meshio ----------------------------------------------------------------------------------


def test_meshio_there_and_back(mesh):
    there = convert.to_meshio(mesh, u=mesh.points[:, 0], q=mesh.areas)
    assert list(there.point_data) == ["u"]
    np.testing.assert_array_equal(there.cell_data["q"][0], mesh.areas)
    back = convert.from_meshio(there)
    assert_same(back, mesh)
    assert (dict(back.names), dict(back.region_names)) == (mesh.names, mesh.region_names)


@pytest.mark.parametrize("kind", ["gmsh22", "vtu", "xdmf"])
def test_meshio_writes_and_reads_it(mesh, tmp_path, kind):
    if kind == "xdmf":
        pytest.importorskip("h5py")
    path = tmp_path / {"gmsh22": "a.msh", "vtu": "a.vtu", "xdmf": "a.xdmf"}[kind]
    meshio.write(path, convert.to_meshio(mesh, u=mesh.points[:, 0]), file_format=kind)
    read = meshio.read(path, file_format=kind.removesuffix("22"))
    np.testing.assert_array_equal(read.point_data["u"], mesh.points[:, 0])
    back = convert.from_meshio(read)
    np.testing.assert_array_equal(back.regions, mesh.regions)
    if kind == "gmsh22":
        assert_same(back, mesh)
        assert_same(am.read(path), mesh)  # and so do we


def test_sets_of_meshio_become_names():
    sets = {"left": [[0], [], []], "rim": [[], [0, 1], [0]], "gmsh:bounding": [[0], [], []]}
    cells = [("triangle", [[0, 1, 2], [0, 3, 2]]), ("line", [[0, 1], [1, 2]]), ("line", [[2, 3]])]
    m = meshio.Mesh(MESH.points, cells, cell_sets=sets)
    back = convert.from_meshio(m)
    assert labelled(back) == ({(0, 1): "rim", (1, 2): "rim", (2, 3): "rim"}, ["left", None])
    assert back.domain is None
    assert "rim" in am.adapt(back, 0.3).names


def test_cells_in_two_sets_of_meshio_have_both_names():
    sets = {"a": [[0, 1]], "b": [[1]]}
    m = meshio.Mesh(MESH.points, [("triangle", MESH.triangles)], cell_sets=sets)
    with pytest.warns(am.FormatWarning, match=r"several sets .* 'a\|b'"):
        back = convert.from_meshio(m)
    assert [back.triangles_in(name).tolist() for name in ("a", "a|b")] == [[0], [1]]


def test_meshio_with_other_cells_is_refused():
    with pytest.raises(am.FormatError, match="1 quad"):
        convert.from_meshio(meshio.Mesh(MESH.points, [("quad", [[0, 1, 2, 3]])]))
    m = meshio.Mesh(
        MESH.points, [("triangle", MESH.triangles)], cell_data={"medit:ref": [[1, 2]]},
        field_data={"steel": [1]},
    )  # fmt: skip
    with pytest.raises(am.FormatError, match=r"field_data\['steel'\]"):
        convert.from_meshio(m)


# --- matplotlib ------------------------------------------------------------------------------


def test_matplotlib_there_and_back(mesh):
    tri = pytest.importorskip("matplotlib.tri")
    there = convert.to_matplotlib(mesh)
    value = tri.LinearTriInterpolator(there, mesh.points @ [1.0, 2.0])(3.1, 0.7)
    assert float(value) == pytest.approx(4.5)
    there.set_mask(mesh.points[mesh.triangles].mean(axis=1)[:, 0] > 2)
    back = convert.from_matplotlib(there)
    assert len(back.points) == len(mesh.points)
    assert back.areas.sum() == pytest.approx(mesh.areas[~there.mask].sum())
    assert len(back.edges) == count_border(back)


def count_border(mesh):
    keys = np.sort(mesh.triangles[:, [0, 1, 1, 2, 2, 0]].reshape(-1, 2), axis=1)
    _, counts = np.unique(keys, axis=0, return_counts=True)
    return int((counts == 1).sum())
