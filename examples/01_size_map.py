"""A size map
==========

A perforated plate, fine around its holes.

The size is a function of position, 4 mm at the rims of the holes, growing by 20 % of the distance
from them up to 60 mm.
"""

import numpy as np
import shapely

import adaptmesh as am

# %%
# What to mesh: two metres by one, with three round holes.
centres_and_radii = [(0.45, 0.55, 0.2), (1.05, 0.4, 0.1), (1.5, 0.62, 0.15)]
holes = shapely.union_all([shapely.Point(x, y).buffer(r, 32) for x, y, r in centres_and_radii])
domain = am.Domain.polygon(shapely.box(0, 0, 2, 1) - holes)


# %%
# How fine: any function from points (n, 2) to sizes (n,) will do.
def size(x):
    return np.minimum(0.004 + 0.2 * shapely.distance(holes, shapely.points(x)), 0.06)


mesh = am.generate(domain, size)

# %%
# How well the mesh has the size that was asked for.
report = am.measure(mesh, size)
print(mesh)
print(report)
assert report.unit_fraction > 0.99
assert abs(mesh.areas.sum() - domain.area) < 1e-12

# %%
am.plot(mesh, show="size", title="A plate, fine around its holes").show()
