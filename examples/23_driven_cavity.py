"""Navier-Stokes in a driven cavity
================================

One mesh for both components of the velocity.

At a Reynolds number of 1000 the lid drags the fluid round. The mesh is adapted to both components
at once, and the pressure is carried along. Speeds on the middle lines are compared with those of
Botella and Peyret (Computers & Fluids 27, 1998), by a spectral method. The solver is scikit-fem:
Taylor-Hood elements, and Newton's method from the flow on the mesh before.
With a number of vertices it makes a last, large solve: ``python 23_driven_cavity.py 50000``.
"""

import sys

import matplotlib
import numpy as np
import skfem
from scipy.sparse import bmat
from skfem.helpers import ddot, div, dot, grad, mul

import adaptmesh as am
import metrics
from adaptmesh.convert import to_skfem

matplotlib.use("Agg")
from matplotlib import pyplot as plt

reynolds = 1000
cavity = am.Domain.rectangle(0, 0, 1, 1)

# %%
# Botella and Peyret, tables 9 and 10: u at x = 1/2 for some y, v at y = 1/2 for some x.
heights = [0.9766, 0.9531, 0.8516, 0.7344, 0.5, 0.2813, 0.1719, 0.1016, 0.0547]
u_there = [0.66442, 0.47233, 0.33722, 0.18867, -0.06206, -0.28037, -0.38857, -0.30046, -0.18129]
widths = [0.9688, 0.9531, 0.9063, 0.8594, 0.5, 0.2266, 0.1563, 0.0938, 0.0625]
v_there = [-0.22792, -0.35532, -0.52644, -0.42645, 0.02580, 0.33399, 0.37692, 0.33304, 0.28071]


@skfem.BilinearForm
def viscosity(u, v, _):
    return ddot(grad(u), grad(v)) / reynolds


@skfem.BilinearForm
def divergence(u, q, _):
    return -div(u) * q


@skfem.BilinearForm
def carried(u, v, w):
    return dot(mul(grad(u), w["wind"]), v)


@skfem.BilinearForm
def carrying(u, v, w):
    return dot(mul(grad(w["wind"]), u), v)


@skfem.LinearForm
def inertia(v, w):
    return dot(mul(grad(w["wind"]), w["wind"]), v)


class TaylorHood:
    """The spaces on a mesh, and values of the velocity in the order of P2 fields of adaptmesh."""

    def __init__(self, mesh):
        m = to_skfem(mesh)
        assert np.array_equal(m.facets.T, mesh.unique_edges)
        self.velocity = skfem.Basis(m, skfem.ElementVector(skfem.ElementTriP2()), intorder=5)
        self.pressure = self.velocity.with_element(skfem.ElementTriP1())
        self.nodes = np.concatenate([self.velocity.nodal_dofs, self.velocity.facet_dofs], axis=1)
        border = self.velocity.get_dofs()
        self.lid = self.velocity.get_dofs(m.boundaries["top"]).all("u^1")
        self.fixed = np.append(border.all(), self.velocity.N)  # and one pressure

    def start(self, velocity):
        """The unknowns with these values of the velocity inside, and those at the border."""
        x = np.zeros(self.velocity.N + self.pressure.N)
        if velocity is not None:
            x[self.nodes] = velocity.T
        x[self.fixed] = 0
        x[self.lid] = 1
        return x


def solve(mesh, previous=None):
    """The velocity at vertices and midpoints of edges, and all at the vertices."""
    spaces = TaylorHood(mesh)
    n = spaces.velocity.N
    a = viscosity.assemble(spaces.velocity)
    b = divergence.assemble(spaces.velocity, spaces.pressure)
    x = spaces.start(previous and previous["velocity"])
    change, steps = np.inf, 0
    while change > 1e-6:
        wind = spaces.velocity.interpolate(x[:n])
        convection, load = carried.assemble(spaces.velocity, wind=wind), np.zeros(len(x))
        if previous or steps > 3:  # Newton's method; before that Picard's, which needs no guess
            convection = convection + carrying.assemble(spaces.velocity, wind=wind)
            load[:n] = inertia.assemble(spaces.velocity, wind=wind)
        matrix = bmat([[a + convection, b.T], [b, None]], "csr")
        new = skfem.solve(*skfem.condense(matrix, load, x=x, D=spaces.fixed))
        change, steps = np.abs(new - x)[:n].max(), steps + 1
        assert steps < 30
        x = new
    velocity = x[spaces.nodes].T
    u, v = velocity[: len(mesh.points)].T
    return {"velocity": velocity, "u": u, "v": v, "pressure": x[n:]}


def deviation(mesh, fields):
    """The largest from the speeds in the tables."""
    basis = skfem.Basis(to_skfem(mesh), skfem.ElementTriP2())
    nodes = np.concatenate([basis.nodal_dofs, basis.facet_dofs], axis=1)[0]
    x = np.empty((basis.N, 2))
    x[nodes] = fields["velocity"]
    upright = basis.probes(np.array([np.full(len(heights), 0.5), heights])) @ x[:, 0]
    level = basis.probes(np.array([widths, np.full(len(widths), 0.5)])) @ x[:, 1]
    return max(np.abs(upright - u_there).max(), np.abs(level - v_there).max())


uniform, thrifty = [], []
for h in (0.06, 0.04, 0.028):
    mesh = am.generate(cavity, h)
    uniform.append((len(mesh.points), deviation(mesh, solve(mesh))))

mesh = am.generate(cavity, 0.06)
for n in [300, 600, 1200, *map(int, sys.argv[1:])]:
    # Two corners of the lid, where the velocity jumps, would take all vertices: hence h_min.
    history = am.adapt_loop(
        solve, mesh, target_vertices=n, fields=["u", "v"], h_min=2e-3, max_iterations=2
    )
    before, last = history[-2:]
    mesh = last.mesh
    thrifty.append((len(mesh.points), deviation(mesh, last.fields)))
print("vertices and deviation, uniform:", *(f"{n} {e:.1e}," for n, e in uniform))
print("vertices and deviation, adapted:", *(f"{n} {e:.1e}," for n, e in thrifty))
assert thrifty[-1][1] < uniform[-1][1] / 8  # with fewer vertices
assert thrifty[-1][1] < 6e-3
share = last.seconds.share_of_library
print(f"{last.n_triangles} triangles: {share:.0%} of the time of a step was in this library")
print(am.measure(mesh, metrics.Background.on(before.mesh, before.metric)))

# %%
speed = np.hypot(last.fields["u"], last.fields["v"])
am.plot(mesh, show=speed, title="The speed of the fluid").show()
figure, axes = plt.subplots(figsize=(6, 4.5), layout="constrained")
axes.loglog(*np.transpose(uniform), "o-", color="0.55", label="uniform")
axes.loglog(*np.transpose(thrifty), "o-", color="tab:red", label="adapted")
n, error = np.transpose(thrifty)
axes.loglog(n, error[0] * n[0] / n, "k:", label="1 / vertices")
axes.set(xlabel="vertices", ylabel="largest deviation of a speed")
axes.legend(frameon=False)
axes.spines[["top", "right"]].set_visible(False)
plt.show()
