"""The command line: ``adaptmesh generate | adapt | check | repair | plot | convert | demo``.

Commands are thin: each reads, calls the one library function of its name, and says what came of
it. Heavy modules are imported inside the commands, so that ``--help`` comes at once. What the
options say is checked before any work.

Results are printed to standard output; progress, warnings and errors go to standard error.
Exit codes: 0 done, 1 bad mesh, domain, metric or file, 2 wrong usage, 130 interrupted.
"""

from __future__ import annotations

import time
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer

from .arguments import (
    Bounds,
    Clean,
    Drawn,
    Frozen,
    Gradation,
    HeldAgainst,
    Json,
    MaxVertices,
    Merge,
    MeshFile,
    Metric,
    MetricField,
    NoHoles,
    OffLines,
    OutlineFile,
    Output,
    Picture,
    Placement,
    Quiet,
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
    cleaned,
    field_of,
    fields_for,
    is_outline,
    outline_and_mesh,
)
from .metric import Request, graded
from .output import (
    EXIT_BAD,
    Speaker,
    neat_errors,
    refused_as_usage,
    show_warnings_neatly,
    write,
)

if TYPE_CHECKING:
    from adaptmesh.mesh.mesh import Mesh
    from metrics import ControlSpace

OUTLINED = ("mesh", "region")  # what --show may be for an outline

app = typer.Typer(
    name="adaptmesh",
    no_args_is_help=True,
    pretty_exceptions_enable=False,
    rich_markup_mode="rich",
    context_settings={"help_option_names": ["-h", "--help"]},
    help="Mesh planar domains with triangles whose edges have the length that a metric asks for.",
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
        bool, typer.Option("--repair", help="Repair the domain first, and say what was done.")
    ] = False,
    tolerance: Tolerance = None,
    simplify: Simplify = None,
    straight_tolerance: StraightTolerance = None,
    no_holes: NoHoles = False,
    quiet: Quiet = False,
    as_json: Json = False,
) -> None:
    """Mesh a domain: polygons, curves, a drawing, or the domain of another mesh."""
    with neat_errors():
        import adaptmesh as am

        speaker = Speaker(quiet, as_json)
        check_outputs(output, plot)
        if tolerance is not None and not repair:
            raise typer.BadParameter("--tolerance is that of --repair")
        if straight_tolerance is not None and (repair or is_outline(domain)):
            raise typer.BadParameter("--straight-tolerance is for the border of a mesh")
        if no_holes and not is_outline(domain):
            raise typer.BadParameter("--no-holes is for drawings and scripts")
        request = Request(size, metric, metric_field)
        request.refuse_empty()
        if repair or is_outline(domain):
            request.refuse_without_mesh()
        outline, carrier = outline_and_mesh(
            domain, repair, tolerance, straight_tolerance, no_holes, speaker
        )
        control = request.control_space(carrier)
        if simplify is not None:
            outline, dropped = am.simplify(outline, control, share=simplify)
            speaker.say(dropped)
        control = graded(outline, control, gradation, max_vertices)
        predicted = am.predict(outline, control)
        speaker.say(f"predicted: about {round(predicted):,} vertices")
        speaker.note(predicted_vertices=predicted)
        with _meshing(speaker, max_vertices, placement) as options:
            mesh = am.generate(outline, control, **options)
        _deliver(mesh, control, output, plot, speaker)


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
        bool, typer.Option("--keep", help="Edit the mesh where it does not fit, keep the rest.")
    ] = False,
    frozen: Frozen = None,
    clean: Clean = False,
    merge: Merge = None,
    straight_tolerance: StraightTolerance = None,
    quiet: Quiet = False,
    as_json: Json = False,
) -> None:
    """Adapt a mesh to a metric, keeping its boundaries, regions and names."""
    with neat_errors():
        import adaptmesh as am

        speaker = Speaker(quiet, as_json)
        check_outputs(output, plot)
        if keep and placement is not None:
            raise typer.BadParameter("--placement is that of a new mesh: leave it out, or --keep")
        request = Request(size, metric, metric_field)
        request.refuse_empty()
        read = am.read(mesh)
        old = cleaned(read, clean, merge, speaker)
        outline = old.to_domain(straight_tolerance=straight_tolerance)
        control = request.control_space(read, old)
        control = graded(outline, control, gradation, max_vertices)
        with _meshing(speaker, max_vertices, placement) as options:
            old = replace(old, domain=outline)
            new = am.adapt(old, control, keep=keep, frozen=frozen or (), **options)
        if new.kept is not None:
            speaker.note(kept_vertices=int((new.kept >= 0).sum()))
        _deliver(new, control, output, plot, speaker)


@app.command(epilog="Example: adaptmesh check part.msh --size 0.05")
def check(
    mesh: MeshFile,
    size: Size = None,
    metric: Metric = None,
    metric_field: MetricField = None,
    domain: HeldAgainst = None,
    tolerance: OffLines = None,
    as_json: Json = False,
) -> None:
    """Check that a mesh is valid (exit code 0, else 1), and how well it fits a metric."""
    with neat_errors():
        import adaptmesh as am

        speaker = Speaker(as_json=as_json)
        request = Request(size, metric, metric_field)
        checked = am.read(mesh)
        if domain is not None:
            checked = replace(checked, domain=am.read_domain(domain))
        validity = checked.validate(tolerance=tolerance)
        speaker.say(validity)
        speaker.note(mesh=str(mesh), valid=validity.ok, checks=[vars(c) for c in validity.checks])
        if not request.is_empty:
            report = am.measure(checked, request.control_space(checked))
            speaker.say(f"\n{report}")
            speaker.note(report=report.as_dict())
        speaker.finish()
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
    """Repair an outline, say what was done, and write the regions as polygons."""
    with neat_errors():
        import adaptmesh as am
        from adaptmesh.io.domains.geojson import GEOJSON_SUFFIXES, write_geojson

        speaker = Speaker(quiet, as_json)
        if output.suffix.lower() not in GEOJSON_SUFFIXES:
            raise typer.BadParameter(f"--output ends in {' or '.join(GEOJSON_SUFFIXES)}")
        check_folder(output)
        clean, repairs = am.repair(domain, tolerance, holes=[] if no_holes else None)
        speaker.say(repairs)
        write_geojson(output, clean)
        speaker.say(f"wrote {output}: {len(clean.points):,} points")
        speaker.note(output=str(output), points=len(clean.points), tolerance=repairs.tolerance)
        speaker.note(displacement=repairs.displacement, repairs=[vars(r) for r in repairs])
        speaker.finish()


@app.command(
    epilog="Example: adaptmesh plot wing.vtu --show length --size '0.01 + 0.1*y' -o wing.png"
)
def plot(
    mesh: Drawn,
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

    Of an outline, points and sides are drawn with their numbers.
    """
    with neat_errors():
        import adaptmesh as am

        request = Request(size, metric, metric_field)
        if (ellipses or show is Show.length) and request.is_empty:
            raise typer.BadParameter("of which metric? Give --size or --metric")
        if field is not None and show is not Show.mesh:
            raise typer.BadParameter("give one of --show and --field")
        check_outputs(picture=output)
        look: Any = {"path": output, "bounds": bounds, "title": title}
        if is_outline(mesh):
            if field is not None or ellipses or not request.is_empty or show.value not in OUTLINED:
                raise typer.BadParameter(
                    f"{mesh} is an outline, drawn with --show mesh or region, without a field or "
                    "metric: generate a mesh to see more"
                )
            with refused_as_usage():
                am.plot(am.read_domain(mesh), show=show.value, **look)
        else:
            drawn = am.read(mesh)
            control = None if request.is_empty else request.control_space(drawn)
            colours = show.value if field is None else field_of(mesh, field)
            with refused_as_usage():
                am.plot(drawn, control, show=colours, ellipses=ellipses, **look)
        write(f"wrote {output}")


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
    """Write a mesh and its fields in another format, told by the suffix."""
    with neat_errors():
        import adaptmesh as am

        check_outputs(target)
        read = am.read(source)
        mesh = cleaned(read, clean, merge, Speaker())
        carried = fields_for(source, read, mesh) if fields else {}
        am.write(target, mesh, **carried)
        write(f"wrote {target}: {_counts(mesh)}")


@app.command(epilog="Example: adaptmesh demo --out pictures")
def demo(
    out: Annotated[
        Path, typer.Option(metavar="DIR", file_okay=False, help="Folder for meshes and pictures.")
    ] = Path("adaptmesh-demo"),
) -> None:
    """Mesh the coast of Iceland and the flow around an aerofoil, and draw them."""
    with neat_errors():
        from .demo import run

        out.mkdir(parents=True, exist_ok=True)
        run(out, say=write)


def main() -> None:
    """Run the command line (the `adaptmesh` script)."""
    show_warnings_neatly()
    app(prog_name="adaptmesh")


@contextmanager
def _meshing(
    speaker: Speaker, max_vertices: int | None, placement: str | None
) -> Iterator[dict[str, Any]]:
    """The options of `generate` and `adapt` that were given, and a progress bar while they run."""
    from .progress import TerminalProgress

    given = {"max_vertices": max_vertices, "placement": placement}
    options = {name: value for name, value in given.items() if value is not None}
    start = time.perf_counter()
    if speaker.is_silent:
        yield options
    else:
        with TerminalProgress() as progress:
            yield {**options, "progress": progress}
    seconds = time.perf_counter() - start
    speaker.say(f"meshed in {seconds:.2f} s")
    speaker.note(seconds=seconds)


def _deliver(
    mesh: Mesh, control: ControlSpace, output: Path, plot: Path | None, speaker: Speaker
) -> None:
    """Write the mesh and its picture, and say how well it fits."""
    import adaptmesh as am

    am.write(output, mesh)
    if plot is not None:
        am.plot(mesh, path=plot)
    if speaker.is_silent and not speaker.as_json:
        return
    report = am.measure(mesh, control)
    speaker.say(report)
    speaker.say(f"wrote {output}: {_counts(mesh)}")
    if plot is not None:
        speaker.say(f"wrote {plot}")
        speaker.note(plot=str(plot))
    speaker.note(output=str(output), vertices=len(mesh.points), triangles=len(mesh.triangles))
    speaker.note(report=report.as_dict())
    speaker.finish()


def _counts(mesh: Mesh) -> str:
    return f"{len(mesh.points):,} vertices, {len(mesh.triangles):,} triangles"
