"""The command line: ``adaptmesh generate | adapt | check | repair | plot | convert | demo``.

Commands are thin: each reads, calls the one library function of its name, and says what came of
it. Heavy modules are imported inside the commands, so that ``--help`` comes at once.

Results are printed to standard output; progress, warnings and errors go to standard error.
Exit codes: 0 done, 1 bad mesh, domain, metric or file, 2 wrong usage, 130 interrupted.
"""

from __future__ import annotations

import time
import warnings
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any, NoReturn

import typer

from .cli_arguments import (
    MaxVertices,
    MeshFile,
    Metric,
    OutlineFile,
    Output,
    Picture,
    Placement,
    Quiet,
    Show,
    Size,
    Tolerance,
)
from .errors import AdaptmeshError, FormatError

if TYPE_CHECKING:
    from metrics import ControlSpace

    from .domain import Domain
    from .mesh import Mesh

EXIT_BAD = 1
EXIT_INTERRUPTED = 130

app = typer.Typer(
    name="adaptmesh",
    no_args_is_help=True,
    add_completion=False,
    pretty_exceptions_enable=False,
    rich_markup_mode="rich",
    context_settings={"help_option_names": ["-h", "--help"]},
    help="Mesh planar domains with triangles whose edges have the length that a metric asks for.",
    epilog="Exit codes: 0 done; 1 the mesh, domain, metric or file is bad; 2 wrong usage; "
    "130 interrupted.",
)


def _print_version(wanted: bool) -> None:
    if wanted:
        from importlib.metadata import version

        typer.echo(f"adaptmesh {version('adaptmesh-metric')}")
        raise typer.Exit


@app.callback()
def _options(
    version: Annotated[
        bool,
        typer.Option(
            "--version", callback=_print_version, is_eager=True, help="Print the version."
        ),
    ] = False,
) -> None:
    pass


@app.command(
    epilog="Example: adaptmesh generate coast.geojson --size '1 + 0.1*hypot(x, y)' -o a.vtu"
)
def generate(
    domain: OutlineFile,
    output: Output,
    size: Size = None,
    metric: Metric = None,
    plot: Picture = None,
    max_vertices: MaxVertices = None,
    placement: Placement = None,
    repair: Annotated[
        bool, typer.Option("--repair", help="Repair the domain first, and say what was done.")
    ] = False,
    tolerance: Tolerance = None,
    quiet: Quiet = False,
) -> None:
    """Mesh a domain: polygons, curves, a drawing, or the domain of another mesh."""
    with _neat_errors():
        import adaptmesh as am

        _check_outputs(output, plot)
        outline, carrier = _outline_and_mesh(domain, repair, tolerance, quiet)
        control = _control_space(size, metric, carrier)
        if not quiet:
            typer.echo(f"predicted: about {round(am.predict(outline, control)):,} vertices")
        with _meshing(quiet, max_vertices, placement) as options:
            mesh = am.generate(outline, control, **options)
        _deliver(mesh, control, output, plot, quiet)


@app.command(epilog="Example: adaptmesh adapt old.mesh --metric old.sol -o new.mesh")
def adapt(
    mesh: MeshFile,
    output: Output,
    size: Size = None,
    metric: Metric = None,
    plot: Picture = None,
    max_vertices: MaxVertices = None,
    placement: Placement = None,
    quiet: Quiet = False,
) -> None:
    """Adapt a mesh to a metric, keeping its boundaries, regions and names."""
    with _neat_errors():
        import adaptmesh as am

        _check_outputs(output, plot)
        old = am.read(mesh)
        control = _control_space(size, metric, old)
        with _meshing(quiet, max_vertices, placement) as options:
            new = am.adapt(old, control, **options)
        _deliver(new, control, output, plot, quiet)


@app.command(epilog="Example: adaptmesh check part.msh --size 0.05")
def check(mesh: MeshFile, size: Size = None, metric: Metric = None) -> None:
    """Check that a mesh is valid (exit code 0, else 1), and how well it fits a metric."""
    with _neat_errors():
        import adaptmesh as am

        checked = am.read(mesh)
        validity = checked.validate()
        typer.echo(str(validity))
        if size is not None or metric is not None:
            typer.echo(f"\n{am.measure(checked, _control_space(size, metric, checked))}")
        if not validity.ok:
            raise typer.Exit(EXIT_BAD)


@app.command(epilog="Example: adaptmesh repair coast.geojson --tolerance 0.01 -o clean.geojson")
def repair(
    domain: OutlineFile,
    output: Annotated[Path, typer.Option("--output", "-o", metavar="FILE.geojson", dir_okay=False)],
    tolerance: Tolerance = None,
    quiet: Quiet = False,
) -> None:
    """Repair an outline, say what was done, and write the regions as polygons."""
    with _neat_errors():
        import adaptmesh as am

        from .geojson import GEOJSON_SUFFIXES, write_geojson

        if output.suffix.lower() not in GEOJSON_SUFFIXES:
            raise typer.BadParameter(f"--output ends in {' or '.join(GEOJSON_SUFFIXES)}")
        clean, repairs = am.repair(domain, tolerance)
        if not quiet:
            typer.echo(f"{repairs}")
        write_geojson(output, clean)
        if not quiet:
            typer.echo(f"wrote {output}: {len(clean.points):,} points")


@app.command(
    epilog="Example: adaptmesh plot wing.vtu --show length --size '0.01 + 0.1*y' -o wing.png"
)
def plot(
    mesh: MeshFile,
    output: Annotated[
        Path,
        typer.Option("--output", "-o", metavar="PNG", dir_okay=False, help="Picture to write."),
    ],
    show: Annotated[Show, typer.Option(help="What to colour the triangles by.")] = Show.mesh,
    size: Size = None,
    metric: Metric = None,
    ellipses: Annotated[
        bool, typer.Option("--ellipses", help="Draw the metric as unit ellipses.")
    ] = False,
) -> None:
    """Draw a mesh: its triangles, quality, edge lengths, sizes or regions."""
    with _neat_errors():
        import adaptmesh as am

        wanted = size is not None or metric is not None
        if (ellipses or show is Show.length) and not wanted:
            raise typer.BadParameter("of which metric? Give --size or --metric")
        _check_outputs(picture=output)
        drawn = am.read(mesh)
        control = _control_space(size, metric, drawn) if wanted else None
        am.plot(drawn, control, show=show.value, ellipses=ellipses, path=output)
        typer.echo(f"wrote {output}")


@app.command(epilog="Example: adaptmesh convert part.msh part.vtu")
def convert(
    source: MeshFile,
    target: Annotated[Path, typer.Argument(metavar="OUT", dir_okay=False, help="Mesh to write.")],
) -> None:
    """Write a mesh in another format, told by the suffix."""
    with _neat_errors():
        import adaptmesh as am

        _check_outputs(target)
        mesh = am.read(source)
        am.write(target, mesh)
        typer.echo(f"wrote {target}: {_counts(mesh)}")


@app.command(epilog="Example: adaptmesh demo --out pictures")
def demo(
    out: Annotated[
        Path, typer.Option(metavar="DIR", file_okay=False, help="Folder for meshes and pictures.")
    ] = Path("adaptmesh-demo"),
) -> None:
    """Mesh the coast of Iceland and the flow around an aerofoil, and draw them."""
    with _neat_errors():
        from .demo import run

        out.mkdir(parents=True, exist_ok=True)
        run(out, say=typer.echo)


def main() -> None:
    """Run the command line (the `adaptmesh` script)."""
    warnings.showwarning = _show_warning
    app(prog_name="adaptmesh")


@contextmanager
def _neat_errors() -> Iterator[None]:
    """Turn what the user can mend into a message and an exit code; let our own mistakes show."""
    try:
        yield
    except AdaptmeshError as error:
        _fail(str(error))
    except BrokenPipeError:
        raise  # the reader of our output has left, as in `| head`; typer ends quietly
    except OSError as error:
        _fail(f"{error.filename or 'a file'}: {error.strerror or error}")
    except KeyboardInterrupt:
        typer.echo("interrupted", err=True)
        raise typer.Exit(EXIT_INTERRUPTED) from None


def _fail(message: str) -> NoReturn:
    typer.echo(typer.style("error: ", fg=typer.colors.RED, bold=True) + message, err=True)
    raise typer.Exit(EXIT_BAD) from None


def _show_warning(message: Warning | str, *_: object, **__: object) -> None:
    typer.echo(typer.style("warning: ", fg=typer.colors.YELLOW, bold=True) + str(message), err=True)


def _check_outputs(mesh: Path | None = None, picture: Path | None = None) -> None:
    """Find out before the work, not after it, that the result cannot be put there."""
    from .io.formats import format_of
    from .plot.screen import check_path

    for path in (mesh, picture):
        if path is not None and not path.parent.is_dir():
            raise typer.BadParameter(f"there is no folder {str(path.parent)!r} for {path.name!r}")
    if mesh is not None:
        format_of(mesh)
    if picture is not None:
        check_path(picture)


def _outline_and_mesh(
    path: Path, repair: bool, tolerance: float | None, quiet: bool
) -> tuple[Domain, Mesh | None]:
    """The domain in a file, and the mesh that it is the domain of, if the file holds one."""
    import adaptmesh as am

    from .domain_io import OUTLINE_SUFFIXES

    if tolerance is not None and not repair:
        raise typer.BadParameter("--tolerance is that of --repair")
    if repair:
        domain, repairs = am.repair(path, tolerance)
        if not quiet:
            typer.echo(f"{repairs}")
        return domain, None
    if path.suffix.lower() in OUTLINE_SUFFIXES:
        return am.read_domain(path), None
    mesh = am.read(path)
    return mesh.domain or am.Domain.of_mesh(mesh), mesh


def _control_space(size: str | None, metric: Path | None, mesh: Mesh | None) -> ControlSpace:
    """What --size or --metric asks for; exactly one of them, the latter on the vertices of mesh."""
    import metrics

    if size is not None and metric is None:
        return metrics.Expression(size)
    if metric is None or size is not None:
        raise typer.BadParameter("give one of --size and --metric")
    if mesh is None:
        raise typer.BadParameter(
            "--metric gives values at the vertices of a mesh, and DOMAIN is an outline without "
            "any: use --size, or give the mesh"
        )
    import adaptmesh as am

    values = am.read_sol(metric)
    if len(values) != len(mesh.points):
        raise FormatError(
            f"{metric} has values for {len(values)} vertices, but the mesh has "
            f"{len(mesh.points)}: they do not belong together"
        )
    return metrics.Background(mesh.points, mesh.triangles, values)


@contextmanager
def _meshing(
    quiet: bool, max_vertices: int | None, placement: str | None
) -> Iterator[dict[str, Any]]:
    """The options of `generate` and `adapt` that were given, and a progress bar while they run."""
    from .placement import PLACEMENTS
    from .progress import TerminalProgress

    options: dict[str, Any] = {}
    if max_vertices is not None:
        options["max_vertices"] = max_vertices
    if placement is not None:
        if placement not in PLACEMENTS:
            raise typer.BadParameter(f"--placement is one of {', '.join(PLACEMENTS)}")
        options["placement"] = placement
    if quiet:
        yield options
        return
    start = time.perf_counter()
    with TerminalProgress() as progress:
        yield {**options, "progress": progress}
    typer.echo(f"meshed in {time.perf_counter() - start:.2f} s")


def _deliver(
    mesh: Mesh, control: ControlSpace, output: Path, plot: Path | None, quiet: bool
) -> None:
    """Write the mesh and its picture, and say how well it fits."""
    import adaptmesh as am

    am.write(output, mesh)
    if plot is not None:
        am.plot(mesh, path=plot)
    if not quiet:
        typer.echo(f"{am.measure(mesh, control)}")
        typer.echo(f"wrote {output}: {_counts(mesh)}")
        if plot is not None:
            typer.echo(f"wrote {plot}")


def _counts(mesh: Mesh) -> str:
    return f"{len(mesh.points):,} vertices, {len(mesh.triangles):,} triangles"
