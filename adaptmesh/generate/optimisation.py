"""A filled mesh made better: smoothed, swapped, coarsened and refined, and settled at last."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from adaptmesh._core import Mesher, Settler
from adaptmesh.boundary.edge_lengths import measure_edges, measure_fresh_edges, refresh
from adaptmesh.boundary.vertex_limit import Budget, Progress
from metrics import ControlSpace


@dataclass(frozen=True)
class Optimisation:
    """How the filled mesh is improved.

    Attributes
    ----------
    smoothings : int
        Passes of smoothing over all vertices.
    wide_rounds, narrow_rounds : int
        Rounds of collapse, split, swap and search where edges are not nearly, and then where they
        are hardly unit.
    wide, narrow : (shortest, longest, least quality)
        What these rounds leave alone: vertices that touch only such edges and triangles.
    step : float
        First step of the search, in metric length.
    swap_below : float
        At last, edges beside triangles of lesser quality are swapped for shape.
    """

    smoothings: int = 2
    wide_rounds: int = 2
    narrow_rounds: int = 4
    wide: tuple[float, float, float] = (0.8, 1.25, 0.6)
    narrow: tuple[float, float, float] = (0.74, 1.36, 0.5)
    step: float = 0.12
    swap_below: float = 0.5


@dataclass(frozen=True)
class Settling:
    """How the last edges and triangles are mended, each change being measured before it is made.

    Attributes
    ----------
    steps : tuple of float
        One round for each: how far vertices are tried to be moved, as a share of the way to the
        rim of their triangles.
    least_quality : float
        Triangles of lesser quality are worked on, besides edges that are not unit.
    most_places, most_places_share : int, float
        If there are more places to work on than the one plus this share of the vertices, nothing is
        done: then the metric is beyond what straight edges can follow, and they are no exceptions.
    lifts : int
        Rounds in which the worst triangles are made better, at the most.
    lift_below : float
        Those of lesser quality.
    most_lifted, most_lifted_share : int, float
        And no more of them at a time than the one plus this share of the vertices.
    """

    steps: tuple[float, ...] = (0.3, 0.15, 0.3, 0.15, 0.3, 0.15)
    least_quality: float = 0.6
    most_places: int = 1000
    most_places_share: float = 0.125
    lifts: int = 6
    lift_below: float = 0.8
    most_lifted: int = 20
    most_lifted_share: float = 0.004


def optimise(
    mesher: Mesher,
    field: ControlSpace,
    options: Optimisation,
    budget: Budget,
    report: Progress,
) -> None:
    """Smooth and swap everywhere, then work on what is not yet unit."""
    bands = [options.wide] * options.wide_rounds + [options.narrow] * options.narrow_rounds
    steps = options.smoothings + len(bands)
    mesher.swap()
    for k in range(options.smoothings):
        report("smoothing", 0.7 + 0.27 * k / steps)
        mesher.smooth()
        refresh(mesher, field)
        mesher.swap()
    for k, band in enumerate(bands):
        report("improving", 0.7 + 0.27 * (options.smoothings + k) / steps)
        measure_fresh_edges(mesher, field, uncut_below=np.inf)
        changes = mesher.collapse_short_edges() + mesher.split_long_edges()
        budget.check(mesher.vertex_count)
        refresh(mesher, field)
        mesher.swap()
        changes += mesher.search_active(*band, options.step)
        if not changes:
            break
        refresh(mesher, field)
        mesher.swap()
    mesher.swap_worst(options.swap_below)


def settle(mesher: Mesher, field: ControlSpace, options: Settling, budget: Budget) -> None:
    """Change what is still off where the change, measured with the exact metric, is better."""
    measure_fresh_edges(mesher, field, uncut_below=np.inf)
    settler = mesher.settler(options.least_quality)
    for step in options.steps:
        places = mesher.find_sites(settler)
        most = options.most_places + options.most_places_share * mesher.vertex_count
        if places > most:
            return
        if not places or not settle_sites(mesher, settler, field, step):
            break
        budget.check(mesher.vertex_count)
    for _ in range(options.lifts):
        most_lifted = int(options.most_lifted + options.most_lifted_share * mesher.vertex_count)
        places = mesher.find_worst(settler, options.lift_below, most_lifted)
        if not places or not settle_sites(mesher, settler, field):
            return


def settle_sites(mesher: Mesher, settler: Settler, field: ControlSpace, step: float = 0.0) -> int:
    """Measure the sites that were found, and what might take their place; how many changed."""
    measure_edges(settler.sampler, field)
    mesher.set_kernels(settler, field(mesher.propose(settler, step)))
    measure_edges(settler.sampler, field)
    return mesher.accept(settler)
