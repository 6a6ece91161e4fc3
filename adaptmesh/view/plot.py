"""`plot`: draw a picture of a mesh or a domain."""

from __future__ import annotations

import os
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import ArrayLike

from adaptmesh.domain.domain import Domain
from adaptmesh.mesh.checks import check_measurable
from adaptmesh.mesh.control_space import control_space_on
from adaptmesh.mesh.mesh import Mesh
from metrics import ControlSpace

from . import layers
from .colours import ELLIPSE, Bytes
from .ellipses import Ellipses, choose_ellipses, sample_vertices
from .frame import Bounds, Frame, bounding_box
from .legend import Pen, draw_header, draw_legend, draw_scale, draw_surroundings, format_count
from .number_labels import NumberLabel, draw_numbers, label_domain, make_domain_mesh
from .paint import (
    Entry,
    Paint,
    View,
    paint_lengths,
    paint_names,
    paint_plain,
    paint_quality,
    paint_regions,
    paint_sizes,
    paint_values,
)
from .plotter import check_path, make_plotter, silence_vtk, write_picture

if TYPE_CHECKING:
    import pyvista as pv

KINDS = ("mesh", "region", "quality", "length", "size")
ELLIPSES = 150  # drawn when the number is not given


def plot(
    mesh: Mesh | Domain,
    metric: Any = None,
    *,
    show: str | ArrayLike = "mesh",
    ellipses: bool | int = False,
    path: str | os.PathLike[str] | None = None,
    bounds: Bounds | None = None,
    title: str | None = None,
    cmap: str | None = None,
    edges: bool = True,
    window_size: tuple[int, int] | None = None,
    off_screen: bool | None = None,
) -> pv.Plotter | None:
    """Draw a mesh, or a domain with the numbers of its points and sides.

    Parameters
    ----------
    mesh : Mesh or Domain
        The sides of a domain (segments, or curves) are labelled with their numbers in bold, its
        points in pale grey, as counted by ``names`` and ``points``; curves are drawn as chords. For
        a domain, `show` is "mesh" or "region", and there is no metric.
    metric : optional
        As for `measure`. "length" and the ellipses show it; "quality" is measured in it, or in the
        Euclidean metric if there is none.
    show : {"mesh", "region", "quality", "length", "size"} or array_like
        What to colour by: nothing; the region of each triangle; its quality from 0 to 1; the
        metric length of each edge, on a logarithmic scale with unit edges in grey; the side of the
        equilateral triangle of the same area. Or numbers (n,) at the points or (m,) on the
        triangles; NaN and masked ones are grey and listed as missing in the legend.
    ellipses : bool or int, optional
        Draw the metric as unit ellipses over the mesh; a number is the maximum. Ellipses too small
        to see are enlarged, all by one factor, which the legend gives.
    path : path, optional
        File to write (.png, .jpg, .tif); then nothing is returned, and no display is needed.
    bounds : (x0, y0, x1, y1), optional
        Show only this part.
    title : str, optional
    cmap : str, optional
        A colour map of pyvista, instead of the default of `show`.
    edges : bool, optional
        Whether to draw the edges of the triangles; they are fainter where they are close together.
    window_size : (int, int), optional
        Width and height in pixels; by default the picture takes the shape of the domain.
    off_screen : bool, optional
        Passed to pyvista; always true with a path.

    Returns
    -------
    pyvista.Plotter or None
        The plotter if no path is given: ``plot(mesh).show()`` opens a window.

    Raises
    ------
    ValueError
        If `show` is unknown or of the wrong shape, a metric is missing, or the view is empty.
    FormatError
        If the picture cannot be written to the path.

    Examples
    --------
    >>> import adaptmesh as am
    >>> mesh = am.generate(am.Domain.rectangle(0, 0, 2, 1), 0.2)
    >>> am.plot(mesh, 0.2, show="length", path="lengths.png")    # doctest: +SKIP
    >>> am.plot(mesh, 0.2, show="quality", ellipses=True).show() # doctest: +SKIP
    """
    numbers: list[NumberLabel] = []
    if isinstance(mesh, Domain):
        _check_request_of_domain(metric, show, ellipses)
        numbers, mesh, edges = label_domain(mesh), make_domain_mesh(mesh), False
    check_measurable(mesh)
    target = None if path is None else check_path(path)
    field = None if metric is None else control_space_on(mesh, metric)
    max_count = ELLIPSES if ellipses is True else int(ellipses)
    visible, view = _find_view(mesh, bounds, window_size)
    _check_request(show, field, max_count)
    paint = _paint(view, show, field, cmap)
    lines, names = paint_names(view)

    has_legend = bool(paint.scale or paint.entries or names or max_count)
    frame = Frame.of(visible, window_size, bool(title), has_legend)
    with silence_vtk():
        plotter = make_plotter(frame, True if target is not None else off_screen)
        _draw_mesh(plotter, frame, view, paint, lines, edges)
        chosen = _draw_ellipses(plotter, frame, view, field, max_count)
        pen = Pen(plotter, frame)
        draw_surroundings(pen, outline=bounds is not None)
        caption = _draw_numbers_and_caption(pen, numbers) if numbers else _make_caption(mesh, frame)
        draw_header(pen, title, caption)
        _draw_legend_column(pen, paint, names, chosen)
        if target is None:
            return plotter
        write_picture(plotter, target)
    return None


def _check_request_of_domain(metric: Any, show: str | ArrayLike, ellipses: bool | int) -> None:
    if metric is not None or ellipses or not isinstance(show, str) or show not in KINDS[:2]:
        raise ValueError(
            "a domain is drawn without metric, ellipses or values, and with show='mesh' or "
            "'region': generate a mesh to see more"
        )


def _draw_numbers_and_caption(pen: Pen, numbers: list[NumberLabel]) -> str:
    """Draw the numbers, and return the caption."""
    drawn = draw_numbers(pen, numbers)
    sides = sum(number.is_side for number in numbers)
    words = f"{format_count(sides)} sides (bold), {format_count(len(numbers) - sides)} points"
    return (
        words if drawn == len(numbers) else f"{words}; {format_count(drawn)} of the numbers drawn"
    )


def _check_request(show: str | ArrayLike, field: ControlSpace | None, max_count: int) -> None:
    if isinstance(show, str) and show not in KINDS:
        raise ValueError(
            f"show: expected one of {', '.join(map(repr, KINDS))}, or numbers, got {show!r}"
        )
    if field is None and isinstance(show, str) and show == "length":
        raise ValueError("show='length' needs a metric: plot(mesh, metric, show='length')")
    if field is None and max_count:
        raise ValueError("ellipses need a metric: plot(mesh, metric, ellipses=True)")
    if max_count < 0:
        raise ValueError(f"ellipses: expected a number of at least 0, got {max_count}")


def _find_view(
    mesh: Mesh, bounds: Bounds | None, window_size: tuple[int, int] | None
) -> tuple[Bounds, View]:
    """Return the visible box and the part of the mesh in it; refuse an empty one."""
    if window_size is not None and not (window_size[0] >= 200 and window_size[1] >= 150):
        raise ValueError(f"window_size: expected at least (200, 150) pixels, got {window_size}")
    if bounds is None:
        bounds = bounding_box(mesh.points[mesh.triangles].reshape(-1, 2))
    elif not (bounds[0] < bounds[2] and bounds[1] < bounds[3] and np.isfinite(bounds).all()):
        raise ValueError(
            f"bounds: expected (x0, y0, x1, y1) with x0 < x1 and y0 < y1, got {bounds}"
        )
    view = View(mesh, bounds)
    if len(view.numbers) == 0:
        raise ValueError(f"bounds={bounds}: there is no triangle in this box")
    return bounds, view


def _paint(
    view: View, show: str | ArrayLike, field: ControlSpace | None, cmap: str | None
) -> Paint:
    if not isinstance(show, str):
        return paint_values(view, show, cmap)
    if show == "length" and field is not None:
        return paint_lengths(view, field, cmap)
    if show == "quality":
        return paint_quality(view, field, cmap)
    if show == "size":
        return paint_sizes(view, cmap)
    return paint_regions(view) if show == "region" else paint_plain(view)


def _draw_mesh(
    plotter: Any, frame: Frame, view: View, paint: Paint, lines: Bytes, edges: bool
) -> None:
    points = view.mesh.points
    layers.draw_faces(plotter, frame, points, view.triangles, paint.faces)
    if edges:
        spacing = layers.compute_edge_spacing(
            frame, points, view.triangles, view.sides, len(view.edges)
        )
        width, strength = paint.edge_width, paint.edge_strength
        layers.draw_edges(plotter, frame, points, view.edges, paint.edges, spacing, width, strength)
    layers.draw_lines(plotter, frame, points, view.mesh.edges[view.constrained], lines, 3.0)


def _draw_ellipses(
    plotter: Any, frame: Frame, view: View, field: ControlSpace | None, max_count: int
) -> Ellipses | None:
    if field is None or max_count == 0:
        return None
    vertices = sample_vertices(view, max_count)
    points = view.mesh.points[vertices]
    chosen = choose_ellipses(points, field(points), max_count, frame)
    layers.draw_ellipses(plotter, frame, chosen)
    return chosen


def _draw_legend_column(
    pen: Pen, paint: Paint, names: list[Entry], chosen: Ellipses | None
) -> None:
    """Draw, from the top down, the colour scale and the legends of regions, lines and ellipses."""
    frame = pen.frame
    y = frame.window[1] - frame.header
    if paint.scale is not None:
        y = draw_scale(pen, paint.scale, y, min(300 * frame.unit, 0.6 * y))
    if paint.entries:
        y = draw_legend(pen, paint.heading, paint.entries, y, 18)
    if names:
        y = draw_legend(pen, "lines", names, y, 4)
    if chosen is not None:
        times = "" if chosen.enlargement == 1 else f" × {chosen.enlargement:g}"
        draw_legend(pen, "metric", [(f"unit ellipses{times}", ELLIPSE)], y, 4)


def _make_caption(mesh: Mesh, frame: Frame) -> str:
    triangles, points = format_count(len(mesh.triangles)), format_count(len(mesh.points))
    words = f"{triangles} triangles, {points} points"
    for axis, scale in zip("xy", frame.axis_scale, strict=True):
        if scale > 1:
            words += f"; {axis} stretched × {scale:.3g}"
    return words
