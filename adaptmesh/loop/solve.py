"""The user's `solve`, and how it is called."""

from __future__ import annotations

import inspect
from collections.abc import Callable
from types import MappingProxyType
from typing import Any

from adaptmesh.mesh.mesh import Mesh


class Solve:
    """The user's solve, called in the way it is written for."""

    def __init__(self, solve: Callable[..., Any]) -> None:
        if not callable(solve):
            raise TypeError(f"solve must be a function of a mesh, got {type(solve).__name__}")
        try:
            parameters = inspect.signature(solve).parameters
        except (TypeError, ValueError):  # some callables made in C have no signature
            parameters = MappingProxyType({})
        self.solve = solve
        self.takes_previous = "previous" in parameters
        needed = [
            q.name
            for q in parameters.values()
            if q.default is q.empty and q.kind in (q.POSITIONAL_ONLY, q.POSITIONAL_OR_KEYWORD)
        ]
        if len(needed) > 1 and set(needed[1:]) != {"previous"}:
            raise TypeError(
                f"solve needs {len(needed)} arguments, {', '.join(needed)}: it is called with a "
                "mesh, and with the last fields if it has a parameter `previous`"
            )

    def __call__(self, mesh: Mesh, previous: Any) -> Any:
        return self.solve(mesh, previous=previous) if self.takes_previous else self.solve(mesh)
