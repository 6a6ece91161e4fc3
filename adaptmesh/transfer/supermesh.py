"""The supermesh of two meshes, and the transfer of fields that conserves their integrals.

Its triangles are the pieces that the triangles of both cut each other into. On a piece, the old
field and the new basis functions are polynomials, so their products are integrated exactly.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from functools import cached_property
from typing import Any

import numpy as np

from adaptmesh._core import Overlay as core_Overlay
from adaptmesh.errors import TransferError
from adaptmesh.mesh.mesh import Mesh
from adaptmesh.types import Array, Floats, Ints
from adaptmesh.value import Value

from .flux_limiter import bounds_on_triangles, limit
from .l2_projection import mass_matrix, solve_mass
from .location import (
    OUTSIDE,
    MeshLocator,
    check_no_loose_points,
    check_outside,
    check_triangles,
    make_locator,
)
from .spaces import Field, Space, as_field, as_fields

COVERED_TWICE = 1e-6
"""Parts of a triangle may exceed it by this share, far more than by rounding."""


class Overlay(Value):
    """Which triangles of two meshes overlap, and by how much; transfers fields conservatively.

    Parameters
    ----------
    old_mesh, new_mesh : Mesh
    outside : float, optional
        The centroid of a triangle that overlaps none of the other mesh may be this far from that
        mesh, times its longest edge or that of the nearest triangle there.

    Attributes
    ----------
    pairs : (p, 2) array of int32
        Old and new triangles that overlap, sorted by the new.
    areas : (p,) array of float
        Of their common part.

    Raises
    ------
    TransferError
        The meshes do not overlap, a triangle of one is too far outside of the other, triangles of
        one mesh overlap each other, or a mesh is broken.

    Notes
    -----
    Whether triangles overlap is decided by exact signs. Without curved boundaries or other
    differences of the domains `uncovered` and `lost` are zero to rounding, that of the coordinates
    of slanted boundaries included.
    """

    def __init__(self, old_mesh: Mesh, new_mesh: Mesh, *, outside: float = OUTSIDE) -> None:
        check_outside(outside)
        self.old_mesh, self.new_mesh = old_mesh, new_mesh
        old, new = self._locators
        check_no_loose_points(new_mesh, "new")
        first, olds, self.areas = self._supermesh.pairs()
        news = np.repeat(np.arange(len(new_mesh.triangles), dtype=np.int32), np.diff(first))
        self.pairs: Ints = np.stack([olds, news], axis=1)
        if not len(olds):
            raise TransferError(f"the meshes do not overlap: {old_mesh!r} and {new_mesh!r}")
        self.areas.flags.writeable = self.pairs.flags.writeable = False
        check_triangles(_missing(news, len(new_mesh.triangles)), new, old, outside)
        check_triangles(_missing(olds, len(old_mesh.triangles)), old, new, outside)
        _check_covered_once(self.uncovered, new, old)
        _check_covered_once(self.lost, old, new)

    @cached_property
    def _locators(self) -> tuple[MeshLocator, MeshLocator]:
        return make_locator(self.old_mesh, "old"), make_locator(self.new_mesh, "new")

    @cached_property
    def _supermesh(self) -> core_Overlay:
        old, new = self._locators
        return core_Overlay(old.locator, old.mesh.areas, new.locator, new.mesh.areas)

    @property
    def area(self) -> float:
        """Of what both meshes cover."""
        return float(self.areas.sum())

    @cached_property
    def uncovered(self) -> Floats:
        """Area of each new triangle outside of the old mesh, (m,)."""
        covered = np.bincount(self.pairs[:, 1], self.areas, len(self.new_mesh.triangles))
        return self.new_mesh.areas - covered

    @cached_property
    def lost(self) -> Floats:
        """Area of each old triangle outside of the new mesh, (m,)."""
        covered = np.bincount(self.pairs[:, 0], self.areas, len(self.old_mesh.triangles))
        return self.old_mesh.areas - covered

    def __repr__(self) -> str:
        return f"<Overlay: {len(self.pairs)} pairs of triangles, area {self.area:.6g}>"

    def project(self, values: Any, *, space: Any = None, keep_bounds: bool = False) -> Any:
        """The L² projection of fields onto the same spaces on the new mesh.

        Parameters
        ----------
        values, space, keep_bounds
            As in `transfer`.

        Returns
        -------
        array, or dict of str to array
        """
        if isinstance(values, Mapping):
            fields = as_fields(values, self.old_mesh, space)
        else:
            fields = {"": as_field(values, self.old_mesh, space, "the field")}
        new: dict[str, Array] = {}
        for kind in dict.fromkeys(field.space.name for field in fields.values()):
            of_kind = {name: f for name, f in fields.items() if f.space.name == kind}
            new.update(zip(of_kind, self._project([*of_kind.values()], keep_bounds), strict=True))
        return {name: new[name] for name in fields} if isinstance(values, Mapping) else new[""]

    def _project(self, fields: Sequence[Field], keep_bounds: bool) -> list[Array]:
        """Fields of one space, all their columns at once."""
        old, new = fields[0].space, Space(self.new_mesh, fields[0].space.name)
        columns = np.concatenate([field.columns for field in fields], axis=1)
        bounds = bounds_on_triangles(old, columns) if keep_bounds else None
        moments = self._supermesh.moments(
            columns,
            old.nodes_of_triangles,
            new.nodes_of_triangles,
            new.size,
            OUTSIDE,
            *(bounds or (None, None)),
        )
        matrix = mass_matrix(new)
        projected = solve_mass(matrix, moments, new.degree)
        if bounds is not None:
            low, high = self._supermesh.ranges(*bounds, new.nodes_of_triangles, new.size)
            projected = limit(new, matrix, moments, projected, low, high)
        ends = np.cumsum([field.columns.shape[1] for field in fields])[:-1]
        parts = np.split(projected, ends, axis=1)
        return [field.like(part) for field, part in zip(fields, parts, strict=True)]


def _check_covered_once(beyond: Floats, ours: MeshLocator, theirs: MeshLocator) -> None:
    """Refuse a mesh of which several triangles cover the same part of a triangle of ours."""
    twice = np.flatnonzero(beyond < -COVERED_TWICE * ours.mesh.areas)
    if len(twice):
        x, y = ours.mesh.points[ours.mesh.triangles[twice[0]]].mean(axis=0).tolist()
        raise TransferError(
            f"triangles of the {theirs.which} mesh overlap each other, near ({x:g}, {y:g}): "
            "Mesh.validate() finds them"
        )


def _missing(numbers: Ints, count: int) -> Ints:
    """Which of 0, ..., count - 1 are not among some numbers."""
    return np.flatnonzero(np.bincount(numbers, minlength=count) == 0).astype(np.int32)
