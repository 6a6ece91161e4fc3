"""One size for each region of a mesh."""

from __future__ import annotations

from collections.abc import Mapping
from functools import cached_property
from typing import Any, Literal, NamedTuple

import numpy as np
from numpy.typing import ArrayLike

from metrics.background import Background
from metrics.checks import as_points, as_triangles, positive
from metrics.control import ControlSpace
from metrics.errors import MetricError
from metrics.gradation import check_growth
from metrics.types import Floats, Ints

from .geometry import Geometry

__all__ = ["RegionSizes"]

# A point this near to an interface, relative to the size of the mesh, is on it by rounding.
_ON_INTERFACE = 1e-9


class RegionSizes(ControlSpace):
    """One size for each region, the smaller one on the interface of two, be it straight or curved.

    Parameters
    ----------
    mesh : adaptmesh.Domain, adaptmesh.Mesh, or alike
        Has `points` (n, 2), `triangles` (m, 3), the number of the region of each triangle (m,) as
        `triangle_regions` or `regions`, and the numbers of names as `region_names`.
    sizes : mapping of str to float
        The size of each region, by its name; or by its number, such as 0 for what has no name.
    default : float, optional
        The size of regions that are not in `sizes`.
    growth : float or None, optional
        Beside a region of smaller sizes, sizes grow by at most this factor from one unit edge to
        the next: triangles of very different sizes cannot be well shaped where they meet. None:
        each region has its size everywhere, and sizes jump at interfaces.
    outside : {"clamp", "error"}, optional
        For a point outside of the mesh: the size at the nearest point of its border, or a
        `MetricError` that names the point.

    Raises
    ------
    MetricError
        Names a region that is unknown, or one that has no size when there is no default.

    Notes
    -----
    Sizes are graded as by ``RegionSizes(mesh, sizes, growth=None).graded(mesh, growth)``, when they
    are asked for first, see `ControlSpace.graded`: on meshes made for it if `mesh` is one of
    adaptmesh or a domain, else at the vertices of the mesh that is given.
    """

    def __init__(
        self,
        mesh: Any,
        sizes: Mapping[str | int, float],
        default: float | None = None,
        outside: Literal["clamp", "error"] = "clamp",
        growth: float | None = 1.5,
    ) -> None:
        domain: Any = getattr(mesh, "domain", None)
        if hasattr(domain, "cubic_pieces") and dict(domain.region_names) == dict(mesh.region_names):
            mesh = domain  # its sides are the curves themselves
        self.sizes, self.growth = dict(sizes), growth
        self._steps = _Steps(mesh, self.sizes, default, outside)
        if growth is not None:
            check_growth(growth, "mixed")
        self._mesh = mesh

    def values(self, points: Floats) -> ArrayLike:
        if self.growth is None or self._steps.interfaces is None:
            return self._steps(points)
        return self._graded(points)

    @cached_property
    def _graded(self) -> ControlSpace:
        assert self.growth is not None
        return self._steps.graded(self._mesh, self.growth)

    def __repr__(self) -> str:
        return f"<RegionSizes: {', '.join(f'{name} {h:g}' for name, h in self.sizes.items())}>"


class _Steps(ControlSpace):
    """The size of the region that a point is in, the smaller one on interfaces."""

    def __init__(
        self,
        mesh: Any,
        sizes: dict[str | int, float],
        default: float | None,
        outside: Literal["clamp", "error"],
    ) -> None:
        points = as_points(mesh.points)
        triangles = as_triangles(mesh.triangles, len(points))
        regions = _regions_of(mesh, len(triangles))
        self.of_triangles = _sizes_of(regions, dict(mesh.region_names), sizes, default)
        #: Finds the triangle of a point; it carries no sizes.
        self.finder = Background(points, triangles, np.ones(len(points)), outside)
        if hasattr(mesh, "cubic_pieces"):  # between chords and curves is no outside
            self.finder.allow_beyond(float(mesh.cubic_pieces().heights.max(initial=0.0)))
        self.interfaces = _Interfaces.of(mesh, points, triangles, self.of_triangles)

    def values(self, points: Floats) -> ArrayLike:
        _, triangles = self.finder.evaluate(points)
        found = self.of_triangles[triangles]
        return found if self.interfaces is None else self.interfaces.sizes(points, found)

    def __repr__(self) -> str:
        return "sizes of regions"


class _Interfaces:
    r"""What lies between triangles of different sizes: edges, or the curves they are chords of.

    ::

          ___---___         Triangles end at the chord: what is between it and the curve has the
        /           \       size of the other side. It is nearest to this piece of the curve, and
       a-------------b      no farther from it than the chord is.
    """

    def __init__(self, pieces: Any, left: Floats, right: Floats) -> None:
        #: The pieces, the sizes on both sides of each, and how far each is off its chord.
        self.geometry = Geometry(pieces)
        self.left, self.right, self.heights = left, right, pieces.heights
        self.margin = _ON_INTERFACE * float(np.ptp(pieces.ends.reshape(-1, 2), axis=0).max())
        self.smaller = np.minimum(left, right)
        _, self.ends = self.geometry.vertices()
        #: At a vertex several interfaces may meet.
        self.at_vertices = np.full(int(self.ends.max()) + 1, np.inf)
        np.minimum.at(self.at_vertices, self.ends.ravel(), np.repeat(self.smaller, 2))

    @classmethod
    def of(cls, mesh: Any, points: Floats, triangles: Ints, sizes: Floats) -> _Interfaces | None:
        """Those of a mesh; None if there are none."""
        edges, left, right = _edges_with_sizes(triangles, sizes, len(points))
        differ = (left != right) & ~np.isnan(left + right)
        if not differ.any():
            return None
        edges, left, right = edges[differ], left[differ], right[differ]
        pieces = _straight(points[edges])
        if hasattr(mesh, "cubic_pieces"):
            pieces, edge = _on_curves(mesh, points, edges)
            left, right = left[edge], right[edge]
        return cls(pieces, left, right)

    def sizes(self, points: Floats, found: Floats) -> Floats:
        """The sizes at points, from those of the triangles that they are in."""
        piece, shares, feet, along = self.geometry.feet(points)
        off = points - feet
        distances = np.hypot(*off.T)
        is_left = along[:, 0] * off[:, 1] > along[:, 1] * off[:, 0]
        beside = np.where(is_left, self.left[piece], self.right[piece])
        out = np.where(distances <= self.heights[piece], beside, found)
        smaller = self.smaller[piece]
        vectors = np.diff(self.geometry.segments, axis=1)[piece, 0]
        travelled = shares * np.hypot(*vectors.T)
        for end, gap in enumerate((travelled, np.hypot(*vectors.T) - travelled)):
            at_end = gap <= self.margin
            vertex = self.ends[piece[at_end], end]
            smaller[at_end] = np.minimum(smaller[at_end], self.at_vertices[vertex])
        is_on = distances <= self.margin
        out[is_on] = np.minimum(out, smaller)[is_on]
        return out


class _Pieces(NamedTuple):
    """What `Geometry` takes from a domain of curves, and how far each is off its chord."""

    ends: Floats
    derivatives: Floats
    heights: Floats

    def cubic_pieces(self) -> _Pieces:
        return self


def _straight(ends: Floats) -> _Pieces:
    return _Pieces(ends, np.repeat(np.diff(ends, axis=1), 2, axis=1), np.zeros(len(ends)))


def _edges_with_sizes(triangles: Ints, sizes: Floats, n: int) -> tuple[Ints, Floats, Floats]:
    """Edges (k, 2), and the sizes on the left and on the right of each; NaN outside."""
    tail = triangles.astype(np.int64).T.ravel()
    head = triangles[:, [1, 2, 0]].astype(np.int64).T.ravel()
    keys, edge = np.unique(np.minimum(tail, head) * n + np.maximum(tail, head), return_inverse=True)
    beside = np.full((2, len(keys)), np.nan)
    beside[(tail > head).astype(int), edge.ravel()] = np.tile(sizes, 3)
    return np.stack(np.divmod(keys, n), axis=1), beside[0], beside[1]


def _on_curves(domain: Any, points: Floats, edges: Ints) -> tuple[_Pieces, Ints]:
    """Edges (k, 2) with the curves of a domain in place of chords, and the edge of each piece."""
    all_pieces = domain.cubic_pieces()
    n = len(points)
    ends = np.asarray(domain.segments, np.int64)
    keys = np.minimum(*ends.T) * n + np.maximum(*ends.T)
    edge_keys = edges[:, 0] * n + edges[:, 1]
    order = np.argsort(edge_keys)
    at = np.minimum(np.searchsorted(edge_keys, keys, sorter=order), len(edge_keys) - 1)
    edge_of_segment = np.where(edge_keys[order[at]] == keys, order[at], -1)
    edge = edge_of_segment[all_pieces.segments]
    curved = np.flatnonzero((edge >= 0) & (all_pieces.heights > 0))
    is_chord = np.isin(np.arange(len(edges)), edge[curved])
    straight = _straight(points[edges[~is_chord]])
    ends_, derivatives = all_pieces.ends[curved], all_pieces.derivatives[curved]
    against = ends[all_pieces.segments[curved], 0] > ends[all_pieces.segments[curved], 1]
    ends_[against] = ends_[against][:, ::-1]  # edges go from the lower number to the higher
    derivatives[against] = -derivatives[against][:, ::-1]
    pieces = _Pieces(
        np.concatenate([straight.ends, ends_]),
        np.concatenate([straight.derivatives, derivatives]),
        np.concatenate([straight.heights, all_pieces.heights[curved]]),
    )
    return pieces, np.concatenate([np.flatnonzero(~is_chord), edge[curved]])


def _regions_of(mesh: Any, count: int) -> Ints:
    for name in ("triangle_regions", "regions"):
        numbers = getattr(mesh, name, None)
        if numbers is not None and np.shape(numbers) == (count,):
            return np.asarray(numbers)
    raise MetricError(
        f"{type(mesh).__name__} has neither triangle_regions nor regions, a number for each of its "
        f"{count} triangles"
    )


def _sizes_of(
    regions: Ints,
    names: dict[str, int],
    sizes: Mapping[str | int, float],
    default: float | None,
) -> Floats:
    """The size of each triangle."""
    known = set(names.values()) | set(regions.tolist())
    of_numbers: dict[int, float] = {}
    for region, h in sizes.items():
        number = names.get(region) if isinstance(region, str) else region
        if number is None or number not in known:
            raise MetricError(
                f"there is no region {region!r}; the names are "
                f"{', '.join(map(repr, names)) or 'none'}, the numbers {sorted(known)}"
            )
        of_numbers[number] = positive(f"the size of region {region!r}", h)
    if default is not None:
        default = positive("default", default)
    out = np.empty(len(regions))
    for number in np.unique(regions).tolist():
        size = of_numbers.get(number, default)
        if size is None:
            name = next((repr(n) for n, k in names.items() if k == number), f"number {number}")
            raise MetricError(f"region {name} has no size: add it to sizes, or give default")
        out[regions == number] = size
    return out
