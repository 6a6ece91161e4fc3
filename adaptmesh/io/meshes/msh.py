"""Which program a `.msh` file is of: Gmsh, FreeFEM (or BAMG), or JIGSAW."""

from __future__ import annotations

import re

from adaptmesh.errors import FormatError
from adaptmesh.files.whole import without_mark
from adaptmesh.mesh.incoming import Content

from . import freefem, gmsh, jigsaw

_NUMBERS = re.compile(rb"\s*\d+\s+\d+\s+\d+\s")
_JIGSAW = re.compile(rb"(?:\s|#[^\n]*\n)*MSHID\s*=", re.IGNORECASE)


def decode(data: bytes) -> Content:
    """What the file says."""
    data = without_mark(data)
    if data.lstrip()[:1] == b"$":
        return gmsh.decode(data)
    if _JIGSAW.match(data):
        return jigsaw.decode(data)
    if _NUMBERS.match(data):
        return freefem.decode(data)
    raise FormatError(
        "does not start with $MeshFormat or $NOD (Gmsh), three counts (FreeFEM, BAMG) or MSHID "
        "(JIGSAW): it is damaged, or of another program; convert it, for example with meshio"
    )
