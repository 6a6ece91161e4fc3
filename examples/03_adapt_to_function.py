"""Adapting to a function
======================

A function that is known only at the vertices, as a solution would be.

Five times: sample the function at the vertices, estimate its Hessian there, scale the Hessian to
the metric that makes the L2 interpolation error least for a given number of vertices (Loseille and
Alauzet, Continuous mesh framework part I, SIAM J. Numer. Anal. 49, 2011), and mesh again.
"""

import numpy as np
from scipy.sparse import coo_array

import adaptmesh as am
import metrics
from metrics import tensor

VERTICES = 3000


def u(x):
    """Two steep fronts, one of them curved, that cross."""
    x, y = x[:, 0], x[:, 1]
    curved = np.tanh(40 * (y - 0.5 - 0.25 * np.sin(2 * np.pi * x)))
    straight = np.tanh(60 * (x - 0.6 * y - 0.2))
    return curved + 0.5 * straight


def hessians(mesh, values):
    """Second derivatives (n, 2, 2) at the vertices, by fitting a quadratic to two rings."""
    n = len(mesh.points)
    i, j = mesh.unique_edges.T
    ones = np.ones(len(i))
    ring = coo_array((ones, (i, j)), shape=(n, n)).tocsr()
    ring = ring + ring.T
    i, j = (ring + ring @ ring).nonzero()
    i, j = i[i != j], j[i != j]

    # Measured in the frame in which the two rings are round, thin triangles fit as well as others.
    d = mesh.points[j] - mesh.points[i]
    spread = np.empty((n, 2, 2))
    for a, b in np.ndindex(2, 2):
        spread[:, a, b] = np.bincount(i, d[:, a] * d[:, b]) / np.bincount(i)
    axes, directions = np.linalg.eigh(spread)
    frame = directions / np.sqrt(axes)[:, None, :]  # round = frame' @ d
    x, y = np.einsum("kab,ka->kb", frame[i], d).T

    terms = np.stack([x, y, x * x / 2, x * y, y * y / 2], axis=1)
    rise = values[j] - values[i]
    normal = np.empty((n, 5, 5))
    right = np.empty((n, 5))
    for a in range(5):
        right[:, a] = np.bincount(i, terms[:, a] * rise)
        for b in range(5):
            normal[:, a, b] = np.bincount(i, terms[:, a] * terms[:, b])
    fit = np.linalg.solve(normal + 1e-9 * np.eye(5), right[:, :, None])[:, :, 0]
    in_frame = fit[:, [2, 3, 3, 4]].reshape(-1, 2, 2)
    return frame @ in_frame @ frame.transpose(0, 2, 1)


def optimal_metric(mesh, values):
    """The metric (n, 3) at the vertices that gives VERTICES vertices and the least L2 error."""
    eigenvalues, vectors = np.linalg.eigh(hessians(mesh, values))
    size = np.maximum(np.abs(eigenvalues), 1e-3 * np.abs(eigenvalues).max())
    absolute = vectors * size[:, None, :] @ vectors.transpose(0, 2, 1)
    shape = np.linalg.det(absolute)[:, None, None] ** (-1 / 6) * absolute
    # Twice, as bounds on the sizes change the complexity: scale to that of a mesh of VERTICES.
    bounded = tensor.pack(shape)
    for _ in range(2):
        density = np.sqrt(tensor.det(bounded))[mesh.triangles].mean(axis=1)
        complexity = (mesh.areas * density).sum()
        bounded = tensor.limit(bounded * (np.sqrt(3) / 2 * VERTICES / complexity), 1e-4, 0.2)
    return bounded


def l2_error(mesh):
    """L2 norm of u minus its interpolant on the mesh, by the seven points of Radon's rule."""
    r = np.sqrt(15)
    corners = mesh.points[mesh.triangles]
    nodal = u(mesh.points)[mesh.triangles]

    def mean_square(s, turns):
        places = [np.roll([1 - 2 * s, s, s], k) for k in range(turns)]
        errors = [u(np.tensordot(at, corners, (0, 1))) - nodal @ at for at in places]
        return sum((mesh.areas * e**2).sum() for e in errors)

    return np.sqrt(
        9 / 40 * mean_square(1 / 3, 1)
        + (155 + r) / 1200 * mean_square((6 + r) / 21, 3)
        + (155 - r) / 1200 * mean_square((6 - r) / 21, 3)
    )


domain = am.Domain.rectangle(0, 0, 1, 1)
uniform = am.generate(domain, np.sqrt(2 / np.sqrt(3) / VERTICES))
print(f"uniform:  {len(uniform.points):5d} vertices, L2 error {l2_error(uniform):.2e}")

mesh = uniform
for step in range(5):
    field = metrics.Background.on(mesh, optimal_metric(mesh, u(mesh.points)))
    mesh = am.adapt(mesh, field)
    print(f"adapted {step}: {len(mesh.points):4d} vertices, L2 error {l2_error(mesh):.2e}")

print(am.measure(mesh, field))
assert l2_error(mesh) < l2_error(uniform) / 10

# %%
am.plot(mesh, title="Adapted to two fronts").show()
am.plot(
    mesh,
    field,
    ellipses=60,
    bounds=(0.4, 0.4, 0.6, 0.6),
    title="Where they cross, and what was asked for",
).show()
