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
    FormatWarning,
    LoopError,
    LoopInterrupted,
    MetricError,
    TransferError,
    TransientError,
    TransientInterrupted,
)
from .explain import Explanation, explain
from .generate import generate
from .history import History, Iteration
from .io import read, read_fields, read_sol, write, write_sol
from .loop import adapt_loop
from .mesh import Mesh
from .naming import facing, nearest
from .overlay import Overlay
from .plot import plot
from .prediction import predict
from .raw import Outline
from .reasons import Cause, Reason
from .repair import Repair, Repairs, repair
from .report import Report, measure
from .simplify import Dropped, simplify
from .solved import Solution
from .stopping import Budget
from .transfer import transfer
from .transient import transient_loop
from .transient_history import Interval, TransientHistory
from .triangulate import delaunay
from .validate import Validity, validate

__version__ = "0.1.0"

__all__ = [
    "AdaptmeshError",
    "Budget",
    "BudgetError",
    "Cause",
    "Domain",
    "DomainError",
    "Dropped",
    "Explanation",
    "FormatError",
    "FormatWarning",
    "History",
    "Interval",
    "Iteration",
    "LoopError",
    "LoopInterrupted",
    "Mesh",
    "MetricError",
    "Outline",
    "Overlay",
    "Reason",
    "Repair",
    "Repairs",
    "Report",
    "Solution",
    "TransferError",
    "TransientError",
    "TransientHistory",
    "TransientInterrupted",
    "Validity",
    "adapt",
    "adapt_loop",
    "curves",
    "delaunay",
    "explain",
    "facing",
    "generate",
    "measure",
    "nearest",
    "plot",
    "predict",
    "read",
    "read_domain",
    "read_fields",
    "read_sol",
    "repair",
    "simplify",
    "transfer",
    "transient_loop",
    "validate",
    "write",
    "write_sol",
]
