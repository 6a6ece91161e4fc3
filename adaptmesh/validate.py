"""Is it a mesh? Every invariant by name, each with the first items that break it.

The checks stand on one another:

1. arrays: finite points, indices in range;
2. neighbourhood: positive triangles by exact signs, two triangles to an edge, ...; and marks: what
   is constrained and tagged;
3. covering: the triangles cover what their border encloses once and only once;
4. domain: every segment of the domain that was meshed is there, with its tag.

Each is a function of `adaptmesh.invariants`; the tables below give their names.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass
from typing import TYPE_CHECKING, TypeVar

from .errors import AdaptmeshError
from .invariants import covering, fidelity, local
from .invariants.subject import Finding, Subject

if TYPE_CHECKING:
    from .mesh import Mesh

__all__ = ["Check", "InvalidMeshError", "Validity", "validate"]

S = TypeVar("S", bound=Subject)
Table = Mapping[str, Callable[[S], Finding]]

ARRAYS: Table[Subject] = {
    "not empty": local.not_empty,
    "finite points": local.finite_points,
    "indices in range": local.indices_in_range,
}
NEIGHBOURHOOD: Table[Subject] = {
    "positive triangles": local.positive_triangles,
    "distinct points": local.distinct_points,
    "two triangles an edge": local.two_triangles_an_edge,
    "same orientation": local.same_orientation,
}
MARKS: Table[Subject] = {
    "points used": local.points_used,
    "constrained are edges": local.constrained_are_edges,
    "border is constrained": local.border_is_constrained,
    "tags": local.tags,
}
BORDER: Table[Subject] = {
    "single turn": covering.single_turn,
    "simple border": covering.simple_border,
}
COVERING: Table[Subject] = {
    "covered once": covering.covered_once,
    "Euler's relation": covering.euler,
}
DOMAIN: Table[fidelity.DomainSubject] = {
    "points present": fidelity.points_present,
    "segments present": fidelity.segments_present,
    "curves present": fidelity.curves_present,
    "edges on segments": fidelity.edges_on_segments,
    "area of domain": fidelity.area_of_domain,
}


class InvalidMeshError(AdaptmeshError, ValueError):
    """A mesh that breaks an invariant; the message is the table of the checks."""


@dataclass(frozen=True)
class Check:
    """The verdict on one invariant; true if it holds.

    Attributes
    ----------
    name : str
        What must hold, in two or three words.
    ok : bool or None
        Whether it holds; None if it was not checked, because it rests on one that is broken.
    count : int
        How many items break it.
    note : str
        What was found.
    offenders : tuple of str
        The first few items that break it, with number and coordinates.
    """

    name: str
    ok: bool | None
    count: int = 0
    note: str = ""
    offenders: tuple[str, ...] = ()

    def __bool__(self) -> bool:
        return self.ok is True


@dataclass(frozen=True)
class Validity:
    """What `validate` found; true if every invariant holds.

    Iterate over it for the checks; ``validity["positive triangles"]`` is one of them.

    Attributes
    ----------
    mesh : str
        The mesh in a few words.
    checks : tuple of Check
        One for each invariant.
    """

    mesh: str
    checks: tuple[Check, ...]

    @property
    def ok(self) -> bool:
        """Whether every invariant holds."""
        return all(self.checks)

    @property
    def broken(self) -> tuple[Check, ...]:
        """The checks that failed."""
        return tuple(check for check in self.checks if check.ok is False)

    def raise_if_invalid(self) -> None:
        """Do nothing for a valid mesh.

        Raises
        ------
        InvalidMeshError
            If an invariant does not hold; the message names each and the first offenders.
        """
        if not self.ok:
            raise InvalidMeshError(str(self))

    def __bool__(self) -> bool:
        return self.ok

    def __iter__(self) -> Iterator[Check]:
        return iter(self.checks)

    def __getitem__(self, name: str) -> Check:
        for check in self.checks:
            if check.name == name:
                return check
        known = ", ".join(repr(check.name) for check in self.checks)
        raise KeyError(f"no check is named {name!r}; the names are: {known}")

    def __str__(self) -> str:
        width = max(len(check.name) for check in self.checks)
        indent = " " * (width + 8)
        lines = [f"{self.mesh}: {'valid' if self.ok else 'NOT VALID'}"]
        for check in self.checks:
            mark = {True: "✓", False: "✗", None: "·"}[check.ok]
            lines.append(f"  {mark} {check.name:<{width}}  {check.note}".rstrip())
            lines += [indent + item for item in check.offenders]
            hidden = check.count - len(check.offenders)
            if check.offenders and hidden > 0:
                lines.append(f"{indent}… and {hidden} more")
        return "\n".join(lines)


def validate(mesh: Mesh) -> Validity:
    """Check every invariant of a mesh.

    Parameters
    ----------
    mesh : Mesh
        Any mesh, however broken.

    Returns
    -------
    Validity
        The verdict on each invariant, by name; true if all hold.

    Notes
    -----
    Orientation and crossings are decided by exact signs. A tag without a name is allowed (files
    carry bare numbers), a negative one is not. For a mesh that knows its domain, each segment of it
    must be a chain of constrained edges with the tag of the segment; see
    `adaptmesh.invariants.fidelity` for the tolerance.

    Examples
    --------
    >>> from adaptmesh import Mesh
    >>> corner = [[0, 0], [1, 0], [0, 1]]
    >>> validate(Mesh(corner, [[0, 1, 2]], edges=[[0, 1], [1, 2], [2, 0]])).ok
    True
    >>> validate(Mesh(corner, [[0, 2, 1]]))["positive triangles"].offenders
    ('triangle 0 is clockwise: 0 (0.0, 0.0), 2 (0.0, 1.0), 1 (1.0, 0.0)',)
    """
    subject = Subject(mesh)
    arrays = _run(ARRAYS, subject, True)
    neighbourhood = _run(NEIGHBOURHOOD, subject, all(arrays))
    marks = _run(MARKS, subject, all(arrays))
    border = _run(BORDER, subject, all(neighbourhood))
    cover = _run(COVERING, subject, all(border))
    checks = [*arrays, *neighbourhood, *marks, *border, *cover]
    if mesh.domain is not None:
        table = dict(DOMAIN)
        if not mesh.domain.curved.runs:
            del table["curves present"]
        checks += _run(table, fidelity.DomainSubject(mesh), all(checks))
    return Validity(repr(mesh).strip("<>"), tuple(checks))


def _run(table: Table[S], subject: S, founded: bool) -> list[Check]:
    """The checks of a table, or, without a foundation, that they were not made."""
    if not founded:
        note = "not checked: rests on one that is broken"
        return [Check(name, None, note=note) for name in table]
    found = {name: look(subject) for name, look in table.items()}
    return [Check(name, f.broken == 0, f.broken, f.note, f.offenders) for name, f in found.items()]
