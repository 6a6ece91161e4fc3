"""The control space carried by a mesh."""

from __future__ import annotations

from numbers import Real
from typing import Any, Literal

from numpy.typing import ArrayLike

from .control import ControlSpace
from .interpolant import MeshInterpolant, mesh_arrays
from .types import Floats

__all__ = ["Background"]


class Background(MeshInterpolant, ControlSpace):
    """A metric given at the vertices of a mesh, interpolated on its triangles.

    The logarithm of the tensor is linear on each triangle, which keeps it positive definite and
    sizes geometric: half way between h = 0.01 and h = 1 is 0.1.

    Parameters
    ----------
    points : (n, 2) array_like of float
        The vertices.
    triangles : (m, 3) array_like of int
        Counter-clockwise vertex numbers, from 0; a mesh that may have holes and several parts.
    values : (n,), (n, 3) or (n, 2, 2) array_like
        Sizes, packed tensors or matrices at the vertices.
    outside : {"clamp", "error"}, optional
        For a point outside of the mesh, by more than 1e-9 of its diagonal: the value at the nearest
        point of its border, or a `MetricError` that names the point.

    Raises
    ------
    MetricError
        If the arrays do not fit together, a value is not a metric, or the triangles are not a
        mesh: out of range, not counter-clockwise, without area, or on top of each other.
    """

    @classmethod
    def on(
        cls, mesh: Any, values: ArrayLike, outside: Literal["clamp", "error"] = "clamp"
    ) -> Background:
        """The background on a mesh object.

        Parameters
        ----------
        mesh : object
            Has `points` (n, 2), or (n, 3) of which z is ignored, and either `triangles` (m, 3) or,
            as in meshio, `cells_dict["triangle"]`.
        values, outside
            As for `Background`.
        """
        return cls(*mesh_arrays(mesh), values, outside)

    def values(self, points: Floats) -> ArrayLike:
        return self.evaluate(points)[0]

    def graded(self, domain: Any = None, beta: float = 1.5, law: str = "mixed") -> ControlSpace:
        """The same field with sizes that grow no faster than `beta`: see `metrics.graded`.

        Without a domain, at the vertices of this background, which is the mesh of the result; with
        one, everywhere in it, see `ControlSpace.graded`. ``graded(1.3)`` is ``graded(beta=1.3)``.
        """
        if isinstance(domain, Real):
            domain, beta = None, float(domain)
        if domain is not None:
            return super().graded(domain, beta, law)
        limited = self.graded_at_vertices(beta, law)
        return Background(self.points, self.triangles, limited, self.outside)

    def __repr__(self) -> str:
        return f"<Background: {len(self.points)} points, {len(self.triangles)} triangles>"
