"""The loop, from vertices to error
================================

From a coarse uniform mesh to the best one for a front, for any number of vertices.

`adapt_loop` is given a function that "solves" by sampling tanh(60 (y - 1/2 - sin(2 pi x) / 5)) at
the vertices, and a number of vertices; it knows nothing else of the front. The L2 error of linear
interpolation then falls as one over the number of vertices, which is the best there is, and with
the constant of the continuous theory (Loseille and Alauzet, Continuous mesh framework part II, SIAM
J. Numer. Anal. 49, 2011).
"""

import matplotlib
import numpy as np

import adaptmesh as am
import metrics

matplotlib.use("Agg")
from matplotlib import pyplot as plt

domain = am.Domain.rectangle(0, 0, 1, 1)


def u(x):
    return np.tanh(60 * (x[..., 1] - 0.5 - 0.2 * np.sin(2 * np.pi * x[..., 0])))


def solve(mesh):
    return u(mesh.points)


def l2_error(mesh, depth=5):
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


start = am.generate(domain, 0.07)
true, estimated, uniform = [], [], []
for count in (1000, 3000, 8000, 20000):
    history = am.adapt_loop(solve, start, target_vertices=count, max_iterations=8)
    assert history.converged
    n = len(history.mesh.points)
    true.append((n, l2_error(history.mesh)))
    estimated.append((n, history.errors["solution"][-1]))
    plain = am.generate(domain, np.sqrt(2 / np.sqrt(3) / count))
    uniform.append((len(plain.points), l2_error(plain)))
    print(f"{count} vertices were asked for; L2 error x vertices is {np.prod(true[-1]):.3f}")
    print(history, end="\n\n")
    if count == 3000:
        picture, metric = history.mesh, history[-2].metric
        print(am.measure(picture, metrics.Background.on(history[-2].mesh, metric)), end="\n\n")

(n0, e0), (n1, e1) = true[0], true[-1]
order = np.log(e0 / e1) / np.log(n1 / n0)
print(f"the error falls with the number of vertices to the power {order:.2f}")
assert order > 0.97
assert true[-1][1] * true[-1][0] < 1.13
assert abs(estimated[-1][1] / true[-1][1] - 1) < 0.05
assert true[-1][1] < uniform[-1][1] / 10

# %%
am.plot(picture, title="What the loop has made of a front").show()
figure, axes = plt.subplots(figsize=(6, 4.5), layout="constrained")
axes.loglog(*np.transpose(uniform), "o-", color="0.55", label="uniform")
axes.loglog(*np.transpose(true), "o-", color="tab:red", label="adapt_loop")
axes.loglog(*np.transpose(estimated), "x", color="tab:blue", label="its own estimate")
axes.loglog(*np.transpose([(n, e1 * n1 / n) for n, _ in true]), "k:", label="1 / vertices")
axes.set(xlabel="vertices", ylabel="L2 error of linear interpolation")
axes.legend(frameon=False)
axes.spines[["top", "right"]].set_visible(False)
plt.show()
