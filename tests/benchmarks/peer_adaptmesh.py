"""adaptmesh itself: one call, given the metric as a function; the time is the whole of it."""

from __future__ import annotations

from mesher import Direct, Run, Stopwatch
from phases import phases

import adaptmesh as am


class Adaptmesh(Direct):
    def __init__(self, problem):
        super().__init__(problem)
        problem.domain, problem.factor  # made beforehand, as for the others  # noqa: B018

    def make(self):
        with Stopwatch() as clock:
            mesh = am.generate(self.problem.domain, self.problem.metric)
        return Run(mesh.points, mesh.triangles, clock.cpu, clock.wall)

    def phases(self):
        """CPU seconds of each stage of `make`."""
        return phases(self.problem.domain, self.problem.metric)
