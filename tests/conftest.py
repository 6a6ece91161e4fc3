"""Where tests find the package and the oracles."""

import importlib.util
import os
import random
import shutil
import subprocess
import sys
from collections import defaultdict
from pathlib import Path

import pytest

# `python -m pytest` in the root of the project puts that first on the path. There the packages are
# sources, which have no compiled core: what is tested is what is installed, be it editable.
ROOT = Path(__file__).resolve().parent.parent
sys.path[:] = [entry for entry in sys.path if Path(entry).resolve() != ROOT]

import adaptmesh  # noqa: E402
import metrics  # noqa: E402

# Lets tests import the oracles: ``from reference.exact import incircle``. Appended, not put first:
# tests/metrics and tests/adaptmesh must not hide the packages.
sys.path.append(str(Path(__file__).parent))


FAST_CASES = 3
"""How many cases of a test are run by ``pytest -m "not slow"`` if it does not say otherwise."""


@pytest.hookimpl(tryfirst=True)
def pytest_collection_modifyitems(items):
    """Mark all but a few cases of each test as slow, the same ones each time.

    A test whose cases take long says how many are few: ``@pytest.mark.fast_cases(2)``.
    """
    cases = defaultdict(list)
    for item in items:
        if item.get_closest_marker("slow") is None:
            cases[item.nodeid.partition("[")[0]].append(item)
    for name, found in cases.items():
        marker = found[0].get_closest_marker("fast_cases")
        few = marker.args[0] if marker else FAST_CASES
        fast = random.Random(name).sample(range(len(found)), min(few, len(found)))
        for number, item in enumerate(found):
            if number not in fast:
                item.add_marker(pytest.mark.slow)


@pytest.fixture(scope="session", autouse=True)
def run_elsewhere(tmp_path_factory):
    """Run in an empty folder, and let new processes find the package that the tests have found.

    From the root of the project a new process would find the sources there first, which have no
    compiled core when the package is installed.
    """
    before = Path.cwd()
    os.environ["PYTHONPATH"] = str(Path(adaptmesh.__file__).parent.parent)
    os.chdir(tmp_path_factory.mktemp("elsewhere"))
    yield
    os.chdir(before)


@pytest.fixture
def plate():
    """Two named regions with an interface, a hole, and names: a bit of everything."""
    points = [
        (0, 0),
        (4, 0),
        (4, 2),
        (0, 2),
        (2, 0),
        (2, 2),
        (0.5, 0.5),
        (1, 0.5),
        (1, 1),
        (0.5, 1),
    ]
    segments = [(0, 4), (4, 1), (1, 2), (2, 5), (5, 3), (3, 0), (4, 5)]
    segments += [(6, 7), (7, 8), (8, 9), (9, 6)]
    return adaptmesh.Domain(
        points,
        segments,
        holes=[(0.75, 0.75)],
        regions={"left": (0.1, 0.1), "right": (3, 1)},
        names={"bottom": [0, 1], "interface": [6], "hole": [7, 8, 9, 10]},
    )


@pytest.fixture
def python_with_dolfinx(tmp_path):
    """Runs a script by an interpreter that has dolfinx: this one, or that of the system.

    The latter can load our core if it is of the same version; it finds a copy of the packages.
    """
    packages = tmp_path / "packages"
    python = sys.executable
    if importlib.util.find_spec("dolfinx") is None:
        python = shutil.which("python3", path="/usr/bin") or pytest.skip("no other python3")
    for package in (adaptmesh, metrics):
        copy = packages / package.__name__
        shutil.copytree(Path(package.__file__).parent, copy)
        shutil.copy(package._core.__file__, copy)
    environment = dict(os.environ, PYTHONPATH=str(packages), OMP_NUM_THREADS="1")

    def run(*arguments):
        command = [python, *map(str, arguments)]
        return subprocess.run(
            command, env=environment, cwd=tmp_path, capture_output=True, text=True, timeout=300
        )

    probe = run("-c", "import adaptmesh, dolfinx")
    if probe.returncode:
        pytest.skip(f"no interpreter with dolfinx: {probe.stderr.strip().splitlines()[-1]}")
    return run
