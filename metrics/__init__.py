"""The control space: how long is this edge, here?"""

from . import tensor
from .background import Background
from .control import ControlSpace, Metric, Uniform, as_control_space
from .curvature import Curvature, interpolation_errors
from .errors import AdaptmeshError, MetricError
from .estimators import (
    doerfler_marking,
    metric_from_indicators,
    residual_indicators,
    zz_indicators,
)
from .expression import Expression
from .files import read
from .goal import metric_from_adjoint
from .gradation import graded
from .implied import implied_metric, triangle_metrics
from .measure import (
    Complexity,
    complexity,
    edge_lengths,
    mesh_edges,
    metric_areas,
    qualities,
)
from .nodal import (
    efficiency_index,
    h_shocks,
    nodal_areas,
    nodal_complexity,
    nodal_lengths,
    nodal_qualities,
    predicted_vertices,
)
from .normalise import Limits, combined, interpolation_error, lp_metric, normalised
from .recovery import absolute, gradients, hessians
from .sizes import (
    BoundaryCurvature,
    BoundaryLayer,
    Distance,
    Geometry,
    Nearest,
    Raster,
    RegionSizes,
    Shock,
    first_height,
)
from .solution import metric_from_hessians, metric_from_solution

__all__ = [
    "AdaptmeshError",
    "Background",
    "BoundaryCurvature",
    "BoundaryLayer",
    "Complexity",
    "ControlSpace",
    "Curvature",
    "Distance",
    "Expression",
    "Geometry",
    "Limits",
    "Metric",
    "MetricError",
    "Nearest",
    "Raster",
    "RegionSizes",
    "Shock",
    "Uniform",
    "absolute",
    "as_control_space",
    "combined",
    "complexity",
    "doerfler_marking",
    "edge_lengths",
    "efficiency_index",
    "first_height",
    "graded",
    "gradients",
    "h_shocks",
    "hessians",
    "implied_metric",
    "interpolation_error",
    "interpolation_errors",
    "lp_metric",
    "mesh_edges",
    "metric_areas",
    "metric_from_adjoint",
    "metric_from_hessians",
    "metric_from_indicators",
    "metric_from_solution",
    "nodal_areas",
    "nodal_complexity",
    "nodal_lengths",
    "nodal_qualities",
    "normalised",
    "predicted_vertices",
    "qualities",
    "read",
    "residual_indicators",
    "tensor",
    "triangle_metrics",
    "zz_indicators",
]
