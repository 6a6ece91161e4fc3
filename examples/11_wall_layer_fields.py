"""A wall layer from ready-made fields
===================================

A strut in a stream, with y+ = 1 at its wall.

The height of the first layer comes from the Reynolds number, the size along the wall from its
curvature; away from the wall both sizes grow into one another. Behind the strut the wake is kept
fine by a second field.
"""

import numpy as np

import adaptmesh as am
import metrics

# %%
# The strut: an ellipse of chord 1 m, and of 0.2 m across.
t = np.linspace(0, 2 * np.pi, 2001)
wall = np.stack([0.5 * np.cos(t), 0.1 * np.sin(t)], axis=1)

height = metrics.first_height(y_plus=1, reynolds=2e5, length=1.0)
along = metrics.BoundaryCurvature(wall, elements_per_circle=60, h_max=0.02, growth=0.2)
layer = metrics.BoundaryLayer(wall, height, growth_ratio=1.25, tangential=along, h_max=0.2)
wake = metrics.Distance([(0.5, 0), (2.5, 0)], h_min=0.02, growth=0.15)
field = layer & wake
print(f"first height {1e6 * height:.0f} micrometres, along the wall {along}")

# %%
# Corners of the strut, one size apart: equal shares of the integral of ds / h along the wall.
steps = np.linalg.norm(np.diff(wall, axis=0), axis=1)
middles = 0.5 * (wall[1:] + wall[:-1])
h = metrics.tensor.sizes(along(middles))[:, 0]
count = np.concatenate([[0], np.cumsum(steps / h)])
shares = np.linspace(0, count[-1], round(count[-1]) + 1)[:-1]
strut = wall[np.searchsorted(count, shares)]

box = [(-2, -1.5), (4, -1.5), (4, 1.5), (-2, 1.5)]
domain = am.Domain.polygon(box, [strut], names={"wall": range(4, 4 + len(strut))})
mesh = am.generate(domain, field)
report = am.measure(mesh, field)
print(mesh)
print(report)
assert report.unit_fraction > 0.9

# %%
# The triangles that stand on the wall are as thin as asked, and up to 200 times as long.
on_wall = np.isin(mesh.triangles, mesh.edges_named("wall"))
standing = on_wall.sum(axis=1) == 2
p = mesh.points[mesh.triangles[standing]]
base = np.linalg.norm(np.roll(p, -1, axis=1) - p, axis=2).max(axis=1)
thin = 2 * mesh.areas[standing] / base
print(
    f"{standing.sum()} triangles on the wall, median height {1e6 * np.median(thin):.0f} micrometres"
)
assert 0.6 < np.median(thin) / (height * np.sqrt(3) / 2) < 1.7

# %%
view = (-0.9, -0.6, 1.3, 0.6)
am.plot(mesh, bounds=view, title="A strut and its wake").show()
am.plot(
    mesh,
    field,
    ellipses=True,
    bounds=(-0.511, -0.0045, -0.496, 0.0045),
    title="The nose",
).show()
