"""Meshes of domains for code below the mesher: metrics that are graded all over a domain need one.

`generate` is above this floor, so it registers itself here when it is imported, and `adaptmesh`
imports it.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Any, Protocol

from adaptmesh.types import Floats, Ints

from .data import DomainData


class TriangleMesh(Protocol):
    """Points (n, 2) and triangles (m, 3)."""

    @property
    def points(self) -> Floats: ...

    @property
    def triangles(self) -> Ints: ...


Mesher = Callable[[Any, Any], TriangleMesh]
"""From a domain and a metric to a mesh."""

_registered: list[Mesher] = []


def register_mesher(mesher: Mesher) -> Mesher:
    """Make the meshes of `background_mesh` with this function from now on."""
    _registered[:] = [mesher]
    return mesher


def background_mesh(domain: DomainData, metric: Any) -> TriangleMesh:
    """A mesh of a domain for a metric, by the function that is registered."""
    return _registered[0](domain, metric)
