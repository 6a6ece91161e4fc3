"""The iterations of a loop as a table and as a picture."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING

import numpy as np
from rich.console import Group, RenderableType
from rich.table import Table
from rich.text import Text

from adaptmesh.text import html, plain

from .iteration import Iteration, counts_of, errors_of
from .records import STAGES, Seconds

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

WIDTH = 120
ORDER = 1.0  # of linear interpolation in L^p, in the number of vertices


def as_text(iterations: Sequence[Iteration], end: str) -> str:
    """The table in plain text, without colours; `end` says how the loop has ended."""
    return plain(as_renderable(iterations, end), WIDTH)


def as_html(iterations: Sequence[Iteration], end: str) -> str:
    """The table for a notebook."""
    return html(as_renderable(iterations, end), WIDTH)


def as_renderable(iterations: Sequence[Iteration], end: str) -> RenderableType:
    """The table for a rich console."""
    names = list(errors_of(iterations))
    table = Table(box=None, header_style="bold", padding=(0, 2, 0, 0))
    for heading in ("", "vertices", "triangles", *names, "unit edges"):
        table.add_column(Text(heading), justify="right")  # a text: names are no markup
    for stage in STAGES:
        table.add_column(f"{stage} s", justify="right", style="dim")
    for iteration in iterations:
        table.add_row(*_row(iteration, names))
    seconds = sum((iteration.seconds for iteration in iterations), Seconds())
    return Group(table, Text(end), Text(_times(seconds), style="dim"))


def _row(iteration: Iteration, names: list[str]) -> list[str]:
    i = iteration
    errors = [f"{i.errors[name]:.4e}" if name in i.errors else "" for name in names]
    unit = "" if np.isnan(i.unit_fraction) else f"{100 * i.unit_fraction:.2f} %"
    times = [f"{getattr(i.seconds, stage):.3f}" for stage in STAGES]
    return [str(i.number), f"{i.n_points:,}", f"{i.n_triangles:,}", *errors, unit, *times]


def _times(seconds: Seconds) -> str:
    share = 100 * seconds.share_of_library
    return f"{seconds.total:.2f} s in all, {share:.1f} % of it outside of solve"


def draw(iterations: Sequence[Iteration]) -> Figure:
    """Error against vertices beside what theory says, and both by iteration."""
    try:
        from matplotlib.figure import Figure
    except ModuleNotFoundError as error:
        raise ModuleNotFoundError(
            'histories are drawn by matplotlib: pip install "adaptmesh-metric[matplotlib]"'
        ) from error
    figure = Figure(figsize=(9, 4), layout="constrained")
    against, by_iteration = figure.subplots(1, 2)
    _draw_against_vertices(against, iterations)
    _draw_by_iteration(by_iteration, iterations)
    return figure


def _draw_against_vertices(axes: Axes, iterations: Sequence[Iteration]) -> None:
    from matplotlib.ticker import NullFormatter

    counts = counts_of(iterations)
    for name, errors in errors_of(iterations).items():
        (line,) = axes.loglog(counts, errors, "o-", ms=4, label=name)
        last = errors[-1]
        if len(counts) > 1 and last > 0:
            ends = np.array([counts.min(), counts.max()], float)
            axes.loglog(ends, last * (counts[-1] / ends) ** ORDER, ":", color=line.get_color())
    axes.plot([], [], "k:", label="1 / vertices")
    axes.xaxis.set_minor_formatter(NullFormatter())  # they overlap
    axes.set(xlabel="vertices", ylabel="estimate of error")
    axes.legend(frameon=False)


def _draw_by_iteration(axes: Axes, iterations: Sequence[Iteration]) -> None:
    steps = range(len(iterations))
    for name, errors in errors_of(iterations).items():
        axes.semilogy(steps, errors, "o-", ms=4, label=name)
    axes.set(xlabel="iteration", ylabel="estimate of error")
    counts = axes.twinx()
    counts.semilogy(steps, counts_of(iterations), "s--", ms=3, color="0.5")
    counts.set_ylabel("vertices (dashed)", color="0.4")
