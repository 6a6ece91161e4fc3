"""The command line: every command, bad input, exit codes, and what is printed where."""

import json
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest
from typer.testing import CliRunner

import adaptmesh as am
from adaptmesh.cli.commands import app

SQUARE = {"type": "Polygon", "coordinates": [[[0, 0], [1, 0], [1, 1], [0, 1], [0, 0]]]}
BOWTIE = {"type": "Polygon", "coordinates": [[[0, 0], [1, 1], [1, 0], [0, 1], [0, 0]]]}


@pytest.fixture
def run(tmp_path, monkeypatch):
    """Run a command in a folder of its own."""
    monkeypatch.chdir(tmp_path)
    runner = CliRunner()
    return lambda *arguments: runner.invoke(app, list(arguments), env={"COLUMNS": "200"})


@pytest.fixture
def square(tmp_path):
    (tmp_path / "square.geojson").write_text(json.dumps(SQUARE))
    return "square.geojson"


@pytest.fixture
def mesh(tmp_path):
    am.write(tmp_path / "old.mesh", am.generate(am.Domain.rectangle(0, 0, 1, 1), 0.25))
    return "old.mesh"


def assert_bad(result, message):
    """Exit code 1, one block on stderr, no traceback, and nothing left in the folder."""
    assert result.exit_code == 1, result.output
    assert result.stderr.startswith("error: ")
    assert message in result.stderr
    assert "Traceback" not in result.output
    assert not list(Path().glob("out*"))


def assert_usage(result, message):
    assert result.exit_code == 2, result.output
    assert message in " ".join(result.stderr.replace("│", " ").split())
    assert not list(Path().glob("out*"))


def test_help_has_an_example_for_each_command(run):
    commands = ["generate", "adapt", "check", "plot", "convert", "demo"]
    top = run("--help")
    assert top.exit_code == 0
    for command in commands:
        assert command in top.stdout
        assert f"Example: adaptmesh {command} " in run(command, "--help").stdout
    assert "Exit codes" in top.stdout


def test_help_loads_nothing_heavy():
    code = (
        "import sys\nsys.argv = ['adaptmesh', '--help']\n"
        "import atexit\nfrom adaptmesh.cli.commands import main\n"
        "heavy = ('vtkmodules', 'pyvista', 'meshio', 'matplotlib', 'shapely')\n"
        "atexit.register(lambda: print('LOADED', [m for m in heavy if m in sys.modules]))\n"
        "main()\n"
    )
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    assert "LOADED []" in done.stdout


def test_version(run):
    from importlib.metadata import PackageNotFoundError, version

    try:
        expected = version("adaptmesh-metric")
    except PackageNotFoundError:
        pytest.skip("run from a source tree that is not installed")
    assert run("--version").stdout.strip() == f"adaptmesh {expected}"


def test_generate_writes_reports_and_draws(run, square):
    result = run("generate", square, "--size", "0.1 + 0.1*x", "-o", "out.vtu", "--plot", "out.png")
    assert result.exit_code == 0, result.output
    assert result.stdout.startswith("predicted: about ")
    assert "wrote out.vtu: " in result.stdout
    assert result.stderr == ""
    written = am.read("out.vtu")
    assert written.validate().ok
    assert np.sum(written.areas) == pytest.approx(1.0)
    assert Path("out.png").read_bytes().startswith(b"\x89PNG")


def test_generate_quietly(run, square):
    result = run("generate", square, "-s", "0.2", "-o", "out.msh", "-q")
    assert (result.exit_code, result.output) == (0, "")
    assert am.read("out.msh").validate().ok


def test_generate_with_placement(run, square):
    result = run("generate", square, "-s", "0.2", "-o", "out.msh", "--placement", "edges")
    assert result.exit_code == 0, result.output


def test_generate_repairs_on_request_only(run, tmp_path):
    (tmp_path / "bow.geojson").write_text(json.dumps(BOWTIE))
    refused = run("generate", "bow.geojson", "-s", "0.1", "-o", "out.vtu")
    assert_bad(refused, "crossing at (0.5, 0.5)")
    assert "--repair" in refused.stderr
    repaired = run("generate", "bow.geojson", "-s", "0.1", "-o", "a.vtu", "--repair")
    assert repaired.exit_code == 0
    assert "1 repair" in repaired.stdout


def test_repair_writes_what_can_be_read_without_it(run, tmp_path):
    (tmp_path / "bow.geojson").write_text(json.dumps(BOWTIE))
    result = run("repair", "bow.geojson", "-o", "clean.geojson")
    assert result.exit_code == 0, result.output
    assert "crossing: 1" in result.stdout
    assert am.read_domain("clean.geojson").area == am.repair("bow.geojson")[0].area
    assert run("repair", "clean.geojson", "-o", "again.geojson", "-q").output == ""


def test_repair_options_that_make_no_sense(run, square):
    assert run("repair", square, "-o", "out.vtu").exit_code == 2
    assert run("generate", square, "-s", "1", "-o", "a.vtu", "--tolerance", "1").exit_code == 2


def test_generate_from_a_mesh_and_its_metric(run, mesh, tmp_path):
    n = len(am.read(mesh).points)
    values = "\n".join("0.1" for _ in range(n))
    header = f"MeshVersionFormatted 2\nDimension 2\nSolAtVertices\n{n}\n1 1\n"
    (tmp_path / "old.sol").write_text(f"{header}{values}\nEnd\n")
    for command in ("generate", "adapt"):
        result = run(command, mesh, "--metric", "old.sol", "-o", "new.mesh")
        assert result.exit_code == 0, result.output
        assert am.measure(am.read("new.mesh"), 0.1).unit_fraction > 0.95


def test_a_metric_of_another_mesh_is_refused(run, mesh, tmp_path):
    (tmp_path / "few.sol").write_text(
        "MeshVersionFormatted 2\nDimension 2\nSolAtVertices\n2\n1 1\n0.1\n0.1\nEnd\n"
    )
    result = run("adapt", mesh, "--metric", "few.sol", "-o", "out.mesh")
    assert_bad(result, "few.sol: expected values for the 25 vertices of the mesh, got 2")


def test_adapt_keeps_names(run, mesh):
    result = run("adapt", mesh, "--size", "0.1", "-o", "out.mesh")
    assert result.exit_code == 0, result.output
    assert sorted(am.read("out.mesh").names) == sorted(am.read(mesh).names)


def test_check_says_valid(run, mesh):
    result = run("check", mesh)
    assert result.exit_code == 0, result.output
    assert result.stdout.strip() == str(am.read(mesh).validate())
    fit = run("check", mesh, "--size", "0.25")
    assert str(am.measure(am.read(mesh), 0.25)) in fit.stdout


def test_check_holds_a_mesh_against_its_domain(run, square):
    made = run("generate", square, "--size", "0.5", "-o", "out.vtu")
    assert made.exit_code == 0, made.output
    held = run("check", "out.vtu", "--domain", square)
    assert held.exit_code == 0, held.output
    assert "regions of domain" in held.stdout
    Path("other.wkt").write_text("POLYGON ((0 0, 3 0, 3 3, 0 3, 0 0))")
    held = run("check", "out.vtu", "--domain", "other.wkt", "--tolerance", "1e-6")
    assert held.exit_code == 1, held.output
    assert "✗ points present" in held.stdout


def test_check_says_invalid_by_exit_code(run, tmp_path):
    (tmp_path / "overlap.mesh").write_text(
        "MeshVersionFormatted 2\nDimension 2\nVertices\n4\n0 0 0\n1 0 0\n0 1 0\n0.2 0.2 0\n"
        "Triangles\n2\n1 2 3 0\n1 2 4 0\nEnd\n"
    )
    result = run("check", "overlap.mesh")
    assert result.exit_code == 1, result.output
    assert "Traceback" not in result.output


def test_plot(run, mesh):
    for number, show in enumerate(("mesh", "quality", "length", "size", "region")):
        picture = f"{number}.png"
        result = run("plot", mesh, "--show", show, "--size", "0.2", "--ellipses", "-o", picture)
        assert result.exit_code == 0, result.output
        assert Path(picture).read_bytes().startswith(b"\x89PNG")


def test_convert(run, mesh):
    result = run("convert", mesh, "out.vtu")
    assert result.exit_code == 0, result.output
    assert np.array_equal(am.read("out.vtu").triangles, am.read(mesh).triangles)


@pytest.mark.slow
def test_demo(run, monkeypatch):
    from adaptmesh.cli import demo

    cases = demo.make_demo
    monkeypatch.setattr(demo, "make_demo", lambda out, say: cases(out, say, coarsening=10.0))
    result = run("demo", "--out", "new/folder")
    assert result.exit_code == 0, result.output
    assert Path("new/folder/iceland.png").exists()


@pytest.mark.parametrize(
    ("size", "message"),
    [("0.1 +", ""), ("z", "z"), ("__import__('os')", ""), ("-1", ""), ("1/0", ""), ("0*x", "")],
)
def test_bad_sizes(run, square, size, message):
    assert_bad(run("generate", square, f"--size={size}", "-o", "out.vtu"), message)


def test_too_many_vertices_are_refused(run, square):
    result = run("generate", square, "-s", "1e-5", "-o", "out.vtu", "--max-vertices", "1000")
    assert_bad(result, "1,000")


@pytest.mark.parametrize("content", ["", "{", "[]", '{"type": "Point", "coordinates": [0, 0]}'])
def test_bad_domains(run, tmp_path, content):
    (tmp_path / "bad.geojson").write_text(content)
    assert_bad(run("generate", "bad.geojson", "-s", "1", "-o", "out.vtu"), "bad.geojson")


@pytest.mark.parametrize("suffix", [".mesh", ".vtu", ".msh", ".poly"])
def test_bad_meshes(run, tmp_path, suffix):
    (tmp_path / f"bad{suffix}").write_text("nonsense")
    assert_bad(run("generate", f"bad{suffix}", "-s", "1", "-o", "out.vtu"), f"bad{suffix}")
    if suffix != ".poly":
        assert_bad(run("check", f"bad{suffix}"), f"bad{suffix}")
        assert_bad(run("convert", f"bad{suffix}", "out.vtu"), f"bad{suffix}")


def test_an_unknown_output_format_is_refused_before_the_work(run, square, mesh, monkeypatch):
    assert_bad(run("convert", mesh, "out.docx"), "out.docx")
    monkeypatch.setattr(am, "generate", None)
    assert_bad(run("generate", square, "-s", "1", "-o", "out.docx"), "out.docx")
    drawn = run("generate", square, "-s", "1", "-o", "out.vtu", "--plot", "out.docx")
    assert_bad(drawn, "out.docx")
    assert_bad(run("plot", mesh, "-o", "out.docx"), "out.docx")


def test_wrong_usage(run, square, mesh):
    assert_usage(run("generate", "absent.geojson", "-s", "1", "-o", "out.vtu"), "does not exist")
    assert_usage(run("generate", square, "-o", "out.vtu"), "one of --size and --metric")
    assert_usage(run("generate", square, "-s", "1"), "Missing option")
    assert_usage(run("generate", square, "-s", "1", "-o", "no/folder/out.vtu"), "no folder")
    Path("old.sol").write_text("nothing")
    assert_usage(run("generate", square, "-m", "old.sol", "-o", "out.vtu"), "is an outline")
    assert_usage(
        run("generate", square, "-s", "1", "-o", "out.vtu", "--placement", "nowhere"),
        "expected one of",
    )
    assert_usage(run("plot", mesh, "--ellipses", "-o", "out.png"), "need a metric")
    assert_usage(run("plot", mesh, "--show", "length", "-o", "out.png"), "need a metric")
    assert_usage(run("knit"), "No such command")


def test_interrupted(run, square, monkeypatch):
    def interrupted(*_, **__):
        raise KeyboardInterrupt

    monkeypatch.setattr(am, "generate", interrupted)
    result = run("generate", square, "-s", "0.1", "-o", "out.vtu")
    assert result.exit_code == 130
    assert "interrupted" in result.stderr
    assert not Path("out.vtu").exists()


def test_a_full_disk_is_a_neat_error(run, square, monkeypatch):
    def full(path, *_, **__):
        raise OSError(28, "No space left on device", str(path))

    monkeypatch.setattr(am, "write", full)
    assert_bad(run("generate", square, "-s", "0.1", "-o", "out.vtu"), "No space left on device")


@pytest.mark.slow
def test_as_a_module(tmp_path):
    domain, output = tmp_path / "bad.geojson", tmp_path / "out.vtu"
    domain.write_text("{")
    command = [sys.executable, "-m", "adaptmesh", "generate", domain, "--size", "1", "-o", output]
    done = subprocess.run(command, capture_output=True, text=True, check=False)
    assert done.returncode == 1
    assert done.stderr.startswith(f"error: {domain}")
    assert done.stdout == ""
    assert not output.exists()
