"""Where the time of `generate` goes, stage by stage, without anything built into it.

Its progress reports tell the stages; the time of the metric is taken out of every other.
"""

from __future__ import annotations

import time
from contextlib import contextmanager

import adaptmesh as am
import metrics

# Stages that the progress of adaptmesh.generate names, and what their time is listed under.
STAGES = {
    "predicting the size": "predict",
    "cutting the boundary": "cut",
    "triangulating": "triangulate",
    "placing points ahead of the front": "front",
    "placing points along edges": "edges",
    "smoothing": "smooth",
    "improving": "improve",
    "final optimisation": "final",
    "done": "finish",
}
METRIC, CHECKS, REST = "metric", "metric checked", "rest"
ORDER = (*STAGES.values(), METRIC, CHECKS, REST)


class Ledger:
    """CPU seconds of each stage."""

    def __init__(self):
        self.seconds = dict.fromkeys(ORDER, 0.0)
        self._open = [REST]
        self._since = time.process_time()

    def _book(self):
        now = time.process_time()
        self.seconds[self._open[-1]] += now - self._since
        self._since = now

    @contextmanager
    def stage(self, name):
        self._book()
        self._open.append(name)
        yield
        self._book()
        self._open.pop()

    def turn_to(self, reported):
        """The outermost stage becomes the one that a progress report names."""
        self._book()
        self._open[0] = STAGES.get(reported, REST)


class Watched(metrics.ControlSpace):
    """A metric given by a function, which books its time and that of the checks around it."""

    def __init__(self, function, ledger):
        self._function, self._ledger = function, ledger

    def values(self, points):
        with self._ledger.stage(METRIC):
            return self._function(points)

    def __call__(self, points):
        with self._ledger.stage(CHECKS):
            return super().__call__(points)


def phases(domain, metric):
    """CPU seconds of each stage of making one mesh."""
    ledger = Ledger()
    am.generate(domain, Watched(metric, ledger), progress=lambda stage, _: ledger.turn_to(stage))
    ledger.turn_to(REST)
    return ledger.seconds
