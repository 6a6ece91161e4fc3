"""What of a mesh could not be made unit, where, and why."""

from __future__ import annotations

from collections import Counter
from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np

from adaptmesh.mesh.checks import check_measurable
from adaptmesh.mesh.control_space import control_space_on
from adaptmesh.mesh.mesh import Mesh
from adaptmesh.value import FrozenMapping, Value
from metrics.measure.exact import edge_lengths, metric_areas
from metrics.topology import mesh_edges

from .reasons import Cause, Reasons
from .report import (
    BAD_QUALITY,
    LONGEST,
    SHORTEST,
    WorstEdge,
    WorstTriangle,
    edge_entries,
    qualities,
    ratio_to_unit,
    triangle_entries,
)

__all__ = ["Explanation", "explain"]


@dataclass(frozen=True, eq=False)
class Explanation(Value):
    """The edges that are not unit and the bad triangles of a mesh, each with a reason; print it.

    Attributes
    ----------
    edges : tuple of WorstEdge
        With `length`, `vertices`, `start`, `end` and `reason`, the farthest from unit first.
    triangles : tuple of WorstTriangle
        With `quality`, `triangle`, `corners` and `reason`, the worst first.
    n_edges, n_triangles : int
        How many there are in all; of more than the limit only the worst were looked into.
    """

    edges: tuple[WorstEdge, ...]
    triangles: tuple[WorstTriangle, ...]
    n_edges: int
    n_triangles: int

    @property
    def edge_causes(self) -> Mapping[Cause, int]:
        """How many of `edges` have each cause, the most frequent first."""
        return _count_causes(self.edges)

    @property
    def triangle_causes(self) -> Mapping[Cause, int]:
        """How many of `triangles` have each cause, the most frequent first."""
        return _count_causes(self.triangles)

    def __str__(self) -> str:
        lines = [f"{self.n_edges} edges are not unit"]
        for cause, count in self.edge_causes.items():
            worst = next(e for e in self.edges if e.reason.cause is cause)
            lines.append(f"{count:8d}  {cause.value}; the worst, of length {worst.length:.3g}:")
            lines.append(f"{'':10s}{worst.reason.detail}")
        lines.append(f"{self.n_triangles} triangles are bad")
        for cause, count in self.triangle_causes.items():
            bad = next(t for t in self.triangles if t.reason.cause is cause)
            lines.append(f"{count:8d}  {cause.value}; the worst, of quality {bad.quality:.3g}:")
            lines.append(f"{'':10s}{bad.reason.detail}")
        return "\n".join(lines)


def explain(
    mesh: Mesh, metric: Any, *, min_quality: float = BAD_QUALITY, max_items: int = 1000
) -> Explanation:
    """Say why edges are not unit and triangles are bad.

    The first of these that applies is the cause. Each is measured; none is guessed.

    =====================  =======================================================================
    short constraint       a piece of a segment of the domain, itself or a side of the triangle, is
                           shorter than 1/√2
    sharp angle            (triangles) two constraints meet at less than 29° in the metric, the
                           smallest angle of a triangle with unit sides
    crowded constraints    all corners are on constraints: nothing can be moved (of triangles asked
                           last)
    metric jump            along an edge sizes change by a factor of more than 1.5 over a distance
                           of an edge / 100 000
    unresolved metric      along an edge sizes change, or axes turn, by a factor of more than 2
    no reason found        what is left: the mesher might have done better
    =====================  =======================================================================

    Parameters
    ----------
    mesh : Mesh
    metric : number, callable, control space, or array_like
        As for `measure`.
    min_quality : float
        Triangles of lower quality are bad.
    max_items : int
        The number of edges, and of triangles, that are looked into, the worst first.

    Returns
    -------
    Explanation

    Raises
    ------
    MetricError, InvalidMeshError
        As `measure` does.

    Examples
    --------
    >>> import adaptmesh as am
    >>> strip = am.Domain.rectangle(0, 0, 10, 0.5)
    >>> found = am.explain(am.generate(strip, 1.0), 1.0)
    >>> sorted(cause.value for cause in found.edge_causes)
    ['crowded constraints', 'short constraint']
    """
    check_measurable(mesh)
    if max_items < 0:
        raise ValueError(f"max_items={max_items}: expected 0 or more")
    field = control_space_on(mesh, metric)
    edges, sides = mesh_edges(mesh.triangles)
    lengths = edge_lengths(mesh.points, edges, field)
    quality = qualities(lengths[sides], metric_areas(mesh.points, mesh.triangles, field))
    off = np.flatnonzero((lengths < SHORTEST) | (lengths > LONGEST))
    off = off[np.argsort(ratio_to_unit(lengths[off]), kind="stable")]
    bad = np.flatnonzero(quality < min_quality)
    bad = bad[np.argsort(quality[bad], kind="stable")]
    reasons = Reasons(mesh, field)
    return Explanation(
        edges=edge_entries(mesh, edges, lengths, off[:max_items], reasons),
        triangles=triangle_entries(mesh, quality, bad[:max_items], reasons, min_quality),
        n_edges=len(off),
        n_triangles=len(bad),
    )


def _count_causes(items: tuple[WorstEdge, ...] | tuple[WorstTriangle, ...]) -> Mapping[Cause, int]:
    return FrozenMapping(dict(Counter(item.reason.cause for item in items).most_common()))
