"""Do the vertices of periodic boundaries correspond?"""

from __future__ import annotations

import numpy as np

from adaptmesh.domain.periodic import images_on
from adaptmesh.domain.side import Tie
from adaptmesh.types import Floats

from .domain_subject import DomainSubject
from .rows import Row
from .subject import Finding, finding


def periodic_boundaries(s: DomainSubject) -> Finding:
    """Rows of lines that are periodic have as many vertices, each at the image of the other.

    The k-th vertex from the one end belongs to the k-th from the image of that end. How far it may
    be off is the tolerance for points on lines, and what the domain's own lines are off each other.
    """
    bad: list[str] = []
    count = 0
    for line, tie in s.lines.ties.items():
        one, other = s.rows[line], s.rows[tie.line]
        if line > tie.line or one is None or other is None:
            continue
        count += 1
        if tie.is_reversed:
            other = other.reversed()
        lines = f"{s.line_text(line)} and {s.line_text(tie.line)}"
        if len(one.edges) != len(other.edges):
            bad.append(f"{lines} have {len(one.edges)} and {len(other.edges)} edges")
            continue
        bad += [
            f"point {s.at(one.vertices[k])} and its image {s.at(other.vertices[k])} are "
            f"{off:.3g} off each other, on {lines}"
            for k, off in _off(s, tie, one, other)
        ]
    return finding(
        np.arange(len(bad)),
        f"{count} pairs of lines",
        "vertices of periodic boundaries do not correspond",
        bad.__getitem__,
    )


def _off(s: DomainSubject, tie: Tie, one: Row, other: Row) -> list[tuple[int, float]]:
    """The places of vertices that are too far from the image of their partner, and how far."""
    images = tie.motion(s.mesh.points[one.vertices])
    off = np.hypot(*(images - s.mesh.points[other.vertices]).T)
    bad = np.flatnonzero(off > s.tolerance + 4 * _off_in_domain(s, tie, images))
    return [(int(k), float(off[k])) for k in bad]


def _off_in_domain(s: DomainSubject, tie: Tie, images: Floats) -> Floats:
    """How far the images of the vertices of a line are off the line that is tied to it."""
    if tie.line >= s.lines.n_straight:
        run = s.domain.curved.runs[tie.line - s.lines.n_straight]
        nearest = images_on(run, images)
        return np.hypot(*(run.point(nearest) - images).T)
    a, b = s.lines.corners[s.lines.ends[tie.line]]
    if np.abs(images[0] - a).max() > np.abs(images[0] - b).max():
        a, b = b, a
    ends = np.hypot(*(images[[0, -1]] - [a, b]).T)
    return np.full(len(images), ends.max())
