"""Tensors at the vertices of a mesh, interpolated on its triangles."""

from __future__ import annotations

from typing import Any, Literal

import numpy as np
from numpy.typing import ArrayLike

import metrics._core as _core

from . import tensor
from .checks import as_numbers, as_points, as_triangles
from .errors import MetricError
from .gradation import graded
from .types import Floats, Ints

# A point this far outside, relative to the diagonal of the mesh, is on its border by rounding.
_BORDER = 1e-9


class MeshInterpolant:
    """Tensors at the vertices of a mesh, whose logarithms are linear on each triangle.

    `Background` is the control space of one; parameters and errors are described there.
    """

    def __init__(
        self,
        points: ArrayLike,
        triangles: ArrayLike,
        values: ArrayLike,
        outside: Literal["clamp", "error"] = "clamp",
    ) -> None:
        if outside not in ("clamp", "error"):
            raise MetricError(f'outside must be "clamp" or "error", not {outside!r}')
        self.outside = outside
        self.points = as_points(points).copy()
        self.triangles = as_triangles(triangles, len(self.points)).copy()
        _check_areas(self.points, self.triangles)
        tensors = tensor.pack(values, points=self.points, what="the value")
        self.logs = _core.log(tensors)
        for array in (self.points, self.triangles, self.logs):
            array.flags.writeable = False
        self._build()

    def _build(self) -> None:
        try:
            self._search = _core.Background(self.points, self.logs, self.triangles)
        except ValueError as error:
            raise MetricError(f"the triangles are not a mesh: {error}") from error
        self._border = _BORDER * self._search.diagonal

    def __getstate__(self) -> dict[str, Any]:
        return {name: value for name, value in vars(self).items() if name != "_search"}

    def __setstate__(self, state: dict[str, Any]) -> None:
        vars(self).update(state)
        self._build()

    def allow_beyond(self, distance: float) -> None:
        """Take points no farther outside than this for points on the border, with any `outside`."""
        self._border = max(self._border, distance)

    def evaluate(self, points: ArrayLike, hints: ArrayLike | None = None) -> tuple[Floats, Ints]:
        """The metric at points, and the triangle that each was found in.

        Parameters
        ----------
        points : (k, 2) array_like of float
        hints : (k,) array_like of int, optional
            For each point, a triangle that is probably near; -1 where none is known. Hints change
            the time taken and nothing else, except which of two triangles a point on their common
            edge is found in.

        Returns
        -------
        tensors : (k, 3) array of float
            Packed.
        triangles : (k,) array of int32
            For a point outside, the triangle at the nearest point of the border.

        Raises
        ------
        MetricError
            With ``outside="error"``, naming the first point outside.
        """
        where = as_points(points)
        near = None if hints is None else _as_hints(hints, len(where))
        tensors, triangles, distances = self._search.evaluate(where, near)
        if self.outside == "error" and (distances > self._border).any():
            i = int(np.argmax(distances > self._border))
            x, y = where[i].tolist()
            raise MetricError(
                f"point {i} ({x!r}, {y!r}) is outside of the background mesh by "
                f'{distances[i]:.6g}; outside="clamp" takes the nearest value'
            )
        return tensors, triangles

    @property
    def tensors(self) -> Floats:
        """Packed tensors (n, 3) at the vertices, a new array."""
        return tensor.exp(self.logs)

    def graded_at_vertices(self, beta: float, law: str) -> Floats:
        """The tensors, with sizes that grow no faster than `beta`: see `metrics.graded`."""
        return graded(self.tensors, self.points, self.triangles, beta, law)


def mesh_arrays(mesh: Any) -> tuple[Floats, ArrayLike]:
    """The points (n, 2) and the triangles of a mesh object, as `Background.on` takes it."""
    points = getattr(mesh, "points", None)
    if points is None:
        raise MetricError(
            f"expected a domain or a mesh, with points and triangles, got {type(mesh).__name__}"
        )
    points = np.asarray(points)
    if points.ndim == 2 and points.shape[1] == 3:
        points = points[:, :2]
    triangles = getattr(mesh, "triangles", None)
    if triangles is None:
        triangles = getattr(mesh, "cells_dict", {}).get("triangle")
    if triangles is None:
        raise MetricError(f"{type(mesh).__name__} has neither triangles nor triangle cells")
    return points, triangles


def _as_hints(hints: ArrayLike, count: int) -> Ints:
    raw = as_numbers(hints, "hints")
    if raw.shape != (count,) or (raw.size and raw.dtype.kind not in "iu"):
        raise MetricError(
            f"hints must be {count} integers, one for each point, not {raw.dtype} {raw.shape}"
        )
    return np.ascontiguousarray(raw, np.int32)


def _check_areas(points: Floats, triangles: Ints) -> None:
    if len(triangles) == 0:
        raise MetricError("a background mesh needs at least one triangle")
    i = _core.check_triangles(points, triangles)
    if i < 0:
        return
    (x0, y0), (x1, y1), (x2, y2) = points[triangles[i]].tolist()
    flat = (x1 - x0) * (y2 - y0) == (y1 - y0) * (x2 - x0)
    flaw = "has no area" if flat else "is clockwise; reverse it: triangles[i] = triangles[i, ::-1]"
    corners = f"({x0:.6g}, {y0:.6g}), ({x1:.6g}, {y1:.6g}), ({x2:.6g}, {y2:.6g})"
    raise MetricError(f"triangle {i} with the corners {corners} {flaw}")
