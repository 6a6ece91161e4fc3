"""How many vertices a mesh will have, before it is made."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

import metrics
from adaptmesh.domain.domain import Domain
from adaptmesh.domain.measures import inside_is_left_of
from adaptmesh.domain.paths import points_on
from adaptmesh.errors import DomainError
from adaptmesh.types import Floats, Ints
from metrics import ControlSpace, tensor

# A chord is followed more closely while its curve is off it by more than this, in metric length,
# and it is longer than an edge would be.
OFF_CHORD = 0.1

# With so many points no chord is halved any more: then sizes are far below the rounding of
# coordinates, or the mesh is larger than any.
MOST_POINTS = 20_000


def predict(domain: Domain, metric: Any) -> int:
    """The number of vertices that a mesh of the domain will have, before it is made.

    (2/sqrt 3) C + B/2 + 1, what a hexagonal lattice of unit edges would have: C is the complexity,
    the integral of sqrt(det M), and B the metric length of the boundary. To about 5 %, except for
    meshes of a few triangles; features far below their surroundings may hide from it. It is too low
    where straight edges cannot follow the metric: where a layer bends by more than its thickness
    along an edge.
    """
    check_is_domain(domain)
    return predicted(domain, metrics.as_control_space(metric)).count


@dataclass(frozen=True)
class Prediction:
    """A number of vertices, and where the metric was asked for it.

    Attributes
    ----------
    count : int
    points, tensors : (n, 2), (n, 3) arrays
        Samples of the metric: close to each other where it is large.
    """

    count: int
    points: Floats
    tensors: Floats


def predicted(domain: Domain, field: ControlSpace) -> Prediction:
    """Predict as `predict` does, and keep the samples."""
    samples = _Samples(field)
    polygon = _inscribed(domain, samples)
    complexity = metrics.complexity(polygon.points, polygon.triangles, samples).value
    boundary = metrics.edge_lengths(polygon.points, polygon.border, samples).sum()
    least = max(3, int(domain.curved.is_vertex.sum()))
    count = max(least, int(2 / np.sqrt(3) * complexity + boundary / 2) + 1)
    return Prediction(count, np.concatenate(samples.points), np.concatenate(samples.tensors))


class _Samples(ControlSpace):
    """A control space that writes down where it is asked, and what it answers."""

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
    """Refuse what is no domain."""
    if not isinstance(domain, Domain):
        raise DomainError(f"a Domain is wanted, not {type(domain).__name__}: see adaptmesh.Domain")


class _Polygon(NamedTuple):
    """Points (n, 2), triangles (m, 3) whose areas add up, with signs, and edges of the border."""

    points: Floats
    triangles: Ints
    border: Ints


def _inscribed(domain: Domain, field: ControlSpace) -> _Polygon:
    r"""The domain, its curves followed as closely as the edges of the mesh will.

    ::

              m              The chord ab of the domain is replaced by am and mb, and the triangle
            /   \            amb is added; it is taken away, being clockwise, where the curve is on
          a-------b          the other side. A layer along the curve may be thinner than this
           inside            triangle is high.
    """
    curved = domain.curved
    border = domain.pieces[domain.piece_is_boundary]
    segment = domain.piece_segments[domain.piece_is_boundary]
    on_run = curved.segment_paths[segment] >= 0
    if not on_run.any():
        return _Polygon(domain.points, domain.triangles, border)
    segment = segment[on_run]
    run, u = curved.segment_paths[segment], curved.segment_parameters[segment]
    turned = ~inside_is_left_of(domain, segment)[:, None]
    u = np.where(turned, u[:, ::-1], u)
    chord = np.where(turned, domain.segments[segment][:, ::-1], domain.segments[segment])

    points, tensors = domain.points, field(domain.points)
    triangles, edges = [domain.triangles], [border[~on_run]]
    while len(chord):
        middle = len(points) + np.arange(len(chord), dtype=np.int32)
        u_middle = u.mean(axis=1)
        new = points_on(curved.paths, run, u_middle)
        points, tensors = np.concatenate([points, new]), np.concatenate([tensors, field(new)])
        halved = _is_coarse(points, tensors, chord, middle) & (len(points) < MOST_POINTS)
        edges.append(chord[~halved])
        run, chord, middle = run[halved], chord[halved], middle[halved]
        triangles.append(np.column_stack([chord[:, 0], middle, chord[:, 1]]))
        u, u_middle = u[halved], u_middle[halved]
        u = np.column_stack([u[:, 0], u_middle, u_middle, u[:, 1]]).reshape(-1, 2)
        chord = np.column_stack([chord[:, 0], middle, middle, chord[:, 1]]).reshape(-1, 2)
        run = np.repeat(run, 2)
    return _Polygon(points, np.concatenate(triangles), np.concatenate(edges))


def _is_coarse(points: Floats, tensors: Floats, chord: Ints, middle: Ints) -> NDArray[np.bool_]:
    """Which chords (k, 2) are longer than unit and further off the curve than they should be."""
    a, b = chord.T
    height = points[middle] - 0.5 * (points[a] + points[b])
    off = np.max([tensor.lengths(tensors[v], tensors[v], height) for v in (a, b, middle)], axis=0)
    length = tensor.lengths(tensors[a], tensors[b], points[b] - points[a])
    return (off > OFF_CHORD) & (length > 1)
