"""The programs on the page on solvers give the same solution, each where its solver is there."""

import os
import re
import shutil
import subprocess
import sys
from pathlib import Path

import pytest

PAGE = (Path(__file__).parent.parent / "docs" / "solvers.md").read_text("utf-8")
PROGRAMS = dict(
    re.findall(r"^## ([^\n]*)\n(?:(?!^## ).)*?^```python\n(.*?)^```$", PAGE, re.M | re.S)
)
HIGHEST = 0.15364  # of the solution, by quadratic elements on a uniform mesh of 8857 vertices


def check(done):
    assert done.returncode == 0, done.stderr
    vertices, highest = map(float, done.stdout.split()[-2:])
    assert 950 < vertices < 1050
    assert highest == pytest.approx(HIGHEST, rel=3e-3)


@pytest.mark.slow
@pytest.mark.parametrize(("title", "module"), [("scikit-fem", "skfem"), ("NGSolve", "ngsolve")])
def test_program_in_this_python(title, module, tmp_path):
    pytest.importorskip(module)
    check(run_here(PROGRAMS[title], tmp_path))


@pytest.mark.slow
def test_program_in_time(tmp_path):
    pytest.importorskip("skfem")
    done = run_here(PROGRAMS["In time"], tmp_path)
    assert done.returncode == 0, done.stderr
    vertices, heat = map(float, done.stdout.split()[-2:])
    assert vertices == pytest.approx(1000, rel=0.06)
    assert heat == pytest.approx(1, abs=5e-3)  # quadrature of the spot


@pytest.mark.slow
def test_program_for_freefem(tmp_path):
    if not shutil.which("FreeFem++-nw"):
        pytest.skip("no FreeFEM")
    check(run_here(PROGRAMS["FreeFEM"], tmp_path))


@pytest.mark.slow
def test_program_for_dolfinx(python_with_dolfinx):
    old = "from dolfinx import fem\nfem.functionspace = getattr(fem, 'functionspace', None)"
    old += " or fem.FunctionSpace"
    check(python_with_dolfinx("-c", old + "\n" + PROGRAMS["FEniCSx"]))


def test_every_solver_has_a_program():
    assert set(PROGRAMS) == {"scikit-fem", "NGSolve", "FEniCSx", "FreeFEM", "In time"}
    for program in PROGRAMS.values():
        compile(program, "page", "exec")


def run_here(program, folder):
    return subprocess.run(
        [sys.executable, "-c", program],
        cwd=folder,
        env=dict(os.environ, PYTHONUTF8="1"),
        capture_output=True,
        text=True,
        timeout=300,
    )
