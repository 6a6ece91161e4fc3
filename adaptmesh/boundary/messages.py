"""What is wrong where the boundary of a valid domain is cut."""

from __future__ import annotations

from adaptmesh.domain.domain import Domain
from adaptmesh.domain.messages import segment_text

from .discretise import Outline


def too_near_text(
    domain: Domain, outline: Outline, kind: str, i: int, j: int, x: float, y: float
) -> str:
    """What of a valid domain cannot be told apart where its curves are cut, and what to do."""
    if kind == "duplicate_points":
        sides = [int((outline.segments == point).any(axis=1).argmax()) for point in (i, j)]
    else:
        sides = [i, j]
    a, b = (segment_text(domain, int(outline.segment_owners[k])) for k in sides)
    return (
        f"{a} and {b} come so near each other at ({x:.17g}, {y:.17g}) that vertices on them "
        "cannot be told apart (coordinates are rounded): move them apart, make them one, or move "
        "the origin near them"
    )
