"""Thin layers on walls, and how thin the first one must be."""

from __future__ import annotations

from typing import Any, Literal

import numpy as np
from numpy.typing import ArrayLike

from metrics.checks import h_limit, one_of, positive
from metrics.control import ControlSpace, Metric, as_control_space
from metrics.errors import MetricError
from metrics.types import Floats

from .anisotropic_layer import layer_metric, size_along
from .geometry import as_curves
from .growth import slope_of

__all__ = ["BoundaryLayer", "first_height"]


class BoundaryLayer(ControlSpace):
    """An anisotropic layer on a wall: thin across it, long along it.

    At the distance d from the wall, across it ``h_n = first_height + (r - 1) d`` with the growth
    ratio r: layers that are as high as the size where they start have the heights
    ``first_height * r**k``. Along it ``h_t = max(tangential, h_n)``: the size given, until the
    layers have grown as high; from there on both sizes are the same, and grow to h_max.

    Parameters
    ----------
    wall : Geometry, or what it takes
        Sides of an `adaptmesh.Domain` by name, ``domain.sides("wall")``, whose curves are taken as
        they are; curves as polylines, polygons (their boundary, which has a layer on both sides), a
        shapely geometry, or segments (k, 2, 2). Coordinates and sizes are in one unit of length.
    first_height : float
        The size across the wall, at the wall. The first row of triangles, if equilateral in the
        metric, is lower than that by sqrt(3)/2. See `metrics.first_height` for a given y+.
    growth_ratio : float
        Ratio r of the heights of two neighbouring layers, at least 1.
    tangential : number, callable or ControlSpace
        The size along the wall; it is asked for at the nearest point of the wall, so that a
        `BoundaryCurvature` of the wall makes it follow the curvature.
    h_max : float, optional
        Neither size is larger, at any distance.

    Raises
    ------
    MetricError
        Names the argument that is out of range, or what is wrong with the wall.

    Notes
    -----
    The direction across the wall is that from the nearest point, which is exact: constant beside a
    segment, turning with the point around a convex corner and past an end, and jumping only on the
    medial axis, where two parts of the wall are equally near.
    """

    def __init__(
        self,
        wall: Any,
        first_height: float,
        growth_ratio: float,
        tangential: Metric,
        h_max: float = np.inf,
    ) -> None:
        self.wall = as_curves(wall, "a wall")
        self.first_height = positive("first_height", first_height)
        self.slope = slope_of(growth_ratio, "geometric", "growth_ratio")
        self.tangential = as_control_space(tangential)
        self.h_max = h_limit(h_max, "first_height", self.first_height)

    def values(self, points: Floats) -> ArrayLike:
        near = self.wall.nearest(points)
        along = size_along(self.tangential, near.points, near.directions)
        return layer_metric(
            near.distances, near.directions, self.first_height, along, self.slope, self.h_max
        )

    def __repr__(self) -> str:
        return (
            f"<BoundaryLayer: {self.first_height:g} + {self.slope:g} d across, "
            f"{self.tangential!r} along, at most {self.h_max:g}>"
        )


def first_height(
    y_plus: float,
    reynolds: float,
    length: float,
    *,
    correlation: Literal["schlichting", "white"] = "schlichting",
) -> float:
    """The distance from a wall at which y+ has a given value, as on a flat plate.

    ``y = y_plus * nu / u_tau`` with the friction velocity ``u_tau = U sqrt(c_f / 2)``, which is
    ``y = y_plus * length / (reynolds * sqrt(c_f / 2))``.

    Parameters
    ----------
    y_plus : float
        The wall distance, in viscous lengths; 1 to resolve the viscous sublayer, 30 to 100
        for wall functions.
    reynolds : float
        ``U length / nu``, dimensionless.
    length : float
        The length that `reynolds` is made with: the distance x from the leading edge at which y+
        is wanted. A plate is where the layer is thinnest near its leading edge; a small x is on
        the safe side.
    correlation : {"schlichting", "white"}, optional
        The local skin friction of a smooth plate with a turbulent layer from its leading edge:
        ``c_f = (2 log10(Re_x) - 0.65)**-2.3`` (Schlichting, to Re_x = 1e9), or
        ``c_f = 0.455 / log(0.06 Re_x)**2`` (White, natural logarithm).

    Returns
    -------
    float
        The height in the unit of `length`, from the wall to where the first value is: the first
        node of a vertex-centred solver, the middle of the first cell of a cell-centred one, which
        is then twice as high.

    Raises
    ------
    MetricError
        For what is not positive, and for a Reynolds number below 1e4, where no such layer is
        turbulent, or above 1e10.

    References
    ----------
    Schlichting, Gersten: Boundary-layer theory. Springer.
    White: Viscous fluid flow. McGraw-Hill.

    Examples
    --------
    >>> from metrics import first_height
    >>> f"{first_height(1, 1e6, 1.0):.3g} m for y+ = 1 on a plate of one metre"
    '2.31e-05 m for y+ = 1 on a plate of one metre'
    """
    positive("y_plus", y_plus)
    positive("length", length)
    if not 1e4 <= positive("reynolds", reynolds) <= 1e10:
        raise MetricError(
            f"the Reynolds number {reynolds!r} is not within 1e4 ... 1e10, where turbulent skin "
            "friction is known; it is velocity * length / kinematic viscosity"
        )
    if one_of("correlation", correlation, ("schlichting", "white")) == "schlichting":
        friction = (2 * np.log10(reynolds) - 0.65) ** -2.3
    else:
        friction = 0.455 / np.log(0.06 * reynolds) ** 2
    return float(y_plus * length / (reynolds * np.sqrt(friction / 2)))
