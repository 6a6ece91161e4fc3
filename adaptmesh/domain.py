"""What to mesh: points, segments, holes, regions and names, checked before any work."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from types import MappingProxyType
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from . import _core
from .errors import DomainError

if TYPE_CHECKING:
    from .mesh import Mesh

Floats = NDArray[np.float64]
Ints = NDArray[np.int32]


LARGEST = 1e75  # coordinate: its fourth power is still a double
OR_REPAIR = "or let adaptmesh.repair do it"


class Domain:
    """A planar domain: straight segments between points, with holes, regions and names.

    Everything is checked here, so that a domain that exists can be meshed. It never changes.

    Parameters
    ----------
    points : (n, 2) array_like of float
        Corners; every one becomes a vertex of every mesh of the domain.
    segments : (k, 2) array_like of int
        Pairs of point numbers, from 0. They bound the domain, separate regions, or just lie inside
        it; they may meet only at points. A point that lies exactly on a segment divides it.
    holes : sequence of (x, y), or "nesting"
        A point inside each hole. ``"nesting"``: what an odd number of boundaries encloses is
        inside, what an even number encloses is a hole; an island in a hole is inside again.
    regions : mapping of str to (x, y), optional
        For each named region a point inside it, or several points if it has several parts. A part
        without a point belongs to region 0, which has no name.
    names : mapping of str to sequence of int, optional
        The segments that bear each name. A segment bears at most one.

    Raises
    ------
    DomainError
        Names the first offending point, segment or seed with its coordinates, and the remedy.

    Examples
    --------
    >>> square = Domain([(0, 0), (1, 0), (1, 1), (0, 1)], [(0, 1), (1, 2), (2, 3), (3, 0)],
    ...                 names={"inlet": [3]})
    >>> square.area
    1.0
    """

    def __init__(
        self,
        points: ArrayLike,
        segments: ArrayLike,
        holes: ArrayLike | str = (),
        regions: Mapping[str, ArrayLike] | None = None,
        names: Mapping[str, Iterable[int]] | None = None,
    ) -> None:
        self.points = checked_points(points, "point")
        self.segments = _checked_segments(segments, self.points)
        self.nesting = isinstance(holes, str)
        if self.nesting and holes != "nesting":
            raise DomainError(f"holes={holes!r}: give points inside the holes, or 'nesting'")
        self.holes = checked_points(() if self.nesting else holes, "hole", least=0)
        self.region_names, self.seeds, self.seed_regions = _checked_regions(regions or {})
        self.names, self.segment_tags = checked_names(names or {}, len(self.segments))

        triangles, labels, pieces, segment, is_boundary = self._triangulate()
        #: Constrained Delaunay triangles of the points alone, (m, 3), and their regions, (m,).
        self.triangles: Ints = _read_only(triangles)
        self.triangle_regions: Ints = _read_only(self.region_of_label(labels))
        #: The segments, divided where points lie on them, (p, 2); the segment each is a piece of,
        #: (p,); and whether it has the outside on one side, (p,).
        self.pieces: Ints = _read_only(pieces)
        self.piece_segments: Ints = _read_only(segment)
        self.piece_is_boundary: NDArray[np.bool_] = _read_only(is_boundary)

    @classmethod
    def polygon(
        cls,
        outer: Any,
        holes: Sequence[ArrayLike] = (),
        *,
        names: Mapping[str, Iterable[int]] | None = None,
    ) -> Domain:
        """A domain bounded by closed rings.

        Parameters
        ----------
        outer : (n, 2) array_like, or a polygon
            The outer ring, in either direction, closed or not; or a shapely ``Polygon`` or
            ``MultiPolygon``, or anything else with a ``__geo_interface__`` of these.
        holes : sequence of (n, 2) array_like
            The rings of the holes; a ring inside a hole is an island.
        names : mapping of str to sequence of int, optional
            As in `Domain`; segments are numbered ring by ring, in the order given.
        """
        if hasattr(outer, "__geo_interface__"):
            if len(holes):
                raise DomainError("give a shapely polygon with its own holes, or rings, not both")
            rings = _rings_of(outer.__geo_interface__)
        else:
            rings = [outer, *holes]
        points, segments = _join_rings(rings)
        return cls(points, segments, "nesting", names=names)

    @classmethod
    def rectangle(cls, x0: float, y0: float, x1: float, y1: float) -> Domain:
        """The rectangle [x0, x1] x [y0, y1]; its sides are named bottom, right, top, left."""
        if not (x0 < x1 and y0 < y1):
            raise DomainError(f"rectangle({x0}, {y0}, {x1}, {y1}): x0 < x1 and y0 < y1 are wanted")
        corners = [(x0, y0), (x1, y0), (x1, y1), (x0, y1)]
        sides = {"bottom": [0], "right": [1], "top": [2], "left": [3]}
        return cls(corners, [(0, 1), (1, 2), (2, 3), (3, 0)], names=sides)

    @classmethod
    def of_mesh(cls, mesh: Mesh) -> Domain:
        """The domain that a mesh covers, from its constrained edges, regions and names."""
        from .outline import domain_of_mesh

        return domain_of_mesh(mesh)

    @property
    def area(self) -> float:
        """Area without the holes."""
        p = self.points[self.triangles]
        u, v = p[:, 1] - p[:, 0], p[:, 2] - p[:, 0]
        return float(0.5 * np.sum(u[:, 0] * v[:, 1] - u[:, 1] * v[:, 0]))

    def __repr__(self) -> str:
        names = ", ".join([*self.names, *self.region_names])
        return (
            f"<Domain: {len(self.points)} points, {len(self.segments)} segments"
            f"{'; ' + names if names else ''}>"
        )

    def region_of_label(self, labels: Ints) -> Ints:
        """Region numbers from what the core numbers by seed: 0 is no seed, i + 1 is seed i."""
        out: Ints = np.concatenate([[0], self.seed_regions]).astype(np.int32)[labels]
        return out

    def _triangulate(self) -> tuple[Ints, Ints, Ints, Ints, NDArray[np.bool_]]:
        try:
            return _core.triangulate(
                self.points, self.segments, self.holes, self.seeds, self.nesting
            )
        except _core.Fault as fault:
            raise DomainError(self._explain(*fault.args)) from None

    def _explain(self, kind: str, i: int, j: int, x: float, y: float) -> str:
        """What is wrong, where, and what to do, from a fault that the core found."""
        place = f"({x:.17g}, {y:.17g})"
        if kind in ("crossing_segments", "overlapping_segments"):
            a, b = self._segment(i), self._segment(j)
            if kind == "crossing_segments":
                return (
                    f"{a} and {b} cross at {place}: put a point there and divide both, {OR_REPAIR}"
                )
            return (
                f"{a} and {b} overlap near {place}: keep one, divided at the points on it, "
                f"{OR_REPAIR}"
            )
        messages = {
            "all_collinear": "all points lie on one line: there is nothing to mesh",
            "duplicate_points": f"points {i} and {j} are the same, {place}: keep one of them, "
            f"{OR_REPAIR}",
            "open_boundary": "the boundary is not closed: the outside leaks in"
            + (f" past point {i} {place}, where a boundary ends" if i >= 0 else "")
            + "; close it, or check `holes`; adaptmesh.repair closes gaps below its tolerance",
            "hole_outside": f"hole {i} at {place} is not inside the domain: move or remove it",
            "hole_on_segment": f"hole {i} at {place} lies on a segment: move it into the hole",
            "region_seed_outside": f"the point of {self._seed(i)} at {place} is not inside the "
            "domain: move or remove it",
            "region_seed_on_segment": f"the point of {self._seed(i)} at {place} lies on a "
            "segment: move it into the region",
            "two_seeds_one_region": f"{self._seed(i)} and {self._seed(j)} are the same part of the "
            "domain: remove one, or separate them by segments",
            "point_outside": f"point {i} at {place} is on no segment and outside the domain: "
            "remove it",
            "empty_domain": "nothing is left inside: every part of the domain is a hole",
        }
        return messages.get(kind, f"{kind} at {place}")

    def _segment(self, i: int) -> str:
        (x0, y0), (x1, y1) = self.points[self.segments[i]].tolist()
        return f"segment {i} from ({x0:g}, {y0:g}) to ({x1:g}, {y1:g})"

    def _seed(self, i: int) -> str:
        number = int(self.seed_regions[i]) if 0 <= i < len(self.seed_regions) else 0
        names = [name for name, region in self.region_names.items() if region == number]
        return f"region {names[0]!r}" if names else f"region seed {i}"


def _read_only(array: NDArray[Any]) -> NDArray[Any]:
    array.flags.writeable = False
    return array


def checked_points(points: ArrayLike, what: str, least: int = 3) -> Floats:
    """Coordinates (n, 2) that areas can be computed of, or a `DomainError`."""
    try:
        out = np.array(points, dtype=np.float64, order="C")
    except (TypeError, ValueError) as error:
        raise DomainError(f"{what}s must be an (n, 2) array of numbers: {error}") from None
    if out.size == 0:
        out = out.reshape(0, 2)
    if out.ndim != 2 or out.shape[1] != 2:
        raise DomainError(f"{what}s must be an (n, 2) array, not one of shape {out.shape}")
    if len(out) < least:
        raise DomainError(f"{len(out)} {what}s: at least {least} are needed")
    bad = np.flatnonzero(~np.isfinite(out).all(axis=1))
    if len(bad):
        x, y = out[bad[0]]
        raise DomainError(f"{what} {bad[0]} is ({x}, {y}): coordinates must be finite")
    bad = np.flatnonzero((np.abs(out) > LARGEST).any(axis=1))
    if len(bad):
        x, y = out[bad[0]]
        raise DomainError(
            f"{what} {bad[0]} is ({x:g}, {y:g}): areas and squares of coordinates beyond "
            f"{LARGEST:g} overflow; choose another unit of length"
        )
    return _read_only(out)


def checked_pairs(segments: ArrayLike, n_points: int) -> Ints:
    """Pairs of point numbers, (k, 2), or a `DomainError`."""
    raw = np.asarray(segments)
    if raw.size == 0:
        raise DomainError("no segments: say which points the boundary joins, e.g. Domain.polygon")
    if raw.ndim != 2 or raw.shape[1] != 2:
        raise DomainError(f"segments must be a (k, 2) array, not one of shape {raw.shape}")
    if not np.issubdtype(raw.dtype, np.integer):
        raise DomainError(f"segments must be integers, pairs of point numbers, not {raw.dtype}")
    bad = np.flatnonzero(((raw < 0) | (raw >= n_points)).any(axis=1))
    if len(bad):
        i = bad[0]
        raise DomainError(
            f"segment {i} joins points {raw[i, 0]} and {raw[i, 1]}, but the points are numbered "
            f"0 to {n_points - 1}"
        )
    return _read_only(np.array(raw, dtype=np.int32, order="C"))


def _checked_segments(segments: ArrayLike, points: Floats) -> Ints:
    out = checked_pairs(segments, len(points))
    bad = np.flatnonzero((points[out[:, 0]] == points[out[:, 1]]).all(axis=1))
    if len(bad):
        i = bad[0]
        x, y = points[out[i, 0]]
        raise DomainError(
            f"segment {i} has no length: its ends are both ({x:g}, {y:g}); remove it, {OR_REPAIR}"
        )
    return out


def _checked_regions(regions: Mapping[str, ArrayLike]) -> tuple[Mapping[str, int], Floats, Ints]:
    numbers: dict[str, int] = {}
    seeds, owners = [], []
    for name, where in regions.items():
        numbers[str(name)] = len(numbers) + 1
        points = checked_points(np.atleast_2d(np.asarray(where)), f"region {name!r} point", least=1)
        seeds.append(points)
        owners += [numbers[str(name)]] * len(points)
    all_seeds = np.concatenate(seeds) if seeds else np.empty((0, 2))
    return MappingProxyType(numbers), _read_only(all_seeds), _read_only(np.array(owners, np.int32))


def checked_names(
    names: Mapping[str, Iterable[int]], n_segments: int
) -> tuple[Mapping[str, int], Ints]:
    """The tag of each name and of each segment, (k,), or a `DomainError`."""
    numbers: dict[str, int] = {}
    tags = np.zeros(n_segments, np.int32)
    for name, segments in names.items():
        numbers[str(name)] = tag = len(numbers) + 1
        for i in segments:
            if not 0 <= i < n_segments:
                raise DomainError(
                    f"name {name!r} is given to segment {i}, but the segments are numbered "
                    f"0 to {n_segments - 1}"
                )
            if tags[i] not in (0, tag):
                other = next(n for n, t in numbers.items() if t == tags[i])
                raise DomainError(f"segment {i} is named both {other!r} and {name!r}: choose one")
            tags[i] = tag
    return MappingProxyType(numbers), _read_only(tags)


def _rings_of(geometry: Mapping[str, Any]) -> list[ArrayLike]:
    """All rings of a GeoJSON-like Polygon or MultiPolygon."""
    kind = geometry.get("type")
    if kind == "Polygon":
        polygons = [geometry["coordinates"]]
    elif kind == "MultiPolygon":
        polygons = geometry["coordinates"]
    else:
        raise DomainError(f"a domain is made of a Polygon or MultiPolygon, not of a {kind}")
    return [np.asarray(ring, float)[:, :2] for polygon in polygons for ring in polygon]


def _join_rings(rings: Sequence[ArrayLike]) -> tuple[Floats, Ints]:
    """Points and segments of closed rings; rings that share a point share its number."""
    points, segments, n = [], [], 0
    for k, ring in enumerate(rings):
        p = checked_points(ring, f"ring {k}: point")
        if (p[0] == p[-1]).all():
            p = p[:-1]
        if len(p) < 3:
            raise DomainError(f"ring {k} has {len(p)} different points: at least 3 are needed")
        number = n + np.arange(len(p))
        points.append(p)
        segments.append(np.stack([number, np.roll(number, -1)], axis=1))
        n += len(p)
    joined = np.concatenate(points) if points else np.empty((0, 2))
    unique, first, inverse = np.unique(joined, axis=0, return_index=True, return_inverse=True)
    if len(unique) == len(joined):
        return joined, np.concatenate(segments) if segments else np.empty((0, 2), int)
    order = np.argsort(first)  # np.unique sorts; keep the order in which the points were given
    number_of = np.empty(len(unique), int)
    number_of[order] = np.arange(len(unique))
    return unique[order], number_of[inverse.ravel()][np.concatenate(segments)]
