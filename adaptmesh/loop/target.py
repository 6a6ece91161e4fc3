"""From what was solved to the metric for the next mesh: how many vertices, and where."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field

import numpy as np

from adaptmesh.checks import expect_number
from adaptmesh.errors import MetricError
from adaptmesh.mesh.mesh import Mesh
from adaptmesh.types import Array, Floats
from metrics import Curvature, Limits, normalised
from metrics.from_solution.normalise import check_combination, check_norm
from metrics.from_solution.optimal_metric import optimal_tensors
from metrics.from_solution.recovery import check_method
from metrics.measure.nodal import vertices_of
from metrics.topology import border_edges

from .error_control import next_count
from .history import Iteration
from .solution import Solved, space_of

# Meshes come within a few per cent of the number of vertices predicted, and a budget is not
# exceeded: this much of it is asked for.
SHARE_OF_BUDGET = 0.95

SCALES = (1e-100, 1e100)  # of fields; squares of their derivatives are to be numbers


@dataclass(frozen=True)
class Steering:
    """What the meshes are made for.

    Attributes
    ----------
    target_vertices : float or None
    error : float, mapping of str to float, or None
        Asked for, of every field, or by its name.
    p : float
        Of the norm of the interpolation error.
    fields : sequence of str or None
        Those that steer the mesh; None for all real ones that are given at the vertices.
    limits : Limits
    recovery, combine : str
        As for `metrics.metric_from_solution`.
    growth : float
        Bound on the ratio of the numbers of vertices of a mesh and the next.
    order : float
        The error falls with the number of vertices to this power.
    max_vertices : int
    """

    target_vertices: float | None = None
    error: float | Mapping[str, float] | None = None
    p: float = 2.0
    fields: Sequence[str] | None = None
    limits: Limits = field(default_factory=Limits)
    recovery: str = "green"
    combine: str = "intersection"
    growth: float = 4.0
    order: float = 1.0
    max_vertices: int = 5_000_000

    @property
    def asked_for(self) -> list[str]:
        """The options that decide what the mesh is to be; the others only how it is reached."""
        return [name for name in vars(self) if name not in ("growth", "order", "max_vertices")]

    def __post_init__(self) -> None:
        for name in ("p", "growth", "order"):
            expect_number(name, getattr(self, name))
        check_norm(self.p)
        check_method(self.recovery)
        check_combination(self.combine)
        if self.target_vertices is not None and self.error is not None:
            raise ValueError("give one target: target_vertices or error")
        if self.target_vertices is not None:
            check_target(self.target_vertices)
        if self.target_vertices is not None and self.target_vertices > self.max_vertices:
            raise ValueError(
                f"target_vertices={self.target_vertices!r} is more than the budget of "
                f"{self.max_vertices}"
            )
        if self.error is not None:
            _check_errors(self.error)
        check_fields(self.fields)
        if not self.growth > 1:
            raise ValueError(f"growth={self.growth!r}: must be more than 1")
        if not self.order > 0:
            raise ValueError(f"order={self.order!r}: must be positive")

    def metric(
        self, mesh: Mesh, solved: Solved, earlier: Sequence[Iteration] = ()
    ) -> tuple[Floats, dict[str, float]]:
        """The metric (n, 3) at the vertices for the next mesh, and the errors on this one.

        `earlier` are the iterations before, made for the same options.
        """
        if solved.metric is None:
            return self._recovered(mesh, solved, earlier)
        count = self._count(mesh, solved.errors, earlier)
        errors = dict(solved.errors) or self._watched(mesh, solved)
        metric = solved.metric
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
        return max(value / self._wanted(name) for name, value in errors.items())

    def _recovered(
        self, mesh: Mesh, solved: Solved, earlier: Sequence[Iteration]
    ) -> tuple[Floats, dict[str, float]]:
        points, triangles = mesh.points, mesh.triangles
        curvatures = self._curvatures(mesh, self._varying_fields(mesh, solved))
        errors = dict(solved.errors) or self._estimates(curvatures)
        bent = {name: c for name, c in curvatures.items() if not c.is_flat}
        shares = None
        if self.error is not None and not solved.errors:
            shares = [self._wanted(name) for name in bent]
        self._refuse_unknown(errors, solved)
        count = self._count(mesh, errors, earlier)
        if count is None:
            raise MetricError(
                "neither target_vertices nor error is given, and solve returned no metric: "
                "there is nothing that says how fine the mesh is to be"
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

    def _watched(self, mesh: Mesh, solved: Solved) -> dict[str, float]:
        """Errors of fields that do not steer, as there is a metric: they tell when all is settled.

        The number of vertices, which is asked for, is what it is long before.
        """
        fields = {
            name: values
            for name, values in solved.fields.items()
            if _can_steer(values, mesh) and not is_constant(values)
        }
        try:
            return self._estimates(self._curvatures(mesh, fields))
        except MetricError:  # on a mesh that is too coarse for derivatives there is nothing to tell
            return {}

    def _curvatures(self, mesh: Mesh, fields: Mapping[str, Array]) -> dict[str, Curvature]:
        return {
            name: Curvature.of(mesh.points, mesh.triangles, values, self.recovery)
            for name, values in fields.items()
        }

    def _estimates(self, curvatures: Mapping[str, Curvature]) -> dict[str, float]:
        """The interpolation error of each field; 0 of one that is linear to rounding."""
        return {
            name: 0.0 if c.is_flat else norm(c.interpolation_errors(self.p), self.p)
            for name, c in curvatures.items()
        }

    def _varying_fields(self, mesh: Mesh, solved: Solved) -> dict[str, Array]:
        """The fields that steer and are not the same everywhere, (n, k)."""
        chosen = steering_fields(self.fields, solved.fields, mesh)
        varying = {n: v.reshape(len(v), -1) for n, v in chosen.items() if not is_constant(v)}
        for name, values in varying.items():
            refuse_beyond_range(name, values)
        if not varying:
            raise MetricError(
                f"no field asks for any size: {', '.join(map(repr, chosen))} "
                f"{'are' if len(chosen) > 1 else 'is'} the same everywhere"
            )
        return varying

    def _refuse_unknown(self, errors: Mapping[str, float], solved: Solved) -> None:
        known = dict.fromkeys([*solved.fields, *errors])
        for name in self.error if isinstance(self.error, Mapping) else ():
            if name not in known:
                raise MetricError(
                    f"error asks for something of {name!r}, but solve gave "
                    f"{', '.join(map(repr, known))}"
                )

    def _count(
        self, mesh: Mesh, errors: Mapping[str, float], earlier: Sequence[Iteration]
    ) -> float | None:
        """How many vertices the next mesh is to have; None if only a metric can say.

        What is on the way to the number wanted, or comes of an error that even the coarsest mesh
        has, is at least that of the coarsest mesh.
        """
        n_points = len(mesh.points)
        if self.error is not None:
            counts = [*(it.n_points for it in earlier), n_points]
            excesses = [*(self.excess(it.errors) for it in earlier), self.excess(errors)]
            wanted = next_count(counts, excesses, self.order, self.growth)
            wanted = min(wanted, SHARE_OF_BUDGET * self.max_vertices)
        elif self.target_vertices is not None:
            wanted = self.target_vertices
        else:
            return None
        wanted = min(max(wanted, n_points / self.growth), n_points * self.growth)
        return max(3.0, wanted, fewest_vertices(mesh, self.limits.h_max))

    def _wanted(self, name: str) -> float:
        if not isinstance(self.error, Mapping):
            assert self.error is not None
            return float(self.error)
        if name not in self.error:
            raise MetricError(f"error gives nothing for {name!r}: give a value, or name `fields`")
        return float(self.error[name])


def steering_fields(
    names: Sequence[str] | None, fields: Mapping[str, Array], mesh: Mesh
) -> dict[str, Array]:
    """The fields of these names, or else all that can steer: real ones at the vertices."""
    if names is None:
        chosen = {name: values for name, values in fields.items() if _can_steer(values, mesh)}
        if not chosen:
            raise MetricError(
                "no field can steer: real values at the vertices are needed; there "
                f"{'are' if fields else 'is'} {', '.join(map(repr, fields)) or 'none'}"
            )
        return chosen
    for name in names:
        if name not in fields:
            known = ", ".join(map(repr, fields)) or "none"
            raise MetricError(f"there is no field {name!r} to steer by; solve gave {known}")
        if not _can_steer(fields[name], mesh):
            raise MetricError(
                f"field {name!r} cannot steer: real values at the vertices are needed"
            )
    return {name: fields[name] for name in names}


def refuse_beyond_range(name: str, values: Array) -> None:
    """Refuse a field of which the derivatives are no numbers any more."""
    largest = float(np.abs(values).max())
    if not SCALES[0] <= largest <= SCALES[1]:
        raise MetricError(
            f"field {name!r} has values up to {largest:.3g}: choose a unit in which they are "
            f"between {SCALES[0]:g} and {SCALES[1]:g}"
        )


def fewest_vertices(mesh: Mesh, h_max: float) -> float:
    """About how many vertices a mesh has in which all sizes are the largest allowed."""
    if h_max == np.inf:
        return 3.0
    ends = mesh.points[border_edges(mesh.triangles)]
    border = np.linalg.norm(ends[:, 1] - ends[:, 0], axis=1).sum()
    return vertices_of(mesh.areas.sum() / h_max**2, border / h_max)


def check_reachable(target_vertices: float, mesh: Mesh, h_max: float) -> None:
    """Refuse a number of vertices that is less than the coarsest mesh has."""
    fewest = fewest_vertices(mesh, h_max)
    if target_vertices < fewest:
        raise ValueError(
            f"target_vertices={target_vertices!r}: with all sizes h_max = {h_max:.6g} a mesh has "
            f"about {fewest:.0f}; raise h_max, or ask for more"
        )


def is_constant(values: Array) -> bool:
    """Whether a field, and each of its components, is the same everywhere."""
    return not np.ptp(values.reshape(len(values), -1), axis=0).any()


def check_target(vertices: float) -> None:
    """Refuse a number of vertices of which no mesh can be."""
    expect_number("target_vertices", vertices)
    if not 3 <= vertices < np.inf:
        raise ValueError(f"target_vertices={vertices!r}: a number, at least 3, is needed")


def _check_errors(error: float | Mapping[str, float]) -> None:
    for name, value in error.items() if isinstance(error, Mapping) else [("", error)]:
        label = f"error[{name!r}]" if name else "error"
        expect_number(label, value)
        if not 0 < value < np.inf:
            raise ValueError(f"{label}={value!r}: must be positive, and finite")
    if isinstance(error, Mapping) and not error:
        raise ValueError("error={}: give the error wanted of each field, by name")


def check_fields(names: Sequence[str] | None) -> None:
    """Refuse a name where a list of names is wanted, and none at all."""
    if isinstance(names, str):
        raise TypeError(f"fields={names!r}: give a list of names, [{names!r}]")
    if names is not None and not names:
        raise ValueError("fields=[]: give the names of those that steer the mesh, or leave it out")


def _can_steer(values: Array, mesh: Mesh) -> bool:
    return values.dtype.kind != "c" and space_of(values, mesh) == "P1"


def norm(errors: Floats, p: float) -> float:
    """The L^p norm on the mesh from those on its triangles."""
    largest = float(errors.max())
    if p == np.inf or largest == 0:
        return largest
    return largest * float(np.sum((errors / largest) ** p) ** (1 / p))
