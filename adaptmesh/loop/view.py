"""A history as a table and as a picture."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
from rich.console import Group, RenderableType
from rich.table import Table
from rich.text import Text

from adaptmesh.text import html, plain

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

    from .history import History, Iteration, Seconds

WIDTH = 120
ORDER = 1.0  # of linear interpolation in L^p, in the number of vertices


def as_text(history: History) -> str:
    """The table in plain text, without colours."""
    return plain(as_renderable(history), WIDTH)


def as_html(history: History) -> str:
    """The table for a notebook."""
    return html(as_renderable(history), WIDTH)


def as_renderable(history: History) -> RenderableType:
    """The table for a rich console."""
    table = Table(box=None, header_style="bold", padding=(0, 2, 0, 0))
    for heading in ("", "vertices", "triangles", *history.errors, "unit edges"):
        table.add_column(Text(heading), justify="right")  # a text: names are no markup
    for heading in ("adapt", "transfer", "solve", "metric"):
        table.add_column(f"{heading} s", justify="right", style="dim")
    names = list(history.errors)
    for iteration in history:
        table.add_row(*_row(iteration, names))
    return Group(table, Text(_end(history)), Text(_times(history.seconds), style="dim"))


def _row(iteration: Iteration, names: list[str]) -> list[str]:
    i, s = iteration, iteration.seconds
    errors = [f"{i.errors[name]:.4e}" if name in i.errors else "" for name in names]
    unit = "" if np.isnan(i.unit_fraction) else f"{100 * i.unit_fraction:.2f} %"
    times = [f"{t:.3f}" for t in (s.adapt, s.transfer, s.solve, s.metric)]
    return [str(i.number), f"{i.n_points:,}", f"{i.n_triangles:,}", *errors, unit, *times]


def _end(history: History) -> str:
    if not history.reason:
        return "not ended"
    return f"{'converged' if history.converged else 'not converged'}: {history.reason}"


def _times(seconds: Seconds) -> str:
    share = 100 * seconds.share_of_library
    return f"{seconds.total:.2f} s in all, {share:.1f} % of it outside of solve"


def draw(history: History) -> Figure:
    """Error against vertices beside what theory says, and both by iteration."""
    from matplotlib.figure import Figure

    figure = Figure(figsize=(9, 4), layout="constrained")
    against, by_iteration = figure.subplots(1, 2)
    _draw_against_vertices(against, history)
    _draw_by_iteration(by_iteration, history)
    return figure


def _draw_against_vertices(axes: Axes, history: History) -> None:
    from matplotlib.ticker import NullFormatter

    counts = history.counts
    for name, errors in history.errors.items():
        (line,) = axes.loglog(counts, errors, "o-", ms=4, label=name)
        last = errors[-1]
        if len(counts) > 1 and last > 0:
            ends = np.array([counts.min(), counts.max()], float)
            axes.loglog(ends, last * (counts[-1] / ends) ** ORDER, ":", color=line.get_color())
    axes.plot([], [], "k:", label="1 / vertices")
    axes.xaxis.set_minor_formatter(NullFormatter())  # they overlap
    axes.set(xlabel="vertices", ylabel="estimate of error")
    axes.legend(frameon=False)


def _draw_by_iteration(axes: Axes, history: History) -> None:
    steps = range(len(history))
    for name, errors in history.errors.items():
        axes.semilogy(steps, errors, "o-", ms=4, label=name)
    axes.set(xlabel="iteration", ylabel="estimate of error")
    counts = axes.twinx()
    counts.semilogy(steps, history.counts, "s--", ms=3, color="0.5")
    counts.set_ylabel("vertices (dashed)", color="0.4")
