"""What a loop keeps of an iteration or an interval: its arrays, and the time that it took."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field

from adaptmesh.mesh.mesh import Mesh
from adaptmesh.types import Array, Floats
from adaptmesh.value import Value

from .solution import Solution

Fields = Mapping[str, Array]

STAGES = ("adapt", "transfer", "solve", "metric")


@dataclass(frozen=True)
class Seconds:
    """Wall-clock time by stage: making the mesh (adapt, transfer), solving on it, estimating."""

    adapt: float = 0.0
    transfer: float = 0.0
    solve: float = 0.0
    metric: float = 0.0

    def __add__(self, other: Seconds) -> Seconds:
        return Seconds(*(getattr(self, s) + getattr(other, s) for s in STAGES))

    @property
    def total(self) -> float:
        return self.adapt + self.transfer + self.solve + self.metric

    @property
    def share_of_library(self) -> float:
        """The share of time that was not in the user's solve; 0 if there was none."""
        return 1 - self.solve / self.total if self.total else 0.0


@dataclass(frozen=True, eq=False)
class Snapshot(Value):
    """The arrays of an iteration.

    Attributes
    ----------
    mesh : Mesh
    solution : Solution
        On this mesh.
    metric : (n, 3) array of float
        At the vertices of this mesh, for the next one.
    """

    mesh: Mesh
    solution: Solution
    metric: Floats


@dataclass(frozen=True, eq=False)
class Interval(Value):
    """What happened on one mesh.

    Attributes
    ----------
    start, end : float
        Of the interval.
    mesh : Mesh
    first, last : mapping of str to array
        The fields at its start, as they were transferred, and at its end.
    times : (k,) array
        Of the samples from which the metric was made.
    hessians : mapping of str to (n, 3) array
        Absolute, at the vertices, over the interval, of each field that the meshes are adapted to:
        the mesh of the next sweep is made for these.
    seconds : Seconds
        Wall-clock time; `solve` is that in `initial` and `advance`.
    """

    start: float
    end: float
    mesh: Mesh
    first: Fields = field(repr=False)
    last: Fields = field(repr=False)
    times: Floats = field(repr=False)
    hessians: Fields = field(repr=False)
    seconds: Seconds
    is_bare: bool = field(repr=False)  # whether `advance` is given an array and not a dict
