"""Meshes as objects of solvers, and back: each with the real package, where it is installed."""

from __future__ import annotations

import shutil
import subprocess
from pathlib import Path

import numpy as np
import pytest

import adaptmesh as am
from adaptmesh import convert

SCRIPTS = Path(__file__).parent / "solvers"


@pytest.fixture
def mesh(plate):
    return am.generate(plate, 0.2)


def named_length(mesh, name):
    ends = mesh.points[mesh.edges_named(name)]
    return np.linalg.norm(ends[:, 1] - ends[:, 0], axis=1).sum()


def assert_same(back, mesh):
    """The same points and triangles, and the same length and area under each name."""
    np.testing.assert_array_equal(back.points, mesh.points)
    assert rows(back.triangles) == rows(mesh.triangles)
    assert (back.areas > 0).all()
    assert set(back.names) == set(mesh.names)
    assert set(back.region_names) == set(mesh.region_names)
    for name in mesh.names:
        assert named_length(back, name) == pytest.approx(named_length(mesh, name))
    for name in mesh.region_names:
        here, there = back.triangles_in(name), mesh.triangles_in(name)
        assert rows(back.triangles[here]) == rows(mesh.triangles[there])


def rows(triangles):
    return sorted(map(tuple, np.sort(triangles, axis=1).tolist()))


def assert_adapts(back, mesh):
    """What came back has a domain, with all names."""
    fine = am.adapt(back, 0.15)
    assert fine.areas.sum() == pytest.approx(mesh.areas.sum())
    for name in mesh.names:
        assert named_length(fine, name) == pytest.approx(named_length(mesh, name))
    for name in mesh.region_names:
        area = mesh.areas[mesh.triangles_in(name)].sum()
        assert fine.areas[fine.triangles_in(name)].sum() == pytest.approx(area)


# --- scikit-fem ------------------------------------------------------------------------------


@pytest.fixture
def skfem():
    return pytest.importorskip("skfem")


def test_skfem_there_and_back(skfem, mesh):
    m = convert.to_skfem(mesh)
    assert set(m.boundaries) == {"bottom", "interface", "hole"}
    assert m.is_valid()
    bottom = m.p[:, m.facets[:, m.boundaries["bottom"]]]
    np.testing.assert_array_equal(bottom[1], 0)
    back = convert.from_skfem(m)
    assert_same(back, mesh)
    assert_adapts(back, mesh)


def test_skfem_solves_on_it(skfem, mesh):
    """u = 2 x + y, harmonic, from its values on the whole border; the flux through a name."""
    m = convert.to_skfem(mesh)
    basis = skfem.Basis(m, skfem.ElementTriP2())
    stiffness = skfem.BilinearForm(lambda u, v, w: u.grad[0] * v.grad[0] + u.grad[1] * v.grad[1])
    exact = basis.project(lambda x: 2 * x[0] + x[1])
    border = basis.get_dofs(m.boundary_facets())
    u = skfem.solve(*skfem.condense(stiffness.assemble(basis), x=exact, D=border))
    np.testing.assert_allclose(u[basis.nodal_dofs[0]], mesh.points @ [2, 1], atol=1e-12)
    through = skfem.FacetBasis(m, skfem.ElementTriP2(), facets=m.boundaries["bottom"])
    flux = skfem.Functional(lambda w: w["u"].grad[1] * w.n[1]).assemble(
        through, u=through.interpolate(u)
    )
    assert flux == pytest.approx(-4)
    copper = skfem.Basis(m, skfem.ElementTriP0(), elements=m.subdomains["right"])
    area = skfem.Functional(lambda w: 1 + 0 * w.x[0]).assemble(copper)
    assert area == pytest.approx(4)


def test_mesh_of_skfem_with_names_of_its_own(skfem):
    m = skfem.MeshTri.init_lshaped().refined(2)
    m = m.with_boundaries({"left": lambda x: x[0] == -1, "all": lambda x: x[0] < 9})
    m = m.with_subdomains({"low": lambda x: x[1] < 0})
    with pytest.raises(am.FormatError, match=r"MeshTri: facet .* both 'left' and 'all'"):
        convert.from_skfem(m)
    back = convert.from_skfem(m, boundaries=["left"])
    assert named_length(back, "left") == pytest.approx(2)
    assert am.validate(back)
    fine = am.adapt(back, 0.1)  # the interface, which bears no name, is kept
    assert fine.areas[fine.triangles_in("low")].sum() == pytest.approx(2)
    with pytest.raises(am.FormatError, match="no element is in a set 'high'"):
        convert.from_skfem(m, boundaries=["left"], subdomains=["high"])


def test_boundary_of_skfem_with_an_orientation(skfem):
    m = skfem.MeshTri().refined(2).with_subdomains({"a": lambda x: x[0] < 0.5})
    m = m.with_boundaries({"between": m.facets_around("a")})
    assert named_length(convert.from_skfem(m), "between") == pytest.approx(3)


def test_other_meshes_of_skfem_are_refused(skfem):
    straight = skfem.MeshTri().refined(1)
    for m in (skfem.MeshQuad(), skfem.MeshTri2.from_mesh(straight), skfem.MeshTet()):
        with pytest.raises(am.FormatError, match="not a plane MeshTri"):
            convert.from_skfem(m)


def test_tags_without_a_name_are_called_by_their_number(skfem):
    square = am.Mesh(
        [[0, 0], [1, 0], [1, 1], [0, 1]], [[0, 1, 2], [0, 2, 3]], regions=[0, 7],
        edges=[[0, 1], [1, 2]], edge_tags=[3, 0],
    )  # fmt: skip
    m = convert.to_skfem(square)
    assert set(m.boundaries) == {"3"}
    assert m.subdomains["7"].tolist() == [1]
    assert convert.to_skfem(am.Mesh(square.points, square.triangles)).boundaries is None


# --- NGSolve ---------------------------------------------------------------------------------


@pytest.fixture
def ngsolve():
    return pytest.importorskip("ngsolve")


def test_netgen_there_and_back(ngsolve, mesh):
    for m in (convert.to_netgen(mesh), ngsolve.Mesh(convert.to_netgen(mesh))):
        back = convert.from_netgen(m)
        assert_same(back, mesh)
        assert_adapts(back, mesh)


def test_ngsolve_solves_on_it(ngsolve, mesh):
    """u = 2 x + y, harmonic, from its values on the whole border; lengths and areas by name."""
    m = ngsolve.Mesh(convert.to_netgen(mesh))
    assert ngsolve.Integrate(1, m, definedon=m.Materials("right")) == pytest.approx(4)
    on_bottom = m.Boundaries("bottom")
    assert ngsolve.Integrate(1, m, ngsolve.BND, definedon=on_bottom) == pytest.approx(4)
    space = ngsolve.H1(m, order=2, dirichlet="bottom|hole|default")
    u, v = space.TnT()
    a = ngsolve.BilinearForm(ngsolve.grad(u) * ngsolve.grad(v) * ngsolve.dx).Assemble()
    solution = ngsolve.GridFunction(space)
    solution.Set(2 * ngsolve.x + ngsolve.y, definedon=m.Boundaries("bottom|hole|default"))
    residual = -a.mat * solution.vec
    solution.vec.data += a.mat.Inverse(space.FreeDofs()) * residual
    values = solution.vec.FV().NumPy()[: m.nv]
    np.testing.assert_allclose(values, mesh.points @ [2, 1], atol=1e-10)


def test_mesh_of_netgen_with_two_materials(ngsolve):
    geometry = pytest.importorskip("netgen.geom2d").SplineGeometry()
    p = [geometry.AppendPoint(*x) for x in [(0, 0), (1, 0), (2, 0), (2, 1), (1, 1), (0, 1)]]
    for a, b, left, right, name in [
        (0, 1, 1, 0, "wall"), (1, 2, 2, 0, "wall"), (2, 3, 2, 0, "out"), (3, 4, 2, 0, "wall"),
        (4, 5, 1, 0, "wall"), (5, 0, 1, 0, "in"), (1, 4, 1, 2, "between"),
    ]:  # fmt: skip
        segment = ["line", p[a], p[b]]
        geometry.Append(segment, leftdomain=left, rightdomain=right, bc=name)
    geometry.SetMaterial(1, "steel")
    back = convert.from_netgen(geometry.GenerateMesh(maxh=0.3))
    assert am.validate(back)
    assert named_length(back, "wall") == pytest.approx(4)
    assert named_length(back, "between") == pytest.approx(1)
    assert set(back.region_names) == {"steel"}
    assert_adapts(back, back)


def test_other_meshes_of_netgen_are_refused(ngsolve):
    from netgen.csg import unit_cube
    from netgen.geom2d import unit_square

    with pytest.raises(am.FormatError, match="3 dimensions"):
        convert.from_netgen(unit_cube.GenerateMesh(maxh=0.5))
    with pytest.raises(am.FormatError, match="quadrilaterals"):
        convert.from_netgen(unit_square.GenerateMesh(maxh=0.3, quad_dominated=True))
    second = unit_square.GenerateMesh(maxh=0.5)
    second.SecondOrder()
    with pytest.raises(am.FormatError, match="second order"):
        convert.from_netgen(second)


# --- FEniCSx ---------------------------------------------------------------------------------


@pytest.mark.slow
def test_dolfinx_there_and_back_and_solves(python_with_dolfinx, mesh, tmp_path):
    am.write(tmp_path / "mesh.vtu", mesh)
    done = python_with_dolfinx(SCRIPTS / "poisson_dolfinx.py", "mesh.vtu", "back.vtu")
    assert done.returncode == 0, done.stderr
    back, fields = am.read(tmp_path / "back.vtu"), am.read_fields(tmp_path / "back.vtu")
    assert_same(back, mesh)
    assert_adapts(back, mesh)
    np.testing.assert_allclose(fields["u"], mesh.points @ [2, 1], atol=1e-12)
    np.testing.assert_allclose(fields["gradient"], np.tile([2, 1], (len(mesh.points), 1)))


# --- FreeFEM ---------------------------------------------------------------------------------


def test_freefem_solves_on_a_medit_mesh(mesh, tmp_path):
    """u = 2 x + y, harmonic, from its values on labels; solution and mesh come back."""
    freefem = shutil.which("FreeFem++-nw") or shutil.which("FreeFem++") or pytest.skip("no FreeFEM")
    am.write(tmp_path / "mesh.mesh", mesh)
    arguments = [mesh.names["bottom"], mesh.names["hole"], mesh.region_names["right"]]
    command = [freefem, "-v", "0", "-nw", SCRIPTS / "poisson.edp", *arguments]
    done = subprocess.run(
        list(map(str, command)), cwd=tmp_path, capture_output=True, text=True, timeout=120
    )
    assert done.returncode == 0, done.stdout
    vertices, triangles, bottom, hole, right = map(float, done.stdout.split()[-5:])
    assert (vertices, triangles) == (len(mesh.points), len(mesh.triangles))
    assert bottom == pytest.approx(4)
    assert hole == pytest.approx(2)
    assert right == pytest.approx(4)
    u = am.read_sol(tmp_path / "u.sol")
    np.testing.assert_allclose(u, mesh.points @ [2, 1], atol=1e-8)
    back = am.read(tmp_path / "back.mesh")
    np.testing.assert_allclose(back.points, mesh.points, atol=1e-12)
    np.testing.assert_array_equal(back.regions, mesh.regions)
