"""The control space: how long is this edge, here?"""

from . import tensor
from .background import Background
from .control import ControlSpace, Metric, Uniform, as_control_space
from .errors import AdaptmeshError, MetricError
from .expression import Expression
from .files import read
from .measure import (
    Complexity,
    complexity,
    edge_lengths,
    mesh_edges,
    metric_areas,
    qualities,
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

__all__ = [
    "AdaptmeshError",
    "Background",
    "BoundaryCurvature",
    "BoundaryLayer",
    "Complexity",
    "ControlSpace",
    "Distance",
    "Expression",
    "Geometry",
    "Metric",
    "MetricError",
    "Nearest",
    "Raster",
    "RegionSizes",
    "Shock",
    "Uniform",
    "as_control_space",
    "complexity",
    "edge_lengths",
    "first_height",
    "mesh_edges",
    "metric_areas",
    "qualities",
    "read",
    "tensor",
]
