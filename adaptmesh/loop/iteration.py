"""One iteration of a loop: its numbers in memory, its arrays there too or on disk."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import asdict, dataclass, field
from pathlib import Path
from typing import Any

import numpy as np

from adaptmesh.domain.domain import Domain
from adaptmesh.errors import FormatError
from adaptmesh.files.notes import Notes
from adaptmesh.mesh.mesh import Mesh
from adaptmesh.types import Floats, Int64s
from adaptmesh.value import FrozenMapping, Value

from .archive import OnDisk
from .records import Fields, Seconds, Snapshot


@dataclass(frozen=True, eq=False)
class Iteration(Value):
    """A mesh, the solution on it, and the metric for the next.

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
    def fields(self) -> Fields:
        """By name; ``"solution"`` for one that was returned without."""
        return self.snapshot.solution.fields

    @property
    def metric(self) -> Floats:
        """Packed (n, 3), at the vertices of this mesh: what the next mesh is made for."""
        return self.snapshot.metric

    def numbers(self) -> dict[str, Any]:
        """All but the arrays, for JSON."""
        return {
            "number": self.number,
            "n_points": self.n_points,
            "n_triangles": self.n_triangles,
            "errors": dict(self.errors),
            "unit_fraction": None if np.isnan(self.unit_fraction) else self.unit_fraction,
            "seconds": asdict(self.seconds),
        }

    @classmethod
    def of_numbers(cls, numbers: Notes, folder: Path, domain: Domain | None) -> Iteration:
        """The iteration with these numbers, whose arrays are in a folder."""
        number = numbers.count("number")
        is_first = numbers.is_null("unit_fraction")
        return cls(
            number=number,
            n_points=numbers.count("n_points"),
            n_triangles=numbers.count("n_triangles"),
            errors=FrozenMapping(numbers.reals("errors")),
            unit_fraction=np.nan if is_first else numbers.real("unit_fraction"),
            seconds=numbers.record("seconds", Seconds),
            kept=OnDisk(folder / file_name(number), domain),
        )


def file_name(number: int) -> str:
    """The name of the file with the arrays of an iteration."""
    return f"iteration_{number:04d}.npz"


def counts_of(iterations: Sequence[Iteration]) -> Int64s:
    """The number of vertices of each mesh."""
    return np.array([iteration.n_points for iteration in iterations], np.int64)


def errors_of(iterations: Sequence[Iteration]) -> dict[str, Floats]:
    """By field, the estimate on each mesh; not a number where there is none."""
    names = dict.fromkeys(name for it in iterations for name in it.errors)
    return {name: np.array([it.errors.get(name, np.nan) for it in iterations]) for name in names}
