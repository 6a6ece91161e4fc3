"""Sphinx configuration. Build with: sphinx-build -W -b html docs docs/_build"""

import subprocess
import sys
from pathlib import Path

import pyvista

import adaptmesh

sys.path.insert(0, str(Path(__file__).parent))
import floors

project = "adaptmesh"
author = "the adaptmesh authors"
copyright = "the adaptmesh authors"
version = release = adaptmesh.__version__

extensions = [
    "myst_parser",
    "numpydoc",
    "sphinx.ext.autodoc",
    "sphinx.ext.autosummary",
    "sphinx.ext.mathjax",
    "sphinx_gallery.gen_gallery",
]
exclude_patterns = ["_build", "generated/cli.md", "generated/floors.md"]

templates_path = ["_templates"]

html_theme = "furo"
html_title = f"adaptmesh {release}"
html_static_path = ["_static"]
html_css_files = ["style.css"]

myst_enable_extensions = ["colon_fence", "deflist", "dollarmath"]
myst_heading_anchors = 3

# Docstrings are numpydoc; a name in single backquotes is a link where it can be one.
default_role = "py:obj"
numpydoc_show_class_members = False  # autosummary lists them
autodoc_typehints = "none"
autodoc_member_order = "bysource"
autosummary_generate = True

# The examples run when the pages are made, so that their pictures and what they print are true.
# `sphinx-build -D plot_gallery=0` leaves that out.
pyvista.BUILDING_GALLERY = True
pyvista.OFF_SCREEN = True
sphinx_gallery_conf = {
    "examples_dirs": "../examples",
    "gallery_dirs": "generated/gallery",
    "filename_pattern": r"/\d\d_",
    "ignore_pattern": r"/data/",
    "image_scrapers": ("pyvista", "matplotlib"),
    "within_subsection_order": "FileNameSortKey",
    "abort_on_example_error": True,
    "download_all_examples": False,
    "show_memory": False,
    "show_signature": False,
    "write_computation_times": False,
}


def write_command_reference() -> None:
    """The options of each command, from the command line itself."""
    target = Path(__file__).parent / "generated" / "cli.md"
    target.parent.mkdir(exist_ok=True)
    command = [sys.executable, "-m", "typer", "adaptmesh.cli.commands", "utils", "docs"]
    text = subprocess.run([*command, "--name", "adaptmesh"], check=True, stdout=subprocess.PIPE)
    target.write_bytes(text.stdout)


write_command_reference()
floors.write(Path(__file__).parent / "generated")
