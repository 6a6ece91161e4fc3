"""The control space: how long is this edge, here?"""

from . import tensor
from .background import Background
from .control import ControlSpace, Metric, Uniform, as_control_space
from .errors import AdaptmeshError, MetricError
from .expression import Expression
from .measure import (
    Complexity,
    complexity,
    edge_lengths,
    mesh_edges,
    metric_areas,
    qualities,
)

__all__ = [
    "AdaptmeshError",
    "Background",
    "Complexity",
    "ControlSpace",
    "Expression",
    "Metric",
    "MetricError",
    "Uniform",
    "as_control_space",
    "complexity",
    "edge_lengths",
    "mesh_edges",
    "metric_areas",
    "qualities",
    "tensor",
]
