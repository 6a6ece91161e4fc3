"""What is measured of a domain with curves: its area, and segments near to its lines."""

from __future__ import annotations

from collections.abc import Iterable

import numpy as np

from adaptmesh.checks import checked_number
from adaptmesh.domain.sides.paths import points_on
from adaptmesh.errors import DomainError
from adaptmesh.geometry.products import cross
from adaptmesh.types import Bools, Floats, Ints

from .data import DomainData

SMALLEST_TOLERANCE = 1e-10  # of `segments_within`, as a share of the extent


def area_of(domain: DomainData) -> float:
    """Area without the holes; that between the true curves if there are any."""
    p = domain.points[domain.triangles]
    u, v = p[:, 1] - p[:, 0], p[:, 2] - p[:, 0]
    straight = 0.5 * np.sum(cross(u, v))
    return float(straight + _area_beyond_chords(domain))


def _area_beyond_chords(domain: DomainData) -> float:
    """The area between the boundary and its chords, negative where the curve is inside."""
    curved = domain.curved
    boundary = domain.piece_segments[domain.piece_is_boundary]
    segments = boundary[curved.segment_paths[boundary] >= 0]
    areas = curved.areas_beside(curved.segment_paths[segments], curved.segment_parameters[segments])
    return float(np.sum(np.where(inside_is_left_of(domain, segments), areas, -areas)))


def inside_is_left_of(domain: DomainData, segments: Ints) -> Bools:
    """Whether the domain is on the left of boundary segments, given by number (k,)."""
    t, n = domain.triangles, len(domain.points)
    halves = np.concatenate([t[:, [0, 1]], t[:, [1, 2]], t[:, [2, 0]]]).astype(np.int64)
    a, b = domain.segments[segments].astype(np.int64).T
    return np.isin(a * n + b, halves[:, 0] * n + halves[:, 1])


def segments_within(domain: DomainData, tolerance: float, names: Iterable[str] | None) -> Floats:
    """As `Domain.outline`."""
    least = SMALLEST_TOLERANCE * float(np.ptp(domain.points, axis=0).max())
    if not checked_number(tolerance, "tolerance") >= least:
        raise DomainError(f"tolerance={tolerance}: expected at least {least:g}")
    if isinstance(names, str):
        raise TypeError(f"names={names!r}: give a list of names, [{names!r}]")
    curved = domain.curved
    asked = np.ones(len(domain.segments), bool)
    if names is not None:
        asked = np.isin(domain.segment_tags, [domain.tag_named(name) for name in names])
    straight = domain.points[domain.segments[asked & (curved.segment_paths < 0)]]
    if not curved.paths:
        return straight
    path, u = curved.chords_within(tolerance)
    mine = np.isin(path, curved.segment_paths[asked])
    path, u = path[mine], u[mine]
    ends = points_on(curved.paths, np.repeat(path, 2), u.ravel()).reshape(-1, 2, 2)
    return np.concatenate([straight, ends])
