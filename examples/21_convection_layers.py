"""Convection with thin layers
===========================

Little diffusion makes layers a ten-thousandth thick, three ways to mesh them.

-eps laplace u + b . grad u = f on the unit square, with eps = 1e-4 and b = (1, 1); u falls to 0 in
two layers, at the right and at the top. The solver is scikit-fem: linear elements, stabilised by
SUPG with the length of a triangle along the flow.
With a number of vertices it makes a last, large solve: ``python 21_convection_layers.py 50000``.
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

domain = am.Domain.rectangle(0, 0, 1, 1)
eps = 1e-4


def profile(s):
    """The solution of -eps g'' + g' = 1 that is 0 at 0 and 1; u is g(x) g(y)."""
    return s + (np.exp(-1 / eps) - np.exp((s - 1) / eps)) / (1 - np.exp(-1 / eps))


@skfem.BilinearForm
def convection(u, v, w):
    flow = grad(u)[0] + grad(u)[1]
    return eps * dot(grad(u), grad(v)) + flow * (v + w["tau"] * (grad(v)[0] + grad(v)[1]))


@skfem.LinearForm
def source(v, w):
    f = profile(w.x[0]) + profile(w.x[1])
    return f * (v + w["tau"] * (grad(v)[0] + grad(v)[1]))


def solve(mesh):
    """Values at the vertices."""
    basis = skfem.Basis(to_skfem(mesh), skfem.ElementTriP1(), intorder=4)
    along = [np.abs(hat[0].grad[0] + hat[0].grad[1]) for hat in basis.basis]
    peclet = 1 / (sum(along) * eps)  # sum |b . grad hat| is 2 |b| / length along the flow
    tau = (1 / np.tanh(peclet) - 1 / peclet) / sum(along)
    matrix, load = convection.assemble(basis, tau=tau), source.assemble(basis, tau=tau)
    return skfem.solve(*skfem.condense(matrix, load, D=basis.mesh.boundary_nodes()))


# %%
# The judge: a grid that is fine in the layers, to which the solution is interpolated.
half = np.concatenate([np.linspace(0, 1 - 2e-3, 300)[:-1], 1 - np.geomspace(2e-3, 1e-6, 200), [1]])
n = len(half)
lower = (np.arange(n - 1)[:, None] * n + np.arange(n - 1)).ravel()
quads = np.stack([lower, lower + n, lower + n + 1, lower + 1], axis=1)
grid = np.stack(np.meshgrid(half, half, indexing="ij"), axis=2).reshape(-1, 2)
judge = am.Mesh(grid, np.concatenate([quads[:, [0, 1, 2]], quads[:, [0, 2, 3]]]))
weights = np.gradient(half)
weights[[0, -1]] /= 2
weights = np.outer(weights, weights).ravel()


def l2_error(mesh, u):
    error = am.transfer(u, mesh, judge) - profile(grid[:, 0]) * profile(grid[:, 1])
    return np.sqrt(weights @ error**2)


def study(counts, **limits):
    """Solve and adapt, with more and more vertices; their numbers and L2 errors, and the end."""
    mesh, results = am.generate(domain, 0.05), []
    for n in counts:
        history = am.adapt_loop(solve, mesh, target_vertices=n, max_iterations=3, **limits)
        mesh = history[-1].mesh
        results.append((len(mesh.points), l2_error(mesh, history[-1].fields["solution"])))
    return results, history


def show(results, name):
    print(f"vertices and L2 error, {name}:", *(f"{n} {e:.1e}," for n, e in results))


def vertices_for(error, results):
    """How many vertices it takes, between the two meshes that are on either side of the error."""
    n, e = np.log(np.transpose(results))
    assert e.min() <= np.log(error) <= e.max()
    return np.exp(np.interp(-np.log(error), -e, n))


uniform = []
for h in (0.04, 0.02, 0.01, 0.005):
    mesh = am.generate(domain, h)
    uniform.append((len(mesh.points), l2_error(mesh, solve(mesh))))
show(uniform, "uniform")
round_, _ = study([1000, 2000, 4000, 8000, 16000], max_anisotropy=1)
show(round_, "isotropic")
thin, history = study([100, 250, 500, 1000, 2000, *map(int, sys.argv[1:])])
show(thin, "anisotropic")

n, error = uniform[-1]
fewer = n / vertices_for(error, thin)
print(f"{fewer:.0f} times fewer vertices than a uniform mesh of the same error")
assert fewer > 20
n, error = round_[-1]
fewer = n / vertices_for(error, thin)
print(f"{fewer:.0f} times fewer vertices than an isotropic mesh of the same error")
assert fewer > 3
before, last = history[-2:]
share = last.seconds.share_of_library
print(f"{last.n_triangles} triangles: {share:.0%} of the time of a step was in this library")
print(am.measure(last.mesh, metrics.Background.on(before.mesh, before.metric)))

# %%
_, history = study([250, 500])
mesh, u = history[-1].mesh, history[-1].fields["solution"]
am.plot(mesh, show=u, title="Two layers, and the corner between").show()
corner = (0.9985, 0.9985, 1, 1)
title = "The last 1.5 thousandths"
am.plot(mesh, show=u, bounds=corner, title=title).show()

figure, axes = plt.subplots(figsize=(6, 4.5), layout="constrained")
for results, colour, label in (
    (uniform, "0.55", "uniform"),
    (round_, "tab:blue", "adapted, isotropic"),
    (thin, "tab:red", "adapted, anisotropic"),
):
    axes.loglog(*np.transpose(results), "o-", color=colour, label=label)
n, error = thin[-1]
axes.loglog([m for m, _ in thin], [error * n / m for m, _ in thin], "k:", label="1 / vertices")
n, error = uniform[-1]
power = [error * (n / m) ** 0.25 for m, _ in uniform]
axes.loglog([m for m, _ in uniform], power, "k-.", label="vertices to the power -1/4")
axes.set(xlabel="vertices", ylabel="L2 norm of the error")
axes.legend(frameon=False)
axes.spines[["top", "right"]].set_visible(False)
plt.show()
