"""Where the boundary polylines of a mesh are to be cut again, as they are not unit there.

::

    A---o---o-----o--o---o---B      a side of the domain from A to B, and a mesh's polyline along it
            [-----------]           a part with an edge that is not unit, and its neighbours,
    A---o---o---n---n---o---B       cut into equal parts

1. Parts are found, and how they would be cut is worked out: as in `generate`, on curves more finely
   where the curve asks for it; where boundaries are periodic, the same on both sides.
2. Those that this makes better are chosen: what the curve forces to be short stays as it is.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np

from adaptmesh import ragged
from adaptmesh.boundary.edge_lengths import straight_lengths
from adaptmesh.boundary.unit_polylines import MAX_TURN, periodic_polylines, unit_polylines
from adaptmesh.domain.sides.polyline import Polylines, polylines_along
from adaptmesh.domain.sides.side import SideParts, SidePoints, Sides
from adaptmesh.mesh.boundary_polylines import BoundaryPolylines
from adaptmesh.types import Bools, Floats, Index
from metrics import ControlSpace

from .periodic_polylines import Anchors, same_parameters
from .sub_polylines import is_better, is_off, ranges_to_cut

FAR = 1.1
"""A polyline whose edge count is off by more than this factor is far from a new one."""


@dataclass(frozen=True)
class Boundary:
    """The polylines of a mesh, and what their edges are like in the metric.

    Attributes
    ----------
    sides : Sides
    polylines : BoundaryPolylines
    points : (c, 2) array
        Of their vertices.
    metric : ControlSpace
    max_vertices : int
    """

    sides: Sides
    polylines: BoundaryPolylines
    points: Floats
    metric: ControlSpace
    max_vertices: int

    @cached_property
    def anchors(self) -> Anchors:
        return Anchors.of(self.polylines, self.sides)

    @cached_property
    def may_stay(self) -> Bools:
        """Which of the vertices of the polylines (c,) are not to go in any case."""
        return self.anchors.may_stay(len(self.points))

    @cached_property
    def staying(self) -> SidePoints:
        """Those of them that are no corners."""
        side = self.polylines.sides
        is_end = np.zeros(len(side), bool)
        is_end[self.polylines.first[:-1]] = is_end[self.polylines.first[1:] - 1] = True
        return SidePoints(side, self.polylines.u).where(self.may_stay & ~is_end)

    @cached_property
    def lengths(self) -> Floats:
        """The lengths of all edges between anchors, as they count."""
        anchors = self.anchors
        lengths = anchors.lengths(self.points, self.metric)
        a = anchors.starts
        ends = np.stack([anchors.at[a], anchors.at[a + 1]], axis=1)
        return _counted(self.sides, anchors.side[a], self.polylines.u[ends], lengths)

    def is_far_from_new(self) -> bool:
        """Whether the boundary should be cut again from end to end.

        That is if periodic polylines differ, or curved ones that are not unit have far more or
        fewer edges than new ones. Where curves come very near each other, the vertices of each keep
        the other from being cut more coarsely, and triangles between them from being cut more
        finely.
        """
        if not self.may_stay.all():
            return True
        sides, anchors = self.sides, self.anchors
        off = np.unique(anchors.side[anchors.starts][is_off(self.lengths)])
        off = off[~sides.is_straight[off]]
        if not len(off):
            return False
        parts = sides.whole().where(~sides.is_straight)
        new = unit_polylines(sides, parts, SidePoints.none(), self.metric, self.max_vertices)
        n_new = np.bincount(periodic_polylines(sides, new).side, minlength=len(sides))[off].sum()
        n_now = np.diff(self.polylines.first)[off].sum() - len(off)
        return not n_new / FAR <= n_now <= n_new * FAR

    def planned(self) -> SidePoints:
        """The vertices of new polylines but the corners, the old ones where nothing changes."""
        starts = self.anchors.starts
        ranges = ranges_to_cut(self.anchors.side[starts], self.lengths, self.sides.is_frozen)
        if not len(ranges):
            return self._agreeing(self.staying)[0] if not self.may_stay.all() else self.staying
        parts, owner = self._parts(
            np.stack([starts[ranges[:, 0]], starts[ranges[:, 1] - 1] + 1], 1)
        )
        rest = self.staying.where(self.staying.within(parts) < 0)
        new = unit_polylines(self.sides, parts, rest, self.metric, self.max_vertices).inner
        new = new.where(new.within(parts) >= 0)
        points, lines = self._agreeing(rest.joined(_alike(self.sides, parts, owner, new)))
        old = [self.lengths[a:b] for a, b in ranges]
        better = self._is_better(parts, owner, lines, old)
        if better.all():
            return points
        chosen = parts.where(better[owner])
        rest = self.staying.where(self.staying.within(chosen) < 0)
        return self._agreeing(rest.joined(points.where(points.within(chosen) >= 0)))[0]

    def _parts(self, ends: Index) -> tuple[SideParts, Index]:
        """Parts of sides between anchors (r, 2), then their images, and the range of each part."""
        anchors = self.anchors
        side, at, image = anchors.side[ends[:, 0]], anchors.at[ends], anchors.image[ends]
        periodic = np.flatnonzero(image[:, 0] >= 0)
        others = np.array([self.sides.images[k].side for k in side[periodic].tolist()], np.intp)
        u = np.sort(self.polylines.u[np.concatenate([at, image[periodic]])], axis=1)
        owner = np.concatenate([np.arange(len(ends)), periodic])
        return SideParts(np.concatenate([side, others]), u), owner

    def _agreeing(self, points: SidePoints) -> tuple[SidePoints, Polylines]:
        """With more vertices on curves where edges would cross, the same on periodic sides.

        Vertices of the mesh keep their parameters, to the bit.
        """
        lines = polylines_along(self.sides, points, MAX_TURN)
        lines = periodic_polylines(self.sides, lines)
        points = lines.inner
        u = points.u.copy()
        for side in {*self.sides.images} & {*points.side.tolist()}:
            row = slice(*self.polylines.first[[side, side + 1]])
            old = self.polylines.u[row][self.may_stay[row]]
            mine = points.side == side
            k = same_parameters(u[mine], old)
            u[mine] = np.where(k >= 0, old[k], u[mine])
        return SidePoints(points.side, u), lines

    def _is_better(
        self, parts: SideParts, owner: Index, lines: Polylines, old: list[Floats]
    ) -> Bools:
        """Which ranges are nearer to unit with new polylines than with their old lengths."""
        part = SidePoints(lines.side, lines.u.mean(axis=1)).within(parts)
        edges = np.argsort(part, kind="stable")[np.count_nonzero(part < 0) :]
        lengths = straight_lengths(lines.points, lines.ends[edges], self.metric)
        lengths = _counted(self.sides, lines.side[edges], lines.u[edges], lengths)
        by_part = ragged.split(lengths, np.bincount(part[edges], minlength=len(owner)))
        new = by_part[: len(old)]
        for k in range(len(old), len(owner)):  # the images
            r = int(owner[k])
            is_reversed = self.sides.images[int(parts.side[k])].is_reversed
            new[r] = np.maximum(new[r], by_part[k][::-1] if is_reversed else by_part[k])
        return np.array([is_better(n, o) for n, o in zip(new, old, strict=True)])


def _counted(sides: Sides, side: Index, u: Floats, lengths: Floats) -> Floats:
    """Lengths of edges as they count: one that turns by as much as it may is no shorter than 1."""
    if not sides.paths:
        return lengths
    turn = sides.turn(side, u[:, 1]) - sides.turn(side, u[:, 0])
    return np.maximum(lengths, turn / np.radians(MAX_TURN))


def _alike(sides: Sides, parts: SideParts, owner: Index, points: SidePoints) -> SidePoints:
    """Points within parts, alike in each and its image: the fewer are replaced by images."""
    part = points.within(parts)
    rows = [points.u[part == k] for k in range(len(owner))]
    for j in range(int(owner.max()) + 1, len(owner)):
        i = int(owner[j])
        if len(rows[i]) < len(rows[j]):
            i, j = j, i
        rows[j] = np.sort(sides.image(int(parts.side[i]), rows[i]))
    side = np.repeat(parts.side, [len(row) for row in rows])
    return SidePoints.none().joined(SidePoints(side, np.concatenate(rows)))
