"""Poisson at a corner
===================

The order that the corner takes away, and adaptation brings back.

-div grad u = 0 with the solution r^(2/3) sin(2/3 angle), whose gradient is infinite in the corner.
On uniform meshes the energy error of linear elements falls with the number of vertices only to
the power -1/3; on meshes adapted to the solution it is -1/2 again. The solver is scikit-fem.
With a number of vertices it makes a last, large solve: ``python 20_poisson_corner.py 50000``.
"""

import sys

import matplotlib
import numpy as np
import skfem
from skfem.helpers import dot, grad

import adaptmesh as am
import metrics
from adaptmesh.convert import to_skfem

matplotlib.use("Agg")
from matplotlib import pyplot as plt

corners = [(0, 0), (1, 0), (1, 1), (-1, 1), (-1, -1), (0, -1)]
domain = am.Domain.polygon(corners, names={"corner": [0, 5], "outer": [1, 2, 3, 4]})


def polar(x):
    return np.hypot(x[0], x[1]), np.mod(np.arctan2(x[1], x[0]), 2 * np.pi)


def exact(x):
    r, angle = polar(x)
    return r ** (2 / 3) * np.sin(2 / 3 * angle)


def exact_gradient(x):
    r, angle = polar(x)
    return 2 / 3 * r ** (-1 / 3) * np.stack([-np.sin(angle / 3), np.cos(angle / 3)])


@skfem.BilinearForm
def energy(u, v, _):
    return dot(grad(u), grad(v))


@skfem.Functional
def energy_error(w):
    difference = grad(w["u"]) - exact_gradient(w.x)
    return dot(difference, difference)


def solve(mesh):
    """Values at the vertices."""
    m = to_skfem(mesh)
    basis = skfem.Basis(m, skfem.ElementTriP1())
    border = np.concatenate([m.boundaries["corner"], m.boundaries["outer"]])
    matrix = energy.assemble(basis)
    return skfem.solve(*skfem.condense(matrix, x=exact(m.p), D=basis.get_dofs(border)))


def error(mesh, u):
    """The energy norm of the error."""
    basis = skfem.Basis(to_skfem(mesh), skfem.ElementTriP1(), intorder=8)
    return np.sqrt(energy_error.assemble(basis, u=basis.interpolate(u)))


def order(results):
    (n0, e0), (n1, e1) = results[0], results[-1]
    return np.log(e1 / e0) / np.log(n1 / n0)


uniform, thrifty = [], []
for h in (0.1, 0.05, 0.025, 0.0125):
    mesh = am.generate(domain, h)
    uniform.append((len(mesh.points), error(mesh, solve(mesh))))

mesh = am.generate(domain, 0.2)
for n in [200, 400, 800, 1600, 3200, 6400, *map(int, sys.argv[1:])]:
    # Least in the energy norm are sizes in proportion to the curvature to the power -1/2, which
    # is what p = inf gives.
    history = am.adapt_loop(solve, mesh, target_vertices=n, p=np.inf, max_iterations=3)
    before, last = history[-2:]
    mesh, u = last.mesh, last.fields["solution"]
    thrifty.append((len(mesh.points), error(mesh, u)))
    if n == 800:
        am.plot(
            mesh,
            show=u,
            title="Sizes that shrink towards the corner",
        ).show()
print("vertices and energy error, uniform:", *(f"{n} {e:.2e}," for n, e in uniform))
print("vertices and energy error, adapted:", *(f"{n} {e:.2e}," for n, e in thrifty))
print(f"orders: uniform {order(uniform):.3f}, adapted {order(thrifty[2:]):.3f}")
share = last.seconds.share_of_library
print(f"{last.n_triangles} triangles: {share:.0%} of the time of a step was in this library")
assert -0.36 < order(uniform) < -0.31  # -1/3
assert -0.56 < order(thrifty[2:]) < -0.48  # -1/2
print(am.measure(mesh, metrics.Background.on(before.mesh, before.metric)))

figure, axes = plt.subplots(figsize=(6, 4.5), layout="constrained")
for results, power, colour, label in (
    (uniform, "-1/3", "0.55", "uniform"),
    (thrifty, "-1/2", "tab:red", "adapted"),
):
    n, errors = np.transpose(results)
    theory = errors[-1] * (n / n[-1]) ** (int(power[:2]) / int(power[3:]))
    axes.loglog(n, errors, "o-", color=colour, label=label)
    axes.loglog(n, theory, ":", color=colour, label=f"vertices to the power {power}")
axes.set(xlabel="vertices", ylabel="energy norm of the error")
axes.legend(frameon=False)
axes.spines[["top", "right"]].set_visible(False)
plt.show()
