"""What a file has kept of what was to be written, found by comparing both."""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np

from adaptmesh.errors import FormatError
from adaptmesh.mesh.incoming import Content
from adaptmesh.types import Array

ROUNDED = 1e-5
"""Share of the extent by which coordinates, or of its size a field, may be rounded."""


def what_is_lost(content: Content, back: Content) -> list[str]:
    """In words, what of `content` is not in `back`, which was read from its file.

    Raises
    ------
    FormatError
        The file would hold another mesh.
    """
    lost: list[str] = []
    place = _places(content, back, lost)
    cells = place[content.triangles]
    order = _rows_in(cells, back.triangles)
    if order is None:
        raise FormatError("would hold other triangles than the mesh: write it in another format")
    if (order != np.arange(len(order))).any():
        lost.append("the order of the triangles")
    regions = back.regions[order]
    if (content.regions != 0).any() or content.region_names:
        lost += _lost_labels(
            "regions", content.regions, content.region_names, regions, back.region_names
        )
    if len(content.edges):
        rows = _rows_in(place[content.edges], back.edges)
        if rows is None:
            lost.append(f"edges{_with_names(content.names)}")
        else:
            tags = back.edge_tags[rows]
            lost += _lost_labels("edge tags", content.edge_tags, content.names, tags, back.names)
    lost += _lost_fields(content, back, place, order)
    return lost


def _places(content: Content, back: Content, lost: list[str]) -> Array:
    """For each point its number in the file, -1 if it is not there."""
    points, found = content.points[:, :2], back.points[:, :2]
    here = np.arange(len(points))
    size = float(np.ptp(points, axis=0).max(initial=0))
    if len(points) == len(found):
        off = float(np.abs(points - found).max(initial=0))
        if off == 0:
            return here
        if off <= ROUNDED * size:
            lost.append(f"all digits of coordinates (they move by up to {off:.1g})")
            return here
    from scipy.spatial import KDTree

    distance, nearest = KDTree(found).query(points)
    used = np.zeros(len(points), bool)
    used[content.triangles.ravel()] = True
    off = float(distance[used].max(initial=0))
    twice = len(np.unique(nearest[used])) < np.count_nonzero(used)
    if off > ROUNDED * size or twice:
        raise FormatError("would hold other points than the mesh: write it in another format")
    if off > 0:
        lost.append(f"all digits of coordinates (they move by up to {off:.1g})")
    lost.append("the order of the points")
    if not used.all():
        lost.append("points in no triangle")
    return np.where(used | (distance <= ROUNDED * size), nearest, -1)


def _rows_in(cells: Array, found: Array) -> Array | None:
    """For each cell its row among those found, whatever vertex comes first; None if one is not."""
    if len(cells) != len(found):
        return None
    ours, theirs = np.sort(cells, axis=1), np.sort(found, axis=1)
    order, their_order = np.lexsort(ours.T), np.lexsort(theirs.T)
    if not np.array_equal(ours[order], theirs[their_order]):
        return None
    rows = np.empty(len(cells), np.intp)
    rows[order] = their_order
    return rows


def _lost_labels(
    what: str,
    numbers: Array,
    names: Mapping[str, int],
    found: Array,
    found_names: Mapping[str, int],
) -> list[str]:
    """That parts are no longer told apart, or have lost names or numbers."""
    if len(np.unique(np.column_stack([numbers, found]), axis=0)) != len(np.unique(numbers)) or (
        len(np.unique(found)) != len(np.unique(numbers))
    ):
        return [f"{what}{_with_names(names)}"]
    out = []
    gone = [
        name
        for name, tag in names.items()
        if name not in found_names or not np.array_equal(numbers == tag, found == found_names[name])
    ]
    if gone:
        out.append(f"names of {what} ({_listed(gone)})")
    if (numbers != found).any() or any(found_names.get(n, t) != t for n, t in names.items()):
        out.append(f"numbers of {what}")
    return out


def _lost_fields(content: Content, back: Content, place: Array, order: Array) -> list[str]:
    gone, rounded = [], []
    there = place >= 0
    metrics = [({} if c.metric is None else {"metric": c.metric}) for c in (content, back)]
    for ours, theirs, rows, kept in (
        (content.point_fields, back.point_fields, place, there),
        (metrics[0], metrics[1], place, there),
        (content.triangle_fields, back.triangle_fields, order, np.ones(len(order), bool)),
    ):
        for name, values in ours.items():
            found = theirs.get(name)
            if found is None or found.shape[1:] != values.shape[1:]:
                gone.append(name)
                continue
            found, asked = found[rows[kept]].astype(np.float64), values[kept].astype(np.float64)
            size = float(np.abs(asked[np.isfinite(asked)]).max(initial=0))
            if not np.allclose(asked, found, rtol=0, atol=ROUNDED * size, equal_nan=True):
                gone.append(name)
            elif not np.array_equal(asked, found, equal_nan=True):
                rounded.append(name)
    out = []
    if gone:
        out.append(f"fields ({_listed(gone)})")
    if rounded:
        out.append(f"all digits of fields ({_listed(rounded)})")
    return out


def _with_names(names: Mapping[str, int]) -> str:
    return f" with their names ({_listed(names)})" if names else ""


def _listed(names: Mapping[str, int] | list[str], most: int = 5) -> str:
    listed = list(names)
    more = f" and {len(listed) - most} more" if len(listed) > most else ""
    return ", ".join(map(repr, listed[:most])) + more
