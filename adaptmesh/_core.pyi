"""Types of the compiled core; see the C++ headers in core/ for what each thing does."""

from collections.abc import Callable
from enum import Enum

import numpy as np
from numpy.typing import NDArray

Floats = NDArray[np.float64]
Ints = NDArray[np.int32]
Bools = NDArray[np.bool_]

MAX_VERTICES: int
FREE: int
FIXED: int

class Fault(Exception):  # noqa: N818
    """What is wrong with points and segments: (kind, i, j, x, y)."""

    args: tuple[str, int, int, float, float]

def orient2d(a: Floats, b: Floats, c: Floats) -> NDArray[np.int8]: ...
def incircle(a: Floats, b: Floats, c: Floats, d: Floats) -> NDArray[np.int8]: ...
def delaunay(points: Floats) -> tuple[Ints, Ints]: ...
def triangulate(
    points: Floats,
    segments: Ints,
    holes: Floats,
    seeds: Floats,
    nesting: bool,
    certain: bool = False,
) -> tuple[Ints, Ints, Ints, Ints, Bools]: ...
def encounters(
    points: Floats, segments: Ints, is_unseen: Bools, tolerance: float, most_crossings: int
) -> tuple[Ints, Ints]: ...
def sweep_border(points: Floats, edges: Ints) -> tuple[tuple[int, int], Ints]: ...
def decimate(
    points: Floats, tensors: Floats, edges: Ints, kind: Ints, share: float
) -> tuple[Ints, Ints, Ints, NDArray[np.int64]]: ...

LONGEST_CHORD: float
AGREEMENT: float
SHORTEST_CHORD: float
FINE_DEPTH: int
LONGEST_FINE_CHORD: float

Metric = Callable[[Floats], Floats]
MeshArrays = tuple[Floats, Ints, Ints, Ints, Ints]

class TooManyVertices(Exception):  # noqa: N818
    """A mesh needs more vertices than allowed: (x, y) near which many are, or ()."""

    args: tuple[float, ...]

class MeasuredEdges:
    def __init__(
        self, points: Floats, tensors: Floats, edges: Ints, metric: Metric, max_vertices: int
    ) -> None: ...
    def lengths(self) -> Floats: ...
    def cut(self) -> tuple[Floats, Ints]: ...

class Placement(Enum):
    front = 0
    edges = 1

class Monitor:
    def __init__(
        self, max_vertices: int, expected_vertices: int, progress: Callable[[str, float], None]
    ) -> None: ...

class BoundaryCuts:
    def __init__(
        self,
        points: Floats,
        tensors: Floats,
        segments: Ints,
        owners: Ints,
        pieces: Ints,
        piece_segments: Ints,
        is_chord: Bools,
        cuts: Floats,
        cut_tensors: Floats,
        cut_pieces: Ints,
        ties: Ints,
    ) -> None: ...

def generate(
    boundary: BoundaryCuts,
    holes: Floats,
    seeds: Floats,
    nesting: bool,
    sample_points: Floats,
    sample_tensors: Floats,
    placement: Placement,
    metric: Metric,
    monitor: Monitor,
) -> MeshArrays: ...

class MetricMesh:
    def __init__(
        self,
        points: Floats,
        tensors: Floats,
        triangles: Ints,
        labels: Ints,
        edges: Ints,
        held_by: Ints,
    ) -> None: ...
    def points(self) -> Floats: ...
    def measure(self, metric: Metric) -> None: ...
    def edges(self) -> tuple[Ints, Floats, Bools]: ...
    def corners_below(self, quality: float) -> Ints: ...
    def hold_all_but(self, in_zone: Bools) -> int: ...
    def refill(
        self, sample_points: Floats, sample_tensors: Floats, metric: Metric, monitor: Monitor
    ) -> None: ...
    def recut(
        self,
        first_stop: Ints,
        stops: Ints,
        stop_places: Floats,
        first_cut: Ints,
        cuts: Floats,
        tensors: Floats,
        cut_places: Floats,
        segments: Ints,
    ) -> tuple[Ints, Floats, Ints]: ...
    def finished(self, edges: Ints, segments: Ints) -> MeshArrays: ...

class Locator:
    def __init__(self, points: Floats, triangles: Ints) -> None: ...
    def locate(self, points: Floats) -> tuple[Ints, Floats, Floats]: ...

def triangle_areas(corners: Floats) -> Floats: ...

class Overlay:
    def __init__(
        self, older: Locator, old_areas: Floats, newer: Locator, new_areas: Floats
    ) -> None: ...
    def pairs(self) -> tuple[NDArray[np.int64], Ints, Floats]: ...
    def moments(
        self,
        values: Floats,
        old_nodes: Ints,
        new_nodes: Ints,
        size: int,
        reach: float,
        low: Floats | None,
        high: Floats | None,
    ) -> Floats: ...
    def ranges(
        self, low: Floats, high: Floats, nodes: Ints, size: int
    ) -> tuple[Floats, Floats]: ...
