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
