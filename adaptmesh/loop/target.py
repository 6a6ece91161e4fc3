"""From a solution to the metric for the next mesh: how many vertices, and where."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np

from adaptmesh.checks import expect_number
from adaptmesh.errors import MetricError
from adaptmesh.mesh.mesh import Mesh
from adaptmesh.types import Array, Floats
from metrics import Curvature, normalised
from metrics.from_solution.optimal_metric import optimal_tensors

from .chosen_fields import check_scale, choose_fields, is_constant, is_usable
from .error_control import next_count
from .iteration import Iteration
from .metric_options import MetricOptions
from .solution import Solution
from .vertex_count import check_count, min_vertices

# Meshes come within a few per cent of the number of vertices predicted, and a budget is not
# exceeded: this much of it is asked for.
SHARE_OF_BUDGET = 0.95


@dataclass(frozen=True, kw_only=True)
class Target(MetricOptions):
    """What the meshes are made for; see also `MetricOptions`.

    Attributes
    ----------
    target_vertices : float or None
    error : float, mapping of str to float, or None
        Asked for, of every field, or by its name.
    growth : float
        Bound on the ratio of the numbers of vertices of a mesh and the next.
    order : float
        The error falls with the number of vertices to this power.
    max_vertices : int
    """

    target_vertices: float | None = None
    error: float | Mapping[str, float] | None = None
    growth: float = 4.0
    order: float = 1.0
    max_vertices: int = 5_000_000

    def __post_init__(self) -> None:
        super().__post_init__()
        for name in ("growth", "order"):
            expect_number(name, getattr(self, name))
        if self.target_vertices is not None and self.error is not None:
            raise ValueError("give one target: target_vertices or error")
        if self.target_vertices is not None:
            check_count(self.target_vertices)
        if self.target_vertices is not None and self.target_vertices > self.max_vertices:
            raise ValueError(
                f"target_vertices={self.target_vertices!r} is more than the budget of "
                f"{self.max_vertices}"
            )
        if self.error is not None:
            _check_errors(self.error)
        if not self.growth > 1:
            raise ValueError(f"growth={self.growth!r}: must be more than 1")
        if not self.order > 0:
            raise ValueError(f"order={self.order!r}: must be positive")

    def asks_for_the_same(self, options: Mapping[str, str], others: Mapping[str, str]) -> bool:
        """Whether two targets, as text, make the same mesh, however it is reached."""
        names = vars(self).keys() - {"growth", "order", "max_vertices"}
        return all(options.get(name) == others.get(name) for name in names)

    def metric(
        self, mesh: Mesh, solution: Solution, earlier: Sequence[Iteration] = ()
    ) -> tuple[Floats, dict[str, float]]:
        """The metric (n, 3) at the vertices for the next mesh, and the errors on this one.

        `earlier` are the iterations before, made for the same options.
        """
        if solution.metric is None:
            return self._from_fields(mesh, solution, earlier)
        count = self._count(mesh, solution.errors, earlier)
        errors = dict(solution.errors) or self._monitor(mesh, solution)
        metric = solution.metric
        if count is None:
            metric = self.limits.applied(metric, mesh.points, mesh.triangles)
        else:
            metric = normalised(
                metric, mesh.points, mesh.triangles, target_vertices=count, limits=self.limits
            )
        return metric, errors

    def excess(self, errors: Mapping[str, float]) -> float:
        """The largest ratio of an error to what was asked for."""
        assert self.error is not None
        if not errors:
            raise MetricError(
                "an error was asked for, but solve gave a metric and no estimate of its own: "
                "return adaptmesh.Solution(metric=..., errors=...), or give target_vertices"
            )
        return max(value / self._error_for(name) for name, value in errors.items())

    def _from_fields(
        self, mesh: Mesh, solution: Solution, earlier: Sequence[Iteration]
    ) -> tuple[Floats, dict[str, float]]:
        points, triangles = mesh.points, mesh.triangles
        curvatures = self.curvatures(mesh, self._varying_fields(mesh, solution))
        errors = dict(solution.errors) or self._estimates(curvatures)
        bent = {name: c for name, c in curvatures.items() if not c.is_flat}
        shares = None
        if self.error is not None and not solution.errors:
            shares = [self._error_for(name) for name in bent]
        self._check_names_of_errors(errors, solution)
        count = self._count(mesh, errors, earlier)
        if count is None:
            raise MetricError(
                "neither target_vertices nor error is given, and solve returned no metric: "
                "there is nothing that says how fine the mesh should be"
            )
        if not bent:
            uniform = np.tile([1.0, 0.0, 1.0], (len(points), 1))
            metric = normalised(
                uniform, points, triangles, target_vertices=count, limits=self.limits
            )
            return metric, errors
        metric = optimal_tensors(
            points,
            triangles,
            [c.absolute for c in bent.values()],
            target_vertices=count,
            error=shares,
            p=self.p,
            limits=self.limits,
            combine=self.combine,
        )
        return metric, errors

    def _monitor(self, mesh: Mesh, solution: Solution) -> dict[str, float]:
        """Errors of fields beside a metric, to which the mesh is adapted: they tell convergence.

        The number of vertices, which is asked for, is met long before.
        """
        fields = {
            name: values
            for name, values in solution.fields.items()
            if is_usable(values, mesh) and not is_constant(values)
        }
        try:
            return self._estimates(self.curvatures(mesh, fields))
        except MetricError:  # on a mesh that is too coarse for derivatives there is nothing to tell
            return {}

    def _estimates(self, curvatures: Mapping[str, Curvature]) -> dict[str, float]:
        """The interpolation error of each field; 0 of one that is linear to rounding."""
        return {
            name: 0.0 if c.is_flat else norm(c.interpolation_errors(self.p), self.p)
            for name, c in curvatures.items()
        }

    def _varying_fields(self, mesh: Mesh, solution: Solution) -> dict[str, Array]:
        """The fields to adapt to that are not the same everywhere, (n, k)."""
        chosen = choose_fields(self.fields, solution.fields, mesh)
        varying = {n: v.reshape(len(v), -1) for n, v in chosen.items() if not is_constant(v)}
        for name, values in varying.items():
            check_scale(name, values)
        if not varying:
            raise MetricError(
                f"the fields say nothing about sizes: {', '.join(map(repr, chosen))} "
                f"{'are' if len(chosen) > 1 else 'is'} the same everywhere"
            )
        return varying

    def _check_names_of_errors(self, errors: Mapping[str, float], solution: Solution) -> None:
        known = dict.fromkeys([*solution.fields, *errors])
        for name in self.error if isinstance(self.error, Mapping) else ():
            if name not in known:
                raise MetricError(
                    f"error has a value for {name!r}, but solve gave {', '.join(map(repr, known))}"
                )

    def _count(
        self, mesh: Mesh, errors: Mapping[str, float], earlier: Sequence[Iteration]
    ) -> float | None:
        """How many vertices the next mesh is to have; None if only a metric can say.

        At least that of the coarsest mesh, as on the way to the target, and where even the
        coarsest mesh has the error asked for.
        """
        n_points = len(mesh.points)
        if self.error is not None:
            counts = [*(it.n_points for it in earlier), n_points]
            excesses = [*(self.excess(it.errors) for it in earlier), self.excess(errors)]
            count = next_count(counts, excesses, self.order, self.growth)
            count = min(count, SHARE_OF_BUDGET * self.max_vertices)
        elif self.target_vertices is not None:
            count = self.target_vertices
        else:
            return None
        count = min(max(count, n_points / self.growth), n_points * self.growth)
        return max(3.0, count, min_vertices(mesh, self.limits.h_max))

    def _error_for(self, name: str) -> float:
        if not isinstance(self.error, Mapping):
            assert self.error is not None
            return float(self.error)
        if name not in self.error:
            raise MetricError(f"error has no value for {name!r}: give one, or name `fields`")
        return float(self.error[name])


def _check_errors(error: float | Mapping[str, float]) -> None:
    for name, value in error.items() if isinstance(error, Mapping) else [("", error)]:
        label = f"error[{name!r}]" if name else "error"
        expect_number(label, value)
        if not 0 < value < np.inf:
            raise ValueError(f"{label}={value!r}: must be positive, and finite")
    if isinstance(error, Mapping) and not error:
        raise ValueError("error={}: give the error of each field, by name")


def norm(errors: Floats, p: float) -> float:
    """The L^p norm on the mesh from those on its triangles."""
    largest = float(errors.max())
    if p == np.inf or largest == 0:
        return largest
    return largest * float(np.sum((errors / largest) ** p) ** (1 / p))
