"""Prediction of the number of vertices of a mesh."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any, NamedTuple

import numpy as np

import metrics
from adaptmesh.domain.domain import Domain
from adaptmesh.domain.measures import inside_is_left_of
from adaptmesh.domain.sides.paths import points_on
from adaptmesh.errors import DomainError
from adaptmesh.types import Bools, Floats, Ints
from metrics import ControlSpace, tensor

MAX_SAGITTA = 0.1
"""A chord longer than 1 in the metric is halved if its curve is farther off it than this length."""

MAX_POINTS = 20_000
"""No chord is halved beyond this number of points: then sizes are far too small for a mesh."""


def predict(domain: Domain, metric: Any) -> int:
    """Predict the number of vertices of a mesh of the domain.

    The number is (2/sqrt 3) C + B/2 + 1, as for a hexagonal lattice of unit edges: C is the
    complexity, the integral of sqrt(det M), and B the metric length of the boundary. Accurate to
    about 5 %, except for meshes of a few triangles, and for features so small that the samples miss
    them. The number is too low where straight edges cannot follow the metric: where a layer bends
    by more than its thickness along an edge.

    Parameters
    ----------
    domain : Domain
    metric : number, callable, or control space
        As for `generate`.

    Returns
    -------
    int

    Raises
    ------
    DomainError
        If `domain` is not a `Domain`.
    MetricError
        If the metric is not valid at a point of the domain.
    """
    check_is_domain(domain)
    return predict_with_samples(domain, metrics.as_control_space(metric)).count


@dataclass(frozen=True)
class Prediction:
    """A number of vertices, and the samples of the metric that it was computed from.

    Attributes
    ----------
    count : int
    points, tensors : (n, 2), (n, 3) arrays
        Samples of the metric, denser where it is larger.
    """

    count: int
    points: Floats
    tensors: Floats


def predict_with_samples(domain: Domain, field: ControlSpace) -> Prediction:
    """Predict as `predict` does, and return the samples as well."""
    samples = _Samples(field)
    polygon = _inscribed(domain, samples)
    complexity = metrics.complexity(polygon.points, polygon.triangles, samples).value
    boundary = metrics.edge_lengths(polygon.points, polygon.border, samples).sum()
    min_count = max(3, int(domain.curved.is_vertex.sum()))
    count = max(min_count, int(2 / np.sqrt(3) * complexity + boundary / 2) + 1)
    return Prediction(count, np.concatenate(samples.points), np.concatenate(samples.tensors))


class _Samples(ControlSpace):
    """A control space that records the points where it is evaluated, and the tensors there."""

    def __init__(self, field: ControlSpace) -> None:
        self._field = field
        self.points: list[Floats] = []
        self.tensors: list[Floats] = []

    def values(self, points: Floats) -> Floats:
        tensors = self._field(points)
        self.points.append(points)
        self.tensors.append(tensors)
        return tensors


def check_is_domain(domain: object) -> None:
    """Raise `DomainError` unless this is a `Domain`."""
    if not isinstance(domain, Domain):
        raise DomainError(f"expected a Domain, got {type(domain).__name__}: see adaptmesh.Domain")


class _Polygon(NamedTuple):
    """Points (n, 2), triangles (m, 3) of signed area, and the boundary edges of a polygon."""

    points: Floats
    triangles: Ints
    border: Ints


def _inscribed(domain: Domain, field: ControlSpace) -> _Polygon:
    r"""Refine the polygon of the domain until it follows its curves as the mesh edges will.

    ::

              m              The chord ab is replaced by am and mb, and the triangle amb is added.
            /   \            Where the curve is on the other side, the triangle is clockwise and
          a-------b          its area counts as negative. This matters where a layer along the
           inside            curve is thinner than the triangle is high.
    """
    curved = domain.curved
    border = domain.pieces[domain.piece_is_boundary]
    segment = domain.piece_segments[domain.piece_is_boundary]
    on_path = curved.segment_paths[segment] >= 0
    if not on_path.any():
        return _Polygon(domain.points, domain.triangles, border)
    segment = segment[on_path]
    path, u = curved.segment_paths[segment], curved.segment_parameters[segment]
    turned = ~inside_is_left_of(domain, segment)[:, None]
    u = np.where(turned, u[:, ::-1], u)
    chord = np.where(turned, domain.segments[segment][:, ::-1], domain.segments[segment])

    points, tensors = domain.points, field(domain.points)
    triangles, edges = [domain.triangles], [border[~on_path]]
    while len(chord):
        middle = len(points) + np.arange(len(chord), dtype=np.int32)
        u_middle = u.mean(axis=1)
        new = points_on(curved.paths, path, u_middle)
        points, tensors = np.concatenate([points, new]), np.concatenate([tensors, field(new)])
        halved = _is_coarse(points, tensors, chord, middle) & (len(points) < MAX_POINTS)
        edges.append(chord[~halved])
        path, chord, middle = path[halved], chord[halved], middle[halved]
        triangles.append(np.column_stack([chord[:, 0], middle, chord[:, 1]]))
        u, u_middle = u[halved], u_middle[halved]
        u = np.column_stack([u[:, 0], u_middle, u_middle, u[:, 1]]).reshape(-1, 2)
        chord = np.column_stack([chord[:, 0], middle, middle, chord[:, 1]]).reshape(-1, 2)
        path = np.repeat(path, 2)
    return _Polygon(points, np.concatenate(triangles), np.concatenate(edges))


def _is_coarse(points: Floats, tensors: Floats, chord: Ints, middle: Ints) -> Bools:
    """Mark chords (k, 2) longer than 1 and farther from the curve than `MAX_SAGITTA`."""
    a, b = chord.T
    height = points[middle] - 0.5 * (points[a] + points[b])
    off = np.max([tensor.lengths(tensors[v], tensors[v], height) for v in (a, b, middle)], axis=0)
    length = tensor.lengths(tensors[a], tensors[b], points[b] - points[a])
    return (off > MAX_SAGITTA) & (length > 1)
