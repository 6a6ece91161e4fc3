"""Plane arrays as formats of three-dimensional space want them, and back."""

from __future__ import annotations

import math

import numpy as np

from adaptmesh.mesh.incoming import Content
from adaptmesh.types import Array

_MOST_DIMENSIONS = 8


def spatial(values: Array) -> Array:
    """Vectors (n, 2) with a third component of zero; anything else as it is."""
    if values.ndim != 2 or values.shape[1] != 2:
        return values
    return np.column_stack([values, np.zeros(len(values), values.dtype)])


def shapes(content: Content) -> dict[str, list[int]]:
    """Shapes of the values of fields that are neither scalars nor vectors, by name."""
    fields = {**content.point_fields, **content.triangle_fields}
    return {
        name: list(values.shape[1:])
        for name, values in fields.items()
        if values.ndim > 2 or (values.ndim == 2 and values.shape[1] > 3)
    }


def flat(values: Array) -> Array:
    """Values with more than one axis as columns, (n, c)."""
    return values if values.ndim < 3 else values.reshape(len(values), -1)


def shaped(values: Array, shape: object) -> Array:
    """The inverse of `flat`: columns beyond those of the shape are left out."""
    if not isinstance(shape, (list, tuple)) or len(shape) > _MOST_DIMENSIONS:
        return values
    if not all(type(k) is int and k > 0 for k in shape):
        return values
    columns = values.reshape(len(values), math.prod(values.shape[1:]))
    size = math.prod(shape)
    return columns[:, :size].reshape(len(values), *shape) if size <= columns.shape[1] else values


def plane_fields(content: Content) -> list[str]:
    """Names of the fields with two columns, which `spatial` changes."""
    fields = {**content.point_fields, **content.triangle_fields}
    return [name for name, values in fields.items() if values.ndim == 2 and values.shape[1] == 2]


def spatial_tensor(metric: Array) -> Array:
    """Packed metrics (n, 3) as tensors by row, (n, 9): m11 m12 0  m12 m22 0  0 0 0."""
    out = np.zeros((len(metric), 9))
    out[:, [0, 1, 4]] = metric
    out[:, 3] = metric[:, 1]
    return out


def take_metric(fields: dict[str, Array]) -> Array | None:
    """Take ``metric`` out of the fields, packed, if it is what `spatial_tensor` gives."""
    tensor = fields.get("metric")
    if tensor is None or tensor.ndim != 2 or tensor.shape[1] != 9:
        return None
    if (tensor[:, 1] != tensor[:, 3]).any() or tensor[:, [2, 5, 6, 7]].any():
        return None
    return fields.pop("metric")[:, [0, 1, 4]].astype(np.float64)
