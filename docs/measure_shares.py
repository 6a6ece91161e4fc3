"""How much of an iteration of adapt_loop is in this library: the table of solvers.md.

Run it with the number of vertices: python measure_shares.py 50000
The solver is scikit-fem with scipy's SuperLU, on one thread. Medians of processor time are taken
over iterations that all have this number of vertices; all from the end of one solve to the start of
the next is the library's, and the conversion of the mesh for scikit-fem is the solver's.
"""

import os
import sys
import time

os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")

import numpy as np
import skfem
from skfem.helpers import dot, grad
from skfem.models.elasticity import linear_elasticity

import adaptmesh as am
from adaptmesh.convert import to_skfem

ITERATIONS = 3  # that are measured
corners = [(0, 0), (1, 0), (1, 1), (-1, 1), (-1, -1), (0, -1)]
domain = am.Domain.polygon(corners, names={"corner": [0, 5], "outer": [1, 2, 3, 4]})


@skfem.BilinearForm
def energy(u, v, _):
    return dot(grad(u), grad(v))


@skfem.LinearForm
def load(v, _):
    return 1.0 * v


@skfem.LinearForm
def weight(v, _):
    return -1.0 * v[1]


def poisson(element):
    """A membrane under load, held everywhere."""

    def solve(mesh):
        basis = skfem.Basis(to_skfem(mesh), element)
        held = basis.get_dofs(["corner", "outer"])
        u = skfem.solve(*skfem.condense(energy.assemble(basis), load.assemble(basis), D=held))
        return u[basis.nodal_dofs[0]]

    return solve


def elasticity(element):
    """A plate under its weight, held at the outer sides."""

    def solve(mesh):
        basis = skfem.Basis(to_skfem(mesh), skfem.ElementVector(element))
        stiffness = linear_elasticity(1.0, 1.0).assemble(basis)
        held = basis.get_dofs("outer")
        u = skfem.solve(*skfem.condense(stiffness, weight.assemble(basis), D=held))
        return {"displacement": u[basis.nodal_dofs].T}

    return solve


PROBLEMS = {
    "Poisson, P1": poisson(skfem.ElementTriP1()),
    "Poisson, P2": poisson(skfem.ElementTriP2()),
    "elasticity, P1": elasticity(skfem.ElementTriP1()),
}


def measured(solve, n):
    """Median seconds per iteration in the library and in the solver, and the triangles."""
    spans = []

    def timed(mesh):
        start = time.process_time()
        answer = solve(mesh)
        spans.append((start, time.process_time()))
        return answer

    coarse = am.generate(domain, 0.1)
    found = am.adapt_loop(PROBLEMS["Poisson, P1"], coarse, target_vertices=n, tolerance=0.05)
    history = am.adapt_loop(
        timed, found[-1].mesh, target_vertices=n, max_iterations=ITERATIONS, tolerance=0.0
    )
    start, end = np.transpose(spans)
    return np.median(start[1:] - end[:-1]), np.median(end - start), history[-1].n_triangles


if __name__ == "__main__":
    count = int(sys.argv[1]) if len(sys.argv) > 1 else 50_000
    for name in sys.argv[2:] or PROBLEMS:
        library, solver, triangles = measured(PROBLEMS[name], count)
        print(
            f"{name}: {triangles} triangles, {library:.2f} s in adaptmesh, {solver:.2f} s in the "
            f"solver: {library / (library + solver):.0%}",
            flush=True,
        )
