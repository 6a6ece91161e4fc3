"""A metric that is known at the vertices of a mesh, everywhere."""

from __future__ import annotations

from typing import Any

import numpy as np

import metrics
from metrics import ControlSpace

from .data import MeshData


def control_space_on(mesh: MeshData, metric: Any) -> ControlSpace:
    """A control space from values at the vertices of a mesh, or from anything `generate` takes."""
    if callable(metric) or np.ndim(metric) == 0:
        return metrics.as_control_space(metric)
    return metrics.Background(mesh.points, mesh.triangles, metric)
