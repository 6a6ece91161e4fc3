"""What is drawn in the view: triangles, edges, boundaries, ellipses; each on a level of its own."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

from adaptmesh.types import Floats, Index

from .colours import ELLIPSE, Bytes, rgb
from .ellipses import SIDES, Ellipses
from .frame import Frame

FACES, EDGES, LINES, ELLIPSES = 0.0, 1e-3, 2e-3, 3e-3  # levels above the paper
CLEAR = 7.0  # pixels between edges from which on they are drawn at full strength
THICKER = 2.0  # lines are drawn on a finer grid of pixels, see `screen.make_plotter`
FAINTEST = 4  # of 255; fainter edges are left out


def draw_faces(
    plotter: Any, frame: Frame, points: Floats, triangles: Index, colours: Bytes
) -> None:
    """Fill triangles, each in its colour, or between the colours of their vertices."""
    shape = _polygons(frame.place(points, FACES), triangles)
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
    """Draw edges, fainter where they crowd, so that a fine mesh is grey and not black.

    Parameters
    ----------
    edges : (e, 2) array of int
    colours : (e, 3) array of uint8
    spacing : (e,) array of float
        Distance to the next edge beside each, in frame units.
    """
    opacity = 255 * strength * np.clip(spacing * frame.pixel / (CLEAR * frame.unit), 0, 1)
    seen = opacity >= FAINTEST
    rgba = np.column_stack([colours[seen], opacity[seen].astype(np.uint8)])
    _add_lines(plotter, frame.place(points, EDGES), edges[seen], rgba, width * frame.unit)


def draw_lines(
    plotter: Any, frame: Frame, points: Floats, edges: Index, colours: Bytes, width: float
) -> None:
    """Draw constrained edges, thick."""
    _add_lines(plotter, frame.place(points, LINES), edges, colours, width * frame.unit)


def draw_ellipses(plotter: Any, frame: Frame, ellipses: Ellipses) -> None:
    """Fill ellipses with a veil and draw their outlines."""
    outlines = ellipses.outlines
    n = len(outlines)
    corners = frame.place(outlines.reshape(-1, 2), ELLIPSES)
    number = np.arange(n * SIDES).reshape(n, SIDES)
    plotter.add_mesh(_polygons(corners, number), color=ELLIPSE, opacity=0.16, lighting=False)
    sides = np.stack([number, np.roll(number, -1, axis=1)], axis=2).reshape(-1, 2)
    colours = np.tile(rgb(ELLIPSE), (len(sides), 1))
    _add_lines(plotter, corners, sides, colours, 1.6 * frame.unit)


def _polygons(points: NDArray[np.float32], corners: Index) -> Any:
    """Polygons of as many corners each, (k, corners)."""
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
    width = max(THICKER * width, 1.0)
    plotter.add_mesh(shape, scalars="colour", rgb=True, line_width=width, lighting=False)


def edge_spacing(
    frame: Frame, points: Floats, triangles: Index, sides: Index, count: int
) -> Floats:
    """The lesser height of the triangles beside each edge, in frame units.

    Parameters
    ----------
    sides : (m, 3) array of int
        The edge opposite each corner of each triangle, out of so many.
    """
    p = frame.place(points)[:, :2].astype(float)[triangles]
    along = np.roll(p, -2, axis=1) - np.roll(p, -1, axis=1)  # opposite each corner
    doubled = np.abs(along[:, 0, 0] * along[:, 1, 1] - along[:, 0, 1] * along[:, 1, 0])
    length = np.hypot(along[..., 0], along[..., 1])
    height = doubled[:, None] / np.maximum(length, 1e-30)
    out = np.full(count, np.inf)
    np.minimum.at(out, sides.ravel(), height.ravel())
    return out
