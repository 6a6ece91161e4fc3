"""Progress and results of the commands that make a mesh."""

from __future__ import annotations

import time
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any

from adaptmesh.mesh.mesh import Mesh
from metrics import ControlSpace

from .output import Reporter


@contextmanager
def show_progress(
    reporter: Reporter, max_vertices: int | None, placement: str | None
) -> Iterator[dict[str, Any]]:
    """Show a progress bar in a block; yield the options of `generate` and `adapt` given."""
    from .progress import TerminalProgress

    given = {"max_vertices": max_vertices, "placement": placement}
    options = {name: value for name, value in given.items() if value is not None}
    start = time.perf_counter()
    if reporter.is_silent:
        yield options
    else:
        with TerminalProgress() as progress:
            yield {**options, "progress": progress}
    seconds = time.perf_counter() - start
    reporter.print(f"meshed in {seconds:.2f} s")
    reporter.record(seconds=seconds)


def write_results(
    mesh: Mesh, control: ControlSpace, output: Path, plot: Path | None, reporter: Reporter
) -> None:
    """Write the mesh and its picture, and report how well the mesh fits the metric."""
    import adaptmesh as am

    am.write(output, mesh)
    if plot is not None:
        am.plot(mesh, path=plot)
    if reporter.is_silent and not reporter.as_json:
        return
    report = am.measure(mesh, control)
    reporter.print(report)
    reporter.print(f"wrote {output}: {format_counts(mesh)}")
    if plot is not None:
        reporter.print(f"wrote {plot}")
        reporter.record(plot=str(plot))
    reporter.record(output=str(output), vertices=len(mesh.points), triangles=len(mesh.triangles))
    reporter.record(report=report.as_dict())
    reporter.finish()


def format_counts(mesh: Mesh) -> str:
    return f"{len(mesh.points):,} vertices, {len(mesh.triangles):,} triangles"
