"""The floors of `adaptmesh`, drawn from the contract that import-linter checks.

Called by `conf.py` when the pages are made, so that page and contract cannot differ: the rows are
the layers of ``[tool.importlinter]`` in ``pyproject.toml``, the words the first lines of the
docstrings of the folders.
"""

from __future__ import annotations

import ast
import re
from html import escape
from pathlib import Path

ROOT = Path(__file__).parent.parent
ROAD = ("domain", "boundary", "generate", "core", "mesh", "quality", "view")
"""Where a call of `generate` comes by, from a domain to a picture."""

WIDTH, ROW, GAP = 760, 34, 8


def layers() -> list[list[str]]:
    """The names on each floor, the top one first."""
    text = (ROOT / "pyproject.toml").read_text("utf-8")
    found = re.search(r'^type = "layers"$.*?^layers = (\[.*?^\])', text, re.MULTILINE | re.DOTALL)
    if found is None:
        raise ValueError("pyproject.toml has no contract with layers: what shall be drawn?")
    return [[name.strip(" ()") for name in row.split("|")] for row in ast.literal_eval(found[1])]


def about(package: str, name: str) -> str:
    """The first line of the docstring of a folder or module, without its full stop."""
    path = ROOT / package / name / "__init__.py"
    if not path.exists():
        path = ROOT / package / f"{name}.py"
    docstring = ast.get_docstring(ast.parse(path.read_text("utf-8"))) or ""
    return docstring.partition("\n")[0].rstrip(".")


def table() -> str:
    """A row for each floor, in Markdown."""
    rows = ["| floor | what is on it |", "|---|---|"]
    for names in layers():
        words = " · ".join(about("adaptmesh", name) for name in names)
        rows.append(f"| {', '.join(f'`{name}`' for name in names)} | {words} |")
    return "\n".join(rows) + "\n"


def drawing() -> str:
    """The floors as SVG, with the numbers of the road; below them the cores, and `metrics`."""
    rows = [*layers(), ["core"]]
    missing = set(ROAD) - {name for row in rows for name in row}
    if missing:
        raise ValueError(f"the road comes by {', '.join(sorted(missing))}, which is on no floor")
    parts, y = [], GAP
    for row in rows:
        width = (WIDTH - GAP * (len(row) + 1)) / len(row)
        for number, name in enumerate(row):
            label = "core: compiled, C++" if name == "core" else name
            step = f"{ROAD.index(name) + 1}  " if name in ROAD else ""
            parts += box(GAP + number * (width + GAP), y, width, f"{step}{label}", name == "core")
        y += ROW + GAP
    ground = "metrics: tensors, control spaces, metrics from solutions, measures; and its core"
    parts += box(GAP, y + GAP, WIDTH - 2 * GAP, ground, False)
    words = "Floors of adaptmesh: " + "; ".join(", ".join(row) for row in rows) + "; metrics."
    return (
        f'<svg class="drawing" viewBox="0 0 {WIDTH} {y + ROW + 2 * GAP}" role="img" '
        f'aria-label="{escape(words)}">\n' + "\n".join(parts) + "\n</svg>\n"
    )


def box(x: float, y: float, width: float, label: str, is_core: bool) -> list[str]:
    """A rectangle with words in its middle."""
    kind = "core" if is_core else "box"
    return [
        f'<rect class="{kind}" x="{x:.1f}" y="{y}" width="{width:.1f}" height="{ROW}" rx="4"/>',
        f'<text class="name" x="{x + width / 2:.1f}" y="{y + ROW / 2 + 4}">{escape(label)}</text>',
    ]


def write(folder: Path) -> None:
    """Write ``floors.svg`` and ``floors.md``."""
    folder.mkdir(exist_ok=True)
    (folder / "floors.svg").write_text(drawing(), "utf-8")
    (folder / "floors.md").write_text(table(), "utf-8")
