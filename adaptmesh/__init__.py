"""Adaptive anisotropic meshing of planar domains governed by a metric field."""

from .adapt import adapt
from .domain import Domain
from .errors import AdaptmeshError, BudgetError, DomainError, FormatError, MetricError
from .generate import generate, predict
from .mesh import Mesh

__version__ = "0.1.0"

__all__ = [
    "AdaptmeshError",
    "BudgetError",
    "Domain",
    "DomainError",
    "FormatError",
    "Mesh",
    "MetricError",
    "adapt",
    "generate",
    "predict",
]
