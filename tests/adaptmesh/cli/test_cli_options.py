"""The command line: metrics from files, JSON, closed pipes, completion, options checked first."""

import json
import os
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest
from reference.transforms import SIMILARITIES
from typer.testing import CliRunner

import adaptmesh as am
from adaptmesh.cli.commands import app

RING = [[0, 0], [3, 1], [2.5, 2.5], [1, 2], [0, 0]]  # slanted, not convex
DOMAIN = am.Domain.polygon(RING[:-1])


def size(x):
    return 0.1 + 0.05 * x[:, 0]


@pytest.fixture
def run(tmp_path, monkeypatch):
    """Run a command in a folder with an outline, a mesh, and a mesh that carries a metric."""
    monkeypatch.chdir(tmp_path)
    outline = {"type": "Polygon", "coordinates": [RING]}
    Path("plate.geojson").write_text(json.dumps(outline))
    mesh = am.generate(DOMAIN, 0.3)
    am.write("plain.vtu", mesh)
    values = mesh.points[:, 0] * mesh.points[:, 1]
    am.write("carrier.vtu", mesh, metric=size, temperature=values, other=1 + values)
    runner = CliRunner()
    return lambda *arguments: runner.invoke(
        app, [str(a) for a in arguments], env={"COLUMNS": "200"}
    )


def done(result):
    assert result.exit_code == 0, result.output + str(result.exception)
    return result.stdout


def usage(result, message):
    assert result.exit_code == 2, result.output
    assert message in " ".join(result.stderr.replace("│", " ").split())
    assert not list(Path().glob("out*"))


# Where the metric comes from


def assert_has_the_sizes(path):
    mesh = am.read(path)
    assert am.validate(mesh)
    assert am.measure(mesh, size).unit_fraction > 0.9


@pytest.mark.fast_cases(3)
@pytest.mark.parametrize("suffix", [".vtu", ".vtk", ".msh", ".xdmf", ".mesh"])
def test_a_mesh_of_any_format_carries_the_metric_of_an_outline_or_another_mesh(run, suffix):
    carrier = f"sizes{suffix}"
    am.write(carrier, am.generate(DOMAIN, 0.2), metric=size)
    done(run("generate", "plate.geojson", "-m", carrier, "-o", "out.vtu"))
    assert_has_the_sizes("out.vtu")
    done(run("adapt", "plain.vtu", "-m", carrier, "-o", "out2.vtu"))
    assert_has_the_sizes("out2.vtu")


def test_the_field_is_chosen_by_name(run):
    mesh = am.read("plain.vtu")
    am.write("two.vtu", mesh, fine=size(mesh.points) / 2, coarse=size(mesh.points))
    arguments = ("generate", "plate.geojson", "-m", "two.vtu", "-o", "out.vtu")
    ambiguous = run(*arguments)
    assert (
        ambiguous.exit_code == 1
        and "'fine', 'coarse'; choose one by field (--metric-field)" in ambiguous.stderr
    )
    assert run(*arguments, "--metric-field", "none").exit_code == 1
    assert not Path("out.vtu").exists()
    done(run(*arguments, "--metric-field", "coarse"))
    assert_has_the_sizes("out.vtu")


def test_what_is_no_metric_is_refused(run):
    nothing = run("adapt", "plain.vtu", "-m", "plain.vtu", "-o", "out.vtu")
    assert nothing.exit_code == 1 and "got none" in nothing.stderr
    Path("a.txt").write_text("")
    usage(run("adapt", "plain.vtu", "-m", "a.txt", "-o", "out.vtu"), "or a raster")


def test_a_raster_of_sizes(run):
    rasterio = pytest.importorskip("rasterio")
    x = np.tile(np.arange(-0.5, 4, 0.05), (70, 1))
    transform = rasterio.Affine(0.05, 0, -0.525, 0, -0.05, 3.025)
    options = {"driver": "GTiff", "width": x.shape[1], "height": x.shape[0], "count": 1}
    with rasterio.open("s.tif", "w", dtype="float64", transform=transform, **options) as file:
        file.write(0.1 + 0.05 * np.maximum(x, -1), 1)
    done(run("generate", "plate.geojson", "-m", "s.tif", "-o", "out.vtu"))
    assert_has_the_sizes("out.vtu")


# Other options


def test_generate_simplifies_on_request_only(run):
    notched = [[0, 0], [3, 1], [2.5, 2.5], [1.001, 2.0], [1, 1.999], [0.999, 1.998], [0, 0]]
    outline = {"type": "Polygon", "coordinates": [notched]}
    Path("notched.geojson").write_text(json.dumps(outline))
    arguments = ("generate", "notched.geojson", "-s", "0.3", "-o", "out.vtu")
    done(run(*arguments))
    before = am.read("out.vtu")
    said = done(run(*arguments, "--simplify", "0.1"))
    assert "removed" in said
    after = am.read("out.vtu")
    assert min(am.measure(m, 0.3).length_min for m in (before, after)) < 0.01
    assert am.measure(after, 0.3).length_min > 0.5


def test_holes_of_a_drawing_are_none_on_request(run):
    inner = "M1,1 h1 v1 h-1 z"
    Path("a.svg").write_text(
        f'<svg xmlns="http://www.w3.org/2000/svg"><path d="M0,0 h3 v3 h-3 z {inner}"/></svg>'
    )
    arguments = ("generate", "a.svg", "-s", "0.5", "-o", "out.vtu")
    for more, area in (((), 8), (("--no-holes",), 9)):
        for repair in ((), ("--repair",)):
            done(run(*arguments, *more, *repair))
            assert am.read("out.vtu").areas.sum() == pytest.approx(area)
        done(run("repair", "a.svg", "-o", "out.geojson", *more))
        assert am.read_domain("out.geojson").area == pytest.approx(area)


JUMP = "0.4 - 0.37*(x > 2)"


@pytest.mark.fast_cases(1)
@pytest.mark.parametrize("first", [("generate", "plate.geojson"), ("adapt", "plain.vtu")])
def test_gradation_lets_sizes_grow_slowly(run, first):
    worst = {}
    for name, options in (("as asked", ()), ("graded", ("--gradation", "1.4"))):
        said = done(run(*first, "-s", JUMP, "-o", "a.vtu", "--json", *options))
        report = json.loads(said)["report"]
        mesh = am.read("a.vtu")
        assert am.validate(mesh) and report["unit_fraction"] > 0.9
        worst[name] = am.measure(mesh, 1.0).quality_min
    assert worst["graded"] > 0.3 > worst["as asked"]
    too_many = run(*first, "-s", "0.01", "-o", "out.vtu", "--gradation", "2", "--max-vertices", 99)
    assert too_many.exit_code == 1 and "max_vertices is 99" in too_many.stderr
    for bad in ("1", "0.5", "nan", "inf"):
        usage(run(*first, "-s", "1", "-o", "out.vtu", "--gradation", bad), "factor above 1")


@pytest.mark.fast_cases(3)
@pytest.mark.parametrize("transform", SIMILARITIES, ids=str)
def test_straight_tolerance_of_a_border_with_rounded_coordinates(run, transform):
    mesh = am.generate(DOMAIN, 0.3)
    rng = np.random.default_rng(2)
    points = transform(mesh.points + rng.uniform(-1e-4, 1e-4, mesh.points.shape))
    am.write("rounded.vtu", am.Mesh(points, mesh.triangles))
    unit = np.sqrt(abs(np.linalg.det(transform([(1, 0), (0, 1)]) - transform([(0, 0)]))))
    counts = {}
    for command in (("adapt",), ("generate",)):
        for options in ((), ("--straight-tolerance", repr(1e-3 * float(unit)))):
            out = ("-s", repr(float(unit)), "-o", "a.vtu", "--json")
            said = json.loads(done(run(*command, "rounded.vtu", *out, *options)))
            counts[command + options[:1]] = said["vertices"]
    assert counts["adapt", "--straight-tolerance"] == counts["generate", "--straight-tolerance"]
    assert counts["adapt", "--straight-tolerance"] < 15 < counts["adapt",]
    of_outline = ("generate", "plate.geojson", "-s", "1", "-o", "out.vtu")
    usage(run(*of_outline, "--straight-tolerance", "1"), "--straight-tolerance needs a mesh")


def seam(transform):
    """Two blocks with vertices twice along their seam, and a point in no triangle."""
    left = am.generate(am.Domain.rectangle(0, 0, 1, 1), 0.4)
    n = len(left.points)
    points = np.concatenate([left.points, left.points * [-1, 1] + [2, 0], [(5, 5)]])
    triangles = np.concatenate([left.triangles, left.triangles[:, ::-1] + n])
    mesh = am.Mesh(transform(points), triangles)
    return mesh if mesh.areas.min() > 0 else am.Mesh(mesh.points, triangles[:, ::-1])


@pytest.mark.fast_cases(2)
@pytest.mark.parametrize("transform", SIMILARITIES, ids=str)
def test_loose_and_double_points_are_cleaned_with_fields_and_metric(run, transform):
    mesh = seam(transform)
    unit = float(np.sqrt(mesh.areas.sum() / 2))
    values = np.arange(len(mesh.points), dtype=float)
    am.write("seam.mesh", mesh)
    am.write_sol("seam.sol", np.full(len(mesh.points), 0.3 * unit))
    am.write("seam.vtu", mesh, number=values, triangle_fields={"kind": mesh.triangles[:, 0] * 1.0})
    assert run("check", "seam.vtu").exit_code == 1
    done(run("convert", "seam.vtu", "clean.vtu", "--clean"))
    assert len(am.read("clean.vtu").points) == len(mesh.points) - 1
    merge = ("--merge", repr(1e-6 * unit))
    assert "points removed or merged" in done(run("convert", "seam.vtu", "whole.vtk", *merge))
    checks = json.loads(run("check", "whole.vtk", "--json").stdout)["checks"]
    assert {c["name"] for c in checks if not c["ok"]} == {"border is constrained"}  # has no edges
    whole, fields = am.read("whole.vtk"), am.read_fields("whole.vtk")
    numbers = fields["number"].astype(int)
    np.testing.assert_array_equal(whole.points, mesh.points[numbers])
    np.testing.assert_array_equal(fields["kind"], mesh.triangles[:, 0])
    done(run("adapt", "seam.mesh", "-m", "seam.sol", "-o", "new.vtu", *merge))
    new = am.read("new.vtu")
    assert am.validate(new) and new.areas.sum() == pytest.approx(2 * unit**2, rel=1e-6)
    assert am.measure(new, 0.3 * unit).unit_fraction > 0.9
    for bad in ("-1", "nan", "inf"):
        usage(run("convert", "seam.vtu", "out.vtu", "--merge", bad), "at least 0")


def test_convert_keeps_fields_unless_told_not_to(run):
    mesh = am.read("plain.vtu")
    fields = {"p": mesh.points[:, 0], "v": mesh.points, "kind": mesh.triangles[:, 0] * 1.0}
    am.write("a.vtu", mesh, metric=size, **fields)
    for suffix in (".vtu", ".vtk", ".msh", ".xdmf"):
        done(run("convert", "a.vtu", f"b{suffix}"))
        read = am.read_fields(f"b{suffix}")
        assert read.keys() == {"metric", *fields}
        for name, values in fields.items():
            np.testing.assert_array_equal(read[name], values)
    done(run("convert", "a.vtu", "c.vtu", "--no-fields"))
    assert am.read_fields("c.vtu") == {}


def test_frozen_edges_stay(run):
    mesh = am.generate(DOMAIN.with_names({"base": [0]}), 0.3)
    am.write("named.vtu", mesh)
    done(run("adapt", "named.vtu", "-s", "0.1", "-o", "a.vtu", "--frozen", "base"))
    edges = [
        {tuple(sorted(map(tuple, m.points[e].tolist()))) for e in m.edges_named("base")}
        for m in (mesh, am.read("a.vtu"))
    ]
    assert edges[0] == edges[1]
    unknown = run("adapt", "named.vtu", "-s", "0.1", "-o", "out.vtu", "--frozen", "top")
    assert unknown.exit_code == 1 and "'top'" in unknown.stderr and not Path("out.vtu").exists()


def test_keep_edits_the_mesh(run):
    first = json.loads(done(run("generate", "plate.geojson", "-s", "0.2", "-o", "a.vtu", "--json")))
    kept = json.loads(done(run("adapt", "a.vtu", "-s", "0.2", "-o", "b.vtu", "--keep", "--json")))
    assert kept["kept_vertices"] > 0.8 * first["vertices"]
    usage(
        run("adapt", "a.vtu", "-s", "1", "-o", "out.vtu", "--keep", "--placement", "edges"),
        "one of --placement and --keep",
    )


def test_plot_of_a_field_with_bounds_and_title(run, monkeypatch):
    seen = {}
    monkeypatch.setattr(am, "plot", lambda mesh, metric, **options: seen.update(options))
    options = ("--field", "temperature", "--bounds", "0.5", "0.5", "2", "2", "--title", "T")
    done(run("plot", "carrier.vtu", *options, "-o", "out.png"))
    mesh = am.read("carrier.vtu")
    np.testing.assert_allclose(seen["show"], mesh.points[:, 0] * mesh.points[:, 1])
    assert (seen["bounds"], seen["title"]) == ((0.5, 0.5, 2.0, 2.0), "T")
    usage(
        run("plot", "carrier.vtu", "--field", "x", "-o", "out.png"),
        "the fields 'temperature', 'other'",
    )
    both = ("--field", "other", "--show", "size")
    usage(run("plot", "carrier.vtu", *both, "-o", "out.png"), "--show and --field")
    wrong = ("--bounds", "1", "0", "0", "1")
    usage(run("plot", "carrier.vtu", *wrong, "-o", "out.png"), "X0 < X1")
    endless = ("--bounds", "0", "0", "inf", "inf")
    usage(run("plot", "carrier.vtu", *endless, "-o", "out.png"), "X0 < X1")


@pytest.mark.parametrize("drawn", ["plain.vtu", "plate.geojson"])
def test_plot_of_a_part_where_nothing_is(run, drawn):
    away = ("--bounds", "50", "50", "60", "60")
    usage(run("plot", drawn, *away, "-o", "out.png"), "no triangle in this box")


def test_plot_of_an_outline_numbers_its_points_and_sides(run, monkeypatch):
    done(run("plot", "plate.geojson", "-o", "out.png"))
    assert Path("out.png").stat().st_size > 1000
    seen = []
    monkeypatch.setattr(am, "plot", lambda drawn, **options: seen.append((drawn, options)))
    done(run("plot", "plate.geojson", "--show", "region", "--title", "T", "-o", "b.png"))
    ((drawn, options),) = seen
    assert drawn == am.read_domain("plate.geojson")
    assert (options["show"], options["title"], options["bounds"]) == ("region", "T", None)


@pytest.mark.parametrize(
    "arguments",
    [
        ("generate", "plate.geojson", "-s", "1", "-o", "out.vtu", "--gradation", "1"),
        ("generate", "plate.geojson", "-s", "1", "-o", "out.vtu", "--simplify", "nan"),
        ("generate", "plate.geojson", "-s", "1", "-o", "out.vtu", "--straight-tolerance", "1"),
        ("generate", "plain.vtu", "-s", "1", "-o", "out.vtu", "--no-holes"),
        ("adapt", "plain.vtu", "-s", "1", "-o", "out.vtu", "--merge", "nan"),
        ("check", "plain.vtu", "--tolerance", "nan"),
        ("convert", "plain.vtu", "out.vtu", "--merge", "inf"),
        ("repair", "plate.geojson", "--tolerance", "nan", "-o", "out.geojson"),
        ("plot", "plate.geojson", "-s", "1", "-o", "out.png"),
        ("plot", "plate.geojson", "--show", "quality", "-o", "out.png"),
        ("plot", "plate.geojson", "--field", "a", "-o", "out.png"),
        ("generate", "plate.geojson", "-s", "0.1 +", "-o", "out.vtu"),
        ("generate", "plate.geojson", "-s", "1", "-o", "out.vtu", "--tolerance", "1"),
        ("generate", "plate.geojson", "-s", "1", "-o", "out.vtu", "--placement", "nowhere"),
        ("generate", "plate.geojson", "-s", "1", "-m", "carrier.vtu", "-o", "out.vtu"),
        ("generate", "plate.geojson", "-s", "1", "-o", "out.vtu", "--metric-field", "a"),
        ("generate", "plate.geojson", "-s", "1", "-o", "out.vtu", "--quiet", "--json"),
        ("adapt", "plain.vtu", "-s", "foo(x)", "-o", "out.vtu"),
        ("check", "plain.vtu", "-s", "foo(x)"),
        ("plot", "plain.vtu", "-s", "foo(x)", "-o", "out.png"),
        ("repair", "plate.geojson", "-o", "no/folder/out.geojson"),
    ],
    ids=" ".join,
)
def test_options_are_checked_before_any_file_is_read(run, monkeypatch, arguments):
    for name in ("read", "read_domain", "repair"):
        monkeypatch.setattr(am, name, lambda *_: pytest.fail("a file was read"))
    assert run(*arguments).exit_code in (1, 2)
    assert not list(Path().glob("out*"))


# JSON


def test_json_of_generate_and_check(run):
    said = done(run("generate", "plate.geojson", "-s", "0.2", "-o", "a.vtu", "--json"))
    facts = json.loads(said)
    mesh = am.read("a.vtu")
    assert (facts["vertices"], facts["triangles"]) == (len(mesh.points), len(mesh.triangles))
    assert facts["predicted_vertices"] == pytest.approx(facts["vertices"], rel=0.2)
    assert facts["report"]["unit_fraction"] == am.measure(mesh, 0.2).unit_fraction
    assert facts["output"] == "a.vtu" and facts["seconds"] > 0
    checked = json.loads(done(run("check", "a.vtu", "-s", "0.2", "--json")))
    assert checked["valid"] and checked["report"] == facts["report"]
    assert {c["name"] for c in checked["checks"]} == {c.name for c in mesh.validate()}


def test_json_of_a_bad_mesh_and_of_a_repair(run):
    good = am.generate(DOMAIN, 0.5)
    am.write("bad.vtu", am.Mesh(good.points, good.triangles[:, ::-1]))
    bad = run("check", "bad.vtu", "--json")
    assert bad.exit_code == 1 and not json.loads(bad.stdout)["valid"]
    bowtie = {"type": "Polygon", "coordinates": [[[0, 0], [1, 1], [1, 0], [0, 1], [0, 0]]]}
    Path("bowtie.geojson").write_text(json.dumps(bowtie))
    repaired = json.loads(done(run("repair", "bowtie.geojson", "-o", "out.json", "--json")))
    assert [r["kind"] for r in repaired["repairs"]] and repaired["points"] == 5


# The reader of the output may leave


@pytest.mark.fast_cases(1)
@pytest.mark.parametrize("command", ["generate", "check", "repair"])
def test_a_closed_pipe_does_not_stop_the_work(run, command):
    arguments = {
        "generate": ["generate", "plate.geojson", "-s", "0.1", "-o", "out.vtu"],
        "check": ["check", "plain.vtu", "-s", "0.1"],
        "repair": ["repair", "plate.geojson", "-o", "out.geojson"],
    }[command]
    reader, writer = os.pipe()
    os.close(reader)
    done = subprocess.run(
        [sys.executable, "-m", "adaptmesh", *arguments],
        stdout=writer,
        stderr=subprocess.PIPE,
        text=True,
        timeout=300,
    )
    os.close(writer)
    assert (done.returncode, done.stderr) == (0, "")
    assert command == "check" or list(Path().glob("out*"))


# The shell completes


def complete(words):
    """What bash is offered for the last word."""
    code = "from adaptmesh.cli.commands import main\nmain()"
    environment = {
        **os.environ,
        "_ADAPTMESH_COMPLETE": "complete_bash",
        "COMP_WORDS": " ".join(words),
        "COMP_CWORD": str(len(words) - 1),
    }
    done = subprocess.run(
        [sys.executable, "-c", code], env=environment, capture_output=True, text=True, timeout=300
    )
    return done.stdout.split()


@pytest.mark.slow
def test_commands_options_and_values_are_completed():
    assert "generate" in complete(["adaptmesh", "gen"])
    assert "--placement" in complete(["adaptmesh", "generate", "--pl"])
    assert complete(["adaptmesh", "generate", "--placement", "e"]) == ["edges"]
    assert "quality" in complete(["adaptmesh", "plot", "--show", "q"])
