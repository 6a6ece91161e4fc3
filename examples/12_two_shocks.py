"""Two shocks that cross
=====================

The intersection of two metrics.

Each shock asks for thin triangles along itself. Where they cross both are to be obeyed: the
intersection of the two metrics, written &, allows no step that is longer than either does.
"""

import numpy as np

import adaptmesh as am
import metrics
from metrics import tensor

ACROSS, ALONG = 0.004, 0.08
domain = am.Domain.rectangle(0, 0, 2, 1)

# %%
# One shock is a straight line given by its ends, the other a curve given by where a function is 0.
straight = metrics.Shock([(0.2, 1.0), (1.8, 0.0)], ACROSS, ALONG, growth=0.3, h_max=0.2)
bow = metrics.Shock(
    lambda x: x[:, 0] - 0.6 - 1.2 * (x[:, 1] - 0.25) ** 2, ACROSS, ALONG, growth=0.3, h_max=0.2
)
both = straight & bow

# %%
# Where they cross, a step across either shock is as short as that shock asks for.
y = np.roots([1.2, 1.6 - 0.6, 0.075 + 0.6 - 1.8])  # x from the curve, put into the line
y = y[(y > 0) & (y < 1)]
crossing = np.stack([1.8 - 1.6 * y, y], axis=1)
m = tensor.unpack(both(crossing))[0]
slope = 2.4 * (y[0] - 0.25)
for name, normal in (("straight", [1, 1.6]), ("bow", [1, -slope])):
    n = np.array(normal) / np.linalg.norm(normal)
    print(f"at {crossing[0].round(3)}, across the {name} shock: {(n @ m @ n) ** -0.5:.4f}")
    assert 0.9 * ACROSS < (n @ m @ n) ** -0.5 < 1.001 * ACROSS

for name, field in (("straight", straight), ("bow", bow), ("both", both)):
    mesh = am.generate(domain, field)
    print(f"{name}: {len(mesh.points)} vertices")
    x0, y0 = crossing[0]
    am.plot(
        mesh,
        field,
        ellipses=True,
        bounds=(x0 - 0.12, y0 - 0.08, x0 + 0.12, y0 + 0.08),
        title={"both": "The intersection of both"}.get(name, f"The {name} shock alone"),
    ).show()

# %%
report = am.measure(mesh, both)
print(report)
assert report.unit_fraction > 0.97
am.plot(mesh, title="Two shocks that cross").show()
