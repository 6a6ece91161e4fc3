"""Control spaces whose sizes grow slowly everywhere in a domain: graded on a mesh of it."""

from __future__ import annotations

from typing import Any

import numpy as np

from .background import Background
from .control import ControlSpace
from .errors import MetricError
from .gradation import check_growth

__all__ = ["graded_on"]

ROUNDS = 2
"""Meshes made, each for what was graded on the one before: the first is coarse beside a jump."""


def graded_on(field: ControlSpace, domain: Any, beta: float, law: str) -> ControlSpace:
    """A field, intersected with what it is where it is graded: see `ControlSpace.graded`."""
    check_growth(beta, law)
    if not hasattr(domain, "background_mesh"):
        return _graded_at_vertices(field, domain, beta, law)
    graded = field
    for _ in range(ROUNDS):
        graded = _graded_at_vertices(field, domain.background_mesh(graded), beta, law)
    return graded


def _graded_at_vertices(field: ControlSpace, mesh: Any, beta: float, law: str) -> ControlSpace:
    points = getattr(mesh, "points", None)
    if points is None:
        raise MetricError(
            f"expected a domain or a mesh, with points and triangles, got {type(mesh).__name__}"
        )
    values = field(np.asarray(points)[:, :2])
    return field & Background.on(mesh, values).graded(beta=beta, law=law)


ControlSpace.grade = graded_on
