"""The command line: ``adaptmesh generate | adapt | check | repair | plot | convert | demo``.

Each command reads its input, calls the library function of its name, and reports the result.
Heavy modules are imported inside the commands, so that ``--help`` is fast. Options are checked
before any work.

Results are printed to standard output; progress, warnings and errors go to standard error.
Exit codes: 0 done, 1 bad mesh, domain, metric or file, 2 wrong usage, 130 interrupted.
"""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path
from typing import Annotated, Any

import typer

from .arguments import (
    Bounds,
    Clean,
    Frozen,
    Gradation,
    Json,
    LineTolerance,
    MaxVertices,
    Merge,
    MeshFile,
    MeshOrOutline,
    Metric,
    MetricField,
    NoHoles,
    OutlineFile,
    Output,
    Picture,
    Placement,
    Quiet,
    ReferenceDomain,
    Show,
    Simplify,
    Size,
    StraightTolerance,
    Title,
    Tolerance,
)
from .files import (
    check_folder,
    check_outputs,
    clean_mesh,
    is_outline,
    read_field,
    read_fields_of_mesh,
    read_outline_and_mesh,
)
from .metric import Request, grade
from .output import (
    EXIT_BAD,
    Reporter,
    report_as_usage_error,
    report_errors,
    shorten_warnings,
    write,
)
from .results import format_counts, show_progress, write_results

OUTLINE_PICTURES = (
    "an outline, which is drawn with --show mesh or region and without field or metric: generate a "
    "mesh to see more"
)
"""The rest of messages about options that an outline does not have."""

app = typer.Typer(
    name="adaptmesh",
    no_args_is_help=True,
    pretty_exceptions_enable=False,
    rich_markup_mode="rich",
    context_settings={"help_option_names": ["-h", "--help"]},
    help="Mesh planar domains with triangles whose edges have the length that a metric requests.",
    epilog="Exit codes: 0 done; 1 the mesh, domain, metric or file is bad; 2 wrong usage; "
    "130 interrupted.",
)


def _print_version(is_asked: bool) -> None:
    if is_asked:
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
    metric_field: MetricField = None,
    gradation: Gradation = None,
    plot: Picture = None,
    max_vertices: MaxVertices = None,
    placement: Placement = None,
    repair: Annotated[
        bool, typer.Option("--repair", help="Repair the domain first, and report the repairs.")
    ] = False,
    tolerance: Tolerance = None,
    simplify: Simplify = None,
    straight_tolerance: StraightTolerance = None,
    no_holes: NoHoles = False,
    quiet: Quiet = False,
    as_json: Json = False,
) -> None:
    """Mesh a domain: polygons, curves, a drawing, or the domain of another mesh."""
    with report_errors():
        import adaptmesh as am

        reporter = Reporter(quiet, as_json)
        check_outputs(output, plot)
        if tolerance is not None and not repair:
            raise typer.BadParameter("--tolerance needs --repair")
        if straight_tolerance is not None and (repair or is_outline(domain)):
            raise typer.BadParameter("--straight-tolerance needs a mesh as DOMAIN, and no --repair")
        if no_holes and not is_outline(domain):
            raise typer.BadParameter("--no-holes needs a drawing or a script as DOMAIN")
        request = Request(size, metric, metric_field)
        request.refuse_empty()
        if repair or is_outline(domain):
            request.refuse_without_mesh()
        outline, carrier = read_outline_and_mesh(
            domain, repair, tolerance, straight_tolerance, no_holes, reporter
        )
        control = request.control_space(carrier)
        if simplify is not None:
            outline, dropped = am.simplify(outline, control, share=simplify)
            reporter.print(dropped)
        control = grade(outline, control, gradation, max_vertices)
        predicted = am.predict(outline, control)
        reporter.print(f"predicted: about {round(predicted):,} vertices")
        reporter.record(predicted_vertices=predicted)
        with show_progress(reporter, max_vertices, placement) as options:
            mesh = am.generate(outline, control, **options)
        write_results(mesh, control, output, plot, reporter)


@app.command(epilog="Example: adaptmesh adapt old.mesh --metric old.sol -o new.mesh")
def adapt(
    mesh: MeshFile,
    output: Output,
    size: Size = None,
    metric: Metric = None,
    metric_field: MetricField = None,
    gradation: Gradation = None,
    plot: Picture = None,
    max_vertices: MaxVertices = None,
    placement: Placement = None,
    keep: Annotated[
        bool,
        typer.Option(
            "--keep", help="Edit the mesh where it does not fit the metric, and keep the rest."
        ),
    ] = False,
    frozen: Frozen = None,
    clean: Clean = False,
    merge: Merge = None,
    straight_tolerance: StraightTolerance = None,
    quiet: Quiet = False,
    as_json: Json = False,
) -> None:
    """Adapt a mesh to a metric, keeping its boundaries, regions and names."""
    with report_errors():
        import adaptmesh as am

        reporter = Reporter(quiet, as_json)
        check_outputs(output, plot)
        if keep and placement is not None:
            raise typer.BadParameter("give one of --placement and --keep")
        request = Request(size, metric, metric_field)
        request.refuse_empty()
        read = am.read(mesh)
        old = clean_mesh(read, clean, merge, reporter)
        outline = old.to_domain(straight_tolerance=straight_tolerance)
        control = request.control_space(read, old)
        control = grade(outline, control, gradation, max_vertices)
        with show_progress(reporter, max_vertices, placement) as options:
            old = replace(old, domain=outline)
            new = am.adapt(old, control, keep=keep, frozen=frozen or (), **options)
        if new.kept is not None:
            reporter.record(kept_vertices=int((new.kept >= 0).sum()))
        write_results(new, control, output, plot, reporter)


@app.command(epilog="Example: adaptmesh check part.msh --size 0.05")
def check(
    mesh: MeshFile,
    size: Size = None,
    metric: Metric = None,
    metric_field: MetricField = None,
    domain: ReferenceDomain = None,
    tolerance: LineTolerance = None,
    as_json: Json = False,
) -> None:
    """Check that a mesh is valid (exit code 0, else 1), and measure how well it fits a metric."""
    with report_errors():
        import adaptmesh as am

        reporter = Reporter(as_json=as_json)
        request = Request(size, metric, metric_field)
        checked = am.read(mesh)
        if domain is not None:
            checked = replace(checked, domain=am.read_domain(domain))
        validity = checked.validate(tolerance=tolerance)
        reporter.print(validity)
        reporter.record(
            mesh=str(mesh), valid=validity.ok, checks=[vars(c) for c in validity.checks]
        )
        if not request.is_empty:
            report = am.measure(checked, request.control_space(checked))
            reporter.print(f"\n{report}")
            reporter.record(report=report.as_dict())
        reporter.finish()
        if not validity.ok:
            raise typer.Exit(EXIT_BAD)


@app.command(epilog="Example: adaptmesh repair coast.geojson --tolerance 0.01 -o clean.geojson")
def repair(
    domain: OutlineFile,
    output: Annotated[Path, typer.Option("--output", "-o", metavar="FILE.geojson", dir_okay=False)],
    tolerance: Tolerance = None,
    no_holes: NoHoles = False,
    quiet: Quiet = False,
    as_json: Json = False,
) -> None:
    """Repair an outline, report the repairs, and write the regions as polygons."""
    with report_errors():
        import adaptmesh as am
        from adaptmesh.io.domains.geojson import GEOJSON_SUFFIXES, write_geojson

        reporter = Reporter(quiet, as_json)
        if output.suffix.lower() not in GEOJSON_SUFFIXES:
            raise typer.BadParameter(
                f"--output: expected a {' or '.join(GEOJSON_SUFFIXES)} file, got {output.name}"
            )
        check_folder(output)
        clean, repairs = am.repair(domain, tolerance, holes=[] if no_holes else None)
        reporter.print(repairs)
        write_geojson(output, clean)
        reporter.print(f"wrote {output}: {len(clean.points):,} points")
        reporter.record(output=str(output), points=len(clean.points), tolerance=repairs.tolerance)
        reporter.record(displacement=repairs.displacement, repairs=[vars(r) for r in repairs])
        reporter.finish()


@app.command(
    epilog="Example: adaptmesh plot wing.vtu --show length --size '0.01 + 0.1*y' -o wing.png"
)
def plot(
    mesh: MeshOrOutline,
    output: Annotated[
        Path,
        typer.Option("--output", "-o", metavar="PNG", dir_okay=False, help="Picture to write."),
    ],
    show: Annotated[Show, typer.Option(help="What to colour the triangles by.")] = Show.mesh,
    field: Annotated[
        str | None,
        typer.Option(metavar="NAME", help="Colour by this field of the file, not by --show."),
    ] = None,
    size: Size = None,
    metric: Metric = None,
    metric_field: MetricField = None,
    ellipses: Annotated[
        bool, typer.Option("--ellipses", help="Draw the metric as unit ellipses.")
    ] = False,
    bounds: Bounds = None,
    title: Title = None,
) -> None:
    """Draw a mesh: its triangles, quality, edge lengths, sizes, regions, or a field.

    An outline is drawn with the numbers of its points and sides.
    """
    with report_errors():
        import adaptmesh as am

        request = Request(size, metric, metric_field)
        if (ellipses or show is Show.length) and request.is_empty:
            raise typer.BadParameter(
                "--ellipses and --show length need a metric: give --size or --metric"
            )
        if field is not None and show is not Show.mesh:
            raise typer.BadParameter("give one of --show and --field")
        check_outputs(picture=output)
        options: Any = {"path": output, "bounds": bounds, "title": title}
        if is_outline(mesh):
            if field is not None or ellipses or not request.is_empty:
                raise typer.BadParameter(f"{mesh} is {OUTLINE_PICTURES}")
            _plot_outline(mesh, show, options)
        else:
            drawn = am.read(mesh)
            control = None if request.is_empty else request.control_space(drawn)
            colours = show.value if field is None else read_field(mesh, field)
            with report_as_usage_error():
                am.plot(drawn, control, show=colours, ellipses=ellipses, **options)
        write(f"wrote {output}")


def _plot_outline(path: Path, show: Show, options: dict[str, Any]) -> None:
    import adaptmesh as am

    if show not in (Show.mesh, Show.region):
        raise typer.BadParameter(f"{path} is {OUTLINE_PICTURES}")
    with report_as_usage_error():
        am.plot(am.read_domain(path), show=show.value, **options)


@app.command(epilog="Example: adaptmesh convert part.msh part.vtu")
def convert(
    source: MeshFile,
    target: Annotated[Path, typer.Argument(metavar="OUT", dir_okay=False, help="Mesh to write.")],
    clean: Clean = False,
    merge: Merge = None,
    fields: Annotated[
        bool, typer.Option("--fields/--no-fields", help="Whether to write the fields, too.")
    ] = True,
) -> None:
    """Write a mesh and its fields in another format, chosen by the suffix."""
    with report_errors():
        import adaptmesh as am

        check_outputs(target)
        read = am.read(source)
        mesh = clean_mesh(read, clean, merge, Reporter())
        carried = read_fields_of_mesh(source, read, mesh) if fields else {}
        am.write(target, mesh, **carried)
        write(f"wrote {target}: {format_counts(mesh)}")


@app.command(epilog="Example: adaptmesh demo --out pictures")
def demo(
    out: Annotated[
        Path, typer.Option(metavar="DIR", file_okay=False, help="Folder for meshes and pictures.")
    ] = Path("adaptmesh-demo"),
) -> None:
    """Mesh the coast of Iceland and the flow around an aerofoil, and draw them."""
    with report_errors():
        from .demo import make_demo

        out.mkdir(parents=True, exist_ok=True)
        make_demo(out, say=write)


def main() -> None:
    """Run the command line (the `adaptmesh` script)."""
    shorten_warnings()
    app(prog_name="adaptmesh")
