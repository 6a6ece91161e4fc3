"""Sizes that grow with the distance."""

from __future__ import annotations

from typing import Any, Literal

import numpy as np
from numpy.typing import ArrayLike

from metrics.checks import h_limit, one_of, positive
from metrics.control import ControlSpace
from metrics.types import Floats

from .geometry import as_geometry
from .growth import Law, grown, slope_of

__all__ = ["Distance"]


class Distance(ControlSpace):
    """A size that grows with the distance d to points, curves or polygons.

    ``h(d) = min(h_min + slope * d, h_max)``, with the exact distance to the segments.

    Parameters
    ----------
    geometry : Geometry, or what it takes
        A point (2,), a polyline (n, 2), polylines (k, n, 2), a shapely geometry, ...
    h_min : float
        The size at distance 0; a length in the units of the coordinates, as are h_max and d.
    growth : float
        With ``law="linear"`` the slope dh/dd, not negative: 0.2 makes h larger by 0.2 d. With
        ``law="geometric"`` the ratio r of one size to the one a step before, at least 1; the slope
        is ``r - 1``.
    h_max : float, optional
        The largest size.
    law : {"linear", "geometric"}, optional
        What `growth` is. Steps that are as long as the size where they start have lengths
        ``h_min r**k`` exactly under the geometric law, and steps of unit metric length grow by
        ``exp(slope)`` under both; see `metrics.sizes.growth`.
    inside : {"zero", "boundary"}, optional
        For a geometry made of polygons, what d is inside: 0, or the distance to the boundary as
        it is outside.

    Raises
    ------
    MetricError
        Names the argument that is out of range, or what is wrong with the geometry.

    Examples
    --------
    >>> from metrics import Distance, tensor
    >>> field = Distance([(0, 0), (1, 0)], h_min=0.1, growth=0.5)
    >>> tensor.sizes(field([[0.5, 0.0], [0.5, 1.0]]))
    array([[0.1, 0.1],
           [0.6, 0.6]])
    """

    def __init__(
        self,
        geometry: Any,
        h_min: float,
        growth: float,
        h_max: float = np.inf,
        law: Law = "linear",
        inside: Literal["zero", "boundary"] = "zero",
    ) -> None:
        self.geometry = as_geometry(geometry)
        self.h_min = positive("h_min", h_min)
        self.slope = slope_of(growth, law)
        self.h_max = h_limit(h_max, "h_min", self.h_min)
        self.inside = one_of("inside", inside, ("zero", "boundary"))

    def values(self, points: Floats) -> ArrayLike:
        distances = self.geometry.distances(points)
        if self.geometry.is_polygonal and self.inside == "zero":
            distances[self.geometry.contains(points)] = 0
        return grown(self.h_min, self.slope, distances, self.h_max)

    def __repr__(self) -> str:
        return (
            f"<Distance: h = {self.h_min:g} + {self.slope:g} d, at most {self.h_max:g}, "
            f"{len(self.geometry.segments)} segments>"
        )
