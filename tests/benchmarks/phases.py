"""Where the time of `generate` goes, stage by stage, without anything built into it.

The functions that `generate` calls are wrapped while it runs, and its progress reports tell the
stages within the last of them. Time belongs to the innermost stage at work; that of the metric is
taken out of every other.
"""

from __future__ import annotations

import functools
import importlib
import time
from contextlib import ExitStack, contextmanager
from unittest import mock

import metrics

# Functions that adaptmesh.generate calls, and what their time is listed under.
STAGES = {
    "predict": "predict",
    "cut_outline": "cut",
    "triangulate_outline": "triangulate",
    "place_ahead_of_front": "front",
    "place_along_edges": "edges",
    "insert_what_was_missed": "missed",
    "settle": "settle",
    "finished_mesh": "finish",
}
REPORTED = {"smoothing": "smooth", "improving": "improve"}  # stages of its progress
METRIC, CHECKS, REST = "metric", "metric checked", "rest"
ORDER = (*STAGES.values(), *REPORTED.values(), METRIC, CHECKS, REST)


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
        if len(self._open) == 1:
            self._open[0] = REPORTED.get(reported, REST)

    def watched(self, function, name):
        @functools.wraps(function)
        def timed(*arguments, **options):
            with self.stage(name):
                return function(*arguments, **options)

        return timed


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
    generate = importlib.import_module("adaptmesh.generate.generate")
    ledger = Ledger()
    with ExitStack() as patches:
        for function, name in STAGES.items():
            timed = ledger.watched(getattr(generate, function), name)
            patches.enter_context(mock.patch.object(generate, function, timed))
        generate.generate(
            domain, Watched(metric, ledger), progress=lambda stage, _: ledger.turn_to(stage)
        )
    ledger.turn_to(REST)
    return ledger.seconds
