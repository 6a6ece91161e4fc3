"""What a loop has done: every mesh and every number, to be printed, plotted, saved and resumed."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, field, replace
from pathlib import Path
from typing import TYPE_CHECKING, Any, ClassVar, overload

from adaptmesh.domain.domain import Domain
from adaptmesh.errors import FormatError
from adaptmesh.files.notes import Notes
from adaptmesh.mesh.mesh import Mesh
from adaptmesh.types import Floats, Int64s

from .archive import OnDisk, name_damage, write_snapshot
from .base_history import BaseHistory, PathLike
from .iteration import Iteration, counts_of, errors_of, file_name
from .records import Fields

if TYPE_CHECKING:
    from matplotlib.figure import Figure


@dataclass(frozen=True, eq=False)
class History(BaseHistory, Sequence[Iteration]):
    """The iterations of a loop, in order; a sequence of `Iteration`.

    Of one that was loaded, meshes and fields stay on disk until they are asked for.

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

    LIST: ClassVar[str] = "history.json"
    KIND: ClassVar[str] = "history"

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
    def records(self) -> Sequence[Iteration]:
        """The same as `iterations`."""
        return self.iterations

    @property
    def mesh(self) -> Mesh:
        """The last mesh."""
        return self._last().mesh

    @property
    def fields(self) -> Fields:
        """What was solved on the last mesh."""
        return self._last().fields

    @property
    def meshes(self) -> Iterator[Mesh]:
        """All meshes, one after the other, so that those on disk need not be in memory at once."""
        return (iteration.mesh for iteration in self.iterations)

    @property
    def counts(self) -> Int64s:
        """The number of vertices of each mesh."""
        return counts_of(self.iterations)

    @property
    def errors(self) -> dict[str, Floats]:
        """By field, the estimate on each mesh; not a number where there is none."""
        return errors_of(self.iterations)

    @property
    def for_options(self) -> tuple[Iteration, ...]:
        """The iterations made for `options`, from `options_since` on."""
        return self.iterations[self.options_since :]

    def with_iteration(self, iteration: Iteration) -> History:
        """The same history and one iteration more, not yet ended."""
        return replace(self, iterations=(*self.iterations, iteration), reason="", converged=False)

    def ended(self, reason: str, converged: bool) -> History:
        """The same history with an end."""
        return replace(self, reason=reason, converged=converged)

    def left_on_disk(self, folder: Path, keep_last: int) -> History:
        """The same history, with no more than the last `keep_last` snapshots in memory."""
        domain, older = self.mesh.domain, len(self) - keep_last
        iterations = tuple(
            it
            if k >= older or isinstance(it.kept, OnDisk)
            else replace(it, kept=OnDisk(folder / file_name(k), domain))
            for k, it in enumerate(self)
        )
        return replace(self, iterations=iterations)

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
        from . import view  # which loads rich, a tenth of a second

        figure = view.draw(self.iterations)
        if path is not None:
            figure.savefig(path, dpi=150)
        return figure

    def __str__(self) -> str:
        from . import view

        return view.as_text(self.iterations, self._end())

    def __repr__(self) -> str:
        return f"<History: {len(self)} iterations; {self.reason or 'not ended'}>"

    def _repr_html_(self) -> str:
        from . import view

        return view.as_html(self.iterations, self._end())

    def _end(self) -> str:
        if not self.reason:
            return "not ended"
        return f"{'converged' if self.converged else 'not converged'}: {self.reason}"

    def _last(self) -> Iteration:
        if not self.iterations:
            raise IndexError("the history is empty: no iteration was completed")
        return self.iterations[-1]

    def _write_record(self, number: int, folder: Path) -> None:
        iteration = self.iterations[number]
        path = folder / file_name(iteration.number)
        if not (isinstance(iteration.kept, OnDisk) and iteration.kept.path == path):
            write_snapshot(path, iteration.snapshot)

    def _list(self) -> dict[str, Any]:
        return {
            "options": dict(self.options),
            "options_since": self.options_since,
            "reason": self.reason,
            "converged": self.converged,
            "iterations": [iteration.numbers() for iteration in self],
        }

    @classmethod
    def _of_list(cls, content: Notes, path: Path, domain: Domain | None) -> History:
        with name_damage(path):
            numbers = [Notes(n) for n in content.items("iterations")]
            history = cls(
                tuple(Iteration.of_numbers(n, path.parent, domain) for n in numbers),
                content.text("reason"),
                content.flag("converged"),
                content.texts("options"),
                content.count("options_since") if "options_since" in content else 0,
            )
        for k, iteration in enumerate(history):
            name = file_name(iteration.number)
            if iteration.number != k or not (path.parent / name).exists():
                raise FormatError(f"{path}: iteration {k} is missing ({name})")
        return history
