"""How far a mesh is from a unit mesh of a metric, in figures, and where it is worst."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np

from adaptmesh.mesh.checks import check_measurable
from adaptmesh.mesh.control_space import control_space_on
from adaptmesh.mesh.mesh import Mesh
from adaptmesh.mesh.validate.validate import InvalidMeshError
from adaptmesh.types import Floats, Index
from adaptmesh.value import FrozenMapping
from metrics.measure.exact import edge_lengths, metric_areas
from metrics.topology import mesh_edges

from .figures import Figures, Histogram, WorstEdge, WorstTriangle
from .reasons import MET, Reasons

if TYPE_CHECKING:
    from rich.console import RenderableType

__all__ = ["Histogram", "Report", "WorstEdge", "WorstTriangle", "measure"]

# A unit edge is as long as these, both included whatever the rounding: a grid of squares of side
# one is a unit mesh.
SHORTEST, LONGEST = 2**-0.5 * (1 - 1e-9), 2**0.5 * (1 + 1e-9)
LENGTH_RULE = "Gauss quadrature of the metric along the edge"
QUANTILES = (0.01, 0.05, 0.25, 0.5, 0.75, 0.95, 0.99)
WORST = 5  # edges and triangles named
BAD_QUALITY = 0.3  # triangles below it get a reason

# Each bin but the first and last is an eighth of an octave, so that the unit band is eight bins.
LENGTH_BINS = np.concatenate([[0.0], 2.0 ** (np.arange(-12, 13) / 8), [np.inf]])
QUALITY_BINS = np.linspace(0, 1, 21)


@dataclass(frozen=True, eq=False)
class Report(Figures):
    """How unit a mesh is in a metric; print it.

    With l the metric length of an edge, over all edges, and Q the quality of a triangle,
    4 sqrt(3) area_M / (sum of the three l²), which is 1 for the unit equilateral one:

    Attributes
    ----------
    length_rule : str
        How lengths were measured.
    n_points, n_triangles, n_edges : int
    unit_fraction, short_fraction, long_fraction : float
        Share of the edges with l in [1/√2, √2], below, and above.
    efficiency_index : float
        1 - mean (1 - min(l, 1/l))², after Borouchaki et al. 1997.
    efficiency_index_frey_george : float
        exp(mean(min(l, 1/l) - 1)), after Frey and George; MMG reports it too (Dobrzynski, RT-422).
    length_min, length_mean, length_max : float
    length_quantiles : mapping of float to float
    quality_min, quality_p1, quality_mean : float
        The minimum, the first percentile, and the mean of Q.
    complexity : float
        The integral of √det M over the mesh.
    ideal_triangles : float
        (4/√3) complexity: the number of unit equilateral triangles of the same metric area.
    count_ratio : float
        Triangles for each ideal one.
    length_histogram, quality_histogram : Histogram
    worst_edges : tuple of WorstEdge
        Those whose l is farthest from 1, by ratio; if not unit, with the reason, see `explain`.
    worst_triangles : tuple of WorstTriangle
        Those of lowest quality.
    border : str
        How many corners of the border were found, and to what tolerance, if the domain was found
        from a mesh (see `Mesh.to_domain`); else empty.
    """

    # rich takes a tenth of a second to import: only where a report is shown.

    def __str__(self) -> str:
        from .report_text import as_text

        return as_text(self)

    def _repr_html_(self) -> str:
        from .report_text import as_html

        return as_html(self)

    def __rich__(self) -> RenderableType:
        from .report_text import as_renderable

        return as_renderable(self)


def measure(mesh: Mesh, metric: Any) -> Report:
    """Measure how unit a mesh is in a metric.

    Parameters
    ----------
    mesh : Mesh
    metric : number, callable, control space, or array_like
        Anything that `generate` takes; or values at the vertices of this mesh: sizes (n,), packed
        metrics (n, 3) = (m11, m12, m22), or tensors (n, 2, 2).

    Returns
    -------
    Report

    Raises
    ------
    MetricError
        The metric cannot be used: not finite, not positive definite, wrong shape.
    InvalidMeshError
        There are no triangles, they name points that do not exist or are not finite, or their
        area is not positive.

    Notes
    -----
    Lengths and areas are integrals of the metric as it is given, by quadrature; no metric
    interpolated from the mesh takes its place.

    Examples
    --------
    >>> from adaptmesh import Mesh, measure
    >>> report = measure(Mesh([[0, 0], [1, 0], [0.5, 0.75**0.5]], [[0, 1, 2]]), 1.0)
    >>> report.unit_fraction, round(report.quality_min, 12)
    (1.0, 1.0)
    """
    check_measurable(mesh)
    field = control_space_on(mesh, metric)
    edges, sides = mesh_edges(mesh.triangles)
    lengths = edge_lengths(mesh.points, edges, field)
    areas = metric_areas(mesh.points, mesh.triangles, field)
    quality = qualities(lengths[sides], areas)
    complexity = float(areas.sum())
    if complexity <= 0:
        raise InvalidMeshError("the triangles are flat or clockwise: see mesh.validate()")
    short, long = lengths < SHORTEST, lengths > LONGEST
    shortfall = 1 - ratio_to_unit(lengths)
    reasons = Reasons(mesh, field)
    return Report(
        length_rule=LENGTH_RULE,
        n_points=len(mesh.points),
        n_triangles=len(mesh.triangles),
        n_edges=len(edges),
        unit_fraction=float(np.mean(~short & ~long)),
        short_fraction=float(short.mean()),
        long_fraction=float(long.mean()),
        efficiency_index=float(1 - np.mean(shortfall**2)),
        efficiency_index_frey_george=float(np.exp(-shortfall.mean())),
        length_min=float(lengths.min()),
        length_mean=float(lengths.mean()),
        length_max=float(lengths.max()),
        length_quantiles=FrozenMapping(
            dict(zip(QUANTILES, np.quantile(lengths, QUANTILES).tolist(), strict=True))
        ),
        quality_min=float(quality.min()),
        quality_p1=float(np.percentile(quality, 1)),
        quality_mean=float(quality.mean()),
        complexity=complexity,
        ideal_triangles=4 / 3**0.5 * complexity,
        count_ratio=len(mesh.triangles) / (4 / 3**0.5 * complexity),
        length_histogram=Histogram.of(lengths, LENGTH_BINS),
        quality_histogram=Histogram.of(np.maximum(quality, 0), QUALITY_BINS),
        worst_edges=edge_entries(mesh, edges, lengths, _smallest(ratio_to_unit(lengths)), reasons),
        worst_triangles=triangle_entries(mesh, quality, _smallest(quality), reasons),
        border=_border(mesh),
    )


def _border(mesh: Mesh) -> str:
    """How the corners of the domain of a mesh were found."""
    found = None if mesh.domain is None else mesh.domain.corners_found
    return "" if found is None else str(found)


def qualities(lengths: Floats, areas: Floats) -> Floats:
    """Quality of triangles from the metric lengths of their sides, (m, 3), and their metric areas.

    1 for the unit equilateral triangle. Where the metric jumps it may come out above 1, and is cut.
    """
    squares = (lengths**2).sum(axis=1)
    return np.minimum(4 * 3**0.5 * areas / np.where(squares > 0, squares, np.inf), 1.0)


def ratio_to_unit(lengths: Floats) -> Floats:
    """min(l, 1/l): how near to one each length is, by ratio."""
    with np.errstate(divide="ignore"):
        out: Floats = np.minimum(lengths, 1 / lengths)
    return out


def edge_entries(
    mesh: Mesh, edges: Index, lengths: Floats, chosen: Index, reasons: Reasons
) -> tuple[WorstEdge, ...]:
    """Some of the edges, with the reason why they are not unit."""
    entries = []
    for length, (a, b) in zip(lengths[chosen].tolist(), edges[chosen].tolist(), strict=True):
        reason = MET if SHORTEST <= length <= LONGEST else reasons.of_edge(a, b)
        start, end = _places(mesh, a, b)
        entries.append(WorstEdge(length, (a, b), start, end, reason))
    return tuple(entries)


def triangle_entries(
    mesh: Mesh, quality: Floats, chosen: Index, reasons: Reasons, below: float = BAD_QUALITY
) -> tuple[WorstTriangle, ...]:
    """Some of the triangles, with the reason why they are of lesser quality than `below`."""
    entries = []
    for t in chosen.tolist():
        corners = mesh.triangles[t].tolist()
        reason = MET if quality[t] >= below else reasons.of_triangle(corners)
        entries.append(WorstTriangle(float(quality[t]), t, _places(mesh, *corners), reason))
    return tuple(entries)


def _smallest(values: Floats) -> Index:
    """Numbers of the few smallest values, smallest first, equal ones in their order."""
    few = np.argpartition(values, min(WORST, len(values) - 1))[:WORST]
    order = np.lexsort((few, values[few]))
    return np.asarray(few[order])


def _places(mesh: Mesh, *vertices: int) -> Any:
    return tuple((float(x), float(y)) for x, y in mesh.points[list(vertices)])
