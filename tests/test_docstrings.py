"""The examples in docstrings run, each pasted into a new session of Python, in an empty folder."""

from __future__ import annotations

import doctest
import importlib
import pkgutil

import pytest

import adaptmesh
import metrics


def modules():
    for package in (adaptmesh, metrics):
        yield package
        for found in pkgutil.walk_packages(package.__path__, f"{package.__name__}."):
            if not found.name.endswith("__main__"):
                yield importlib.import_module(found.name)


def examples():
    """Every docstring with an example, by the full name of what it describes."""
    finder = doctest.DocTestFinder(exclude_empty=True)
    found = [test for module in modules() for test in finder.find(module)]
    return {test.name: test for test in found if test.examples}


EXAMPLES = examples()
NEEDS = {  # what is not installed with the package
    "adaptmesh.convert.matplotlib.to_matplotlib": "matplotlib",
    "adaptmesh.convert.skfem.to_skfem": "skfem",
}


@pytest.mark.parametrize("name", EXAMPLES)
def test_example_runs_and_gives_what_it_says(name, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    if name in NEEDS:
        pytest.importorskip(NEEDS[name])
    test = EXAMPLES[name]
    test.globs = {}  # what it needs it imports
    said: list[str] = []
    result = doctest.DocTestRunner().run(test, out=said.append)
    assert result.attempted
    assert not result.failed, "".join(said)


def test_examples_are_found():
    assert {
        "adaptmesh.quality.explain.explain",
        "adaptmesh.domain.domain.Domain.from_curves",
    } <= set(EXAMPLES)
    assert len(EXAMPLES) >= 18
