"""How reports and messages are written: coordinates, and what rich renders."""

from __future__ import annotations

import math
from collections.abc import Sequence
from io import StringIO
from typing import TYPE_CHECKING

from .types import Floats

if TYPE_CHECKING:
    from rich.console import RenderableType

USUAL, ALL = 5, 17
"""Digits that a coordinate has if nothing asks for more, and that a double has."""


def place_text(point: Sequence[float] | Floats, length: float) -> str:
    """The coordinates of a point, to a thousandth of a length that is found there.

    Far from the origin, as in metres of UTM, five digits would not tell the ends of an edge apart.
    """
    x, y = float(point[0]), float(point[1])
    digits = USUAL
    if 0 < length < math.inf and (largest := max(abs(x), abs(y))) > 0:
        digits = math.floor(math.log10(largest)) - math.floor(math.log10(length)) + 4
    digits = min(max(digits, USUAL), ALL)
    return f"({x:.{digits}g}, {y:.{digits}g})"


def plain(renderable: RenderableType, width: int) -> str:
    """Text without colours, nor blanks at the ends of lines."""
    from rich.console import Console

    console = Console(file=StringIO(), width=width, color_system=None, highlight=False)
    with console.capture() as text:
        console.print(renderable)
    return "\n".join(line.rstrip() for line in text.get().rstrip().splitlines())


def html(renderable: RenderableType, width: int) -> str:
    """A block of HTML with the styles in it."""
    from rich.console import Console

    console = Console(file=StringIO(), width=width, record=True, highlight=False)
    console.print(renderable)
    frame = '<pre style="line-height:1.2;font-family:monospace">{code}</pre>'
    return console.export_html(inline_styles=True, code_format=frame)
