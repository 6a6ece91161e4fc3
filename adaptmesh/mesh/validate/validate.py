"""Is it a mesh? Every invariant by name, each with the first items that break it.

The checks stand on one another:

1. arrays: finite points, indices in range;
2. neighbourhood: positive triangles by exact signs, two triangles to an edge, ...; and marks: what
   is constrained, tagged and named;
3. covering: the triangles cover what their border encloses once and only once;
4. domain: every point, segment and curve of the domain is there, its regions, tags and names.

Each is a function of a file of this folder; the tables below give their names.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass
from typing import TypeVar

import numpy as np

from adaptmesh.domain.domain import Domain
from adaptmesh.errors import AdaptmeshError
from adaptmesh.mesh.data import MeshData, check_is_mesh

from . import covering, fidelity, inside, local, periodicity
from .domain_subject import DomainSubject
from .subject import Finding, Subject

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
    "names": local.names,
    "kept once": local.kept_once,
}
BORDER: Table[Subject] = {
    "single turn": covering.single_turn,
    "simple border": covering.simple_border,
}
COVERING: Table[Subject] = {
    "covered once": covering.covered_once,
    "Euler's relation": covering.euler,
}
LINES: Table[DomainSubject] = {
    "points present": fidelity.points_present,
    "segments present": fidelity.segments_present,
    "curves present": fidelity.curves_present,
    "edges on segments": fidelity.edges_on_segments,
    "vertices on segments": fidelity.vertices_on_segments,
    "vertices on curves": fidelity.vertices_on_curves,
    "tags of domain": fidelity.tags_of_domain,
    "frozen undivided": fidelity.frozen_undivided,
    "periodic boundaries": periodicity.periodic_boundaries,
    "fills domain": inside.fills_domain,
    "regions of domain": inside.regions_of_domain,
    "area of domain": fidelity.area_of_domain,
}
NAMES: Table[DomainSubject] = {
    "names of domain": inside.names_of_domain,
    "region names of domain": inside.region_names_of_domain,
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


def validate(mesh: MeshData, *, tolerance: float | None = None) -> Validity:
    """Check every invariant of a mesh, and hold it against its domain if it has one.

    Parameters
    ----------
    mesh : Mesh
        Any mesh, however broken.
    tolerance : float, optional
        How far off its segment or curve a vertex may be, in units of length. If not given, 1e-12 of
        the diameter of the domain plus 8 units in the last place of the largest coordinate: what
        rounding leaves of points on slanted lines. Give more for coordinates that a text file has
        rounded.

    Returns
    -------
    Validity
        The verdict on each invariant, by name; true if all hold.

    Raises
    ------
    DomainError
        What is given is no mesh.
    ValueError
        The tolerance is negative or not a number.

    Notes
    -----
    Of the arrays, by comparison of numbers:

    - *not empty*: there are triangles.
    - *finite points*: no coordinate is infinite or not a number.
    - *indices in range*: triangles, constrained edges and what is required name what exists.

    Of the neighbourhood of each triangle, by exact signs of areas and by topology:

    - *positive triangles*: every triangle is counter-clockwise and not flat.
    - *distinct points*: no two points have the same coordinates.
    - *two triangles an edge*: no edge is the side of three triangles or more.
    - *same orientation*: the two triangles of an edge run along it in opposite directions.

    Of marks, by topology:

    - *points used*: every point belongs to a triangle.
    - *constrained are edges*: every constrained edge is the side of a triangle, and listed once.
    - *border is constrained*: sides with a single triangle are constrained edges.
    - *tags*: in a mesh with a domain, no tag and no region is negative, unless the domain gives it
      that number. Bare numbers, without names, are allowed; in files they may be negative.
    - *names*: names are text, each for a number of its own, and none for 0, which has no name;
      unless the domain has them so. Files keep such names, but what they mean is ambiguous.

    - *kept once*: `Mesh.kept` gives no vertex of the mesh before to two.

    Of the whole, so that the triangles cover what their border encloses once and only once:

    - *single turn*: the triangles of an inner point turn around it once (the sum of their angles,
      which can only be a whole number of turns).
    - *simple border*: no two edges of the border cross, overlap or touch but at ends. Exact.
    - *covered once*: along the border one triangle lies inside and none outside. Exact.
    - *Euler's relation*: points - edges + triangles is what pieces and holes say. Exact.

    Of a mesh that knows its domain:

    - *points present*: every point of the domain is a vertex, with its very coordinates or, if none
      has them, within the tolerance.
    - *segments present*, *curves present*: each is a row of constrained edges, followed from its
      one end to its other by topology.
    - *edges on segments*: every constrained edge belongs to such a row.
    - *vertices on segments*, *vertices on curves*: the vertices of a row are as near to its segment
      or curve as the tolerance says, and follow each other along it.
    - *tags of domain*: every edge of a row has the tag of its segment or curve. Exact.
    - *frozen undivided*: every frozen segment is one edge. Exact.
    - *periodic boundaries*: rows of periodic lines have as many vertices, and the image of each is
      at its partner, within the tolerance and what the lines themselves are off each other.
    - *fills domain*: along the boundary triangles are on the inner side only, along inner lines on
      both: holes are empty, and nothing is missing. Exact.
    - *regions of domain*: every triangle has the number of the region of the domain that it is in.
      Exact.
    - *area of domain*: a domain without curves has the area of its mesh, within the tolerance along
      its segments and rounding.
    - *names of domain*, *region names of domain*: they are those of the domain, with its numbers.

    Checks rest on those before them: what rests on a broken one is not checked, and ``ok`` is None.
    The work grows as n log n.

    Examples
    --------
    >>> from adaptmesh import Mesh, validate
    >>> corner = [[0, 0], [1, 0], [0, 1]]
    >>> validate(Mesh(corner, [[0, 1, 2]], edges=[[0, 1], [1, 2], [2, 0]])).ok
    True
    >>> validate(Mesh(corner, [[0, 2, 1]]))["positive triangles"].offenders
    ('triangle 0 is clockwise: 0 (0.0, 0.0), 2 (0.0, 1.0), 1 (1.0, 0.0)',)
    """
    check_is_mesh(mesh)
    if tolerance is not None and not 0 <= tolerance < np.inf:
        raise ValueError(f"tolerance={tolerance!r}: expected a length, 0 or more")
    subject = Subject(mesh)
    arrays = _checked(ARRAYS, subject, True)
    neighbourhood = _checked(NEIGHBOURHOOD, subject, all(arrays))
    marks = _checked(MARKS, subject, all(arrays))
    border = _checked(BORDER, subject, all(neighbourhood))
    cover = _checked(COVERING, subject, all(border))
    checks = [*arrays, *neighbourhood, *marks, *border, *cover]
    if mesh.domain is not None:
        held = DomainSubject(mesh, tolerance)
        checks += _checked(_lines_of(mesh.domain), held, all(checks))
        checks += _checked(NAMES, held, True)
    return Validity(repr(mesh).strip("<>"), tuple(checks))


def _lines_of(domain: Domain) -> Table[DomainSubject]:
    """The checks that a domain needs: those of curves only if it has some, and so on."""
    has_curves = bool(domain.curved.paths)
    needed = {
        "curves present": has_curves,
        "vertices on curves": has_curves,
        "frozen undivided": bool(domain.segment_is_frozen.any()),
        "periodic boundaries": bool(domain.periodic),
        "area of domain": not has_curves,
    }
    return {name: look for name, look in LINES.items() if needed.get(name, True)}


def _checked(table: Table[S], subject: S, founded: bool) -> list[Check]:
    """The checks of a table, or, without a foundation, that they were not made."""
    if not founded:
        note = "not checked: rests on one that is broken"
        return [Check(name, None, note=note) for name in table]
    found = {name: look(subject) for name, look in table.items()}
    return [Check(name, f.broken == 0, f.broken, f.note, f.offenders) for name, f in found.items()]
