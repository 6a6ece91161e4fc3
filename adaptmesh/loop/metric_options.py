"""How fields become a metric: the options that both loops share."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field

from adaptmesh.checks import expect_number
from adaptmesh.mesh.mesh import Mesh
from adaptmesh.types import Array
from metrics import Curvature, Limits
from metrics.from_solution.normalise import check_combination, check_norm
from metrics.from_solution.recovery import check_method

from .chosen_fields import check_names


@dataclass(frozen=True, kw_only=True)
class MetricOptions:
    """Base of `Target` and `TargetInTime`.

    Attributes
    ----------
    p : float
        Of the norm of the interpolation error.
    fields : sequence of str or None
        Those that the mesh is adapted to; None for all real ones that are given at the vertices.
    limits : Limits
    recovery, combine : str
        As for `metrics.metric_from_solution`.
    """

    p: float = 2.0
    fields: Sequence[str] | None = None
    limits: Limits = field(default_factory=Limits)
    recovery: str = "green"
    combine: str = "intersection"

    def __post_init__(self) -> None:
        expect_number("p", self.p)
        check_norm(self.p)
        check_method(self.recovery)
        check_combination(self.combine)
        check_names(self.fields)

    def curvatures(self, mesh: Mesh, fields: Mapping[str, Array]) -> dict[str, Curvature]:
        """The derivatives of fields (n,) or (n, k), recovered."""
        return {
            name: Curvature.of(mesh.points, mesh.triangles, values, self.recovery)
            for name, values in fields.items()
        }
