"""A mesh and its domain: which of its vertices, edges and rows stand for what of the domain."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from adaptmesh.domain.projection import places_on_runs, tolerance_of
from adaptmesh.domain.side import Lines
from adaptmesh.mesh.boundary_polylines import vertices_at
from adaptmesh.types import Bools, Floats, Index, Int64s

from .rows import Row, rows_of, rows_of_lines
from .subject import Subject

if TYPE_CHECKING:
    from shapely import LineString, MultiLineString

    from adaptmesh.domain.domain import Domain


class Places(NamedTuple):
    """Where a vertex of a row is: along its line, and how far off it.

    Attributes
    ----------
    along : (k,) array
        On a straight line the coordinate that changes more, growing from its first end to its
        second; on a run its parameter; NaN where the vertex is not on the run.
    off : (k,) array
        Distance from the line.
    """

    along: Floats
    off: Floats


@dataclass(frozen=True)
class DomainSubject(Subject):
    """A mesh that is held against its domain.

    ``given_tolerance`` says how far off their lines vertices may be, `tolerance_of` if None.
    """

    given_tolerance: float | None = None

    @property
    def domain(self) -> Domain:
        """The domain of the mesh; only meshes that have one are held against it."""
        if self.mesh.domain is None:
            raise ValueError("the mesh has no domain")
        return self.mesh.domain

    @cached_property
    def tolerance(self) -> float:
        """How far off its line a vertex may be, in the units of the mesh."""
        given = self.given_tolerance
        return tolerance_of(self.domain) if given is None else given

    @cached_property
    def lines(self) -> Lines:
        """The straight pieces and the runs of the domain."""
        return Lines.of(self.domain)

    @cached_property
    def vertices(self) -> Int64s:
        """The vertex at each corner of the domain, (c,), -1 where there is none.

        One with the very coordinates, or else the nearest that is no other corner and within the
        tolerance.
        """
        from scipy.spatial import KDTree

        corners = self.lines.corners
        out = vertices_at(self.mesh, corners).astype(np.int64)
        missing = np.flatnonzero(out < 0)
        left = np.setdiff1d(np.arange(len(self.mesh.points)), out)
        if len(missing) and len(left):
            off, nearest = KDTree(self.mesh.points[left]).query(corners[missing])
            nearest = np.where(off <= self.tolerance, left[np.minimum(nearest, len(left) - 1)], -1)
            _, once = np.unique(nearest, return_index=True)
            out[missing[once]] = nearest[once]
        return out

    @cached_property
    def corner(self) -> Int64s:
        """The corner of the domain that each vertex is, (n,), or -1."""
        out = np.full(len(self.mesh.points), -1, np.int64)
        found = np.flatnonzero(self.vertices >= 0)
        out[self.vertices[found]] = found
        return out

    @cached_property
    def all_rows(self) -> list[Row]:
        """All constrained edges, in rows between corners."""
        return rows_of(self.mesh.edges, self.corner)

    @cached_property
    def row_of_line(self) -> Int64s:
        """The number of the row of each line, (l,), or -1."""
        return rows_of_lines(self.all_rows, self.corner, self.lines.ends, self._distances)

    @cached_property
    def rows(self) -> list[Row | None]:
        """The row of each line, from its first corner to its second, or None."""
        out: list[Row | None] = []
        for line, number in enumerate(self.row_of_line.tolist()):
            row = self.all_rows[number] if number >= 0 else None
            out.append(row and self._directed(line, row))
        return out

    def _directed(self, line: int, row: Row) -> Row:
        """A row in the direction of its line."""
        begin, end = self.lines.ends[line]
        if begin != end:
            return row if self.corner[row.vertices[0]] == begin else row.reversed()
        u = self.places(np.full(len(row.inner), line), row.inner).along
        u = u[~np.isnan(u)]
        return row if np.sum(np.diff(u) > 0) >= np.sum(np.diff(u) < 0) else row.reversed()

    @property
    def other_rows(self) -> list[Row]:
        """The rows that belong to no line."""
        mine = set(self.row_of_line.tolist())
        return [row for k, row in enumerate(self.all_rows) if k not in mine]

    def places(self, line: Index, vertex: Index) -> Places:
        """Where vertices (k,) are on lines (k,)."""
        return _places(self, line, self.mesh.points[vertex])

    def _distances(self, rows: Index, lines: Index) -> Floats:
        """How far rows are from lines, (r, l); a row without inner vertices by its middle."""
        out = np.empty((len(rows), len(lines)))
        for i, number in enumerate(rows.tolist()):
            row = self.all_rows[number]
            points = self.mesh.points[row.inner]
            if not len(points):
                points = self.mesh.points[row.vertices].mean(axis=0, keepdims=True)
            for j, line in enumerate(lines.tolist()):
                off = _places(self, np.full(len(points), line), points).off
                out[i, j] = off.mean() + self.tolerance * np.sum(off > self.tolerance)
        return out

    @cached_property
    def is_on_missing_line(self) -> Bools:
        """Which constrained edges lie on a line that has no row: parts of one that is broken."""
        import shapely

        out = np.zeros(len(self.mesh.edges), bool)
        missing = np.flatnonzero(self.row_of_line < 0)
        edges = np.concatenate([np.empty(0, np.int64), *(row.edges for row in self.other_rows)])
        if not len(missing) or not len(edges):
            return out
        near = [self.line_shape(line) for line in missing.tolist()]
        tree = shapely.STRtree(shapely.linestrings(self.mesh.points[self.mesh.edges[edges]]))
        reach = np.array(
            [
                0.1 * shape.length if k >= self.lines.n_straight else 0.0
                for k, shape in zip(missing.tolist(), near, strict=True)
            ]
        )
        line, edge = tree.query(near, "dwithin", distance=reach + self.tolerance)
        ends = self.mesh.edges[edges[edge]]
        off = [self.places(missing[line], ends[:, i]).off for i in (0, 1)]
        out[edges[edge[np.max(off, axis=0) <= self.tolerance]]] = True
        return out

    def line_shape(self, line: int) -> LineString | MultiLineString:
        """A line as shapely has it, a run as its chords."""
        import shapely

        if line < self.lines.n_straight:
            return shapely.linestrings(self.lines.corners[self.lines.ends[line]])
        chords = self.domain.curved.segment_runs == line - self.lines.n_straight
        return shapely.multilinestrings(self.domain.points[self.domain.segments[chords]])

    def line_text(self, line: int) -> str:
        """A line in words: what it is and where it begins and ends."""
        segment = int(self.lines.segments[line])
        (x0, y0), (x1, y1) = self.lines.corners[self.lines.ends[line]].tolist()
        curve = int(self.domain.curved.segment_curves[segment])
        what = f"segment {segment}" if curve < 0 else self.domain.curved.describe(segment)
        return f"{what} from ({x0!r}, {y0!r}) to ({x1!r}, {y1!r})"


def _places(s: DomainSubject, line: Index, points: Floats) -> Places:
    lines = s.lines
    along, off = np.empty(len(line)), np.empty(len(line))
    straight = line < lines.n_straight
    along[straight], off[straight] = _on_straight(s, line[straight], points[straight])
    if not straight.all():
        run = line[~straight] - lines.n_straight
        along[~straight], off[~straight] = _on_runs(s, run, points[~straight])
    return Places(along, off)


def _on_straight(s: DomainSubject, line: Index, points: Floats) -> tuple[Floats, Floats]:
    a, b = (s.scale(s.lines.corners[s.lines.ends[line, i]]) for i in (0, 1))
    p = s.scale(points)
    d, w = b - a, p - a
    rows, major = np.arange(len(line)), np.abs(d).argmax(axis=1)
    along = np.sign(d[rows, major]) * p[rows, major]
    share = np.clip((w * d).sum(axis=1) / (d * d).sum(axis=1), 0, 1)
    beyond = np.hypot(*(w - share[:, None] * d).T)
    beside = np.abs(w[:, 0] * d[:, 1] - w[:, 1] * d[:, 0]) / np.hypot(*d.T)
    off = np.where((share > 0) & (share < 1), beside, beyond)
    return along, np.ldexp(off, s.exponent)


def _on_runs(s: DomainSubject, run: Index, points: Floats) -> tuple[Floats, Floats]:
    """Parameters and distances; of a point with several places on the run, the first."""
    import shapely

    distinct, number = np.unique(points, axis=0, return_inverse=True)
    found, u, point = places_on_runs(s.domain, distinct, s.tolerance)
    n = len(distinct)
    keys = found.astype(np.int64) * n + point
    keys, first = np.unique(keys, return_index=True)
    wanted = run.astype(np.int64) * n + number.ravel()
    place = np.minimum(np.searchsorted(keys, wanted), max(len(keys) - 1, 0))
    along, off = np.full(len(run), np.nan), np.zeros(len(run))
    if len(keys):
        hit = keys[place] == wanted
        along[hit] = u[first[place[hit]]]
    for r in np.unique(run[np.isnan(along)]).tolist():
        mine = np.isnan(along) & (run == r)
        shape = s.line_shape(s.lines.n_straight + r)
        off[mine] = shapely.distance(shape, shapely.points(points[mine])) + 2 * s.tolerance
    return along, off
