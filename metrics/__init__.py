"""The control space: how long is this edge, here?"""

from . import tensor
from .background import Background
from .control import ControlSpace, Metric, Uniform, as_control_space
from .errors import AdaptmeshError, MetricError

__all__ = [
    "AdaptmeshError",
    "Background",
    "ControlSpace",
    "Metric",
    "MetricError",
    "Uniform",
    "as_control_space",
    "tensor",
]
