"""`plot`: one picture of a mesh, layer by layer."""

from __future__ import annotations

import os
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import ArrayLike

from adaptmesh.domain.domain import Domain
from adaptmesh.mesh.checks import check_measurable
from adaptmesh.mesh.control_space import control_space_on
from metrics import ControlSpace

from . import layers
from .colours import ELLIPSE, Bytes
from .ellipses import Ellipses, candidates, choose
from .frame import Bounds, Frame, bounds_of
from .key import Pen, count, draw_header, draw_legend, draw_scale, draw_surroundings
from .numbers import Number, draw_numbers, mesh_of_domain, numbers_of
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
from .screen import check_path, make_plotter, quiet, write_picture

if TYPE_CHECKING:
    import pyvista as pv

    from adaptmesh.mesh.mesh import Mesh

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
        Of a domain, sides are numbered in bold as ``names`` count them (segments, or curves), and
        points, pale, as ``points`` does; curves are drawn by their chords. `show` may be "mesh" or
        "region", and there are no metric and no ellipses then.
    metric : optional
        Anything that `measure` takes; what "length" and the ellipses show, and what "quality" is
        measured in (without one, in plain geometry).
    show : {"mesh", "region", "quality", "length", "size"} or array_like
        What the colours mean: nothing; the region of each triangle; its quality from 0 to 1; the
        metric length of each edge, on a logarithmic scale that sets unit edges apart; the side of
        the equilateral triangle of the same area. Or numbers (n,) at the points or (m,) on the
        triangles; NaN and masked ones are grey, and the legend says so.
    ellipses : bool or int, optional
        Draw the metric as ellipses of its unit vectors over the mesh, so many at most. Where they
        would be too small to see they are all enlarged, and the legend says by how much.
    path : path, optional
        Write the picture there (.png, .jpg, .tif) and return nothing. It needs no display.
    bounds : (x0, y0, x1, y1), optional
        Look at this part only.
    title : str, optional
    cmap : str, optional
        A colour map that pyvista knows, in place of the own one.
    edges : bool, optional
        Whether to draw the edges of the triangles. They fade where they crowd.
    window_size : (int, int), optional
        Width and height in pixels; by default the picture takes the shape of the domain.
    off_screen : bool, optional
        Passed on to pyvista; true if there is a path.

    Returns
    -------
    pyvista.Plotter or None
        The plotter if there is no path: ``plot(mesh).show()`` opens a window.

    Raises
    ------
    ValueError
        An unknown `show`, or numbers that do not fit; no metric where one is needed; an empty view.
    FormatError
        The picture cannot be written there.

    Examples
    --------
    >>> import adaptmesh as am
    >>> mesh = am.generate(am.Domain.rectangle(0, 0, 2, 1), 0.2)
    >>> am.plot(mesh, 0.2, show="length", path="lengths.png")    # doctest: +SKIP
    >>> am.plot(mesh, 0.2, show="quality", ellipses=True).show() # doctest: +SKIP
    """
    numbers: list[Number] = []
    if isinstance(mesh, Domain):
        _check_request_of_domain(metric, show, ellipses)
        numbers, mesh, edges = numbers_of(mesh), mesh_of_domain(mesh), False
    check_measurable(mesh)
    target = None if path is None else check_path(path)
    field = None if metric is None else control_space_on(mesh, metric)
    most = ELLIPSES if ellipses is True else int(ellipses)
    seen, view = _checked_view(mesh, bounds, window_size)
    _check_request(show, field, most)
    paint = _paint(view, show, field, cmap)
    lines, names = paint_names(view)

    has_key = bool(paint.scale or paint.entries or names or most)
    frame = Frame.of(seen, window_size, bool(title), has_key)
    with quiet():
        plotter = make_plotter(frame, True if target is not None else off_screen)
        _draw_mesh(plotter, frame, view, paint, lines, edges)
        chosen = _draw_ellipses(plotter, frame, view, field, most)
        pen = Pen(plotter, frame)
        draw_surroundings(pen, outline=bounds is not None)
        caption = _caption_of_domain(pen, numbers) if numbers else _caption(mesh, frame)
        draw_header(pen, title, caption)
        _draw_key(pen, paint, names, chosen)
        if target is None:
            return plotter
        write_picture(plotter, target)
    return None


def _check_request_of_domain(metric: Any, show: str | ArrayLike, ellipses: bool | int) -> None:
    if metric is not None or ellipses or not isinstance(show, str) or show not in KINDS[:2]:
        raise ValueError(
            "a domain is drawn without metric, ellipses or values, show='mesh' or 'region': mesh "
            "it to see more"
        )


def _caption_of_domain(pen: Pen, numbers: list[Number]) -> str:
    """What is numbered, after the numbers were drawn."""
    drawn = draw_numbers(pen, numbers)
    sides = sum(number.is_side for number in numbers)
    words = f"{count(sides)} sides (bold), {count(len(numbers) - sides)} points"
    return words if drawn == len(numbers) else f"{words}; {count(drawn)} numbers have room"


def _check_request(show: str | ArrayLike, field: ControlSpace | None, most: int) -> None:
    if isinstance(show, str) and show not in KINDS:
        raise ValueError(f"show={show!r} is none of {', '.join(map(repr, KINDS))}, nor numbers")
    if field is None and isinstance(show, str) and show == "length":
        raise ValueError("show='length': the length in which metric? give it: plot(mesh, metric)")
    if field is None and most:
        raise ValueError("ellipses of which metric? give it: plot(mesh, metric, ellipses=True)")
    if most < 0:
        raise ValueError(f"ellipses={most}: a number of ellipses is wanted, not less than 0")


def _checked_view(
    mesh: Mesh, bounds: Bounds | None, window_size: tuple[int, int] | None
) -> tuple[Bounds, View]:
    """What is looked at: the box, and the part of the mesh in it."""
    if window_size is not None and not (window_size[0] >= 200 and window_size[1] >= 150):
        raise ValueError(f"window_size={window_size}: at least (200, 150) pixels are wanted")
    if bounds is None:
        bounds = bounds_of(mesh.points[mesh.triangles].reshape(-1, 2))
    elif not (bounds[0] < bounds[2] and bounds[1] < bounds[3] and np.isfinite(bounds).all()):
        raise ValueError(f"bounds={bounds}: (x0, y0, x1, y1) with x0 < x1 and y0 < y1 are wanted")
    view = View(mesh, bounds)
    if len(view.numbers) == 0:
        raise ValueError(f"bounds={bounds}: no triangle is in sight")
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
        spacing = layers.edge_spacing(frame, points, view.triangles, view.sides, len(view.edges))
        width, strength = paint.edge_width, paint.edge_strength
        layers.draw_edges(plotter, frame, points, view.edges, paint.edges, spacing, width, strength)
    layers.draw_lines(plotter, frame, points, view.mesh.edges[view.constrained], lines, 3.0)


def _draw_ellipses(
    plotter: Any, frame: Frame, view: View, field: ControlSpace | None, most: int
) -> Ellipses | None:
    if field is None or most == 0:
        return None
    vertices = candidates(view, most)
    places = view.mesh.points[vertices]
    chosen = choose(places, field(places), most, frame)
    layers.draw_ellipses(plotter, frame, chosen)
    return chosen


def _draw_key(pen: Pen, paint: Paint, names: list[Entry], chosen: Ellipses | None) -> None:
    """Colour scale, regions, names of lines, ellipses, from the top down."""
    frame = pen.frame
    y = frame.window[1] - frame.header
    if paint.scale is not None:
        y = draw_scale(pen, paint.scale, y, min(300 * frame.unit, 0.6 * y))
    if paint.entries:
        y = draw_legend(pen, paint.heading, paint.entries, y, 18)
    if names:
        y = draw_legend(pen, "lines", names, y, 4)
    if chosen is not None:
        times = "" if chosen.enlarged == 1 else f" × {chosen.enlarged:g}"
        draw_legend(pen, "metric", [(f"unit ellipses{times}", ELLIPSE)], y, 4)


def _caption(mesh: Mesh, frame: Frame) -> str:
    words = f"{count(len(mesh.triangles))} triangles, {count(len(mesh.points))} points"
    for axis, stretch in zip("xy", frame.stretch, strict=True):
        if stretch > 1:
            words += f"; {axis} stretched × {stretch:.3g}"
    return words
