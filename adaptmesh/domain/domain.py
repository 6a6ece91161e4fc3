"""What to mesh: points, segments, holes, regions and names, checked before any work."""

from __future__ import annotations

import copy
from collections.abc import Iterable, Mapping, Sequence
from functools import cached_property
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np
from numpy.typing import ArrayLike, NDArray

from adaptmesh._core import Fault, triangulate
from adaptmesh.curves import Curve
from adaptmesh.errors import DomainError
from adaptmesh.types import Floats, Ints
from adaptmesh.value import Value

from .cubic_pieces import CubicPieces, cubic_pieces
from .inputs import (
    ByLabel,
    Inside,
    Label,
    checked_names,
    checked_number,
    checked_points,
    checked_segments,
    joined_rings,
    labelled,
    read_only,
)
from .inscribed_polygon import Curved, skeleton_of
from .messages import fault_text, segment_text
from .names import domain_with_names, sides_of_domain, tags_of_sides
from .naming import Chosen, Selector, chosen_tags, split_names
from .paths import points_on
from .periodic import Motion, PeriodicPair

if TYPE_CHECKING:
    from adaptmesh.mesh.mesh import Mesh
    from adaptmesh.mesh.straight_sides import CornersFound

SMALLEST_TOLERANCE = 1e-10  # of `Domain.outline`, as a share of the extent


class Sides(NamedTuple):
    """Some of the segments of a domain, by number, with the curves that they are chords of."""

    domain: Domain
    segments: Ints

    def cubic_pieces(self) -> CubicPieces:
        """The sides as straight pieces and short cubics."""
        chosen = np.zeros(len(self.domain.segments), bool)
        chosen[self.segments] = True
        return cubic_pieces(self.domain, chosen)


class Domain(Value):
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
        self.points = checked_points(points, "point")
        self.segments = checked_segments(segments, self.points)
        n = len(self.segments)
        given, selectors = split_names(names)
        self.names, self.segment_tags = checked_names(given, n, "segment", tags)
        inside = Inside.checked(holes, regions, region_tags)
        self._build(inside, Curved.nothing(len(self.points), n))
        self._choose(selectors)

    def _choose(self, selectors: Mapping[Label, Selector]) -> None:
        """Give names to the segments that are chosen for them, by where they are."""
        if selectors:
            sides = sides_of_domain(self)
            self.segment_tags = read_only(
                chosen_tags(self.segment_tags, selectors, self.names, sides)
            )

    def _build(self, inside: Inside, curved: Curved) -> None:
        """Triangulate what points, segments, names and tags enclose."""
        self.nesting, self.holes = inside.nesting, inside.holes
        self.region_names, self.seeds = inside.region_names, inside.seeds
        self.seed_regions = inside.seed_regions
        #: Which of the points and segments lie on curves, and where.
        self.curved = curved

        triangles, labels, pieces, segment, is_boundary = self._triangulate(inside.certain)
        #: Constrained Delaunay triangles of the points alone, (m, 3), and their regions, (m,).
        self.triangles: Ints = read_only(triangles)
        self.triangle_regions: Ints = read_only(self.region_of_label(labels))
        #: The segments, divided where points lie on them, (p, 2); the segment each is a piece of,
        #: (p,); and whether it has the outside on one side, (p,).
        self.pieces: Ints = read_only(pieces)
        self.piece_segments: Ints = read_only(segment)
        self.piece_is_boundary: NDArray[np.bool_] = read_only(is_boundary)
        #: Pairs of boundaries whose vertices correspond, see `with_periodic`.
        self.periodic: tuple[PeriodicPair, ...] = ()
        #: Which segments are not cut, (k,), see `with_frozen`.
        self.segment_is_frozen: NDArray[np.bool_] = read_only(np.zeros(len(self.segments), bool))
        #: How corners were told from other vertices on the border of a mesh, see `of_mesh`.
        self.corners_found: CornersFound | None = None

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
        from .polygon_input import is_collection, shape_of_polygon, shapes_of, without_empty
        from .polygons import domain_of_shapes
        from .ring_nesting import refuse_rings_out_of_place, rings_with_labels

        holes = () if holes is None else holes
        if isinstance(holes, str) or not isinstance(holes, Iterable):
            raise DomainError(f"holes={holes!r}: expected a sequence of rings, [ring]")
        holes = list(holes)
        if is_collection(outer):
            if names is not None or len(holes):
                raise DomainError("features have names and holes of their own: leave out yours")
            return domain_of_shapes(without_empty(shapes_of(outer)))
        shape = shape_of_polygon(outer, holes)
        shape.refuse_what_is_left_out()
        rings, points = rings_with_labels(shape)
        joined = joined_rings(points)
        given, selectors = split_names(names)
        tag_of, tags = checked_names(given, joined.n_given)
        domain = cls(
            joined.points,
            joined.segments,
            "nesting",
            names=labelled(tags[joined.given]),
            tags=tag_of,
        )
        if len(rings) > 1 or len(joined.points) < len(joined.segments):
            start, end = domain.points[domain.pieces].transpose(1, 0, 2)
            first, last = domain.points[domain.segments[domain.piece_segments]].transpose(1, 0, 2)
            along = ((end - start) * (last - first)).sum(axis=1) > 0
            ring = joined.ring[domain.piece_segments]
            refuse_rings_out_of_place(shape, rings, domain.points, domain.pieces, along, ring)
        domain._choose(selectors)
        return domain

    @classmethod
    def rectangle(cls, x0: float, y0: float, x1: float, y1: float) -> Domain:
        """The rectangle [x0, x1] x [y0, y1]; its sides are named bottom, right, top, left."""
        x0, y0, x1, y1 = (
            checked_number(value, what)
            for value, what in ((x0, "x0"), (y0, "y0"), (x1, "x1"), (y1, "y1"))
        )
        if not (x0 < x1 and y0 < y1):
            raise DomainError(f"rectangle({x0}, {y0}, {x1}, {y1}): x0 < x1 and y0 < y1 are wanted")
        corners = [(x0, y0), (x1, y0), (x1, y1), (x0, y1)]
        sides = {"bottom": [0], "right": [1], "top": [2], "left": [3]}
        return cls(corners, [(0, 1), (1, 2), (2, 3), (3, 0)], names=sides)

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
        curves. Distances to ``points[segments]`` are those to the polygon, which may be off the
        curves by far more than a first height or a small size: give `sides` to what measures them.

        Examples
        --------
        >>> import numpy as np
        >>> from adaptmesh import Domain
        >>> from adaptmesh.curves import Circle
        >>> ring = Domain.from_curves([Circle((0, 0), 2), Circle((0, 0), 1)], names={"hole": [1]})
        >>> round(ring.area / np.pi, 12)
        3.0
        """
        if isinstance(curves, Curve) or not isinstance(curves, Iterable):
            raise DomainError(f"curves={curves!r}: expected a sequence of curves, [curve]")
        corner_angle = checked_number(corner_angle, "corner_angle")
        if join_tolerance is not None:
            join_tolerance = checked_number(join_tolerance, "join_tolerance")
        points = () if points is None else points
        curves = tuple(curves)
        given, selectors = split_names(names)
        numbers, tag_of = checked_names(given, len(curves), "curve", tags)
        inside = Inside.checked(holes, regions, region_tags)
        isolated = checked_points(points, "point", least=0)
        skeleton = skeleton_of(curves, tag_of, inside, isolated, corner_angle, join_tolerance)
        domain = cls.__new__(cls)
        domain.points = checked_points(skeleton.points, "point")
        domain.segments, domain.segment_tags = skeleton.segments, skeleton.segment_tags
        domain.names = numbers
        domain._build(inside, skeleton.curved)
        if not selectors:
            return domain
        chosen = chosen_tags(tags_of_sides(domain), selectors, numbers, sides_of_domain(domain))
        return cls.from_curves(
            curves,
            names=labelled(chosen),
            holes=holes,
            regions=regions,
            tags=numbers,
            region_tags=region_tags,
            points=points,
            corner_angle=corner_angle,
            join_tolerance=join_tolerance,
        )

    @classmethod
    def of_mesh(
        cls,
        mesh: Mesh,
        corner_angle: float | None = None,
        *,
        straight_tolerance: float | None = None,
    ) -> Domain:
        """The domain that a mesh covers, from its constrained edges, regions and names.

        Vertices on a straight line of the border are no corners of the domain: they can be left out
        of the next mesh. `corners_found` of the domain says how many corners there are, of how many
        vertices, to what tolerance the rest is straight, and why to that.

        Parameters
        ----------
        mesh : Mesh
        corner_angle : float, optional
            In degrees. If given, the border is taken to be smooth where it turns by at most this
            from edge to edge: it becomes splines through its vertices, from corner to corner, and
            stays straight where several edges lie on one line. If not, it is the polygon that the
            mesh has.
        straight_tolerance : float, optional
            How far vertices may be off a straight line, in units of the coordinates. If not given,
            by their digits: 1e-12 of the extent, and twice the rounding error of points, which is
            8 units in the last place of the largest coordinate; half a unit of the last decimal
            digit, or of float32, where all coordinates have no more digits than that (at least 8
            different values, whose last digit is mostly not zero, and a unit smaller than 1/20 of
            the shortest edge of the border or 1e-5 of the extent); or, where coordinates were
            turned or scaled since, 8 times what neighbours on the border are off, mostly to
            opposite sides (at least 24 pairs of them, off by less than 4e-6 of the extent).
            Deviations that are larger than the tolerance are corners, however small the angle.

        Raises
        ------
        DomainError
            It is no mesh of a domain, or the tolerance is negative, or so large that sides meet.
        """
        from adaptmesh.mesh.to_domain import domain_of_mesh

        return domain_of_mesh(mesh, corner_angle, straight_tolerance)

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
        return domain_with_names(self, names)

    def tag_named(self, name: str) -> int:
        """The tag of a boundary or line by its name, or a `DomainError`."""
        if name not in self.names:
            known = ", ".join(map(repr, self.names)) or "none"
            raise DomainError(f"no boundary is named {name!r}; the names are: {known}")
        return self.names[name]

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
        from .periodic_corners import domain_with_pair

        if translation is not None and rotation is not None:
            raise DomainError("give a translation or a rotation, not both")
        motion = None
        if translation is not None:
            motion = Motion.translation(translation)
        elif rotation is not None:
            motion = Motion.rotation(rotation, centre)
        for other in self.periodic:
            for name in {first, second} & {other.first, other.second}:
                raise DomainError(
                    f"{name!r} is periodic already, with {other.first!r} and {other.second!r}"
                )
        return domain_with_pair(self, first, second, motion, tolerance)

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
        frozen = self.segment_is_frozen.copy()
        numbers = np.asarray(() if segments is None else segments).ravel()
        if numbers.size and not np.issubdtype(numbers.dtype, np.integer):
            raise DomainError(
                f"segments={segments!r}: expected numbers of segments, from 0 to {len(frozen) - 1}"
            )
        numbers = numbers.astype(np.int64)
        unknown = numbers[(numbers < 0) | (numbers >= len(frozen))]
        if len(unknown):
            raise DomainError(f"segment {unknown[0]}: they are numbered 0 to {len(frozen) - 1}")
        frozen[numbers] = True
        frozen |= np.isin(self.segment_tags, [self.tag_named(name) for name in names])
        curved = np.flatnonzero(frozen & (self.curved.segment_runs >= 0))
        if len(curved):
            raise DomainError(
                f"{segment_text(self, int(curved[0]))} is curved, so that nothing says where its "
                "vertices are: freeze it in `adapt`, as a mesh has it, or give it as points and "
                "segments"
            )
        times = np.bincount(self.piece_segments, minlength=len(self.segments))
        divided = np.flatnonzero(frozen & (times > 1))
        if len(divided):
            raise DomainError(
                f"{segment_text(self, int(divided[0]))} is to be one edge, but a point lies on it: "
                "divide it there"
            )
        out = copy.copy(self)
        out.segment_is_frozen = read_only(frozen)
        return out

    @property
    def area(self) -> float:
        """Area without the holes; that between the true curves if there are any."""
        p = self.points[self.triangles]
        u, v = p[:, 1] - p[:, 0], p[:, 2] - p[:, 0]
        straight = 0.5 * np.sum(u[:, 0] * v[:, 1] - u[:, 1] * v[:, 0])
        return float(straight + self._area_beyond_chords)

    @cached_property
    def _area_beyond_chords(self) -> float:
        """The area between the boundary and its chords, negative where the curve is inside."""
        boundary = self.piece_segments[self.piece_is_boundary]
        segments = boundary[self.curved.segment_runs[boundary] >= 0]
        areas = self.curved.areas_beside(
            self.curved.segment_runs[segments], self.curved.segment_parameters[segments]
        )
        return float(np.sum(np.where(self.inside_is_left_of(segments), areas, -areas)))

    def inside_is_left_of(self, segments: Ints) -> NDArray[np.bool_]:
        """Whether the domain is on the left of boundary segments, given by number (k,)."""
        halves = np.concatenate(
            [self.triangles[:, [0, 1]], self.triangles[:, [1, 2]], self.triangles[:, [2, 0]]]
        )
        n = len(self.points)
        a, b = self.segments[segments].astype(np.int64).T
        return np.isin(a * n + b, halves[:, 0].astype(np.int64) * n + halves[:, 1])

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
        least = SMALLEST_TOLERANCE * float(np.ptp(self.points, axis=0).max())
        if not checked_number(tolerance, "tolerance") >= least:
            raise DomainError(f"tolerance={tolerance}: at least {least:g} is wanted")
        if isinstance(names, str):
            raise TypeError(f"names={names!r}: give a list of names, [{names!r}]")
        of_run = self.curved.segment_runs
        asked = np.ones(len(self.segments), bool)
        if names is not None:
            asked = np.isin(self.segment_tags, [self.tag_named(name) for name in names])
        straight = self.points[self.segments[asked & (of_run < 0)]]
        if not self.curved.runs:
            return straight
        run, u = self.curved.chords_within(tolerance)
        mine = np.isin(run, of_run[asked])
        run, u = run[mine], u[mine]
        ends = points_on(self.curved.runs, np.repeat(run, 2), u.ravel()).reshape(-1, 2, 2)
        return np.concatenate([straight, ends])

    def background_mesh(self, metric: Any) -> Mesh:
        """A mesh of the domain for this metric, for what is to be known all over it."""
        from adaptmesh.generate.generate import generate

        return generate(self, metric)

    def sides(self, *names: str) -> Sides:
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
        tags = [self.tag_named(name) for name in names]
        chosen = np.isin(self.segment_tags, tags) if names else np.ones(len(self.segments), bool)
        return Sides(self, np.flatnonzero(chosen).astype(np.int32))

    def cubic_pieces(self) -> CubicPieces:
        """All sides as straight pieces and short cubics, see `sides`."""
        return self._all_pieces

    @cached_property
    def _all_pieces(self) -> CubicPieces:
        return cubic_pieces(self, np.ones(len(self.segments), bool))

    def __repr__(self) -> str:
        names = ", ".join([*self.names, *self.region_names])
        return (
            f"<Domain: {len(self.points)} points, {len(self.segments)} segments"
            f"{'; ' + names if names else ''}>"
        )

    def region_of_label(self, labels: Ints) -> Ints:
        """Region numbers from what the core numbers by seed: 0 is no seed, i + 1 is seed i."""
        return np.concatenate([[0], self.seed_regions]).astype(np.int32)[labels]

    def _triangulate(self, certain: bool) -> tuple[Ints, Ints, Ints, Ints, NDArray[np.bool_]]:
        try:
            return triangulate(
                self.points, self.segments, self.holes, self.seeds, self.nesting, certain
            )
        except Fault as fault:
            raise DomainError(fault_text(self, *fault.args)) from None
