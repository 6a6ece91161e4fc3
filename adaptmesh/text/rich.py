"""What rich can render, as plain text and for a notebook."""

from __future__ import annotations

from io import StringIO
from typing import TYPE_CHECKING

from rich.console import Console

if TYPE_CHECKING:
    from rich.console import RenderableType


def plain(renderable: RenderableType, width: int) -> str:
    """Text without colours, nor blanks at the ends of lines."""
    console = Console(file=StringIO(), width=width, color_system=None, highlight=False)
    with console.capture() as text:
        console.print(renderable)
    return "\n".join(line.rstrip() for line in text.get().rstrip().splitlines())


def html(renderable: RenderableType, width: int) -> str:
    """A block of HTML with the styles in it."""
    console = Console(file=StringIO(), width=width, record=True, highlight=False)
    console.print(renderable)
    frame = '<pre style="line-height:1.2;font-family:monospace">{code}</pre>'
    return console.export_html(inline_styles=True, code_format=frame)
