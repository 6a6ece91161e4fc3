"""A wall layer
============

Thin triangles along a curved wall.

A channel two metres long with a bump on its floor. Along the floor, triangles are to be 0.5 mm
across and 20 mm along the wall; both sizes grow with the distance. That takes a tensor at every
point, with the direction across the wall as one of its axes.
"""

import numpy as np
from scipy.spatial import cKDTree

import adaptmesh as am


def floor(s):
    return 0.12 * np.exp(-(((s - 0.8) / 0.18) ** 2))


# %%
# The domain: the floor as a polyline, three straight sides, and a name for each side.
s = np.linspace(0, 2, 101)
corners = np.concatenate([np.stack([s, floor(s)], axis=1), [(2, 0.8), (0, 0.8)]])
n = len(s) - 1
names = {"floor": range(n), "outlet": [n], "ceiling": [n + 1], "inlet": [n + 2]}
domain = am.Domain.polygon(corners, names=names)

# %%
# The floor as a row of near points, to find the nearest one and the direction of the wall there.
s = np.linspace(0, 2, 2001)
wall = np.stack([s, floor(s)], axis=1)
along = np.gradient(wall, axis=0)
along /= np.linalg.norm(along, axis=1)[:, None]
nearest_on_wall = cKDTree(wall)

H_ACROSS, H_ALONG, GROWTH, LARGEST = 0.0005, 0.02, 0.15, 0.06


def metric(x):
    _, k = nearest_on_wall.query(x)
    tx, ty = along[k].T
    dx, dy = (x - wall[k]).T
    distance = np.abs(dy * tx - dx * ty)
    across = np.minimum(H_ACROSS + GROWTH * distance, LARGEST) ** -2
    lengthwise = np.minimum(H_ALONG + GROWTH * distance, LARGEST) ** -2
    # M = lengthwise t t' + across n n', with the unit vectors t along the wall and n = (-ty, tx)
    return np.stack(
        [
            lengthwise * tx * tx + across * ty * ty,
            (lengthwise - across) * tx * ty,
            lengthwise * ty * ty + across * tx * tx,
        ],
        axis=1,
    )


mesh = am.generate(domain, metric)
report = am.measure(mesh, metric)
print(mesh)
print(report)
assert report.unit_fraction > 0.95

# %%
# The triangles that stand on the floor are as high as an equilateral one of the size across.
on_floor = np.unique(np.sort(mesh.edges_named("floor"), axis=1), axis=0)
sides = np.sort(mesh.triangles[:, [[1, 2], [2, 0], [0, 1]]], axis=2)
keys = sides[..., 0].astype(int) * len(mesh.points) + sides[..., 1]
stands = np.isin(keys, on_floor[:, 0].astype(int) * len(mesh.points) + on_floor[:, 1])
p, q = mesh.points[sides[stands]].transpose(1, 0, 2)
base = np.linalg.norm(q - p, axis=1)
height = 2 * mesh.areas[stands.any(axis=1)] / base
height, base = 1000 * np.median(height), 1000 * np.median(base)
print(f"first row: height {height:.3f} mm, base {base:.1f} mm")
assert 0.7 < height / (500 * np.sqrt(3) * H_ACROSS) < 1.4

# %%
am.plot(mesh, title="A channel with a bump on its floor").show()
am.plot(
    mesh,
    metric,
    ellipses=True,
    bounds=(0.6, 0.08, 0.8, 0.16),
    title="Where the bump rises",
).show()
