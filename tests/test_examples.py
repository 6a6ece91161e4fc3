"""Each example runs alone, and so does the code on the pages that show how to use it."""

import os
import re
import subprocess
import sys
from functools import cache
from pathlib import Path

import pytest

ROOT = Path(__file__).parent.parent
EXAMPLES = sorted((ROOT / "examples").glob("[0-9]*.py"))
# The programs of this page need solvers; test_solvers_page.py runs each where its solver is there.
NEED_SOLVERS = "solvers.md"
PAGES = [
    page
    for page in (ROOT / "README.md", *sorted((ROOT / "docs").glob("*.md")))
    if "```python" in page.read_text("utf-8") and page.name != NEED_SOLVERS
]

# Replaces the pictures where none can be drawn, as on a server without any OpenGL.
NO_PICTURES = (
    "import types, adaptmesh; "
    "adaptmesh.plot = lambda *_, **__: types.SimpleNamespace(show=lambda: None)\n"
)


@pytest.mark.slow
@pytest.mark.parametrize("example", EXAMPLES, ids=lambda path: path.stem)
def test_example_runs_and_asserts(example, tmp_path):
    code = example.read_text(encoding="utf-8")
    assert re.search(r"^assert ", code, re.MULTILINE), "an example asserts a number"
    if "import skfem" in code:
        pytest.importorskip("skfem")
    assert ").show()" in code, "an example shows a picture"
    code = f"import sys; sys.argv = [{str(example)!r}]\n" + (
        code if can_draw() else NO_PICTURES + code
    )
    run = run_python(code, tmp_path)
    assert run.returncode == 0, run.stderr
    assert "Unit mesh report" in run.stdout


def test_pages_with_code_are_found():
    known = {"README", "start", "domains", "metrics", "measures", "repair", "files", "transfer"}
    assert known <= {page.stem for page in PAGES}


@pytest.mark.fast_cases(1)
@pytest.mark.parametrize("page", PAGES, ids=lambda path: path.stem)
def test_code_of_a_page_runs_and_prints_what_the_page_says(page, tmp_path):
    """One page, one session, in an empty folder."""
    text = page.read_text("utf-8")
    code, messages = blocks(text, "python"), blocks(text, "text")
    assert len(code) == text.count("```python")
    run = run_python(("" if can_draw() else NO_PICTURES) + "\n".join(code), tmp_path)
    assert run.returncode == 0, run.stderr
    for message in messages:
        assert message in run.stdout


def blocks(page, language):
    """The code blocks of a page that are marked as of a language."""
    return re.findall(rf"^```{language}\n(.*?)^```$", page, re.MULTILINE | re.DOTALL)


@cache
def can_draw():
    """Whether a picture can be drawn here; in another process, as VTK may end it."""
    code = (
        "import pyvista as pv; p = pv.Plotter(off_screen=True); p.add_mesh(pv.Sphere()); p.show()"
    )
    return run_python(code, ROOT).returncode == 0


def run_python(code, folder):
    """Run code as a script in a folder."""
    no_windows = {"PYVISTA_OFF_SCREEN": "true", "MPLBACKEND": "agg"}
    environment = dict(os.environ, PYTHONUTF8="1", OPENBLAS_NUM_THREADS="1", **no_windows)
    return subprocess.run(
        [sys.executable, "-c", code],
        cwd=folder,
        env=environment,
        capture_output=True,
        text=True,
        encoding="utf-8",
        timeout=300,
    )
