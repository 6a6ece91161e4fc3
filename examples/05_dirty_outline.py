"""A dirty outline
===============

The coast of Iceland as delivered, repaired, simplified, meshed.

The file is quantised, and its largest island crosses itself: no mesher takes it. `repair` says what
it does to it. Its 3000 points are as near as 300 m to each other, far below the 15 km asked for;
`simplify` leaves out what does not matter at that size.
"""

import sys
from pathlib import Path

import adaptmesh as am

coast = Path(sys.argv[0]).parent / "data" / "iceland.geojson"

# %%
# Without repair it is refused, by place.
try:
    am.read_domain(coast)
except am.DomainError as error:
    print(error)

domain, repairs = am.repair(coast)
print(repairs)
assert repairs.counts == {"crossing": 1}
assert abs(domain.area - 101_716.802) < 0.001  # square kilometres

# %%
# Every corner becomes a vertex: at 15 km the fjords force triangles that are far smaller.
size = 15.0
before = am.generate(domain, size)

# %%
# No shore moves by more than a tenth of the size, and islands below half of it are left out.
simple, dropped = am.simplify(domain, size, loops_below=0.5)
print(dropped)
assert dropped.displacement <= 0.1 * size
mesh = am.generate(simple, size)
report = am.measure(mesh, size)
print(f"{before}\n{mesh}\n{report}")
assert len(mesh.triangles) < 0.4 * len(before.triangles)
assert abs(simple.area / domain.area - 1) < 0.01

# %%
am.plot(before, title="Iceland, all that is in the file").show()
am.plot(mesh, title="Iceland, what matters at 15 km").show()
