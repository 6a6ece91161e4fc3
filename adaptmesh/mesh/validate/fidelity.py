"""Are the points, segments and curves of the domain in its mesh, and nothing else?

Rows of edges are followed from corner to corner (`rows.py`); distances only say whether a vertex of
a row lies on the line that the row stands for.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from adaptmesh.types import Bools, Floats, Index, Int64s

from .domain_subject import DomainSubject
from .rows import Row
from .subject import Finding, finding


def points_present(s: DomainSubject) -> Finding:
    """Every point of the domain is a point of the mesh."""
    corners = s.lines.corners

    def show(i: int) -> str:
        x, y = corners[i].tolist()
        return f"point {number[i]} of the domain ({x!r}, {y!r})"

    number = np.flatnonzero(s.domain.curved.is_vertex)
    bad = np.flatnonzero(s.vertices < 0)
    return finding(bad, f"{len(corners)} points", "points of the domain are missing", show)


def segments_present(s: DomainSubject) -> Finding:
    """Every segment is a row of constrained edges from its first point to its last."""
    return _lines_present(s, "segments", np.arange(s.lines.n_straight))


def curves_present(s: DomainSubject) -> Finding:
    """Every curve, from corner to corner, is a row of constrained edges."""
    return _lines_present(s, "curves", np.arange(s.lines.n_straight, len(s.lines)))


def _lines_present(s: DomainSubject, what: str, lines: Index) -> Finding:
    def show(line: int) -> str:
        return f"{s.line_text(line)} is no row of constrained edges"

    bad = lines[s.row_of_line[lines] < 0]
    return finding(bad, f"{len(lines)} {what}", f"{what} of the domain are missing", show)


def edges_on_segments(s: DomainSubject) -> Finding:
    """Every constrained edge belongs to the row of a segment or a curve."""
    stray = np.zeros(len(s.mesh.edges), bool)
    for row in s.other_rows:
        stray[row.edges] = True

    def show(e: int) -> str:
        return f"constrained edge {s.at(*s.mesh.edges[e])}"

    wrong = "constrained edges are on no segment or curve of the domain"
    return finding(np.flatnonzero(stray & ~s.is_on_missing_line), "", wrong, show)


class Inner(NamedTuple):
    """The vertices of rows but their ends, in order: their lines and numbers, (k,)."""

    line: Int64s
    vertex: Int64s

    @classmethod
    def of(cls, rows: list[Row | None], lines: Index) -> Inner:
        """Those of the rows of some lines."""
        mine = [(k, rows[k]) for k in lines.tolist()]
        inner = [(k, row.inner) for k, row in mine if row is not None]
        line = np.repeat([k for k, _ in inner], [len(v) for _, v in inner]).astype(np.int64)
        return cls(line, np.concatenate([np.empty(0, np.int64), *(v for _, v in inner)]))


def vertices_on_segments(s: DomainSubject) -> Finding:
    """The vertices of the row of a segment lie on it, one after the other."""
    return _vertices_on_lines(s, "segments", np.arange(s.lines.n_straight))


def vertices_on_curves(s: DomainSubject) -> Finding:
    """The vertices of the row of a curve lie on it, one after the other."""
    return _vertices_on_lines(s, "curves", np.arange(s.lines.n_straight, len(s.lines)))


def _vertices_on_lines(s: DomainSubject, what: str, lines: Index) -> Finding:
    inner = Inner.of(s.rows, lines)
    along, off = s.places(inner.line, inner.vertex)
    beside = off > s.tolerance
    early = ~beside & _out_of_order(s, inner, np.where(beside, np.nan, along))

    def show(k: int) -> str:
        text = s.line_text(int(inner.line[k]))
        if beside[k]:
            return f"point {s.at(inner.vertex[k])} is {off[k]:.3g} off {text}"
        return f"point {s.at(inner.vertex[k])} is not between its neighbours on {text}"

    good = f"{len(inner.line)} points, to {s.tolerance:.2g}"
    wrong = f"points are not where they belong on {what}"
    return finding(np.flatnonzero(beside | early), good, wrong, show)


def _out_of_order(s: DomainSubject, inner: Inner, along: Floats) -> Bools:
    """Which inner vertices do not come after those before them, or not before the end."""
    lines = s.lines
    first, last = _ends_along(s, inner.line)
    bad: Bools = (along < first) | (along > last)
    known = np.flatnonzero(~np.isnan(along) & ~bad)
    line, place = inner.line[known], along[known]
    back = (line[1:] == line[:-1]) & (
        np.where(line[1:] < lines.n_straight, place[1:] < place[:-1], place[1:] <= place[:-1])
    )
    bad[known[1:][back]] = True
    return bad


def _ends_along(s: DomainSubject, line: Int64s) -> tuple[Floats, Floats]:
    """Where lines (k,) begin and end, in terms of `Places.along`."""
    ends = s.lines.corners[s.lines.ends[line]]
    p = s.scale(ends)
    d = p[:, 1] - p[:, 0]
    rows, major = np.arange(len(line)), np.abs(d).argmax(axis=1)
    sign = np.sign(d[rows, major])
    straight = line < s.lines.n_straight
    first = np.where(straight, sign * p[rows, 0, major], 0.0)
    last = np.where(straight, sign * p[rows, 1, major], s.lines.lengths[line])
    return first, last


def tags_of_domain(s: DomainSubject) -> Finding:
    """The edges of a row have the tag of their segment or curve."""
    rows = [(line, row) for line, row in enumerate(s.rows) if row is not None]
    edge = np.concatenate([np.empty(0, np.int64), *(row.edges for _, row in rows)])
    line = np.repeat([k for k, _ in rows], [len(row.edges) for _, row in rows]).astype(np.int64)
    order = np.argsort(edge)
    edge, line = edge[order], line[order]
    expected = s.domain.segment_tags[s.lines.segments[line]]
    found = s.mesh.edge_tags[edge]

    def show(k: int) -> str:
        text = f"constrained edge {edge[k]}, {s.at(*s.mesh.edges[edge[k]])}"
        return f"{text}: tag {found[k]}, but {s.line_text(int(line[k]))} has {expected[k]}"

    wrong = "constrained edges have another tag than their segment or curve"
    return finding(np.flatnonzero(found != expected), f"{len(edge)} edges", wrong, show)


def frozen_undivided(s: DomainSubject) -> Finding:
    """Every frozen segment is one edge; see `Domain.with_frozen`."""
    divided = np.array([row is not None and len(row.edges) > 1 for row in s.rows], bool)
    bad = np.flatnonzero(divided & s.lines.is_frozen)
    good = f"{np.count_nonzero(s.lines.is_frozen)} frozen segments"
    return finding(bad, good, "frozen segments are divided", s.line_text)


def area_of_domain(s: DomainSubject) -> Finding:
    """The triangles have the area of the domain, to what its points and rounding allow."""
    a, b = (s.domain.points[i] for i in s.domain.segments.T)
    p = s.mesh.points[s.mesh.triangles]
    u, v = (np.hypot(*(p[:, i] - p[:, 0]).T) for i in (1, 2))
    tolerance = s.tolerance * float(np.hypot(*(b - a).T).sum())
    tolerance += 8 * float(np.finfo(float).eps) * float((u * v).sum())
    found, expected = float(s.mesh.areas.sum()), s.domain.area
    note = f"{found!r}, of the domain {expected!r}, to {tolerance:.2g}"
    return Finding(int(not abs(found - expected) <= tolerance), note)
