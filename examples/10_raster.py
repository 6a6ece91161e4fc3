"""Sizes from a raster
===================

Hills, with small triangles where they are steep.

Sizes often come as an image: a satellite product, a simulation on a grid, a drawing. Here one is
made from heights of terrain, 25 m to a cell, with row 0 in the north as in a GeoTIFF and without
data where there is water. A file would be read with metrics.Raster.read("size.tif").
"""

import numpy as np

import adaptmesh as am
import metrics

# %%
# Heights in metres on 6 km x 4 km; x eastwards along the rows, y southwards from row to row.
CELL, WIDTH, HEIGHT = 25.0, 6000.0, 4000.0
x = np.arange(CELL / 2, WIDTH, CELL)
y = np.arange(HEIGHT - CELL / 2, 0, -CELL)
X, Y = np.meshgrid(x, y)
hills = [(1500, 2700, 600, 420), (3600, 1500, 450, 600), (4700, 3000, 350, 380)]
heights = sum(h * np.exp(-((X - cx) ** 2 + (Y - cy) ** 2) / r**2) for cx, cy, r, h in hills)
heights = heights - 40 + 0.02 * X

# %%
# 200 m on level ground down to 25 m where the terrain rises by 1 in 1; NaN on the water.
rise = np.hypot(*np.gradient(heights, CELL))
sizes = np.where(heights > 0, np.clip(40 / np.maximum(rise, 0.01), 25, 200), np.nan)
raster = metrics.Raster(sizes, x=x, y=y, fill="nearest")
print(raster)

# %%
# Whatever else is wanted is added with &: a camp between the hills, to be seen in detail.
camp = metrics.Distance((4150, 2300), h_min=15, growth=0.25)
field = raster & camp

mesh = am.generate(am.Domain.rectangle(0, 0, WIDTH, HEIGHT), field)
report = am.measure(mesh, field)
print(mesh)
print(report)
assert report.unit_fraction > 0.97
assert 0.9 < report.count_ratio < 1.1

# %%
am.plot(mesh, show="size", title="Small where the ground is steep").show()
