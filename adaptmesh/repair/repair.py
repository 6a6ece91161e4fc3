"""`repair`: make a clean domain of dirty input, with a report."""

from __future__ import annotations

import os
from dataclasses import replace
from typing import Any

from adaptmesh.arrangement.noding import resolve_tolerance
from adaptmesh.arrangement.record import Repair, Repairs
from adaptmesh.domain.domain import Domain
from adaptmesh.domain.inputs import Holes, refuse_holes
from adaptmesh.domain.outline import Outline
from adaptmesh.domain.polygons.polygon_input import shapes_of
from adaptmesh.domain.polygons.shared_borders import repaired_shapes
from adaptmesh.errors import DomainError
from adaptmesh.files.located import located, only_our_errors
from adaptmesh.io.domains.drawings import Drawing
from adaptmesh.io.domains.geo import PlaneModel

from .segments import repair_segments
from .surfaces import repair_surfaces

__all__ = ["Repair", "Repairs", "repair"]


def repair(
    dirty: Any, tolerance: float | None = None, *, holes: Holes = None
) -> tuple[Domain, Repairs]:
    """Make a clean domain of input that may be dirty, and report the repairs.

    Parameters
    ----------
    dirty : object
        ============================  ============================================================
        an `Outline` or a `Domain`    points, segments, holes, regions and names
        an (n, 2) array               a ring
        a sequence of such arrays     the outer ring, then holes and islands, as `Domain.polygon`
        a polygon of shapely          also a MultiPolygon, or a sequence of polygons
        a GeoJSON mapping             a geometry, a feature, or a collection of features
        a mapping of names            to polygons, each of them any of the above: named regions
        a path                        a file that `read_domain` can read
        ============================  ============================================================
    tolerance : float, optional
        Points closer than this are merged, in units of the coordinates. The default is 1e-9 of
        the extent, about the rounding of text files and of earlier computations (1e-6 for
        drawings); wider gaps between borders need a larger tolerance. The minimum is 4 units in
        the last place of the largest coordinate.
    holes : sequence of (x, y), or "nesting", optional
        As in `Domain`, for drawings of lines, .geo scripts without surfaces, and an `Outline`
        without holes of its own: ``[]`` if there are no holes. Not for other input, which defines
        its interior itself.

    Returns
    -------
    domain : Domain
        The clean domain; an exact triangulation proves that segments meet only at their ends.
    repairs : Repairs
        A record of each repair; ``print(repairs)`` prints a report. Empty, and false, if there
        was nothing to repair: then the domain is the same as without `repair`.

    Raises
    ------
    DomainError
        If a defect has no obvious remedy (a boundary that is open by more than the tolerance, a
        seed in no region, nothing left with an area); the message names the point.

    Notes
    -----
    Of points that nearly coincide the first is kept. A point nearly on a segment divides it;
    whichever was given later is moved. Segments are divided where they cross, and of segments that
    overlap one is kept, with the name of the first that has one. Coordinates that need no repair
    keep their bits.

    A polygon covers what its shell winds around, in either direction and any number of times,
    without its holes; a ring in a hole is an island. Where polygons overlap, the first one keeps
    the overlap. Gaps and overlaps narrower than the tolerance are closed; wider gaps become holes.
    Spikes (lines drawn there and back) and rings without an area are removed. All segments of an
    `Outline` are kept, except spikes that stick out of the domain.

    Only straight segments are repaired. Curves have to be clean when a domain is made of them
    (`Domain.from_curves`): a domain with curves is returned unchanged, and a drawing with a curve
    must be clean.

    Examples
    --------
    >>> from adaptmesh import repair
    >>> domain, repairs = repair([(0, 0), (2, 2), (2, 0), (0, 2)])
    >>> domain.area
    2.0
    >>> print(repairs)
    1 repair (tolerance 2e-09, largest displacement 0)
      crossing: 1
        at (1, 1): segment 0 of polygon 0 and segment 2 of polygon 0 cross; a point added there
    """
    if isinstance(dirty, (str, os.PathLike)):
        from adaptmesh.io.domains.read import read_raw

        raw = read_raw(dirty)
        with only_our_errors(dirty), located(dirty, DomainError):
            return _repair_object(raw, tolerance, holes)
    return _repair_object(dirty, tolerance, holes)


def _repair_object(dirty: Any, tolerance: float | None, holes: Holes) -> tuple[Domain, Repairs]:
    """Repair an object as `repair` does; paths excluded."""
    if isinstance(dirty, PlaneModel):
        return repair_surfaces(dirty, tolerance, holes)
    if isinstance(dirty, Drawing) and not dirty.is_straight:
        dirty, holes = dirty.domain(holes), None
    if isinstance(dirty, Drawing):
        outline = replace(dirty.outline(), holes=holes)
        return repair_segments(outline, dirty.join_tolerance if tolerance is None else tolerance)
    if isinstance(dirty, Outline) and dirty.holes is None:
        dirty, holes = replace(dirty, holes=holes), None
    refuse_holes(holes, "a mesh, a domain, polygons or points in holes")
    if isinstance(dirty, Domain):
        if dirty.curved.paths:
            return dirty, Repairs((), resolve_tolerance(dirty.points, tolerance))
        dirty = Outline.of_domain(dirty)
    if isinstance(dirty, Outline):
        return repair_segments(dirty, tolerance)
    given, repairs = repaired_shapes(shapes_of(dirty), tolerance)
    return Domain.of_given(given), repairs
