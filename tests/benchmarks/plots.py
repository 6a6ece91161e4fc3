"""The plots of docs/performance.md."""

from __future__ import annotations

import matplotlib as mpl
import numpy as np
from matplotlib.figure import Figure

COLOURS = {
    "adaptmesh": "#d1495b",
    "BAMG": "#30638e",
    "MMG2D": "#00798c",
    "Gmsh": "#edae49",
    "Triangle": "#8d96a3",
}
LEVEL = 10_000
NO_LESS = 1e-4  # shares of edges below this are drawn as this


def plot_all(results, folder):
    style = {"svg.fonttype": "none", "svg.hashsalt": "adaptmesh", "font.size": 9}
    style |= {"axes.spines.top": False, "axes.spines.right": False}
    with mpl.rc_context(style):
        rows = [row for row in results["rows"] if "failed" not in row]
        level = [row for row in rows if row["level"] == LEVEL]
        save(bars_of_time(level), folder / "performance_time.svg")
        save(bars_of_length(level), folder / "performance_unit.svg")
        save(lines_of_size(rows), folder / "performance_size.svg")
        save(bars_of_phases(results["phases"]), folder / "performance_phases.svg")


def save(figure, path):
    figure.savefig(path, metadata={"Date": None}, bbox_inches="tight")


def grouped(axes, rows, value):
    """For each case a group of bars, one for each mesher."""
    cases = list(dict.fromkeys(row["case"] for row in rows))
    width = 0.8 / len(COLOURS)
    for k, (mesher, colour) in enumerate(COLOURS.items()):
        mine = [row for row in rows if row["mesher"] == mesher]
        x = [cases.index(row["case"]) + (k - (len(COLOURS) - 1) / 2) * width for row in mine]
        axes.bar(x, [value(row) for row in mine], width, color=colour, label=mesher)
    axes.set_xticks(range(len(cases)), cases)
    axes.set_yscale("log")
    axes.grid(axis="y", alpha=0.3)
    axes.legend(frameon=False, ncols=len(COLOURS), loc="lower left", bbox_to_anchor=(0, 1))


def bars_of_time(rows):
    figure = Figure(figsize=(9, 3.2))
    axes = figure.subplots()
    grouped(axes, rows, lambda row: 1e6 * row["cpu"] / row["triangles"])
    axes.set_ylabel("µs a triangle, last pass alone")
    return figure


def bars_of_length(rows):
    figure = Figure(figsize=(9, 3.2))
    axes = figure.subplots()
    grouped(axes, rows, lambda row: 100 * max(1 - row["unit"], NO_LESS))
    axes.set_ylabel("% of the edges not unit")
    return figure


def lines_of_size(rows):
    figure = Figure(figsize=(9, 3.2))
    for axes, case in zip(figure.subplots(1, 2, sharey=True), ("radial", "ring"), strict=True):
        for mesher, colour in COLOURS.items():
            mine = [row for row in rows if (row["case"], row["mesher"]) == (case, mesher)]
            mine.sort(key=lambda row: row["triangles"])
            n = np.array([row["triangles"] for row in mine])
            for key, dashes in (("cpu", "-"), ("total_cpu", ":")):
                cost = 1e6 * np.array([row[key] for row in mine]) / n
                label = mesher if key == "cpu" and len(mine) else None
                axes.plot(n, cost, dashes, marker=".", color=colour, label=label)
        axes.set(xscale="log", yscale="log", xlabel="triangles", title=case)
        axes.grid(alpha=0.3)
        axes.legend(frameon=False, fontsize=8)
    figure.axes[0].set_ylabel("µs of CPU a triangle\nlast pass (line), all passes (dots)")
    return figure


def bars_of_phases(stages):
    figure = Figure(figsize=(9, 0.5 * len(stages) + 0.8))
    axes = figure.subplots()
    names = [name for name in stages[0]["seconds"] if any(s["seconds"][name] > 0 for s in stages)]
    colours = mpl.colormaps["tab20"].colors
    left = np.zeros(len(stages))
    for name, colour in zip(names, colours, strict=False):
        seconds = np.array([stage["seconds"][name] for stage in stages])
        total = np.array([sum(stage["seconds"].values()) for stage in stages])
        axes.barh(range(len(stages)), 100 * seconds / total, left=left, color=colour, label=name)
        left += 100 * seconds / total
    axes.set_yticks(range(len(stages)), [f"{s['case']}, {s['level']:,}" for s in stages])
    axes.invert_yaxis()
    axes.set_xlabel("% of the CPU time")
    axes.legend(frameon=False, ncols=6, loc="lower left", bbox_to_anchor=(0, 1))
    return figure
