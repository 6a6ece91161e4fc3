"""From fields in time to a metric for each interval, all of them from one budget.

::

    t0 ----.-----.---- t1 ---.--- ...     Hessians at the samples of an interval become one of each
     h0    h1    h2    h3                 field, and those of all intervals one metric, as if their
     |_____|_____|_____|                  meshes were the parts of a single mesh: one factor, by
             h                            which the vertices, averaged over time, are as asked for
"""

from __future__ import annotations

import itertools
from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np

from adaptmesh.mesh.mesh import Mesh
from adaptmesh.types import Array, Floats
from metrics import Background, absolute, combined
from metrics.from_solution.optimal_metric import optimal_tensors
from metrics.from_solution.recovery import largest_magnitude
from metrics.measure.nodal import predicted_vertices

from .chosen_fields import check_scale, choose_fields, is_constant
from .metric_options import MetricOptions
from .vertex_count import check_count

Hessians = Mapping[str, Floats]
"""The absolute Hessian (n, 3) of each field that the meshes are adapted to."""

IN_TIME = ("average", "intersection")
PRECISION = 1e-3  # of the mean number of vertices predicted
TRIALS = 8
FLATNESS = 1e-8  # curvature below this share of the largest is not told from none


@dataclass(frozen=True, kw_only=True)
class TargetInTime(MetricOptions):
    """What the meshes of all intervals are made for; see `transient_loop` and `MetricOptions`."""

    target_vertices: float
    in_time: str = "average"

    def __post_init__(self) -> None:
        super().__post_init__()
        check_count(self.target_vertices)
        if self.in_time not in IN_TIME:
            raise ValueError(
                f"in_time={self.in_time!r}: expected one of {', '.join(map(repr, IN_TIME))}"
            )

    def hessians(self, mesh: Mesh, fields: Mapping[str, Array]) -> Hessians:
        """At one time; zero where a field is the same everywhere, as before anything happens."""
        chosen = choose_fields(self.fields, fields, mesh)
        varying = {name: v for name, v in chosen.items() if not is_constant(v)}
        for name, values in varying.items():
            check_scale(name, values)
        hessians = {name: c.absolute for name, c in self.curvatures(mesh, varying).items()}
        return {
            n: hessians[n] if n in hessians else np.zeros((len(v), 3)) for n, v in chosen.items()
        }

    def over_time(self, times: Floats, samples: Sequence[Hessians]) -> Hessians:
        """One Hessian of each field for an interval: the mean by trapezoids, or the finest."""
        weights = np.gradient(times)
        weights[[0, -1]] /= 2
        out = {}
        for name in samples[0]:
            of_field = [sample[name] for sample in samples]
            if self.in_time == "average":
                out[name] = np.average(of_field, axis=0, weights=weights)
            else:
                bent = [h for h in of_field if h.any()]
                out[name] = combined(bent) if bent else of_field[0]
        return out

    def metrics(
        self, meshes: Sequence[Mesh], hessians: Sequence[Hessians], lengths: Floats
    ) -> list[Background]:
        """The metric for each interval; their total is corrected until the mean over time is right.

        Parameters
        ----------
        meshes, hessians : sequences, one for each interval
        lengths : (k,) array
            Of the intervals.
        """
        n_of = np.cumsum([0, *(len(m.points) for m in meshes)])
        points = np.concatenate([m.points for m in meshes])
        triangles = np.concatenate([m.triangles + k for m, k in zip(meshes, n_of, strict=False)])
        stacked = [np.concatenate([h[name] for h in hessians]) for name in hessians[0]]
        bent = [absolute(h, FLATNESS * largest_magnitude(h)) for h in stacked if h.any()]
        total = self.target_vertices * len(meshes)
        for _ in range(TRIALS):
            whole = optimal_tensors(
                points,
                triangles,
                bent,
                target_vertices=total,
                p=self.p,
                limits=self.limits,
                combine=self.combine,
            )
            parts = [whole[a:b] for a, b in itertools.pairwise(n_of)]
            counts = [
                predicted_vertices(m.points, m.triangles, part)
                for m, part in zip(meshes, parts, strict=True)
            ]
            mean = float(np.average(counts, weights=lengths))
            if abs(mean / self.target_vertices - 1) < PRECISION:
                break
            total *= self.target_vertices / mean
        return [Background.on(m, part) for m, part in zip(meshes, parts, strict=True)]
