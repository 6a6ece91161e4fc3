"""Read a mesh, solve on it with dolfinx, and write what came back: python ... IN OUT."""

import sys

import numpy as np
import ufl
from dolfinx import fem
from dolfinx.fem.petsc import LinearProblem
from dolfinx.mesh import CellType, create_unit_cube, create_unit_square, exterior_facet_indices
from mpi4py import MPI
from petsc4py.PETSc import ScalarType

import adaptmesh as am
from adaptmesh import convert

mesh = am.read(sys.argv[1])
domain, cells, facets = convert.to_dolfinx(mesh)

# Areas and lengths by number.
dx = ufl.Measure("dx", domain, subdomain_data=cells)
area = fem.assemble_scalar(fem.form(ScalarType(1) * dx(mesh.region_names["right"])))
assert abs(area - 4) < 1e-12, area
ds = ufl.Measure("ds", domain, subdomain_data=facets)
length = fem.assemble_scalar(fem.form(ScalarType(1) * ds(mesh.names["hole"])))
assert abs(length - 2) < 1e-12, length

# u = 2 x + y, harmonic, from its values on the whole border.
if not hasattr(fem, "functionspace"):  # as it was called until 0.6
    fem.functionspace = fem.FunctionSpace
space = fem.functionspace(domain, ("Lagrange", 2))
u, v = ufl.TrialFunction(space), ufl.TestFunction(space)
border = fem.Function(space)
border.interpolate(lambda x: 2 * x[0] + x[1])
domain.topology.create_connectivity(1, 2)
dofs = fem.locate_dofs_topological(space, 1, exterior_facet_indices(domain.topology))
zero = fem.Constant(domain, ScalarType(0))
problem = LinearProblem(
    ufl.inner(ufl.grad(u), ufl.grad(v)) * ufl.dx,
    zero * v * ufl.dx,
    bcs=[fem.dirichletbc(border, dofs)],
    petsc_options={"ksp_type": "preonly", "pc_type": "lu"},
)
solution = problem.solve()

vectors = fem.VectorFunctionSpace(domain, ("Lagrange", 1))
gradient = fem.Function(vectors)
gradient.interpolate(fem.Expression(ufl.grad(solution), vectors.element.interpolation_points()))
back = convert.from_dolfinx(domain, cells, facets, names=mesh.names, region_names=mesh.region_names)


# A mesh of its own, and what is refused.
def refused(kind, words, call, item):
    try:
        call(item)
    except kind as error:
        assert words in str(error), error
    else:
        raise AssertionError(f"{item} is not refused")


squares = create_unit_square(MPI.COMM_SELF, 2, 2, CellType.quadrilateral)
own = create_unit_square(MPI.COMM_SELF, 7, 5)
x = fem.Function(fem.functionspace(own, ("Lagrange", 1)))
x.interpolate(lambda x: x[0] + 10 * x[1])
own_back = convert.from_dolfinx(own)
np.testing.assert_allclose(
    convert.vertex_values_of_dolfinx(x), own_back.points @ [1, 10], atol=1e-14
)
assert abs(own_back.areas.sum() - 1) < 1e-14
refused(am.FormatError, "quadrilaterals", convert.from_dolfinx, squares)
refused(am.FormatError, "dimension 3", convert.from_dolfinx, create_unit_cube(own.comm, 1, 1, 1))
constant = fem.Function(fem.functionspace(own, ("DG", 0)))
refused(ValueError, "Lagrange", convert.vertex_values_of_dolfinx, constant)

am.write(
    sys.argv[2],
    back,
    u=convert.vertex_values_of_dolfinx(solution),
    gradient=convert.vertex_values_of_dolfinx(gradient),
)
