"""Do the vertices of periodic boundaries correspond?"""

from __future__ import annotations

import numpy as np

from adaptmesh.domain.sides.side import Image
from adaptmesh.mesh.polylines import Polyline
from adaptmesh.types import Floats

from .domain_subject import DomainSubject
from .subject import Finding, finding


def periodic_boundaries(s: DomainSubject) -> Finding:
    """Polylines of sides that are periodic have as many vertices, each at the image of the other.

    The k-th vertex from the one end belongs to the k-th from the image of that end. How far it may
    be off is the tolerance for points on sides, and what the domain's own sides are off each other.
    """
    bad: list[str] = []
    count = 0
    for side, image in s.domain_sides.images.items():
        one, other = (s.polylines.of_side[k] for k in (side, image.side))
        if side > image.side or one is None or other is None:
            continue
        count += 1
        if image.is_reversed:
            other = other.reversed()
        both = f"{s.side_text(side)} and {s.side_text(image.side)}"
        if len(one.edges) != len(other.edges):
            bad.append(f"{both} have {len(one.edges)} and {len(other.edges)} edges")
            continue
        bad += [
            f"point {s.at(one.vertices[k])} and its image {s.at(other.vertices[k])} are "
            f"{off:.3g} off each other, on {both}"
            for k, off in _off(s, image, one, other)
        ]
    return finding(
        np.arange(len(bad)),
        f"{count} pairs of lines",
        "vertices of periodic boundaries do not correspond",
        bad.__getitem__,
    )


def _off(s: DomainSubject, image: Image, one: Polyline, other: Polyline) -> list[tuple[int, float]]:
    """Which vertices are too far from the image of their partner, and how far."""
    images = image.motion(s.mesh.points[one.vertices])
    off = np.hypot(*(images - s.mesh.points[other.vertices]).T)
    bad = np.flatnonzero(off > s.tolerance + 4 * _off_in_domain(s, image, images))
    return [(int(k), float(off[k])) for k in bad]


def _off_in_domain(s: DomainSubject, image: Image, images: Floats) -> Floats:
    """How far the images of the vertices of a side are off the side that is its image."""
    if not s.domain_sides.is_straight[image.side]:
        path = s.domain_sides.path(image.side)
        return np.hypot(*(path.point(path.nearest(images)) - images).T)
    ends = s.domain_sides.corners[s.domain_sides.ends[image.side]]
    off = np.hypot(*(images[[0, -1]] - (ends[::-1] if image.is_reversed else ends)).T)
    return np.full(len(images), off.max())
