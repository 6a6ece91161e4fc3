"""The command line: metrics from files, JSON, closed pipes, completion, options checked first."""

import json
import os
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest
from typer.testing import CliRunner

import adaptmesh as am
from adaptmesh.cli import app

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
    assert ambiguous.exit_code == 1 and "'fine', 'coarse'; choose by --metric" in ambiguous.stderr
    assert run(*arguments, "--metric-field", "none").exit_code == 1
    assert not Path("out.vtu").exists()
    done(run(*arguments, "--metric-field", "coarse"))
    assert_has_the_sizes("out.vtu")


def test_what_is_no_metric_is_refused(run):
    nothing = run("adapt", "plain.vtu", "-m", "plain.vtu", "-o", "out.vtu")
    assert nothing.exit_code == 1 and "found none" in nothing.stderr
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
    assert "left out" in said
    after = am.read("out.vtu")
    assert min(am.measure(m, 0.3).length_min for m in (before, after)) < 0.01
    assert am.measure(after, 0.3).length_min > 0.5


def test_keep_edits_the_mesh(run):
    first = json.loads(done(run("generate", "plate.geojson", "-s", "0.2", "-o", "a.vtu", "--json")))
    kept = json.loads(done(run("adapt", "a.vtu", "-s", "0.2", "-o", "b.vtu", "--keep", "--json")))
    assert kept["kept_vertices"] > 0.8 * first["vertices"]
    usage(
        run("adapt", "a.vtu", "-s", "1", "-o", "out.vtu", "--keep", "--placement", "edges"),
        "--placement is that of a new mesh",
    )


def test_plot_of_a_field_with_bounds_and_title(run, monkeypatch):
    seen = {}
    monkeypatch.setattr(am, "plot", lambda mesh, metric, **options: seen.update(options))
    options = ("--field", "temperature", "--bounds", "0.5", "0.5", "2", "2", "--title", "T")
    done(run("plot", "carrier.vtu", *options, "-o", "out.png"))
    mesh = am.read("carrier.vtu")
    np.testing.assert_allclose(seen["show"], mesh.points[:, 0] * mesh.points[:, 1])
    assert (seen["bounds"], seen["title"]) == ((0.5, 0.5, 2.0, 2.0), "T")
    usage(run("plot", "carrier.vtu", "--field", "x", "-o", "out.png"), "has 'temperature', 'other'")
    both = ("--field", "other", "--show", "size")
    usage(run("plot", "carrier.vtu", *both, "-o", "out.png"), "--show and --field")
    wrong = ("--bounds", "1", "0", "0", "1")
    usage(run("plot", "carrier.vtu", *wrong, "-o", "out.png"), "X0 < X1")


@pytest.mark.parametrize(
    "arguments",
    [
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
    code = "from adaptmesh.cli import main\nmain()"
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


def test_commands_options_and_values_are_completed():
    assert "generate" in complete(["adaptmesh", "gen"])
    assert "--placement" in complete(["adaptmesh", "generate", "--pl"])
    assert complete(["adaptmesh", "generate", "--placement", "e"]) == ["edges"]
    assert "quality" in complete(["adaptmesh", "plot", "--show", "q"])
