"""Curves
======

An aerofoil in a round far field, with its wake.

The aerofoil is a spline, the far field a circle, the wake any function; the vertices are on the
curves themselves, and still there after the mesh has been adapted ten times.
"""

import numpy as np

import adaptmesh as am
from adaptmesh.curves import Circle, Parametric, Spline

# %%
# NACA 0012, from its trailing edge over the nose and back: a spline that is not closed smoothly,
# so that the trailing edge stays a corner.
x = 0.5 * (1 - np.cos(np.linspace(0, np.pi, 50)))
y = 0.6 * x[:, None] ** [0.5, 1, 2, 3, 4] @ [0.2969, -0.126, -0.3516, 0.2843, -0.1036]
y[-1] = 0
upper, lower = np.stack([x, y], axis=1), np.stack([x, -y], axis=1)
wing = Spline(np.concatenate([upper[::-1], lower[1:]]))


def behind(t):
    """Where the wake goes: it leaves the trailing edge at (1, 0), and ends inside."""
    return np.stack([1 + 1.5 * t, 0.15 * t**2], axis=1)


domain = am.Domain.from_curves(
    [Circle((0.5, 0), 3), wing, Parametric(behind)],
    names={"far": [0], "wing": [1], "wake": [2]},
    holes=[(0.5, 0)],  # the inside of the wing
)


# %%
# Fine at the nose, the trailing edge and along the wake.
def size(p, finest=0.006):
    nose = np.hypot(*p.T)
    along = np.clip(p[:, 0], 1, 2.5)
    wake = np.hypot(p[:, 0] - along, p[:, 1] - 0.15 * ((along - 1) / 1.5) ** 2)
    chord = np.maximum(np.abs(p[:, 1]) - 0.06, 0) + np.maximum(np.abs(p[:, 0] - 0.5) - 0.5, 0)
    return finest + np.minimum(0.2 * nose, np.minimum(0.02 + 0.2 * chord, 0.012 + 0.2 * wake))


mesh = am.generate(domain, size)
report = am.measure(mesh, size)
print(mesh)
print(report)
assert report.unit_fraction > 0.99

# %%
# Ten adaptations, finer and coarser by turns: nothing drifts off its curve.
for k in range(10):
    finest = 0.006 if k % 2 else 0.02
    mesh = am.adapt(mesh, size(mesh.points, finest))
rim = mesh.points[np.unique(mesh.edges_named("far"))]
off = np.abs(np.hypot(rim[:, 0] - 0.5, rim[:, 1]) - 3).max()
print(f"vertices are off the far field by at most {off:.1e}")
assert off < 1e-14
mesh.validate().raise_if_invalid()

# %%
# The area is that between the true curves; of the mesh, that between their chords.
print(f"area of the domain {domain.area:.6f}, of the mesh {mesh.areas.sum():.6f}")
assert abs(mesh.areas.sum() / domain.area - 1) < 5e-3

# %%
am.plot(mesh, bounds=(-0.2, -0.5, 1.8, 0.6), title="An aerofoil").show()
