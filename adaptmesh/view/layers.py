"""The layers of the view: triangles, edges, boundaries, ellipses, each at its own height."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

from adaptmesh.types import Floats, Index

from .colours import ELLIPSE, Bytes, rgb
from .ellipses import SIDES, Ellipses
from .frame import Frame

FACES, EDGES, LINES, ELLIPSES = 0.0, 1e-3, 2e-3, 3e-3  # heights in the frame
FULL_SPACING = 7.0  # pixels between edges above which they are drawn with full opacity
SUPERSAMPLING = 2.0  # lines are drawn on a finer grid of pixels, see `plotter.make_plotter`
MIN_OPACITY = 4  # of 255; fainter edges are not drawn


def draw_faces(
    plotter: Any, frame: Frame, points: Floats, triangles: Index, colours: Bytes
) -> None:
    """Fill triangles, with colours of triangles or of vertices."""
    shape = _make_polygons(frame.place(points, FACES), triangles)
    data = shape.cell_data if len(colours) == len(triangles) else shape.point_data
    data["colour"] = colours
    plotter.add_mesh(shape, scalars="colour", rgb=True, lighting=False)


def draw_edges(
    plotter: Any,
    frame: Frame,
    points: Floats,
    edges: Index,
    colours: Bytes,
    spacing: Floats,
    width: float,
    strength: float,
) -> None:
    """Draw edges, fainter where they are close together, so that fine meshes are grey, not black.

    Parameters
    ----------
    edges : (e, 2) array of int
    colours : (e, 3) array of uint8
    spacing : (e,) array of float
        Distance of each edge to the next one beside it, in frame units.
    """
    opacity = 255 * strength * np.clip(spacing * frame.pixel / (FULL_SPACING * frame.unit), 0, 1)
    seen = opacity >= MIN_OPACITY
    rgba = np.column_stack([colours[seen], opacity[seen].astype(np.uint8)])
    _add_lines(plotter, frame.place(points, EDGES), edges[seen], rgba, width * frame.unit)


def draw_lines(
    plotter: Any, frame: Frame, points: Floats, edges: Index, colours: Bytes, width: float
) -> None:
    """Draw constrained edges as thick lines."""
    _add_lines(plotter, frame.place(points, LINES), edges, colours, width * frame.unit)


def draw_ellipses(plotter: Any, frame: Frame, ellipses: Ellipses) -> None:
    """Draw ellipses: transparent, with outlines."""
    outlines = ellipses.outlines
    n = len(outlines)
    corners = frame.place(outlines.reshape(-1, 2), ELLIPSES)
    number = np.arange(n * SIDES).reshape(n, SIDES)
    plotter.add_mesh(_make_polygons(corners, number), color=ELLIPSE, opacity=0.16, lighting=False)
    sides = np.stack([number, np.roll(number, -1, axis=1)], axis=2).reshape(-1, 2)
    colours = np.tile(rgb(ELLIPSE), (len(sides), 1))
    _add_lines(plotter, corners, sides, colours, 1.6 * frame.unit)


def _make_polygons(points: NDArray[np.float32], corners: Index) -> Any:
    """Make polygons of equally many corners, (k, corners)."""
    import pyvista as pv

    faces = np.column_stack([np.full(len(corners), corners.shape[1]), corners])
    return pv.PolyData(points, faces=faces.ravel())


def _add_lines(
    plotter: Any, points: NDArray[np.float32], edges: Index, colours: Bytes, width: float
) -> None:
    import pyvista as pv

    if len(edges) == 0:
        return
    shape = pv.PolyData(points, lines=np.column_stack([np.full(len(edges), 2), edges]).ravel())
    shape.cell_data["colour"] = colours
    width = max(SUPERSAMPLING * width, 1.0)
    plotter.add_mesh(shape, scalars="colour", rgb=True, line_width=width, lighting=False)


def compute_edge_spacing(
    frame: Frame, points: Floats, triangles: Index, sides: Index, count: int
) -> Floats:
    """Return the smaller height of the triangles beside each edge, in frame units.

    Parameters
    ----------
    sides : (m, 3) array of int
        The edge opposite each corner of each triangle.
    count : int
        The number of edges.
    """
    p = frame.place(points)[:, :2].astype(float)[triangles]
    along = np.roll(p, -2, axis=1) - np.roll(p, -1, axis=1)  # opposite each corner
    doubled = np.abs(along[:, 0, 0] * along[:, 1, 1] - along[:, 0, 1] * along[:, 1, 0])
    length = np.hypot(along[..., 0], along[..., 1])
    height = doubled[:, None] / np.maximum(length, 1e-30)
    out = np.full(count, np.inf)
    np.minimum.at(out, sides.ravel(), height.ravel())
    return out
