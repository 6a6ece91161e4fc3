"""What every mesher under comparison offers, and the clock it is timed with."""

from __future__ import annotations

import time
from abc import ABC, abstractmethod
from dataclasses import dataclass

import numpy as np
from cases import Problem

import metrics

# Passes of a remesher: at most so many, and it has converged when the share of unit edges has
# not risen by GAIN twice, or once when nearly all edges are unit.
MOST_PASSES = 8
GAIN = 0.003
NEARLY_ALL = 0.985


class Stopwatch:
    """CPU seconds of this process, and wall seconds, between entering and leaving."""

    def __enter__(self):
        self.cpu, self.wall = -time.process_time(), -time.perf_counter()
        return self

    def __exit__(self, *exception):
        self.cpu += time.process_time()
        self.wall += time.perf_counter()


@dataclass
class Run:
    """A mesh, and what it cost.

    Attributes
    ----------
    points, triangles : (n, 2), (m, 3) arrays
    cpu : float
        CPU seconds of the mesher alone: no files, no copies in and out.
    wall : float
        Wall seconds of all that a user waits for.
    extra : dict
        What the mesher itself wants to find again in the next pass.
    """

    points: np.ndarray
    triangles: np.ndarray
    cpu: float
    wall: float
    extra: dict | None = None


class Mesher(ABC):
    """A mesher and a problem to solve."""

    def __init__(self, problem: Problem) -> None:
        self.problem = problem

    @abstractmethod
    def converge(self) -> tuple[Run, float, float]:
        """The best mesh it makes, and CPU and wall seconds of all that led to it."""

    @abstractmethod
    def again(self) -> Run:
        """The last step of `converge` once more."""


class Direct(Mesher):
    """A mesher that is given the metric as a function, and is done in one call."""

    @abstractmethod
    def make(self) -> Run: ...

    def converge(self):
        run = self.make()
        return run, run.cpu, run.wall

    def again(self):
        return self.make()


class Remesher(Mesher):
    """A mesher that wants the metric at the vertices of a mesh.

    Its own previous mesh carries the exact metric; the first ones are coarser, by 64, 16 and 4, as
    a uniform mesh knows nothing of the metric between its vertices.
    """

    @abstractmethod
    def start(self) -> Run:
        """A nearly uniform mesh, coarse."""

    @abstractmethod
    def remesh(self, previous: Run, tensors: np.ndarray) -> Run:
        """One pass: the domain meshed again, for the metric at the vertices of a mesh."""

    def converge(self):
        current, best, best_share, stalled = self.start(), None, -1.0, 0
        cpu = wall = total_cpu = total_wall = 0.0
        for share_of_detail in _ramp(self.problem.target):
            given = current, share_of_detail * self.problem.metric(current.points)
            current = self.remesh(*given)
            cpu, wall = cpu + current.cpu, wall + current.wall
            if share_of_detail < 1:
                continue
            share = unit_share(current, self.problem.metric)
            stalled = 0 if share > best_share + GAIN else stalled + 1
            if share > best_share:
                best, best_share, self._last = current, share, given
                total_cpu, total_wall = cpu, wall
            if stalled >= (1 if best_share > NEARLY_ALL else 2):
                break
        return best, total_cpu, total_wall

    def again(self):
        return self.remesh(*self._last)


def _ramp(target):
    coarse = [1 / k for k in (64, 16, 4) if target / k >= 900]
    return coarse + [1.0] * (MOST_PASSES - len(coarse))


def unit_share(run, metric):
    edges, _ = metrics.mesh_edges(run.triangles)
    lengths = metrics.edge_lengths(run.points, edges, metric, max_depth=2)
    return float(np.mean((lengths >= 0.5**0.5) & (lengths <= 2**0.5)))
