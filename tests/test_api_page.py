"""The page of the API lists every public name."""

import re
from pathlib import Path

import pytest

import adaptmesh
import adaptmesh.convert
import metrics

MODULES = [adaptmesh, adaptmesh.convert, adaptmesh.curves, metrics, metrics.tensor]
PAGE = Path(__file__).parent.parent / "docs" / "api.md"


@pytest.mark.parametrize("module", MODULES, ids=lambda m: m.__name__)
def test_every_public_name_is_listed(module):
    sections = re.split(r"\.\. currentmodule:: (.*)\n", PAGE.read_text("utf-8"))
    listed = dict(zip(sections[1::2], sections[2::2], strict=True))[module.__name__]
    names = set(re.findall(r"^(?:   |\.\. py:\w+:: )(\w+)$", listed, re.MULTILINE))
    assert set(module.__all__) - {"tensor", "curves"} == names
