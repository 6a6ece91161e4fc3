"""Adaptive anisotropic meshing of planar domains governed by a metric field."""

try:
    from . import _core  # noqa: F401
except ImportError as error:
    raise ImportError(
        f"the compiled core of adaptmesh is not beside {__file__}: this is its source tree. "
        "Install it (pip install .) and start Python in another folder"
    ) from error

from . import curves
from .adapt import adapt
from .domain import Domain
from .domain_io import read_domain
from .errors import (
    AdaptmeshError,
    BudgetError,
    DomainError,
    FormatError,
    MetricError,
    TransferError,
)
from .generate import generate, predict
from .io import read, read_fields, read_sol, write, write_sol
from .mesh import Mesh
from .overlay import Overlay
from .plot import plot
from .raw import Outline
from .repair import Repair, Repairs, repair
from .report import Report, measure
from .transfer import transfer
from .triangulate import delaunay
from .validate import Validity, validate

__version__ = "0.1.0"

__all__ = [
    "AdaptmeshError",
    "BudgetError",
    "Domain",
    "DomainError",
    "FormatError",
    "Mesh",
    "MetricError",
    "Outline",
    "Overlay",
    "Repair",
    "Repairs",
    "Report",
    "TransferError",
    "Validity",
    "adapt",
    "curves",
    "delaunay",
    "generate",
    "measure",
    "plot",
    "predict",
    "read",
    "read_domain",
    "read_fields",
    "read_sol",
    "repair",
    "transfer",
    "validate",
    "write",
    "write_sol",
]
