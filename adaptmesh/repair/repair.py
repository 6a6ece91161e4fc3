"""Dirty input made into a clean domain, and a report of what was done."""

from __future__ import annotations

import os
from dataclasses import replace
from typing import Any

from adaptmesh.arrangement import Repair, Repairs, used_tolerance
from adaptmesh.domain.domain import Domain
from adaptmesh.domain.inputs import Holes, refuse_holes
from adaptmesh.domain.outline import Outline
from adaptmesh.domain.polygon_input import shapes_of
from adaptmesh.domain.polygons import repaired_shapes
from adaptmesh.errors import DomainError
from adaptmesh.files.located import located, only_our_errors
from adaptmesh.io.domains.drawings import Drawing
from adaptmesh.io.domains.geo import PlaneModel

from .segments import repaired_domain_of_segments
from .surfaces import repaired_domain_of_surfaces

__all__ = ["Repair", "Repairs", "repair"]


def repair(
    dirty: Any, tolerance: float | None = None, *, holes: Holes = None
) -> tuple[Domain, Repairs]:
    """Make a clean domain of what may be dirty, and say what was done for it.

    Parameters
    ----------
    dirty : what to mesh, as it comes
        ============================  ============================================================
        an `Outline` or a `Domain`    points, segments, holes, regions and names
        an (n, 2) array               a ring
        a sequence of such arrays     the outer ring, then holes and islands, as `Domain.polygon`
        a polygon of shapely          also a MultiPolygon, or a sequence of polygons
        a GeoJSON mapping             a geometry, a feature, or a collection of features
        a mapping of names            to polygons, each of them any of the above: named regions
        a path                        of a file that `read_domain` can read
        ============================  ============================================================
    tolerance : float, optional
        What is nearer than this is made one, in units of the coordinates. The default is 1e-9 of
        the extent, about the rounding of text files and of earlier computations (of drawings,
        1e-6); borders that miss each other by more need more. Less than 4 units in the last place
        of the largest coordinate is taken as that.
    holes : sequence of (x, y), or "nesting", optional
        As in `Domain`, for drawings of lines, .geo scripts without surfaces, and an `Outline`
        that does not say it: ``[]`` if there are no holes. All else says itself what is inside.

    Returns
    -------
    domain : Domain
        Clean: that its segments meet only at their ends is proven by an exact triangulation.
    repairs : Repairs
        A record of each thing done; ``print(repairs)`` is a report. Empty, and false, if there
        was nothing to do: then the domain is what it would have been without repair.

    Raises
    ------
    DomainError
        If what is wrong has no obvious remedy (a boundary that is open by more than the
        tolerance, a seed in no region, nothing left with an area); it names the place.

    Notes
    -----
    Of points that are nearly the same the first given is kept. A point nearly on a segment divides
    it; whichever was given later is moved. Segments are divided where they cross, and of segments
    that overlap one is kept, with the name of the first that has one. What nothing asks for stays
    where it is, bit for bit.

    Polygons take in what their rings go around, in whatever direction and however often, less
    their holes; a ring in a hole is an island. Where polygons overlap, the first one keeps the
    overlap. Gaps and overlaps narrower than the tolerance vanish; wider gaps are left, and are
    holes. Lines that polygons run along there and back (spikes), and rings of which nothing is
    left, are removed. Segments of an `Outline` are all kept, except those that stick out of the
    domain and were drawn there and back.

    Repair is for straight segments. Curves have to fit when a domain is made of them
    (`Domain.from_curves`); a domain with curves is returned as it is, and a drawing with a curve
    has to be clean.

    Examples
    --------
    >>> from adaptmesh import repair
    >>> domain, repairs = repair([(0, 0), (2, 2), (2, 0), (0, 2)])
    >>> domain.area
    2.0
    >>> print(repairs)
    1 repair (tolerance 2e-09, nothing moved farther than 0)
      crossing: 1
        at (1, 1): segment 0 of polygon 0 and segment 2 of polygon 0 cross; a point put there
    """
    if isinstance(dirty, (str, os.PathLike)):
        from adaptmesh.io.domains.read import read_raw

        raw = read_raw(dirty)
        with only_our_errors(dirty), located(dirty, DomainError):
            return _repaired(raw, tolerance, holes)
    return _repaired(dirty, tolerance, holes)


def _repaired(dirty: Any, tolerance: float | None, holes: Holes) -> tuple[Domain, Repairs]:
    """As `repair`, without paths."""
    if isinstance(dirty, PlaneModel):
        return repaired_domain_of_surfaces(dirty, tolerance, holes)
    if isinstance(dirty, Drawing) and not dirty.is_straight:
        dirty, holes = dirty.domain(holes), None
    if isinstance(dirty, Drawing):
        outline = replace(dirty.outline(), holes=holes)
        return repaired_domain_of_segments(
            outline, dirty.join_tolerance if tolerance is None else tolerance
        )
    if isinstance(dirty, Outline) and dirty.holes is None:
        dirty, holes = replace(dirty, holes=holes), None
    refuse_holes(holes, "a mesh, a domain, polygons or points in holes")
    if isinstance(dirty, Domain):
        if dirty.curved.paths:
            return dirty, Repairs((), used_tolerance(dirty.points, tolerance))
        dirty = Outline.of_domain(dirty)
    if isinstance(dirty, Outline):
        return repaired_domain_of_segments(dirty, tolerance)
    given, repairs = repaired_shapes(shapes_of(dirty), tolerance)
    return Domain.of_given(given), repairs
