"""What to mesh: points, segments, holes, regions and names, checked before any work."""

from __future__ import annotations

import warnings
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from adaptmesh.curves import Curve
from adaptmesh.domain.sides.motion import chosen_motion
from adaptmesh.types import Floats
from adaptmesh.value import contents

from .background import TriangleMesh, background_mesh
from .cubic_pieces import CubicPieces, SomeSides, cubic_pieces, some_sides
from .data import DomainData, made_of
from .from_curves import domain_of_curves
from .from_rings import domain_of_rings
from .from_segments import domain_of_segments
from .frozen import domain_with_frozen
from .given import Given, given_rectangle
from .inputs import ByLabel
from .measures import area_of, segments_within
from .names import domain_with_names
from .naming import Chosen
from .periodic_corners import domain_with_pair
from .points import CurvePoints


@dataclass(frozen=True, eq=False, repr=False, init=False)
class Domain(DomainData):
    """A planar domain: straight segments between points, with holes, regions and names.

    `from_curves` makes one of curves. Everything is checked here, so that a domain that exists can
    be meshed. It never changes.

    Parameters
    ----------
    points : (n, 2) array_like of float
        Corners; every one becomes a vertex of every mesh of the domain.
    segments : (k, 2) array_like of int
        Pairs of point numbers, from 0. They bound the domain, separate regions, or just lie inside
        it; they may meet only at points. A point that lies exactly on a segment divides it.
    holes : sequence of (x, y), or "nesting", optional
        A point inside each hole; ``[]`` if there are none. If not given, holes are found: over
        each line, from outside inwards, the domain and holes take turns, so that a ring in the
        domain bounds a hole, and one in a hole an island; but a part with the point of a region is
        in the domain. Where it is uncertain whether something is a hole, as lines that divide the
        domain end at its border (the middle one of nine squares), the domain is refused;
        ``"nesting"`` takes it for a hole if the fewest lines from outside to it are two, or four...
    regions : mapping of str or int to (x, y), optional
        For each region, by its name or (if it has none) its number, a point inside it, or several
        points if it has several parts. A part without a point belongs to region 0.
    names : mapping of str or int to sequence of int, or a choice, optional
        The segments that bear each name, or each tag that has no name: their numbers, or a function
        of points (n, 2) that returns for each whether it is chosen, or `nearest` or `facing`; see
        `with_names`. A segment bears at most one.
    tags, region_tags : mapping of str to int, optional
        Numbers of names, for files and solvers that know only numbers. Other names get the least
        numbers from 1 on that are free. Two names of one number are two names of the same sides or
        regions, of all that have that number. 0 is the number of what has no name: no side and no
        region can be given a name with that number.

    Raises
    ------
    DomainError
        Names the first offending point, segment or seed with its coordinates, and the remedy.
        Points and segments that would be in no mesh, as they lie outside or in a hole and not on
        its border, are refused, too.

    Examples
    --------
    >>> from adaptmesh import Domain
    >>> square = Domain([(0, 0), (1, 0), (1, 1), (0, 1)], [(0, 1), (1, 2), (2, 3), (3, 0)],
    ...                 names={"inlet": [3]})
    >>> square.area
    1.0

    Two rings, the inner one of which is a hole, an interface, or bounds a region:

    >>> points = [(0, 0), (3, 0), (3, 3), (0, 3), (1, 1), (2, 1), (2, 2), (1, 2)]
    >>> rings = [(0, 1), (1, 2), (2, 3), (3, 0), (4, 5), (5, 6), (6, 7), (7, 4)]
    >>> Domain(points, rings).area
    8.0
    >>> Domain(points, rings, holes=[]).area
    9.0
    >>> Domain(points, rings, regions={"matrix": (0.5, 0.5), "fibre": (1.5, 1.5)}).area
    9.0
    """

    def __init__(
        self,
        points: ArrayLike,
        segments: ArrayLike,
        holes: ArrayLike | str | None = None,
        regions: ByLabel[ArrayLike] | None = None,
        names: ByLabel[Chosen] | None = None,
        tags: Mapping[str, int] | None = None,
        region_tags: Mapping[str, int] | None = None,
    ) -> None:
        given = Given(points, segments, holes, regions, names, tags, region_tags)
        vars(self).update(contents(domain_of_segments(given)))

    @property  # type: ignore[misc]  # in place of the field, which it shows
    def points(self) -> Floats:
        """Its points, (n, 2).

        Pairs of them, ``points[segments]``, are chords of curves, and `metrics.Geometry` measures
        from the curves; not from those of a mesh, ``mesh.points[mesh.edges]``, nor from results.
        """
        return self._curve_points if self.curved.curves else vars(self)["points"]

    @cached_property
    def _curve_points(self) -> CurvePoints:
        return CurvePoints.of(self, vars(self)["points"])

    @classmethod
    def of_data(cls, data: DomainData) -> Domain:
        """The domain with these fields, which are those of a valid one."""
        return made_of(cls, contents(data))

    @classmethod
    def of_given(cls, given: Given) -> Domain:
        """The domain that is made with these arguments."""
        return cls.of_data(domain_of_segments(given))

    @staticmethod
    def of_mesh(mesh: Any, corner_angle: float | None = None, **options: Any) -> Domain:
        """Return ``mesh.to_domain(corner_angle, **options)``; deprecated, use that instead."""
        warnings.warn("Domain.of_mesh(mesh): use mesh.to_domain()", DeprecationWarning, 2)
        out: Domain = mesh.to_domain(corner_angle, **options)
        return out

    @classmethod
    def polygon(
        cls,
        outer: Any,
        holes: Sequence[ArrayLike] | None = None,
        *,
        names: ByLabel[Chosen] | None = None,
    ) -> Domain:
        """A domain bounded by closed rings.

        Parameters
        ----------
        outer : (n, 2) array_like, or a polygon
            The outer ring, in either direction, closed or not; or a shapely ``Polygon`` or
            ``MultiPolygon``, or anything else with a ``__geo_interface__`` of these, or GeoJSON. Of
            a collection of geometries its polygons are taken, if there is nothing else in it. A
            collection of features becomes what `read_domain` makes of it: a region for each name;
            features without geometry are passed over with a `FormatWarning`.
        holes : sequence of (n, 2) array_like, optional
            The rings of the holes, within the outer one; a ring inside a hole is an island.
        names : mapping of str or int to sequence of int, or a choice, optional
            As in `Domain`; segments are numbered ring by ring, in the order given: each starts at
            the point of its number. A point repeated in a row counts, but has no segment.

        Raises
        ------
        DomainError
            As `Domain`; and if a hole is not in its shell, or parts of a polygon overlap.
        """
        return cls.of_data(domain_of_rings(outer, holes, names))

    @classmethod
    def rectangle(cls, x0: float, y0: float, x1: float, y1: float) -> Domain:
        """The rectangle [x0, x1] x [y0, y1]; its sides are named bottom, right, top, left."""
        return cls.of_given(given_rectangle(x0, y0, x1, y1))

    @classmethod
    def from_curves(
        cls,
        curves: Sequence[Curve],
        *,
        names: ByLabel[Chosen] | None = None,
        holes: ArrayLike | str | None = None,
        regions: ByLabel[ArrayLike] | None = None,
        tags: Mapping[str, int] | None = None,
        region_tags: Mapping[str, int] | None = None,
        points: ArrayLike | None = None,
        corner_angle: float = 40.0,
        join_tolerance: float | None = None,
    ) -> Domain:
        """A domain whose boundaries and internal lines are curves.

        Vertices of every mesh of it lie on the curves themselves, and on no polygon that stands
        for them. Curves may bound the domain, separate regions, or just lie inside it.

        Parameters
        ----------
        curves : sequence of Curve
            From `adaptmesh.curves`; those of a closed boundary may come in any order and
            direction. They may meet only at ends: cut a curve where another one ends on it, or
            crosses it (`adaptmesh.curves.Curve.part`).
        names : mapping of str or int to sequence of int, or a choice, optional
            The curves that bear each name (or tag), by number from 0, or chosen as in
            `with_names`. A curve bears at most one.
        holes, regions, tags, region_tags
            As in `Domain`.
        points : (m, 2) array_like
            Isolated points inside the domain, which become vertices. One where curves end makes
            that a vertex, too, be it smooth or not.
        corner_angle : float
            In degrees. Two curves of one name that meet with a turn of at most this are one smooth
            line, and where they meet is no vertex, unless both are straight or they turn by more
            than 60°, as no edge of a mesh may. All other ends of
            curves, and their `breaks`, are vertices of every mesh; so is the start of a closed
            curve that is alone.
        join_tolerance : float, optional
            Ends that are nearer than this are the same. If not given, 1e-12 of the extent or 8
            units in the last place of coordinates, what the rounding of sines and cosines can
            leave. Of a curve that is itself no longer than that, both ends are the same, and
            nothing is left.

        Raises
        ------
        DomainError
            As `Domain`, and where curves cross, or touch other than at ends, or come nearer than
            chords between them could be told apart. It names the curves and the place.

        Notes
        -----
        `points`, `segments` and `triangles` of the domain are a polygon inscribed in the curves;
        `curved` tells which of its points are on which curve. `area` is that between the true
        curves. So are distances from ``points[segments]`` and from `sides`, for what measures them
        in `metrics`; those from other arrays of points are distances from the polygon.

        Examples
        --------
        >>> import numpy as np
        >>> from adaptmesh import Domain
        >>> from adaptmesh.curves import Circle
        >>> ring = Domain.from_curves([Circle((0, 0), 2), Circle((0, 0), 1)], names={"hole": [1]})
        >>> round(ring.area / np.pi, 12)
        3.0
        """
        options = names, holes, regions, tags, region_tags, points, corner_angle, join_tolerance
        return cls.of_data(domain_of_curves(curves, *options))

    def with_names(self, names: ByLabel[Chosen]) -> Domain:
        """The same domain with names for sides that are chosen by where they are.

        Sides are its segments, or the curves that it was made of. One that has a name gets the new
        one in its place.

        Parameters
        ----------
        names : mapping of str or int to a choice
            For each name or tag one of

            - a function of points (n, 2) that returns bool (n,): the sides on which it holds. It is
              asked at places on each side, but not at its ends, which others share;
            - ``adaptmesh.nearest((x, y), ...)``: the side nearest to each point;
            - ``adaptmesh.facing((dx, dy))``: the sides of the border whose outward normal has this
              direction, to 30 degrees if nothing else is said;
            - numbers of segments, or of curves.

        Raises
        ------
        DomainError
            A choice is empty, holds on a part of a side only, or returns something else; two names
            are given to one side; or a side is periodic, or (of a domain of curves) frozen.

        Examples
        --------
        >>> import adaptmesh as am
        >>> cell, repairs = am.repair([(0, 0), (1, 0), (1, 0.5), (1, 1), (0, 1)])
        >>> right = lambda x: x[:, 0] > 1 - 1e-9
        >>> cell = cell.with_names({"left": am.facing((-1, 0)), "right": right})
        >>> cell.segment_tags.tolist()
        [0, 1, 2, 2, 0]
        """
        return self.of_data(domain_with_names(self, names))

    def with_periodic(
        self,
        first: str,
        second: str,
        *,
        translation: ArrayLike | None = None,
        rotation: float | None = None,
        centre: ArrayLike = (0.0, 0.0),
        tolerance: float | None = None,
    ) -> Domain:
        """The same domain, where two boundaries get vertices that correspond.

        In every mesh of it, by `generate` or `adapt`, each vertex on the first boundary has one on
        the second that a rigid motion carries it to; `Mesh.periodic_vertices` gives the pairs. Both
        are cut for the finer of the two metrics. Straight sides need not have the same corners: the
        image of one that the other side lacks becomes a point of the domain there, after the last
        one, and divides its segment.

        Parameters
        ----------
        first, second : str
            Names of boundaries, one the image of the other.
        translation : (dx, dy), optional
            From the first to the second; if no motion is given, from the box around the one to
            that around the other.
        rotation : float, optional
            Instead, an angle in degrees, anticlockwise about `centre`.
        centre : (x, y)
        tolerance : float, optional
            How far images may be off; 1e-9 of the extent if not given.

        Raises
        ------
        DomainError
            A name is not known, or something on one boundary has no image on the other.
        """
        motion = chosen_motion(translation, rotation, centre)
        return self.of_data(domain_with_pair(self, first, second, motion, tolerance))

    def with_frozen(self, *names: str, segments: ArrayLike | None = None) -> Domain:
        """The same domain, where each segment of these names is one edge of every mesh.

        To fit the mesh of a neighbour, whose edges there are the segments: they are not cut, be the
        sizes asked for large or small. `adapt` freezes boundaries as a mesh has them.

        Parameters
        ----------
        *names : str
            Of boundaries or lines.
        segments : sequence of int
            Further segments, by number.

        Raises
        ------
        DomainError
            A name or number is not known, or bears a curve, or a segment of it is divided by a
            point.
        """
        return domain_with_frozen(self, names, segments)

    @cached_property
    def area(self) -> float:
        """Area without the holes; that between the true curves if there are any."""
        return area_of(self)

    def outline(self, tolerance: float, *, names: Iterable[str] | None = None) -> Floats:
        """All boundaries and internal lines as straight segments, curves to a tolerance.

        For other programs; what measures distances here takes the curves themselves, see `sides`.

        Parameters
        ----------
        tolerance : float
            No curve is further than about this from its segments; at least 1e-10 of the extent.
        names : sequence of str, optional
            Of the boundaries and lines to return; all if not given.

        Returns
        -------
        (k, 2, 2) array
            The two ends of each segment.

        Examples
        --------
        >>> import numpy as np
        >>> from adaptmesh import Domain
        >>> from adaptmesh.curves import Circle
        >>> disc = Domain.from_curves([Circle((0, 0), 1)])
        >>> bool(np.hypot(*disc.outline(1e-4).mean(axis=1).T).min() > 1 - 1e-4)
        True
        """
        return segments_within(self, tolerance, names)

    def background_mesh(self, metric: Any) -> TriangleMesh:
        """A mesh of the domain for this metric, for what is to be known all over it."""
        return background_mesh(self, metric)

    def sides(self, *names: str) -> SomeSides:
        """The boundaries and lines of these names, curves as they are; all if none is given.

        For what measures distances from them: `metrics.Geometry`, `metrics.Distance`,
        `metrics.BoundaryLayer` and all else that takes a geometry.

        Raises
        ------
        DomainError
            A name is not known.

        Examples
        --------
        >>> import metrics
        >>> from adaptmesh import Domain
        >>> from adaptmesh.curves import Circle
        >>> ring = Domain.from_curves([Circle((0, 0), 2), Circle((0, 0), 1)], names={"hole": [1]})
        >>> d = metrics.Geometry(ring.sides("hole")).distances([(1.5, 0.0), (0.6, 0.8)])
        >>> [round(float(x), 9) for x in d]
        [0.5, 0.0]
        """
        return some_sides(self, names)

    def cubic_pieces(self) -> CubicPieces:
        """All sides as straight pieces and short cubics, see `sides`."""
        return self._all_pieces

    @cached_property
    def _all_pieces(self) -> CubicPieces:
        return cubic_pieces(self, np.ones(len(self.segments), bool))
