"""Adaptive anisotropic meshing of planar domains governed by a metric field."""

try:
    from . import _core  # noqa: F401
except ImportError as error:
    raise ImportError(
        f"the compiled core of adaptmesh is not beside {__file__}: this is its source tree. "
        "Install it (pip install .) and start Python in another folder"
    ) from error

from . import curves
from .adapt.adapt import adapt
from .domain.domain import Domain
from .domain.naming import facing, nearest
from .domain.outline import Outline
from .errors import (
    AdaptmeshError,
    BudgetError,
    DomainError,
    FormatError,
    FormatWarning,
    MetricError,
    TransferError,
)
from .generate.delaunay import delaunay
from .generate.generate import generate
from .generate.prediction import predict
from .io import read, read_fields, read_metric, read_sol, write, write_sol
from .io.domains.read import read_domain
from .loop.adapt_loop import adapt_loop
from .loop.errors import LoopError, LoopInterrupted, TransientError, TransientInterrupted
from .loop.history import History
from .loop.iteration import Iteration
from .loop.records import Interval
from .loop.solution import Solution
from .loop.stopping import Budget
from .loop.transient_history import TransientHistory
from .loop.transient_loop import transient_loop
from .mesh.mesh import Mesh
from .mesh.validate.validate import Validity, validate
from .quality.explain import Explanation, explain
from .quality.reasons import Cause, Reason
from .quality.report import Report, measure
from .repair.repair import Repair, Repairs, repair
from .repair.simplify import Dropped, simplify
from .transfer.supermesh import Overlay
from .transfer.transfer import transfer
from .view.plot import plot

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
    "read_metric",
    "read_sol",
    "repair",
    "simplify",
    "transfer",
    "transient_loop",
    "validate",
    "write",
    "write_sol",
]


def __dir__() -> list[str]:
    return sorted([*__all__, "__doc__", "__file__", "__name__", "__path__", "__version__"])
