"""A report as a table that a person reads, in plain text or in colour, by rich."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from rich.console import Group, RenderableType
from rich.padding import Padding
from rich.table import Table
from rich.text import Text

from adaptmesh.text import html, place_text, plain

from .figures import Figures, Point
from .reasons import Cause, Reason

WIDTH = 100
ROWS = 6  # height of the histograms
SHOWN = 3  # worst edges and triangles
EIGHTHS = " ▁▂▃▄▅▆▇█"


def as_text(report: Figures) -> str:
    """The report in plain text, without colours."""
    return plain(as_renderable(report), WIDTH)


def as_html(report: Figures) -> str:
    """The report for a notebook."""
    return html(as_renderable(report), WIDTH)


def as_renderable(report: Figures) -> RenderableType:
    """The report for a rich console."""
    histograms = Table.grid(padding=(0, 6, 0, 0))
    histograms.add_row(_length_histogram(report), _quality_histogram(report))
    parts: list[RenderableType] = [
        Text("Unit mesh report", style="bold"),
        Text("─" * 72, style="dim"),
        _key_figures(report),
        Padding(histograms, (1, 0, 1, 0)),
        _worst(report),
        Text(f"lengths: {report.length_rule}", style="dim"),
    ]
    if report.border:
        parts.append(Text(f"border: {report.border}", style="dim"))
    return Padding(Group(*parts), (0, 0, 0, 1))


def _key_figures(report: Figures) -> Table:
    r = report
    table = Table.grid(padding=(0, 3, 0, 0))
    table.add_column(style="dim")
    table.add_column(justify="right", style="bold")
    table.add_column()
    quantiles = r.length_quantiles
    rows = [
        ("mesh", _count(r.n_triangles), f"triangles, {_count(r.n_points)} points"),
        (
            "ideal",
            _count(r.ideal_triangles),
            f"triangles = (4/√3) C, complexity C {r.complexity:.6g}",
        ),
        ("count ratio", f"{r.count_ratio:.3f}", "triangles / ideal"),
        ("unit edges", percent(r.unit_fraction), f"of {_count(r.n_edges)}, in [1/√2, √2]"),
        ("", percent(r.short_fraction), "shorter"),
        ("", percent(r.long_fraction), "longer"),
        (
            "edge length",
            f"{quantiles[0.5]:.3f}",
            f"median; 1 % {quantiles[0.01]:.3f}, 99 % {quantiles[0.99]:.3f}; "
            f"min {r.length_min:.3g}, max {r.length_max:.3g}",
        ),
        (
            "efficiency index",
            f"{r.efficiency_index:.4f}",
            "1 − mean (1 − min(ℓ, 1/ℓ))², Borouchaki et al.",
        ),
        ("", f"{r.efficiency_index_frey_george:.4f}", "exp mean (min(ℓ, 1/ℓ) − 1), Frey–George"),
        (
            "quality",
            f"{r.quality_mean:.3f}",
            f"mean; 1 % {r.quality_p1:.3f}, min {r.quality_min:.3g}",
        ),
    ]
    for row in rows:
        table.add_row(*row)
    return table


def _length_histogram(report: Figures) -> Group:
    """A column for each eighth of an octave, those of unit edges over a heavy line."""
    counts = report.length_histogram.counts
    unit = [0.7 < low < 1.4 for low in report.length_histogram.edges[:-1]]
    return Group(
        Text("edge length", style="dim"),
        *_columns(counts, unit),
        Text("".join("━" if inside else "─" for inside in unit)),
        Text(" .35 .5  .7  1   1.4 2   2.8"),
        Text("         ╰ unit ╯", style="green"),
    )


def _quality_histogram(report: Figures) -> Group:
    """A column for each twentieth."""
    counts = report.quality_histogram.counts
    return Group(
        Text("quality", style="dim"),
        *_columns(counts, [True] * len(counts)),
        Text("─" * len(counts)),
        Text("0         .5        1"),
    )


def _columns(counts: Sequence[int], good: Sequence[bool]) -> list[Text]:
    """Columns of blocks, line by line from the top; nothing that was counted is invisible."""
    tallest = max(counts)
    heights = [max(round(8 * ROWS * n / tallest), 1) if n else 0 for n in counts]
    lines = []
    for floor in range(8 * (ROWS - 1), -1, -8):
        line = Text()
        for height, fine in zip(heights, good, strict=True):
            line.append(EIGHTHS[min(max(height - floor, 0), 8)], "green" if fine else "yellow")
        lines.append(line)
    return lines


def _worst(report: Figures) -> Table:
    table = Table.grid(padding=(0, 3, 0, 0))
    table.add_column(justify="right", style="bold")
    table.add_column()
    table.add_column(style="dim")
    table.add_row("length", "worst edges", "")
    for edge in report.worst_edges[:SHOWN]:
        between = f"{edge.vertices[0]}–{edge.vertices[1]}"
        table.add_row(f"{edge.length:.4g}", between, _ends(edge.start, edge.end))
        _add_reason(table, edge.reason)
    table.add_row("quality", "worst triangles", "")
    for triangle in report.worst_triangles[:SHOWN]:
        corners = np.array(triangle.corners)
        around = place_text(corners.mean(axis=0), float(np.ptp(corners, axis=0).max()))
        table.add_row(f"{triangle.quality:.4g}", str(triangle.triangle), f"around {around}")
        _add_reason(table, triangle.reason)
    return table


def _add_reason(table: Table, reason: Reason) -> None:
    if reason.cause is not Cause.MET:
        table.add_row("", "", str(reason))


def _ends(start: Point, end: Point) -> str:
    apart = float(np.ptp([start, end], axis=0).max())
    return f"{place_text(start, apart)} to {place_text(end, apart)}"


def _count(number: float) -> str:
    return f"{round(number):,}".replace(",", " ")  # a thin space


def percent(share: float) -> str:
    """A share in per cent that is 100 or 0 only if it is exactly so."""
    text = f"{100 * share:.2f}"
    if (share < 1 and text == "100.00") or (share > 0 and text == "0.00"):
        text = f"{100 * share:.6f}".rstrip("0")
    return f"{text} %"
