"""Colours of triangles, points and edges, with their scale or legend."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike

from adaptmesh.mesh.mesh import Mesh
from adaptmesh.types import Array, Bools, Floats, Index
from metrics import ControlSpace
from metrics.measure.exact import edge_lengths, qualities
from metrics.topology import mesh_edges

from .colours import (
    EDGE,
    FACE,
    FIELD,
    INK,
    NAMES,
    NO_VALUE,
    PAPER,
    REGIONS,
    Bytes,
    Scale,
    make_field_scale,
    make_length_scale,
    make_quality_scale,
    make_size_scale,
    rgb,
)
from .frame import Bounds

Entry = tuple[str, str]  # a name and its colour


class View:
    """The visible part of a mesh.

    Attributes
    ----------
    numbers : (k,) array of int
        The visible triangles.
    triangles : (k, 3) array of int
        Their vertices.
    edges : (e, 2) array of int
        Their distinct edges.
    sides : (k, 3) array of int
        The edge opposite each corner.
    constrained : (c,) array of int
        The visible constrained edges.
    """

    def __init__(self, mesh: Mesh, bounds: Bounds) -> None:
        self.mesh = mesh
        self.numbers = np.flatnonzero(_overlaps_view(mesh.points[mesh.triangles], bounds))
        self.constrained = np.flatnonzero(_overlaps_view(mesh.points[mesh.edges], bounds))
        self.triangles = mesh.triangles[self.numbers]
        self.edges, self.sides = mesh_edges(self.triangles)


def _overlaps_view(corners: Floats, bounds: Bounds) -> Bools:
    """Mark triangles or edges whose bounding boxes overlap the view."""
    low, high = corners.min(axis=1), corners.max(axis=1)
    return ((high >= bounds[:2]) & (low <= bounds[2:])).all(axis=1)


@dataclass(frozen=True)
class Paint:
    """Colours of the items in a view.

    Attributes
    ----------
    faces : (k, 3) or (n, 3) array of uint8
        One for each visible triangle, or for each point of the mesh.
    edges : (e, 3) array of uint8
    edge_width, edge_strength : float
        Width in pixels, and opacity where edges are far apart.
    scale : Scale, optional
    entries : sequence of (name, colour)
        Entries of the legend.
    heading : str
        Heading of the legend.
    """

    faces: Bytes
    edges: Bytes
    edge_width: float = 1.0
    edge_strength: float = 0.4
    scale: Scale | None = None
    entries: Sequence[Entry] = ()
    heading: str = "regions"


def paint_plain(view: View) -> Paint:
    """Paint pale triangles and dark edges."""
    return Paint(_fill(FACE, view.triangles), _fill(EDGE, view.edges), edge_strength=0.9)


def paint_regions(view: View) -> Paint:
    """Paint each region in one colour; regions without a name are listed by number."""
    used = np.unique(view.mesh.regions[view.numbers])
    names = {number: name for name, number in view.mesh.region_names.items()}
    table = {r: FACE if r == 0 else REGIONS[(r - 1) % len(REGIONS)] for r in used.tolist()}
    entries = [
        (names.get(r, f"region {r}" if r else "no region"), colour) for r, colour in table.items()
    ]
    colours = np.array([rgb(colour) for colour in table.values()])
    faces = colours[np.searchsorted(used, view.mesh.regions[view.numbers])]
    return Paint(faces, _fill(EDGE, view.edges), edge_strength=0.6, entries=entries)


def paint_quality(view: View, field: ControlSpace | None, cmap: str | None) -> Paint:
    """Paint the quality of each triangle, in the metric if there is one."""
    label = "quality" if field is None else "metric quality"
    quality = qualities(view.mesh.points, view.triangles, 1.0 if field is None else field)
    scale = make_quality_scale(label, cmap)
    return Paint(scale(quality), _fill(EDGE, view.edges), scale=scale)


def paint_lengths(view: View, field: ControlSpace, cmap: str | None) -> Paint:
    """Paint the metric length of each edge."""
    scale = make_length_scale(cmap)
    lengths = edge_lengths(view.mesh.points, view.edges, field)
    white = _fill(PAPER, view.triangles)
    return Paint(white, scale(lengths), edge_width=2.0, edge_strength=1.0, scale=scale)


def paint_sizes(view: View, cmap: str | None) -> Paint:
    """Paint the size of each triangle: the side of the equilateral triangle of its area."""
    sizes = np.sqrt(4 / 3**0.5 * np.abs(view.mesh.areas[view.numbers]))
    scale = make_size_scale(sizes, cmap)
    return Paint(scale(sizes), _fill(EDGE, view.edges), scale=scale)


def paint_values(view: View, values: ArrayLike, cmap: str | None) -> Paint:
    """Paint numbers at points or on triangles; NaN and masked ones count as missing."""
    mesh, v = view.mesh, _to_floats(values)
    n, m = len(mesh.points), len(mesh.triangles)
    if v.shape not in ((n,), (m,)):
        raise ValueError(
            f"show: expected shape ({n},) at points or ({m},) on triangles, got {v.shape}"
        )
    scale = make_field_scale(v, cmap or FIELD)
    faces = scale(v) if v.shape == (n,) else scale(v[view.numbers])
    missing = [("no value", NO_VALUE)] if np.isnan(v).any() else []
    edges = _fill(EDGE, view.edges)
    return Paint(faces, edges, edge_strength=0.3, scale=scale, entries=missing, heading="missing")


def _to_floats(values: ArrayLike) -> Floats:
    array: Array = np.asarray(values)
    if array.dtype.kind not in "biuf":
        raise ValueError(f"show: expected real numbers, got an array of {array.dtype}")
    return np.where(np.ma.getmaskarray(np.ma.asarray(values)), np.nan, array.astype(float))


def paint_names(view: View) -> tuple[Bytes, list[Entry]]:
    """Return colours of the visible constrained edges, and the legend of their names."""
    tags = view.mesh.edge_tags[view.constrained]
    used, which = np.unique(tags, return_inverse=True)
    names = {tag: name for name, tag in view.mesh.names.items()}
    table = {tag: INK if tag == 0 else NAMES[(tag - 1) % len(NAMES)] for tag in used.tolist()}
    colours = np.array([rgb(colour) for colour in table.values()]).reshape(-1, 3)[which.ravel()]
    if not used.any():
        return colours, []
    return colours, [
        (names.get(tag, f"tag {tag}" if tag else "no name"), colour)
        for tag, colour in table.items()
    ]


def _fill(colour: str, items: Index) -> Bytes:
    return np.tile(rgb(colour), (len(items), 1))
