"""Error against vertices
======================

Spending vertices where a function bends: interpolation error against their number.

The function is known at the vertices only, as a solution would be. From its values there
`metrics.metric_from_solution` recovers the Hessian and scales it to the metric of least L2 error
for the number of vertices asked for (Loseille and Alauzet, Continuous mesh framework part I, SIAM
J. Numer. Anal. 49, 2011); the mesh that is adapted to it gives better values, and so on. Then the
other way round: an error is asked for, and the number of vertices found.
"""

import matplotlib
import numpy as np

import adaptmesh as am
import metrics

matplotlib.use("Agg")
from matplotlib import pyplot as plt

domain = am.Domain.rectangle(0, 0, 1, 1)


def u(x):
    """A steep front along a wave, a hill, and ripples a hundredth as high."""
    x, y = x[..., 0], x[..., 1]
    front = np.tanh(60 * (y - 0.5 - 0.2 * np.sin(2 * np.pi * x)))
    hill = np.exp(-((x - 0.75) ** 2 + (y - 0.75) ** 2) / 0.01)
    return front + hill + 0.01 * np.sin(20 * x) * np.sin(20 * y)


def l2_error(mesh, depth=4):
    """L2 norm of u minus its interpolant: each triangle cut into depth² parts, by their middles."""
    corners, nodal = mesh.points[mesh.triangles], u(mesh.points)[mesh.triangles]
    squares = 0
    for i in range(depth):
        for j in range(depth - i):
            for up in (1, 2) if i + j < depth - 1 else (1,):
                s, t = (i + up / 3) / depth, (j + up / 3) / depth
                at = [s, t, 1 - s - t]
                error = u(np.einsum("k,tkd->td", at, corners)) - nodal @ at
                squares += mesh.areas @ error**2 / depth**2
    return np.sqrt(squares)


def adapted(mesh, times=3, **target):
    """Sample, recover, adapt, again: each mesh carries the metric for the next."""
    for _ in range(times):
        values = u(mesh.points)
        field = metrics.metric_from_solution(mesh.points, mesh.triangles, values, **target)
        mesh = am.adapt(mesh, field)
    return mesh, field


counts = [500, 1000, 2000, 4000, 8000, 16000]
uniform, thrifty = [], []
mesh = am.generate(domain, 0.04)
print("vertices asked for: uniform mesh and its L2 error, adapted mesh and its L2 error")
for n in counts:
    plain = am.generate(domain, np.sqrt(2 / np.sqrt(3) / n))
    mesh, _ = adapted(mesh, target_vertices=n)
    uniform.append((len(plain.points), l2_error(plain)))
    thrifty.append((len(mesh.points), l2_error(mesh)))
    rows = (f"{count:6d} {error:.2e}" for count, error in (uniform[-1], thrifty[-1]))
    print(f"{n:6d}: {'   '.join(rows)}")

gain = uniform[-1][1] / thrifty[-1][1]
(n0, e0), (n1, e1) = thrifty[2], thrifty[-1]
order = np.log(e0 / e1) / np.log(n1 / n0)
print(f"{gain:.0f} times less error; it falls with the number of vertices to the power {order:.2f}")
assert gain > 10
assert order > 0.9  # 1 in the limit

asked = 3e-4
mesh, field = adapted(am.generate(domain, 0.04), times=4, error=asked)
print(
    f"an L2 error of {asked} was asked for: {l2_error(mesh):.2e} with {len(mesh.points)} vertices"
)
assert 0.7 * asked < l2_error(mesh) < 1.3 * asked
print(am.measure(mesh, field))

# %%
picture, _ = adapted(am.generate(domain, 0.04), times=4, target_vertices=2000)
am.plot(
    picture,
    title="Adapted to a front, a hill, and ripples",
).show()

figure, axes = plt.subplots(figsize=(6, 4.5), layout="constrained")
axes.loglog(*np.transpose(uniform), "o-", color="0.55", label="uniform")
axes.loglog(*np.transpose(thrifty), "o-", color="tab:red", label="Hessian metric, p = 2")
axes.loglog(*np.transpose([(n, e0 * n0 / n) for n, _ in thrifty]), "k:", label="1 / vertices")
axes.set(xlabel="vertices", ylabel="L2 error of linear interpolation")
axes.legend(frameon=False)
axes.spines[["top", "right"]].set_visible(False)
plt.show()
