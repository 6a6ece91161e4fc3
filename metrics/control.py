"""Control spaces: the metric at every point, and what can be done with one.

A control space is called with points ``(n, 2)`` and returns packed tensors ``(n, 3)``. Whatever it
computes is checked on return, so that nothing downstream meets a metric that is not one.
"""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections.abc import Callable
from numbers import Real
from typing import Any, TypeAlias

import numpy as np
from numpy.typing import ArrayLike

from . import tensor
from .checks import as_points
from .errors import AdaptmeshError, MetricError
from .gradation import check_growth
from .interpolant import MeshInterpolant, mesh_arrays
from .types import Floats

__all__ = ["ControlSpace", "Metric", "Uniform", "as_control_space"]

# Meshes of a domain made to grade a field on, each for what was graded on the one before: the
# first is coarse beside a jump.
GRADED_MESHES = 2


class ControlSpace(ABC):
    """The metric at every point. Derive from it and write `values`.

    Called with points ``(n, 2)`` it returns packed tensors ``(n, 3)``, or raises `MetricError`
    naming the first point where the value is not a metric.

    Examples
    --------
    >>> from metrics import as_control_space, tensor
    >>> field = as_control_space(lambda x: 0.01 + 0.1 * x[:, 0]) & 0.05
    >>> tensor.sizes(field([[0.0, 0.0], [1.0, 0.0]]))
    array([[0.01, 0.01],
           [0.05, 0.05]])
    """

    __array_ufunc__ = None  # np.float64(0.1) & field is ours to answer, not numpy's

    @abstractmethod
    def values(self, points: Floats) -> ArrayLike:
        """Sizes (n,), packed tensors (n, 3) or matrices (n, 2, 2) at points (n, 2)."""

    def __call__(self, points: ArrayLike) -> Floats:
        """Packed tensors (n, 3) at points (n, 2), checked."""
        where = as_points(points)
        return tensor.pack(self.values(where), points=where, what=f"the value of {self!r}")

    def __and__(self, other: Metric) -> ControlSpace:
        """The intersection: nowhere a longer step than either allows."""
        return Intersection(self, as_control_space(other))

    def __rand__(self, other: Metric) -> ControlSpace:
        return Intersection(as_control_space(other), self)

    def __or__(self, other: Metric) -> ControlSpace:
        """The union: everywhere as long a step as either allows."""
        return Union(self, as_control_space(other))

    def __ror__(self, other: Metric) -> ControlSpace:
        return Union(as_control_space(other), self)

    def mean(self, other: Metric, weight: float = 0.5) -> ControlSpace:
        """The log-Euclidean mean with another field, which counts for `weight` from 0 to 1."""
        return Mean(self, as_control_space(other), weight)

    def geometric_mean(self, other: Metric) -> ControlSpace:
        """The geometric mean A#B with another field, see `metrics.tensor.geometric_mean`."""
        return GeometricMean(self, as_control_space(other))

    def scaled(self, factor: float) -> ControlSpace:
        """The same field with every size multiplied by `factor`: 2 gives a mesh twice as coarse."""
        return Scaled(self, factor)

    def limited(
        self, h_min: float = 0.0, h_max: float = np.inf, max_anisotropy: float = np.inf
    ) -> ControlSpace:
        """The same field with every size brought into [h_min, h_max]; the axes stay.

        Then the larger of the two sizes is lowered to `max_anisotropy` times the smaller.
        """
        return Limited(self, h_min, h_max, max_anisotropy)

    def graded(self, domain: Any, beta: float = 1.5, law: str = "mixed") -> ControlSpace:
        """The same field made finer where sizes would otherwise grow too fast within a domain.

        Beside a jump from 0.01 to 1, sizes grow from 0.01 by at most `beta` from one unit edge to
        the next. They spread within the domain, around its holes and not across them.

        Parameters
        ----------
        domain : adaptmesh.Domain, adaptmesh.Mesh, or a mesh object
            Of a domain, or of a mesh of adaptmesh, two meshes are made: one that has the sizes of
            this field, and one of the field graded on that. Any other object with `points` and
            `triangles` is taken as it is: the field is graded at its vertices, which must be close
            enough for it.
        beta, law
            As for `metrics.graded`.

        Returns
        -------
        ControlSpace
            Nowhere coarser than this field, in no direction.

        Raises
        ------
        MetricError
            For a `beta` not above 1, another law, or something else than a domain or mesh.
        """
        check_growth(beta, law)
        if not hasattr(domain, "background_mesh"):
            return Graded(self, domain, beta, law)
        graded: ControlSpace = self
        for _ in range(GRADED_MESHES):
            graded = Graded(self, domain.background_mesh(graded), beta, law)
        return graded


Metric: TypeAlias = "float | Callable[[Floats], ArrayLike] | ControlSpace"


def as_control_space(metric: Metric) -> ControlSpace:
    """The control space that a user means.

    Parameters
    ----------
    metric : float, callable, or ControlSpace
        A size h for everywhere; a function of points (n, 2) that returns sizes (n,), packed
        tensors (n, 3) or matrices (n, 2, 2); or a control space, such as a `Background`, which is
        returned as it is.

    Raises
    ------
    MetricError
        For anything else.
    """
    if isinstance(metric, ControlSpace):
        return metric
    if isinstance(metric, Real) and not isinstance(metric, (bool, np.bool_)):
        return Uniform(float(metric))
    if callable(metric):
        return Function(metric)
    remedy = ""
    if isinstance(metric, str):
        remedy = "; a formula in x and y is metrics.Expression(text)"
    elif isinstance(metric, (np.ndarray, list, tuple)):
        remedy = "; values at the vertices of a mesh are metrics.Background.on(mesh, values)"
    raise MetricError(
        f"a metric is a size, a function of points (n, 2), or a control space, "
        f"not {type(metric).__name__}{remedy}"
    )


class Uniform(ControlSpace):
    """The size h everywhere."""

    def __init__(self, h: float) -> None:
        tensor.pack(np.array([h], np.float64), what="the uniform size")
        self.h = float(h)

    def values(self, points: Floats) -> ArrayLike:
        return np.full(len(points), self.h)

    def __repr__(self) -> str:
        return f"Uniform({self.h!r})"


class Function(ControlSpace):
    """A user's function of points (n, 2)."""

    def __init__(self, function: Callable[[Floats], ArrayLike]) -> None:
        self.function = function

    def values(self, points: Floats) -> ArrayLike:
        try:
            return self.function(points.copy())  # it may write on its argument, but not on ours
        except AdaptmeshError:
            raise
        except Exception as error:
            raise MetricError(
                f"{self!r} raised {type(error).__name__} when called with {len(points)} points, "
                f"an array of shape {points.shape}: {error}"
            ) from error

    def __repr__(self) -> str:
        name = getattr(self.function, "__qualname__", None) or repr(self.function)
        code = getattr(self.function, "__code__", None)
        return f"{name} ({code.co_filename}:{code.co_firstlineno})" if code else name


class Pair(ControlSpace):
    """Two fields made one, point by point; `sign` stands between them when it is printed."""

    sign: str

    def __init__(self, first: ControlSpace, second: ControlSpace) -> None:
        self.first, self.second = first, second

    def __repr__(self) -> str:
        return f"{self.first!r} {self.sign} {self.second!r}"


class Intersection(Pair):
    """Nowhere a longer step than either of two fields allows."""

    sign = "&"

    def values(self, points: Floats) -> ArrayLike:
        return tensor.intersect(self.first(points), self.second(points))


class Union(Pair):
    """Everywhere as long a step as either of two fields allows."""

    sign = "|"

    def values(self, points: Floats) -> ArrayLike:
        return tensor.union(self.first(points), self.second(points))


class GeometricMean(Pair):
    """Half way from one field to another, on the geodesic of the metrics."""

    sign = "#"

    def values(self, points: Floats) -> ArrayLike:
        return tensor.geometric_mean(self.first(points), self.second(points))


class Mean(Pair):
    """The log-Euclidean mean of two fields."""

    sign = "~"

    def __init__(self, first: ControlSpace, second: ControlSpace, weight: float) -> None:
        super().__init__(first, second)
        if not 0 <= weight <= 1:
            raise MetricError(f"the weight of the second field is between 0 and 1, not {weight!r}")
        self.weight = float(weight)

    def values(self, points: Floats) -> ArrayLike:
        first, second = tensor.log(self.first(points)), tensor.log(self.second(points))
        return tensor.exp((1 - self.weight) * first + self.weight * second)


class Scaled(ControlSpace):
    """Every size of a field multiplied by a factor."""

    def __init__(self, field: ControlSpace, factor: float) -> None:
        if not 0 < factor < np.inf:
            raise MetricError(f"sizes are scaled by a positive factor, not {factor!r}")
        self.field, self.factor = field, float(factor)

    def values(self, points: Floats) -> ArrayLike:
        return self.field(points) / self.factor**2

    def __repr__(self) -> str:
        return f"({self.field!r}).scaled({self.factor!r})"


class Limited(ControlSpace):
    """Every size of a field brought into an interval, and their ratio below a bound."""

    def __init__(
        self, field: ControlSpace, h_min: float, h_max: float, max_anisotropy: float
    ) -> None:
        tensor.limit(np.empty((0, 3)), h_min, h_max, max_anisotropy)
        self.field = field
        self.h_min, self.h_max = float(h_min), float(h_max)
        self.max_anisotropy = float(max_anisotropy)

    def values(self, points: Floats) -> ArrayLike:
        return tensor.limit(self.field(points), self.h_min, self.h_max, self.max_anisotropy)

    def __repr__(self) -> str:
        limits = [repr(self.h_min), repr(self.h_max)]
        if self.max_anisotropy < np.inf:
            limits.append(repr(self.max_anisotropy))
        return f"({self.field!r}).limited({', '.join(limits)})"


class Graded(ControlSpace):
    """A field, intersected with what it is at the vertices of a mesh when it is graded there."""

    def __init__(self, field: ControlSpace, mesh: Any, beta: float, law: str) -> None:
        points, triangles = mesh_arrays(mesh)
        given = MeshInterpolant(points, triangles, field(points))
        tensors = given.graded_at_vertices(beta, law)
        self.field, self.beta, self.law = field, beta, law
        self.bound = MeshInterpolant(given.points, given.triangles, tensors)

    def values(self, points: Floats) -> ArrayLike:
        return tensor.intersect(self.field(points), self.bound.evaluate(points)[0])

    def __repr__(self) -> str:
        return f"({self.field!r}).graded(beta={self.beta!r}, law={self.law!r})"
