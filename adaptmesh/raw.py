"""What to mesh as it comes, before it is checked: segments (`Outline`), or polygons (`Shape`)."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, field, replace
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from .domain import Domain
from .domain_input import ByLabel, labelled
from .errors import DomainError, FormatError
from .value import Value

if TYPE_CHECKING:
    from shapely import MultiPolygon, Polygon

Floats = NDArray[np.float64]


@dataclass(frozen=True, eq=False)
class Outline(Value):
    """Points and segments that may be dirty: what `repair` makes a `Domain` of.

    The fields are the arguments of `Domain`, and mean the same. Nothing is checked.

    Attributes
    ----------
    points : (n, 2) array_like of float
    segments : (k, 2) array_like of int
    holes : sequence of (x, y), or "nesting"
    regions : mapping of str or int to (x, y) or several
    names : mapping of str or int to sequence of int
    tags, region_tags : mapping of str to int
    """

    points: ArrayLike
    segments: ArrayLike
    holes: ArrayLike | str = ()
    regions: ByLabel[ArrayLike] = field(default_factory=dict)
    names: ByLabel[Iterable[int]] = field(default_factory=dict)
    tags: Mapping[str, int] = field(default_factory=dict)
    region_tags: Mapping[str, int] = field(default_factory=dict)

    @classmethod
    def of_domain(cls, domain: Domain) -> Outline:
        """The arguments that a domain of straight segments was made of."""
        return cls(
            domain.points,
            domain.segments,
            holes="nesting" if domain.nesting else domain.holes,
            regions={r: domain.seeds[i] for r, i in labelled(domain.seed_regions).items()},
            names=labelled(domain.segment_tags),
            tags=domain.names,
            region_tags=domain.region_names,
        )

    def domain(self) -> Domain:
        """The domain, if nothing is wrong; else a `DomainError` that says what, and where."""
        return Domain(
            self.points,
            self.segments,
            self.holes,
            self.regions,
            self.names,
            self.tags,
            self.region_tags,
        )


@dataclass(frozen=True, eq=False)
class Shape:
    """A polygon or several, as given: nothing is checked.

    Attributes
    ----------
    label : str
        How messages call it.
    name : str or None
        Of its region.
    parts : sequence of sequence of (n, 2) array
        The rings of each part: its shell, then its holes; closed or not, in any direction.
    closed : bool
        Whether rings have to end where they start, as in GeoJSON.
    nested : bool
        Whether a ring inside a hole is meant as an island; else it is a mistake that is read so.
    heights : (float, float) or None
        The least and the greatest third coordinate, if points lie at different heights.
    """

    label: str
    name: str | None
    parts: Sequence[Sequence[Floats]]
    closed: bool = False
    nested: bool = False
    heights: tuple[float, float] | None = None

    @classmethod
    def of_shapely(
        cls, polygon: Polygon | MultiPolygon, number: int = 0, name: str | None = None
    ) -> Shape:
        """The rings of a polygon or multipolygon of shapely."""
        import shapely

        label = label_of(number, name)
        kind = getattr(polygon, "geom_type", type(polygon).__name__)
        if kind not in ("Polygon", "MultiPolygon"):
            raise DomainError(not_a_polygon(label, kind))
        parts = [
            [shapely.get_coordinates(ring) for ring in shapely.get_rings(part)]
            for part in shapely.get_parts(polygon)
        ]
        shape = cls(label, name, [part for part in parts if part])
        return shape.with_heights(shapely.get_coordinates(polygon, include_z=True)[:, 2])

    @classmethod
    def of_rings(
        cls,
        outer: ArrayLike,
        holes: Sequence[ArrayLike] = (),
        number: int = 0,
        name: str | None = None,
    ) -> Shape:
        """A ring, and rings of holes in it, or of islands in these, as in `Domain.polygon`."""
        label = label_of(number, name)
        rings = [_ring(ring, label) for ring in (outer, *holes)]
        return cls(label, name, [rings], nested=True)

    @classmethod
    def of_geojson(cls, geometry: Any, number: int = 0, name: str | None = None) -> Shape:
        """The rings of a GeoJSON geometry."""
        label = label_of(number, name)
        kind = geometry.get("type") if isinstance(geometry, Mapping) else None
        if kind not in ("Polygon", "MultiPolygon"):
            raise DomainError(not_a_polygon(label, kind))
        coordinates = geometry.get("coordinates")
        if not isinstance(coordinates, Sequence) or isinstance(coordinates, str):
            raise FormatError(f"{label} cannot be read: its coordinates are {coordinates!r}")
        parts = [coordinates] if kind == "Polygon" else coordinates
        try:
            read = [[_ring(ring, label) for ring in part] for part in parts]
        except TypeError as error:  # a number in the place of a list
            raise FormatError(f"{label} cannot be read: {error}") from None
        shape = cls(label, name, [part for part in read if part], closed=True)
        points = (point for part in parts for ring in part for point in ring)
        try:
            return shape.with_heights([point[2] for point in points if len(point) > 2])
        except (TypeError, ValueError, OverflowError) as error:
            raise FormatError(f"{label} cannot be read: a height in it is {error}") from None

    def with_heights(self, z: ArrayLike) -> Shape:
        """The same shape, whose points lie at these heights; not finite: at none."""
        heights = np.asarray(z, dtype=np.float64)
        heights = heights[np.isfinite(heights)]
        if not len(heights) or heights.min() == heights.max():
            return self
        return replace(self, heights=(float(heights.min()), float(heights.max())))


def label_of(number: int, name: str | None) -> str:
    """How messages call a polygon."""
    return f"polygon {number}" if name is None else f"polygon {number} ({name!r})"


def not_a_polygon(label: str, kind: str | None) -> str:
    """What to do with a feature that bounds no area."""
    return (
        f"{label} is {'nothing' if kind is None else f'a {kind}'}, and a domain is made of Polygon "
        "and MultiPolygon: remove that feature, or make a polygon of it (shapely.polygonize for "
        "closed lines, shapely.buffer for points and open ones)"
    )


def _ring(points: Any, label: str) -> Floats:
    """The first two coordinates of the points of a ring."""
    try:
        out = np.asarray(points, dtype=np.float64)
    except (TypeError, ValueError, OverflowError):
        try:  # some of the points may have a height
            out = np.array([point[:2] for point in points], dtype=np.float64)
        except (TypeError, ValueError, IndexError, OverflowError) as error:
            raise FormatError(f"{label} cannot be read: {error}") from None
    if out.size == 0:
        return np.empty((0, 2))
    if out.ndim != 2 or out.shape[1] < 2:
        raise FormatError(f"{label} cannot be read: a ring has the shape {out.shape}, not (n, 2)")
    return np.ascontiguousarray(out[:, :2])
