"""What the histories of both loops share: records in a folder, one file each, and their list."""

from __future__ import annotations

import os
from abc import ABC, abstractmethod
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any, ClassVar, TypeVar

from adaptmesh.domain.domain import Domain
from adaptmesh.errors import FormatError
from adaptmesh.files.notes import Notes
from adaptmesh.mesh.mesh import Mesh
from adaptmesh.value import Value

from .archive import make_folder, read_list, write_list
from .iteration import Iteration
from .records import Interval, Seconds

PathLike = str | os.PathLike[str]
H = TypeVar("H", bound="BaseHistory")


class BaseHistory(ABC, Value):
    """Records of a loop in order, each an iteration or an interval, and what it was asked for."""

    LIST: ClassVar[str]  # the file that says which records belong together
    KIND: ClassVar[str]  # for messages

    options: Mapping[str, str]

    def save(self, folder: PathLike) -> None:
        """Write everything into a folder, as ``save=folder`` of the loop does on its way.

        Each record has a file of its own, and the list of them is written last: an interruption
        leaves what was whole before.

        Parameters
        ----------
        folder : path
            Made if it does not exist. A history that is there is replaced.

        Raises
        ------
        FormatError
            It cannot be written.
        """
        path = Path(folder).absolute()
        make_folder(path)
        (path / self.LIST).unlink(missing_ok=True)
        for k in range(len(self.records)):
            self._write_record(k, path)
        self.write_list(path)

    def append(self, folder: Path) -> None:
        """Write the last record, then the list."""
        self._write_record(len(self.records) - 1, folder)
        self.write_list(folder)

    def write_list(self, folder: Path) -> None:
        """Write the list of all records."""
        write_list(folder / self.LIST, self._list())

    @classmethod
    def load(cls: type[H], folder: PathLike, domain: Domain | None = None) -> H:
        """Read what `save`, or ``save=folder`` of the loop, has written.

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
        path = Path(folder).absolute() / cls.LIST
        if not path.exists():
            raise FormatError(f"{path.parent}: there is no {cls.KIND} here ({cls.LIST} is missing)")
        return cls._of_list(read_list(path), path, domain)

    @classmethod
    def refuse_to_replace(cls, folder: Path) -> None:
        """Raise if there is a history of this kind in a folder."""
        if (folder / cls.LIST).exists():
            raise FormatError(
                f"{folder}: there is a history in this folder; give it as `resume` too to go on "
                "with it, or choose another folder"
            )

    @property
    @abstractmethod
    def records(self) -> Sequence[Iteration | Interval]:
        """All iterations, or the intervals of all sweeps."""

    @property
    def first_mesh(self) -> Mesh | None:
        """The mesh that the loop began with; None if there is no record."""
        return self.records[0].mesh if self.records else None

    @property
    def seconds(self) -> Seconds:
        """Of all records together."""
        return sum((record.seconds for record in self.records), Seconds())

    @abstractmethod
    def _write_record(self, number: int, folder: Path) -> None:
        """Write a record, unless it is in that folder already."""

    @abstractmethod
    def _list(self) -> dict[str, Any]:
        """What the list says, for JSON."""

    @classmethod
    @abstractmethod
    def _of_list(cls: type[H], content: Notes, path: Path, domain: Domain | None) -> H:
        """The history of a list that was read from a path."""
