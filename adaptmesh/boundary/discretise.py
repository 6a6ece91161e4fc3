"""The sides of a domain cut into unit pieces, as the core takes them."""

from __future__ import annotations

import numpy as np

from adaptmesh import ragged
from adaptmesh._core import BoundaryCuts
from adaptmesh.domain.data import DomainData
from adaptmesh.domain.sides.side import SidePoints, Sides
from adaptmesh.types import Ints
from metrics import ControlSpace

from .safe_ranges import ends_of, safe_ranges
from .unit_polylines import check_count, periodic_polylines, unit_polylines


def cut_boundary(domain: DomainData, metric: ControlSpace, max_vertices: int) -> BoundaryCuts:
    """Cut every side of the domain into pieces of (nearly) unit metric length.

    Each is cut once, in a direction of its own, so that both what lies beside it and all meshes of
    the domain with this metric agree on it; see `unit_polylines`. Frozen sides are not cut.

    What is triangulated first are the corners, the straight segments, and the ends of ranges of
    edges of curved sides, see `safe_ranges`. Each range, and each straight side, is a piece, which
    the cuts divide then: those of a curved one must all be made.
    """
    sides = domain.all_sides
    tensors = metric(sides.corners)
    parts = sides.whole().where(~sides.is_frozen)
    lines = unit_polylines(sides, parts, SidePoints.none(), metric, max_vertices)
    lines = periodic_polylines(sides, lines)
    check_count(len(lines.points), max_vertices)

    ranges = safe_ranges(sides, lines)
    ends, n_corners = ends_of(lines, ranges), len(sides.corners)
    first = np.unique(ends[ends >= n_corners])
    number = np.arange(len(lines.points), dtype=np.int32)
    number[first] = n_corners + np.arange(len(first))
    pieces, side = number[ends], lines.side[ranges[:, 0]]

    is_last = np.zeros(len(lines.side), bool)
    is_last[ranges[:, 1] - 1] = True
    cuts = lines.points[lines.ends[~is_last, 1]]
    segments, owners = _straight_segments(domain)
    curved = slice(sides.n_straight, None)
    return BoundaryCuts(
        np.concatenate([sides.corners, lines.points[first]]),
        np.concatenate([tensors, metric(lines.points[first])]),
        np.concatenate([segments, pieces[curved]]),
        np.concatenate([owners, sides.segments[side][curved]]),
        pieces,
        sides.segments[side],
        ~sides.is_straight[side],
        cuts,
        metric(cuts),
        ragged.owners(ranges[:, 1] - ranges[:, 0])[~is_last].astype(np.int32),
        _periodic_pieces(sides),
    )


def _straight_segments(domain: DomainData) -> tuple[Ints, Ints]:
    """The straight segments, by corner, and their numbers."""
    number = (np.cumsum(domain.curved.is_vertex) - 1).astype(np.int32)
    straight = np.flatnonzero(domain.curved.segment_paths < 0).astype(np.int32)
    return number[domain.segments[straight]], straight


def _periodic_pieces(sides: Sides) -> Ints:
    """Straight sides, which are pieces, their images, and whether these run backwards, (k, 3)."""
    images = sides.images.items()
    rows = [(i, im.side, im.is_reversed) for i, im in images if i < im.side < sides.n_straight]
    return np.array(rows, np.int32).reshape(-1, 3)
