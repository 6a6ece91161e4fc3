"""Files that the pages for newcomers point to are there, and the drawing has every floor."""

import importlib.util
import re
from pathlib import Path

import pytest

ROOT = Path(__file__).parent.parent
TOP = {"adaptmesh", "metrics", "tests", "docs", "examples"}
PAGES = ["CONTRIBUTING.md", "docs/architecture.md", "docs/contributing.md"]


@pytest.mark.parametrize("page", PAGES)
def test_files_named_on_a_page_are_there(page):
    text = (ROOT / page).read_text("utf-8")
    paths = re.findall(r"`((?!build/|out/)[a-z_]+/[\w./-]+)`", text)
    named = [path if path.split("/")[0] in TOP else f"adaptmesh/{path}" for path in paths]
    assert named
    assert [path for path in named if not (ROOT / path).exists()] == []


def test_every_floor_is_drawn():
    spec = importlib.util.spec_from_file_location("floors", ROOT / "docs" / "floors.py")
    floors = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(floors)
    names = [name for row in floors.layers() for name in row]
    folders = {path.parent.name for path in (ROOT / "adaptmesh").glob("*/__init__.py")}
    assert folders <= set(names)
    drawing, table = floors.drawing(), floors.table()
    for name in names:
        assert f"`{name}`" in table
        assert re.search(rf"<text [^>]*>(?:\d  )?{name}</text>", drawing)
