"""What a loop in time has done: the intervals of each sweep, to be printed, saved and resumed."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field, replace
from pathlib import Path
from typing import Any, ClassVar

import numpy as np

from adaptmesh.domain.domain import Domain
from adaptmesh.errors import FormatError
from adaptmesh.files.notes import Notes

from .archive import name_damage, read_interval, write_interval
from .base_history import BaseHistory
from .records import Interval, Seconds


@dataclass(frozen=True, eq=False)
class TransientHistory(BaseHistory):
    """The intervals of each sweep; print it.

    Attributes
    ----------
    sweeps : tuple of tuple of Interval
        The last is the best; it has fewer intervals than the others if the loop was interrupted.
    options : mapping of str to str
        What the meshes were made for, as text.
    """

    LIST: ClassVar[str] = "transient.json"
    KIND: ClassVar[str] = "history in time"

    sweeps: tuple[tuple[Interval, ...], ...] = ()
    options: Mapping[str, str] = field(default_factory=dict)

    @property
    def records(self) -> Sequence[Interval]:
        """The intervals of all sweeps, in order."""
        return tuple(interval for sweep in self.sweeps for interval in sweep)

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

    def __repr__(self) -> str:
        counts = [len(sweep) for sweep in self.sweeps]
        return f"<TransientHistory: {len(counts)} sweeps of {max(counts, default=0)} intervals>"

    def __str__(self) -> str:
        lines = ["sweep  vertices, averaged over time      min      max  seconds  in adaptmesh"]
        for k, sweep in enumerate(self.sweeps):
            counts = [len(i.mesh.points) for i in sweep]
            spent = sum((i.seconds for i in sweep), Seconds())
            lines.append(
                f"{k:5d}  {self.mean_vertices(k):28.0f} {min(counts):8d} {max(counts):8d} "
                f"{spent.total:8.1f} {spent.share_of_library:13.0%}"
            )
        return "\n".join(lines)

    def _write_record(self, number: int, folder: Path) -> None:
        names = [_file_name(k, i) for k, sweep in enumerate(self.sweeps) for i in range(len(sweep))]
        write_interval(folder / names[number], self.records[number])

    def _list(self) -> dict[str, Any]:
        return {"options": dict(self.options), "intervals": [len(sweep) for sweep in self.sweeps]}

    @classmethod
    def _of_list(cls, content: Notes, path: Path, domain: Domain | None) -> TransientHistory:
        with name_damage(path):
            counts = content.counts("intervals")
            if 0 in counts:
                raise FormatError(f"sweep {counts.index(0)} has no intervals")
            options = content.texts("options") if "options" in content else {}
        sweeps = [_existing_files(path, sweep, count) for sweep, count in enumerate(counts)]
        return cls(
            tuple(tuple(read_interval(p, domain) for p in sweep) for sweep in sweeps), options
        )


def _existing_files(path: Path, sweep: int, count: int) -> list[Path]:
    """The files of a sweep; a `FormatError` that names the first one missing."""
    out: list[Path] = []
    while len(out) < count:
        out.append(path.parent / _file_name(sweep, len(out)))
        if not out[-1].exists():
            raise FormatError(f"{path}: {out[-1].name} is missing")
    return out


def _file_name(sweep: int, number: int) -> str:
    return f"sweep_{sweep:02d}_interval_{number:04d}.npz"
