"""One number of the solution
==========================

Vertices go only where they matter for it.

Five plumes are carried down a channel, -div(eps grad u) + du/dx = f, and a sensor near the outflow
measures the mean of u in the second of them. The adjoint of the sensor says which parts of the
solution it sees: -div(eps grad z) - dz/dx = g, the same problem upstream. The metric from both
(`metrics.metric_from_adjoint`) leaves the other plumes alone, and so gets the number with far fewer
vertices than meshes that follow the whole solution: until, near a thousandth, what the solver adds
for stability is all that is left of the error. The solver is scikit-fem.
"""

import matplotlib
import numpy as np
import skfem
from skfem.helpers import dot, grad

import adaptmesh as am
import metrics
from adaptmesh.convert import to_skfem

matplotlib.use("Agg")
from matplotlib import pyplot as plt

domain = am.Domain.rectangle(0, 0, 3, 1)
eps = 5e-4


def bump(x, at):
    """A narrow bell with the integral 1 around a place."""
    width = 0.04
    square = (x[0] - at[0]) ** 2 + (x[1] - at[1]) ** 2
    return np.exp(-square / (2 * width**2)) / (2 * np.pi * width**2)


def sources(x):
    return sum(bump(x, (0.3, y)) for y in (0.1, 0.3, 0.5, 0.7, 0.9))


def sensor(x):
    return bump(x, (2.5, 0.3))


@skfem.BilinearForm
def primal(u, v, w):
    return eps * dot(grad(u), grad(v)) + grad(u)[0] * (v + w["tau"] * grad(v)[0])


@skfem.BilinearForm
def dual(z, v, w):
    return eps * dot(grad(z), grad(v)) - grad(z)[0] * (v - w["tau"] * grad(v)[0])


@skfem.LinearForm
def primal_load(v, w):
    return sources(w.x) * (v + w["tau"] * grad(v)[0])


@skfem.LinearForm
def dual_load(v, w):
    return sensor(w.x) * (v - w["tau"] * grad(v)[0])


def solve_both(mesh):
    """The solution, 0 at the inflow; the adjoint, 0 at the outflow; and what the sensor reads."""
    basis = skfem.Basis(to_skfem(mesh), skfem.ElementTriP1(), intorder=12)
    along = sum(np.abs(hat[0].grad[0]) for hat in basis.basis)  # 2 / length along the flow
    peclet = 1 / (along * eps)
    tau = (1 / np.tanh(peclet) - 1 / peclet) / along
    u, z = (
        skfem.solve(
            *skfem.condense(
                form.assemble(basis, tau=tau),
                load.assemble(basis, tau=tau),
                D=basis.get_dofs(held),
            )
        )
        for form, load, held in ((primal, primal_load, "left"), (dual, dual_load, "right"))
    )
    reads = skfem.Functional(lambda w: sensor(w.x) * w["u"]).assemble(basis, u=u)
    return u, z, reads


def quadratic_reads(mesh):
    """What the sensor reads of a solution by quadratic elements: the truth, on a fine mesh."""
    basis = skfem.Basis(to_skfem(mesh), skfem.ElementTriP2(), intorder=12)
    forms = primal.assemble(basis, tau=0), primal_load.assemble(basis, tau=0)
    u = skfem.solve(*skfem.condense(*forms, D=basis.get_dofs("left")))
    return skfem.Functional(lambda w: sensor(w.x) * w["u"]).assemble(basis, u=u)


def for_the_goal(n):
    def solve(mesh):
        u, z, _ = solve_both(mesh)
        gradient = metrics.gradients(mesh.points, mesh.triangles, u)
        carried = np.stack([u, np.zeros_like(u)], axis=1)
        fluxes, adjoints = np.stack([carried, -eps * gradient], axis=1), np.stack([z, z], axis=1)
        options = {"target_vertices": n, "h_max": 0.3, "recovery": "green"}
        metric = metrics.metric_from_adjoint(
            mesh.points, mesh.triangles, fluxes, adjoints, **options
        )
        return am.Solution({"u": u, "z": z}, metric=metric)

    return solve


def for_the_solution(mesh):
    return solve_both(mesh)[0]


counts = (300, 450, 700, 1000)
last_meshes = {"the goal": [], "the solution": []}
start = am.generate(domain, 0.08)
for n in counts:
    for_goal = am.adapt_loop(for_the_goal(n), start, max_iterations=12)
    options = {"target_vertices": n, "h_max": 0.3, "max_iterations": 12}
    for_solution = am.adapt_loop(for_the_solution, start, **options)
    for runs, history in zip(last_meshes.values(), (for_goal, for_solution), strict=True):
        runs.append([iteration.mesh for iteration in history[-3:]])
    if n == 1000:
        previous, last = for_goal[-2:]
        mesh, u = last.mesh, last.fields["u"]
        before = metrics.Background.on(previous.mesh, previous.metric)
exact = quadratic_reads(am.adapt_loop(for_the_goal(10_000), mesh, max_iterations=5)[-1].mesh)


def typical_error(meshes):
    """The root of the mean square: one mesh may be right by chance, as errors have signs."""
    reads = [solve_both(m)[2] for m in meshes]
    return len(meshes[-1].points), np.sqrt(np.mean((np.array(reads) / exact - 1) ** 2))


errors = {name: [typical_error(m) for m in runs] for name, runs in last_meshes.items()}
print(f"the sensor reads {exact:.6f} by quadratic elements")
for name, results in errors.items():
    print(f"vertices and relative error, for {name}:", *(f"{n} {e:.1e}," for n, e in results))
near = np.mean(np.abs(mesh.points[:, 1] - 0.3) < 0.15)
print(f"{near:.0%} of the vertices are within 0.15 of the plume that the sensor sees")
goal_mean, whole_mean = (np.exp(np.mean(np.log([e for _, e in r]))) for r in errors.values())
print(f"for the goal the error is {whole_mean / goal_mean:.1f} times less, in the geometric mean")
assert near > 0.6
assert goal_mean < whole_mean / 3

# %%
am.plot(mesh, show=u, title="The sensor is in the second plume").show()
print(am.measure(mesh, before))

figure, axes = plt.subplots(figsize=(6, 4.5), layout="constrained")
for (name, results), colour in zip(errors.items(), ("tab:red", "0.55"), strict=True):
    axes.loglog(*np.transpose(results), "o-", color=colour, label=f"adapted to {name}")
n = np.array([300, 1000])
axes.loglog(n, goal_mean * (n / 550) ** -1.0, ":", color="tab:red", label="one over the vertices")
axes.set(xlabel="vertices", ylabel="relative error of what the sensor reads")
axes.legend(frameon=False)
axes.spines[["top", "right"]].set_visible(False)
plt.show()
