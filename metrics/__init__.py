"""The control space: how long is this edge, here?"""

from . import tensor
from .background import Background
from .control import ControlSpace, Metric, Uniform, as_control_space
from .errors import AdaptmeshError, MetricError
from .expression import Expression
from .from_solution.estimators import (
    doerfler_marking,
    metric_from_indicators,
    residual_indicators,
    zz_indicators,
)
from .from_solution.goal_oriented import metric_from_adjoint
from .from_solution.hessian_field import Curvature, interpolation_errors
from .from_solution.limits import Limits
from .from_solution.normalise import combined, interpolation_error, lp_metric, normalised
from .from_solution.optimal_metric import metric_from_hessians, metric_from_solution
from .from_solution.recovery import absolute, gradients, hessians
from .gradation import graded
from .measure.complexity import Complexity, complexity
from .measure.exact import edge_lengths, metric_areas, qualities
from .measure.implied import implied_metric, triangle_metrics
from .measure.nodal import (
    efficiency_index,
    h_shocks,
    nodal_areas,
    nodal_complexity,
    nodal_lengths,
    nodal_qualities,
    predicted_vertices,
)
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
from .topology import mesh_edges

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
    "residual_indicators",
    "tensor",
    "triangle_metrics",
    "zz_indicators",
]


def __dir__() -> list[str]:
    return sorted([*__all__, "__doc__", "__file__", "__name__", "__path__"])
