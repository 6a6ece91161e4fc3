"""What the colours mean: triangles, points or edges to colours, with the scale or legend."""

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
    field_scale,
    length_scale,
    quality_scale,
    rgb,
    size_scale,
)
from .frame import Bounds

Entry = tuple[str, str]  # a name and its colour


class View:
    """The part of a mesh that is in sight.

    Attributes
    ----------
    numbers : (k,) array of int
        The triangles in sight.
    triangles : (k, 3) array of int
        Their vertices.
    edges : (e, 2) array of int
        Their edges, once.
    sides : (k, 3) array of int
        The edge opposite each of their corners.
    constrained : (c,) array of int
        The constrained edges in sight.
    """

    def __init__(self, mesh: Mesh, bounds: Bounds) -> None:
        self.mesh = mesh
        self.numbers = np.flatnonzero(_touches(mesh.points[mesh.triangles], bounds))
        self.constrained = np.flatnonzero(_touches(mesh.points[mesh.edges], bounds))
        self.triangles = mesh.triangles[self.numbers]
        self.edges, self.sides = mesh_edges(self.triangles)


def _touches(corners: Floats, bounds: Bounds) -> Bools:
    """Which boxes around triangles or edges reach into the view."""
    low, high = corners.min(axis=1), corners.max(axis=1)
    return ((high >= bounds[:2]) & (low <= bounds[2:])).all(axis=1)


@dataclass(frozen=True)
class Paint:
    """Colours of everything in a view.

    Attributes
    ----------
    faces : (k, 3) or (n, 3) array of uint8
        One for each triangle in sight, or for each point of the mesh.
    edges : (e, 3) array of uint8
    edge_width, edge_strength : float
        Pixels, and opacity where edges stand apart.
    scale : Scale, optional
    entries : sequence of (name, colour)
        For the legend.
    heading : str
        Of the legend.
    """

    faces: Bytes
    edges: Bytes
    edge_width: float = 1.0
    edge_strength: float = 0.4
    scale: Scale | None = None
    entries: Sequence[Entry] = ()
    heading: str = "regions"


def paint_plain(view: View) -> Paint:
    """Pale triangles, dark edges."""
    return Paint(_all(FACE, view.triangles), _all(EDGE, view.edges), edge_strength=0.9)


def paint_regions(view: View) -> Paint:
    """A colour for each region; those without a name are called by their number."""
    used = np.unique(view.mesh.regions[view.numbers])
    names = {number: name for name, number in view.mesh.region_names.items()}
    table = {r: FACE if r == 0 else REGIONS[(r - 1) % len(REGIONS)] for r in used.tolist()}
    entries = [
        (names.get(r, f"region {r}" if r else "no region"), colour) for r, colour in table.items()
    ]
    colours = np.array([rgb(colour) for colour in table.values()])
    faces = colours[np.searchsorted(used, view.mesh.regions[view.numbers])]
    return Paint(faces, _all(EDGE, view.edges), edge_strength=0.6, entries=entries)


def paint_quality(view: View, field: ControlSpace | None, cmap: str | None) -> Paint:
    """The quality of each triangle, in the metric or without one."""
    label = "quality" if field is None else "metric quality"
    quality = qualities(view.mesh.points, view.triangles, 1.0 if field is None else field)
    scale = quality_scale(label, cmap)
    return Paint(scale(quality), _all(EDGE, view.edges), scale=scale)


def paint_lengths(view: View, field: ControlSpace, cmap: str | None) -> Paint:
    """The metric length of each edge."""
    scale = length_scale(cmap)
    lengths = edge_lengths(view.mesh.points, view.edges, field)
    white = _all(PAPER, view.triangles)
    return Paint(white, scale(lengths), edge_width=2.0, edge_strength=1.0, scale=scale)


def paint_sizes(view: View, cmap: str | None) -> Paint:
    """The side of the equilateral triangle of the same area."""
    sizes = np.sqrt(4 / 3**0.5 * np.abs(view.mesh.areas[view.numbers]))
    scale = size_scale(sizes, cmap)
    return Paint(scale(sizes), _all(EDGE, view.edges), scale=scale)


def paint_values(view: View, values: ArrayLike, cmap: str | None) -> Paint:
    """Numbers at the points of the mesh or on its triangles; NaN, or masked, is no value."""
    mesh, v = view.mesh, _as_reals(values)
    n, m = len(mesh.points), len(mesh.triangles)
    if v.shape not in ((n,), (m,)):
        raise ValueError(f"show has shape {v.shape}: {n} numbers at the points are wanted, or {m}")
    scale = field_scale(v, cmap or FIELD)
    faces = scale(v) if v.shape == (n,) else scale(v[view.numbers])
    missing = [("no value", NO_VALUE)] if np.isnan(v).any() else []
    edges = _all(EDGE, view.edges)
    return Paint(faces, edges, edge_strength=0.3, scale=scale, entries=missing, heading="missing")


def _as_reals(values: ArrayLike) -> Floats:
    array: Array = np.asarray(values)
    if array.dtype.kind not in "biuf":
        raise ValueError(f"show is an array of {array.dtype}: expected real numbers")
    return np.where(np.ma.getmaskarray(np.ma.asarray(values)), np.nan, array.astype(float))


def paint_names(view: View) -> tuple[Bytes, list[Entry]]:
    """Colours of the constrained edges in sight, and their names; without any, all are ink."""
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


def _all(colour: str, items: Index) -> Bytes:
    return np.tile(rgb(colour), (len(items), 1))
