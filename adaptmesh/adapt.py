"""A mesh and a metric on it: the domain of the mesh, meshed again."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import replace
from typing import Any

import numpy as np

import metrics
from metrics import ControlSpace

from .domain import Domain
from .frozen import frozen_domain
from .generate import Progress, generate
from .mesh import Mesh


def adapt(
    mesh: Mesh,
    metric: Any,
    *,
    frozen: Iterable[str] = (),
    placement: str = "front",
    max_vertices: int = 5_000_000,
    progress: Progress | None = None,
) -> Mesh:
    """Mesh the domain of a mesh again, for a metric given at its vertices.

    The domain, its names and its regions are kept; no vertex is, but for its corners. The old mesh
    carries the metric (P1, log-Euclidean) while the new one is made.

    Parameters
    ----------
    mesh : Mesh
        If it has no `Mesh.domain` (it was read from a file), `Domain.of_mesh` finds it.
    metric : array_like, number, callable, or control space
        Values at the vertices: sizes (n,), packed metrics (n, 3) = (m11, m12, m22), or tensors
        (n, 2, 2); or anything else that `generate` takes.
    frozen : sequence of str, optional
        Names of boundaries and lines whose edges stay as the mesh has them, to fit a neighbour.
    placement, max_vertices, progress
        As in `generate`.

    Returns
    -------
    Mesh
    """
    domain = mesh.domain or Domain.of_mesh(mesh)
    field = control_space_on(mesh, metric)
    meshed = frozen_domain(domain, mesh, frozen) if frozen else domain
    new = generate(meshed, field, placement=placement, max_vertices=max_vertices, progress=progress)
    return replace(new, domain=domain)


def control_space_on(mesh: Mesh, metric: Any) -> ControlSpace:
    """A control space from values at the vertices of a mesh, or from anything `generate` takes."""
    if callable(metric) or np.ndim(metric) == 0:
        return metrics.as_control_space(metric)
    return metrics.Background(mesh.points, mesh.triangles, metric)
