"""A front on the move
===================

A bow-shaped front that crosses the domain, on meshes that follow it, with no mass lost.

du/dt + b . grad u = eps laplace u on a rectangle, with eps = 1e-4. Time is cut into intervals, each
with a mesh of its own. All are gone through three times: first on a uniform mesh, to see where the
front will be, then on meshes adapted to where it was in each interval. Values go from mesh to mesh
by the conservative transfer, which keeps the mass to rounding and makes no new extremes. The solver
is scikit-fem.
With a number of vertices it makes a last, large solve: ``python 22_moving_front.py 50000``.
"""

import itertools
import sys

import matplotlib
import numpy as np
import skfem
from scipy.sparse.linalg import splu
from skfem.helpers import dot, grad

import adaptmesh as am
import metrics
from adaptmesh.convert import to_skfem

matplotlib.use("Agg")
from matplotlib import pyplot as plt

domain = am.Domain.rectangle(0, 0, 1.3, 0.8)
eps, flow, end = 1e-4, np.array([1.0, 0.2]), 0.7
intervals, steps = 14, 20
times = np.linspace(0, end, intervals + 1)
angles = np.linspace(-1, 1, 60)
bow = np.stack([0.1 + 0.2 * np.cos(angles), 0.33 + 0.2 * np.sin(angles)])


def exact(x, t):
    """Drops along a bow, each carried along while it widens."""
    before, now = 0.02**2, 0.02**2 + 2 * eps * t
    squares = sum((x[i][..., None] - flow[i] * t - bow[i]) ** 2 for i in range(2))
    height = before / now * np.exp(-squares / (2 * now)).sum(axis=-1) / 7.5
    return np.where(height > 1e-12, height, 0)  # what is denormal costs much time


@skfem.BilinearForm
def mass(u, v, _):
    return u * v


@skfem.BilinearForm
def transport(u, v, _):
    return dot(eps * grad(u) - flow[:, None, None] * u, grad(v))  # nothing through the walls


@skfem.Functional
def squared_error(w):
    return (w["u"] - exact(w.x, end)) ** 2


def integral(mesh, u):
    return mesh.areas @ u[mesh.triangles].mean(axis=1)


def march(mesh, u, t0, t1):
    """Yields times and values at the vertices, a quarter of an interval apart.

    A step of the fourth order in time, Gauss's: exp(-z) is about 1 + 2 Re(c / (z - pole)).
    """
    basis = skfem.Basis(to_skfem(mesh), skfem.ElementTriP1())
    m, k = mass.assemble(basis), transport.assemble(basis)
    pole = -3 + 1j * np.sqrt(3)
    c = -pole / (pole / 6 + 0.5)
    solve = splu(((t1 - t0) / steps * k - pole * m).tocsc()).solve
    for i, t in enumerate(np.linspace(t0, t1, steps + 1)[1:], 1):
        u = u + 2 * (c * solve((m @ u).astype(complex))).real
        if i % (steps // 4) == 0:
            yield t, u


def final_error(mesh, u):
    basis = skfem.Basis(to_skfem(mesh), skfem.ElementTriP1(), intorder=6)
    return np.sqrt(squared_error.assemble(basis, u=basis.interpolate(u)))


def on_one_mesh(h):
    mesh = am.generate(domain, h)
    u = exact(mesh.points.T, 0)
    for t0, t1 in itertools.pairwise(times):
        *_, (_, u) = march(mesh, u, t0, t1)
    return len(mesh.points), final_error(mesh, u)


def following(n):
    """What happens, on meshes with about n vertices on average."""
    history = am.transient_loop(
        march,
        lambda mesh: exact(mesh.points.T, 0),
        am.generate(domain, 0.03),
        times,
        target_vertices=n,
        h_max=0.2,
        keep_bounds=True,
    )
    for before, after in itertools.pairwise(history.intervals):
        u, moved = before.last["solution"], after.first["solution"]
        lost = abs(integral(after.mesh, moved) / integral(before.mesh, u) - 1)
        assert lost < 1e-10, lost
        assert u.min() <= moved.min() <= moved.max() <= u.max()
    return history


uniform = [on_one_mesh(h) for h in (0.04, 0.03, 0.02)]
thrifty = []
for n in [500, 1000, 2000, *map(int, sys.argv[1:])]:
    history = following(n)
    last = history.intervals[-1]
    u = last.last["solution"]
    thrifty.append((history.mean_vertices(), final_error(last.mesh, u)))
    if n == 1000:
        shown = history.intervals
print("vertices and L2 error, one uniform mesh:", *(f"{n} {e:.1e}," for n, e in uniform))
print("vertices and L2 error, adapted meshes:", *(f"{n:.0f} {e:.1e}," for n, e in thrifty))
share = history.seconds.share_of_library
print(f"{len(last.mesh.triangles)} triangles: {share:.0%} of the time was in adaptmesh")
(n0, e0), (n1, e1) = thrifty[0], thrifty[-1]
order = np.log(e1 / e0) / np.log(n1 / n0)
first = history.intervals[0]
lost = integral(last.mesh, u) / integral(first.mesh, first.first["solution"]) - 1
print(f"order {order:.2f}; of the mass, {abs(lost):.1e} was lost on the way")
assert thrifty[0][1] < uniform[-1][1] / 3  # with a sixth of the vertices
assert order < -0.9
assert abs(lost) < 1e-10
print(history, end="\n\n")

# %%
# The last mesh was made for what happened in its interval in the sweep before.
before = history.sweeps[-2][-1]
metric = metrics.metric_from_hessians(
    before.mesh.points,
    before.mesh.triangles,
    list(before.hessians.values()),
    target_vertices=len(last.mesh.points),
    limits=metrics.Limits(h_max=0.2, gradation=1.5),
)
print(am.measure(last.mesh, metric))

# %%
for interval, values, title in (
    (shown[0], shown[0].first, "The first of fourteen meshes"),
    (shown[-1], shown[-1].last, "The last of fourteen meshes"),
):
    am.plot(interval.mesh, show=values["solution"], title=title).show()
figure, axes = plt.subplots(figsize=(6, 4.5), layout="constrained")
axes.loglog(*np.transpose(uniform), "o-", color="0.55", label="one uniform mesh")
axes.loglog(*np.transpose(thrifty), "o-", color="tab:red", label="meshes that follow")
n, error = np.transpose(thrifty)
axes.loglog(n, error[-1] * n[-1] / n, "k:", label="1 / vertices")
axes.set(xlabel="vertices", ylabel="L2 norm of the error at the end")
axes.legend(frameon=False)
axes.spines[["top", "right"]].set_visible(False)
plt.show()
