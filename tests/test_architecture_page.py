"""The page on architecture draws the floors of the contracts, and names files that exist."""

import re
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parent.parent
PAGE = (ROOT / "docs" / "architecture.md").read_text()


def test_its_floors_are_those_of_the_contract():
    tomllib = pytest.importorskip("tomllib", reason="Python 3.11")
    contracts = tomllib.loads((ROOT / "pyproject.toml").read_text())["tool"]["importlinter"]
    (layers,) = (c["layers"] for c in contracts["contracts"] if c["type"] == "layers")
    table = PAGE.split("| floor |")[1].split("\n\n")[0]
    rows = [row.split("|")[1] for row in table.splitlines()[2:]]
    drawn = [set(re.findall(r"`(\w+)`", row)) for row in rows]
    assert drawn == [set(re.findall(r"\w+", layer)) for layer in layers]


def test_no_exceptions_from_the_contracts():
    tomllib = pytest.importorskip("tomllib", reason="Python 3.11")
    linter = tomllib.loads((ROOT / "pyproject.toml").read_text())["tool"]["importlinter"]
    assert not linter.get("exclude_type_checking_imports", False)
    for contract in linter["contracts"]:
        assert not {"ignore_imports", "skip_descendants"} & contract.keys()


def test_files_that_it_names_exist():
    named = set(re.findall(r"`([\w/]+\.(?:py|cpp|hpp))`", PAGE)) - {"data.py"}
    assert named
    for name in named:
        assert any((ROOT / package / name).is_file() for package in ("adaptmesh", "metrics")), name
