"""What a loop in time has done: the intervals of each sweep, to be printed, saved and resumed."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field, replace
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from adaptmesh.mesh.mesh import Mesh
from adaptmesh.types import Floats
from adaptmesh.value import Value

from .history import PathLike, Seconds

if TYPE_CHECKING:
    from adaptmesh.domain.domain import Domain

Fields = Mapping[str, NDArray[Any]]


@dataclass(frozen=True, eq=False)
class Interval(Value):
    """What happened on one mesh.

    Attributes
    ----------
    start, end : float
        Of the interval.
    mesh : Mesh
    first, last : mapping of str to array
        The fields at its start, as they were carried there, and at its end.
    times : (k,) array
        Of the samples from which the metric was made.
    hessians : mapping of str to (n, 3) array
        Over the interval, of each field that steers, at the vertices: the next sweep is made for
        these.
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


@dataclass(frozen=True, eq=False)
class TransientHistory(Value):
    """The intervals of each sweep; print it.

    Attributes
    ----------
    sweeps : tuple of tuple of Interval
        The last is the best; it has fewer intervals than the others if the loop was interrupted.
    options : mapping of str to str
        What the meshes were made for, as text.
    """

    sweeps: tuple[tuple[Interval, ...], ...] = ()
    options: Mapping[str, str] = field(default_factory=dict)

    @property
    def intervals(self) -> tuple[Interval, ...]:
        """Those of the last sweep."""
        return self.sweeps[-1] if self.sweeps else ()

    def with_interval(self, interval: Interval, sweep: int) -> TransientHistory:
        """The same with one interval more in a sweep, the last or the next."""
        before, now = self.sweeps[:sweep], self.sweeps[sweep:]
        return replace(self, sweeps=(*before, (*sum(now, ()), interval)))

    def mean_vertices(self, sweep: int = -1) -> float:
        """The number of vertices, averaged over time."""
        intervals = self.sweeps[sweep]
        weights = [i.end - i.start for i in intervals]
        return float(np.average([len(i.mesh.points) for i in intervals], weights=weights))

    @property
    def seconds(self) -> Seconds:
        """Of all intervals of all sweeps together."""
        return sum((i.seconds for sweep in self.sweeps for i in sweep), Seconds())

    def save(self, folder: PathLike) -> None:
        """Write everything into a folder, as ``transient_loop(..., save=folder)`` does on its way.

        Parameters
        ----------
        folder : path
            Made if it does not exist. A history that is there is replaced.

        Raises
        ------
        FormatError
            It cannot be written.
        """
        from .transient_files import save

        save(self, Path(folder))

    @classmethod
    def load(cls, folder: PathLike, domain: Domain | None = None) -> TransientHistory:
        """Read what `save`, or ``transient_loop(..., save=folder)``, has written.

        Parameters
        ----------
        folder : path
        domain : Domain, optional
            What was meshed: domains are not saved. Meshes come without one if it is not given.

        Raises
        ------
        FormatError
            There is no history, or it is damaged.
        """
        from .transient_files import load

        return load(Path(folder), domain)

    def __repr__(self) -> str:
        counts = [len(sweep) for sweep in self.sweeps]
        return f"<TransientHistory: {len(counts)} sweeps of {max(counts, default=0)} intervals>"

    def __str__(self) -> str:
        lines = ["sweep  vertices, averaged over time    least     most  seconds  in adaptmesh"]
        for k, sweep in enumerate(self.sweeps):
            counts = [len(i.mesh.points) for i in sweep]
            spent = sum((i.seconds for i in sweep), Seconds())
            lines.append(
                f"{k:5d}  {self.mean_vertices(k):28.0f} {min(counts):8d} {max(counts):8d} "
                f"{spent.total:8.1f} {spent.share_of_library:13.0%}"
            )
        return "\n".join(lines)
