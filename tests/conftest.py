"""Where tests find the package and the oracles."""

import os
import sys
from pathlib import Path

import pytest

import adaptmesh

# Lets tests import the oracles: ``from reference.exact import incircle``. Appended, not put first:
# tests/metrics and tests/adaptmesh must not hide the packages.
sys.path.append(str(Path(__file__).parent))


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
