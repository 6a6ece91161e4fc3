"""One size for each region of a mesh."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any, Literal

import numpy as np
from numpy.typing import ArrayLike

from ..arrays import Floats, Ints, as_points, as_triangles
from ..background import Background
from ..control import ControlSpace
from ..errors import MetricError
from ..measure import mesh_edges
from .geometry import Geometry
from .given import positive

__all__ = ["RegionSizes"]

# A point this near to an interface, relative to the size of the mesh, is on it by rounding.
_ON_INTERFACE = 1e-9


class RegionSizes(ControlSpace):
    """One size for each region, the smaller one on the interface of two.

    Parameters
    ----------
    mesh : adaptmesh.Domain, adaptmesh.Mesh, or alike
        Has `points` (n, 2), `triangles` (m, 3), the number of the region of each triangle (m,) as
        `triangle_regions` or `regions`, and the numbers of names as `region_names`.
    sizes : mapping of str to float
        The size of each region, by its name; or by its number, such as 0 for what has no name.
    default : float, optional
        The size of regions that are not in `sizes`.
    outside : {"clamp", "error"}, optional
        For a point outside of the mesh: the size at the nearest point of its border, or a
        `MetricError` that names the point.

    Raises
    ------
    MetricError
        Names a region that is unknown, or one that has no size when there is no default.

    Notes
    -----
    The size jumps at interfaces; triangles next to one grow only as gradation allows. A mesh of
    this field alone has edges of both sizes there.
    """

    def __init__(
        self,
        mesh: Any,
        sizes: Mapping[str | int, float],
        default: float | None = None,
        outside: Literal["clamp", "error"] = "clamp",
    ) -> None:
        points = as_points(mesh.points)
        triangles = as_triangles(mesh.triangles, len(points))
        regions = _regions_of(mesh, len(triangles))
        self.sizes = dict(sizes)
        of_triangles = _sizes_of(regions, dict(mesh.region_names), self.sizes, default)
        #: Finds the triangle of a point; it carries no sizes.
        self._finder = Background(points, triangles, np.ones(len(points)), outside)
        self._of_triangles = of_triangles
        self._interfaces = _Interfaces.of(points, triangles, of_triangles)

    def values(self, points: Floats) -> ArrayLike:
        _, triangles = self._finder.evaluate(points)
        found = self._of_triangles[triangles]
        if self._interfaces is not None:
            found = np.minimum(found, self._interfaces.sizes(points))
        return found

    def __repr__(self) -> str:
        return f"<RegionSizes: {', '.join(f'{name} {h:g}' for name, h in self.sizes.items())}>"


class _Interfaces:
    """The edges between triangles of different sizes."""

    def __init__(self, segments: Floats, smaller: Floats) -> None:
        self.geometry = Geometry(segments)
        self.margin = _ON_INTERFACE * float(np.ptp(segments.reshape(-1, 2), axis=0).max())
        self.smaller = smaller
        _, self.ends = self.geometry.vertices()
        #: At a vertex several interfaces may meet.
        self.at_vertices = np.full(int(self.ends.max()) + 1, np.inf)
        np.minimum.at(self.at_vertices, self.ends.ravel(), np.repeat(smaller, 2))

    @classmethod
    def of(cls, points: Floats, triangles: Ints, sizes: Floats) -> _Interfaces | None:
        """Those of a mesh; None if there are none."""
        edges, sides = mesh_edges(triangles)
        low, high = np.full(len(edges), np.inf), np.zeros(len(edges))
        np.minimum.at(low, sides, sizes[:, None])
        np.maximum.at(high, sides, sizes[:, None])
        differ = low < high
        return cls(points[edges[differ]], low[differ]) if differ.any() else None

    def sizes(self, points: Floats) -> Floats:
        """The smaller size of both sides for points on an interface, infinite elsewhere."""
        near = self.geometry.nearest(points)
        lengths = np.hypot(*(self.geometry.segments[:, 1] - self.geometry.segments[:, 0]).T)
        travelled = near.shares * lengths[near.segments]
        out = self.smaller[near.segments]
        for end, gap in enumerate((travelled, lengths[near.segments] - travelled)):
            at_end = gap <= self.margin
            vertex = self.ends[near.segments[at_end], end]
            out[at_end] = np.minimum(out[at_end], self.at_vertices[vertex])
        return np.where(near.distances <= self.margin, out, np.inf)


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
