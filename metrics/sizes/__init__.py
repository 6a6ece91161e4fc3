"""Ready-made control spaces: sizes from distances, walls, fronts, curvature, rasters, regions."""

from .boundary_layer import BoundaryLayer, first_height
from .curvature import BoundaryCurvature
from .distance import Distance
from .geometry import Geometry, Nearest
from .raster import Raster
from .regions import RegionSizes
from .shock import Shock

__all__ = [
    "BoundaryCurvature",
    "BoundaryLayer",
    "Distance",
    "Geometry",
    "Nearest",
    "Raster",
    "RegionSizes",
    "Shock",
    "first_height",
]
