"""Header, colour scale and legend beside the view, drawn in pixels."""

from __future__ import annotations

import itertools
from collections.abc import Sequence
from typing import Any

import numpy as np

from .colours import FADED, INK, PAPER, Bytes, Scale, rgb
from .frame import Frame

TEXT = 17  # pixels
MAX_ENTRIES = 14  # per legend


def escape(words: str) -> str:
    """Escape text for VTK, which takes a pair of $ for a formula and | for a column separator.

    VTK cannot draw | inside a text; the broken bar is drawn instead.
    """
    return words.replace("$", r"\$").replace("|", "\N{BROKEN BAR}")


class Pen:
    """Draws text and rectangles at pixel coordinates from the lower left corner of the window."""

    def __init__(self, plotter: Any, frame: Frame) -> None:
        self.plotter = plotter
        self.frame = frame

    def text(
        self,
        words: str,
        x: float,
        y: float,
        *,
        colour: str = INK,
        size: float = TEXT,
        bold: bool = False,
        right: bool = False,
    ) -> None:
        """Draw text from x on, or up to x if `right`, vertically centred at y."""
        from vtkmodules.vtkRenderingCore import vtkTextActor

        actor = vtkTextActor()
        actor.SetInput(escape(words))
        style = actor.GetTextProperty()
        style.SetFontFamilyToArial()
        style.SetFontSize(max(round(size * self.frame.unit), 6))
        style.SetColor(*(rgb(colour) / 255))
        style.SetBold(bold)
        style.SetVerticalJustificationToCentered()
        if right:
            style.SetJustificationToRight()
        where = actor.GetPositionCoordinate()
        where.SetCoordinateSystemToNormalizedViewport()
        where.SetValue(x / self.frame.window[0], y / self.frame.window[1])
        self.plotter.add_actor(actor, pickable=False)

    def rectangles(self, boxes: Sequence[Sequence[float]], colours: Bytes) -> None:
        """Fill boxes (x0, y0, x1, y1), each with its colour."""
        import pyvista as pv
        from vtkmodules.vtkRenderingCore import vtkActor2D, vtkCoordinate, vtkPolyDataMapper2D

        b = np.asarray(boxes, float) / np.tile(self.frame.window, 2)
        corners = b[:, [0, 1, 2, 1, 2, 3, 0, 3]].reshape(-1, 2)
        points = np.column_stack([corners, np.zeros(len(corners))])
        number = np.arange(len(points)).reshape(-1, 4)
        faces = np.column_stack([np.full(len(number), 4), number])
        shape = pv.PolyData(points, faces=faces.ravel())
        shape.cell_data["colour"] = colours
        shape.set_active_scalars("colour", preference="cell")
        mapper, viewport = vtkPolyDataMapper2D(), vtkCoordinate()
        viewport.SetCoordinateSystemToNormalizedViewport()
        mapper.SetInputData(shape)
        mapper.SetTransformCoordinate(viewport)
        actor = vtkActor2D()
        actor.SetMapper(mapper)
        self.plotter.add_actor(actor, pickable=False)


def draw_header(pen: Pen, title: str | None, caption: str) -> None:
    """Draw the title, and under it the caption in smaller letters."""
    frame, u = pen.frame, pen.frame.unit
    top = frame.window[1] - frame.margin / 2
    if title:
        pen.text(title, frame.margin, top - 14 * u, size=24, bold=True)
        pen.text(caption, frame.margin, top - 40 * u, colour=FADED, size=16)
    else:
        pen.text(caption, frame.margin, top - 20 * u, colour=FADED, size=16)


def draw_surroundings(pen: Pen, outline: bool) -> None:
    """Cover what is drawn beyond the overhang of the view; with an outline, beyond the view."""
    frame = pen.frame
    width, height = frame.window
    x0, y0, x1, y1 = frame.view
    if outline:
        sides = [
            (x0, y0, x1, y0 + 1),
            (x0, y1 - 1, x1, y1),
            (x0, y0, x0 + 1, y1),
            (x1 - 1, y0, x1, y1),
        ]
        pen.rectangles(sides, np.tile(rgb(FADED), (4, 1)))
    else:
        beyond = frame.overhang
        x0, y0, x1, y1 = x0 - beyond, y0 - beyond, x1 + beyond, y1 + beyond
    around = [(0, 0, width, y0), (0, y1, width, height), (0, y0, x0, y1), (x1, y0, width, y1)]
    pen.rectangles(around, np.tile(rgb(PAPER), (4, 1)))


def draw_scale(pen: Pen, scale: Scale, top: float, length: float) -> float:
    """Draw a vertical colour scale with ticks; return the y coordinate of its lower end."""
    u = pen.frame.unit
    x = pen.frame.window[0] - pen.frame.legend
    pen.text(scale.label, x, top - 10 * u, bold=True, size=16)
    high, low = top - 34 * u, top - 34 * u - length
    steps = np.linspace(low, high, len(scale.table) + 1)
    width = 18 * u
    pen.rectangles(
        [(x, y0, x + width, y1 + 0.5) for y0, y1 in itertools.pairwise(steps)],
        scale.table,
    )
    marks = []
    for tick in scale.ticks:
        y = low + float(scale.share(tick)) * (high - low)
        marks.append((x + width, y - 0.5, x + width + 5 * u, y + 0.5))
        pen.text(f"{tick:.3g}", x + width + 9 * u, y, size=15)
    if scale.band is not None:
        first, last, name = scale.band
        y0, y1 = (low + float(scale.share(v)) * (high - low) for v in (first, last))
        bar = x + width + 60 * u
        marks += [
            (bar, y0, bar + 3 * u, y1),
            (bar - 4 * u, y0, bar, y0 + 1),
            (bar - 4 * u, y1 - 1, bar, y1),
        ]
        pen.text(name, bar + 9 * u, (y0 + y1) / 2, size=16, bold=True)
    pen.rectangles(marks, np.tile(rgb(INK), (len(marks), 1)))
    return low - 28 * u


def draw_legend(
    pen: Pen, heading: str, entries: Sequence[tuple[str, str]], top: float, height: float
) -> float:
    """Draw a heading and names with coloured marks of a height; return the lower end."""
    u = pen.frame.unit
    x = pen.frame.window[0] - pen.frame.legend
    pen.text(heading, x, top - 10 * u, bold=True, size=16)
    y = top - 36 * u
    boxes, colours = [], []
    for name, colour in entries[:MAX_ENTRIES]:
        boxes.append((x, y - height / 2 * u, x + 18 * u, y + height / 2 * u))
        colours.append(rgb(colour))
        pen.text(_shorten(name), x + 28 * u, y, size=16)
        y -= 25 * u
    pen.rectangles(boxes, np.array(colours))
    if len(entries) > MAX_ENTRIES:
        rest = len(entries) - MAX_ENTRIES
        pen.text(f"and {rest} more", x + 28 * u, y, colour=FADED, size=16)
        y -= 25 * u
    return y - 14 * u


def _shorten(name: str, max_length: int = 20) -> str:
    return name if len(name) <= max_length else name[: max_length - 1] + "…"


def format_count(number: int) -> str:
    """Format a number with spaces between thousands."""
    return f"{number:,}".replace(",", " ")
