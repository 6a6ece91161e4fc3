"""What a loop has done: every mesh and every number, to be printed, plotted, saved and resumed."""

from __future__ import annotations

import os
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, field, replace
from pathlib import Path
from typing import TYPE_CHECKING, Any, overload

import numpy as np
from numpy.typing import NDArray

from adaptmesh.errors import FormatError
from adaptmesh.mesh.mesh import Mesh
from adaptmesh.types import Floats
from adaptmesh.value import Value

from .solution import Solved

if TYPE_CHECKING:
    from matplotlib.figure import Figure

    from adaptmesh.domain.domain import Domain

PathLike = str | os.PathLike[str]


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


STAGES = ("adapt", "transfer", "solve", "metric")


@dataclass(frozen=True, eq=False)
class Snapshot(Value):
    """The arrays of an iteration.

    Attributes
    ----------
    mesh : Mesh
    solved : Solved
        What was found on it.
    metric : (n, 3) array of float
        At the vertices of this mesh, for the next one.
    """

    mesh: Mesh
    solved: Solved
    metric: Floats


@dataclass(frozen=True)
class OnDisk:
    """A snapshot that is read from a file whenever it is asked for."""

    path: Path
    domain: Domain | None

    def read(self) -> Snapshot:
        from .history_files import read_snapshot

        return read_snapshot(self.path, self.domain)


@dataclass(frozen=True, eq=False)
class Iteration(Value):
    """A mesh, what was solved on it, and the metric for the next.

    Attributes
    ----------
    number : int
        0 for the mesh that the loop was given.
    n_points, n_triangles : int
        Of the mesh.
    errors : mapping of str to float
        On this mesh, by field: the estimate of its interpolation error, or what solve gave.
    unit_fraction : float
        Of the edges, those with a length in [1/√2, √2] in the metric that the mesh was made for
        (carried by the mesh before, by Simpson's rule); not a number for the mesh given.
    seconds : Seconds
    """

    number: int
    n_points: int
    n_triangles: int
    errors: Mapping[str, float]
    unit_fraction: float
    seconds: Seconds
    kept: Snapshot | OnDisk = field(repr=False)

    @property
    def snapshot(self) -> Snapshot:
        """The arrays; read from disk if they are only there."""
        if not isinstance(self.kept, OnDisk):
            return self.kept
        snapshot = self.kept.read()
        mesh = snapshot.mesh
        if (len(mesh.points), len(mesh.triangles)) != (self.n_points, self.n_triangles):
            raise FormatError(
                f"{self.kept.path}: is damaged, or of another history: its mesh has "
                f"{len(mesh.points)} points and {len(mesh.triangles)} triangles, not "
                f"{self.n_points} and {self.n_triangles}"
            )
        return snapshot

    @property
    def mesh(self) -> Mesh:
        return self.snapshot.mesh

    @property
    def fields(self) -> Mapping[str, NDArray[Any]]:
        """By name; ``"solution"`` for one that was returned without."""
        return self.snapshot.solved.fields

    @property
    def metric(self) -> Floats:
        """Packed (n, 3), at the vertices of this mesh: what the next mesh is made for."""
        return self.snapshot.metric


@dataclass(frozen=True, eq=False)
class History(Value, Sequence[Iteration]):
    """The iterations of a loop, in order; a sequence of `Iteration`.

    Attributes
    ----------
    iterations : tuple of Iteration
    reason : str
        Why the loop has ended; empty while it has not.
    converged : bool
        Whether it has ended because nothing changed any more.
    options : mapping of str to str
        What the loop was asked for, as text.
    options_since : int
        The first iteration that was made for these options, or whose mesh the loop started from
        when they changed; those before it belong to a call that was resumed with other options.
    """

    iterations: tuple[Iteration, ...] = ()
    reason: str = ""
    converged: bool = False
    options: Mapping[str, str] = field(default_factory=dict)
    options_since: int = 0

    @overload
    def __getitem__(self, index: int) -> Iteration: ...
    @overload
    def __getitem__(self, index: slice) -> tuple[Iteration, ...]: ...
    def __getitem__(self, index: int | slice) -> Iteration | tuple[Iteration, ...]:
        return self.iterations[index]

    def __len__(self) -> int:
        return len(self.iterations)

    @property
    def mesh(self) -> Mesh:
        """The last mesh."""
        return self._last().mesh

    @property
    def fields(self) -> Mapping[str, NDArray[Any]]:
        """What was solved on the last mesh."""
        return self._last().fields

    @property
    def meshes(self) -> Iterator[Mesh]:
        """All meshes, one after the other, so that those on disk need not be in memory at once."""
        return (iteration.mesh for iteration in self.iterations)

    @property
    def counts(self) -> NDArray[np.int64]:
        """The number of vertices of each mesh."""
        return np.array([iteration.n_points for iteration in self.iterations], np.int64)

    @property
    def errors(self) -> dict[str, Floats]:
        """By field, the estimate on each mesh; not a number where there is none."""
        names = dict.fromkeys(name for it in self.iterations for name in it.errors)
        return {
            name: np.array([it.errors.get(name, np.nan) for it in self.iterations])
            for name in names
        }

    @property
    def seconds(self) -> Seconds:
        """Of all iterations together."""
        return sum((iteration.seconds for iteration in self.iterations), Seconds())

    def with_iteration(self, iteration: Iteration) -> History:
        """The same history and one iteration more, not yet ended."""
        return replace(self, iterations=(*self.iterations, iteration), reason="", converged=False)

    def ended(self, reason: str, converged: bool) -> History:
        """The same history with an end."""
        return replace(self, reason=reason, converged=converged)

    def save(self, folder: PathLike) -> None:
        """Write everything into a folder: see `History.load`.

        Each iteration has a file of its own, and ``history.json``, which is written last, says
        which belong to it: an interruption leaves what was whole before.

        Parameters
        ----------
        folder : path
            Made if it does not exist. A history that is there is replaced.

        Raises
        ------
        FormatError
            It cannot be written.
        """
        from .history_files import save

        save(self, Path(folder).absolute())

    @classmethod
    def load(cls, folder: PathLike, domain: Domain | None = None) -> History:
        """Read what `save`, or ``adapt_loop(..., save=folder)``, has written.

        Meshes and fields stay on disk until they are asked for.

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
        from .history_files import load

        return load(Path(folder).absolute(), domain)

    def plot(self, path: PathLike | None = None) -> Figure:
        """Draw estimates of error against the number of vertices, and both by iteration.

        Parameters
        ----------
        path : path, optional
            Where to write the picture; its extension says in which format.

        Returns
        -------
        matplotlib.figure.Figure
        """
        from .view import draw

        figure = draw(self)
        if path is not None:
            figure.savefig(path, dpi=150)
        return figure

    def __str__(self) -> str:
        from .view import as_text

        return as_text(self)

    def __repr__(self) -> str:
        return f"<History: {len(self)} iterations; {self.reason or 'not ended'}>"

    def _repr_html_(self) -> str:
        from .view import as_html

        return as_html(self)

    @property
    def for_options(self) -> tuple[Iteration, ...]:
        """The iterations made for `options`, from `options_since` on."""
        return self.iterations[self.options_since :]

    def _last(self) -> Iteration:
        if not self.iterations:
            raise IndexError("the history is empty: no iteration was completed")
        return self.iterations[-1]
