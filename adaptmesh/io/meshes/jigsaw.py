"""JIGSAW's meshes, `.msh`: lines of a keyword and a count, then rows; read, not written. ::

    # comment
    MSHID=3;EUCLIDEAN-MESH
    NDIMS=2
    POINT=4                  x;y;id
    EDGE2=4                  vertex;vertex;id          vertices from 0
    TRIA3=2                  vertex;vertex;vertex;id
    VALUE=4;1                a field at the points
    BOUND=8                  part;edge;kind      edges from 0, that bound each part of a geometry
    POWER=4;1 SEEDS=... and others are passed over

Ids of edges are tags, those of triangles regions. Parts of a geometry are regions: each is what
its edges enclose an odd number of times. Source: the readers of JIGSAW,
<https://github.com/dengwirda/jigsaw>.
"""

from __future__ import annotations

import re
from collections.abc import Iterator

import numpy as np

from adaptmesh.domain.sides.surfaces import seeds_of
from adaptmesh.errors import FormatError
from adaptmesh.files.bounded import whole_number
from adaptmesh.files.located import located
from adaptmesh.files.records import TextCursor
from adaptmesh.files.whole import text_of
from adaptmesh.mesh.incoming import Content, check_vertices, refuse_cells
from adaptmesh.types import Array

_CELLS = {"EDGE2": 3, "TRIA3": 4}
_OTHER_CELLS = {
    "QUAD4": "quadrilaterals", "TRIA4": "tetrahedra", "HEXA8": "hexahedra", "PYRA5": "pyramids",
    "WEDG6": "wedges",
}  # fmt: skip
_TABLE = re.compile(r"([A-Za-z]\w*)\s*=\s*(.*)")


def decode(data: bytes) -> Content:
    """What the file says."""
    points, values = np.empty((0, 2)), None
    bounds = np.empty((0, 3), np.int64)
    cells = {name: np.empty((0, width), np.int64) for name, width in _CELLS.items()}
    for keyword, head, rows in _tables(text_of(data)):
        with located(keyword):
            if keyword == "MSHID" and "MESH" not in head.upper():
                raise FormatError(f"{head!r}: only a EUCLIDEAN-MESH can be read")
            elif keyword == "NDIMS" and head != "2":
                raise FormatError(f"{head} dimensions; only plane meshes can be read")
            elif keyword == "POINT":
                points = _numbers(rows, whole_number(head), 3, "f8")[:, :2]
            elif keyword in _CELLS:
                cells[keyword] = _numbers(rows, whole_number(head), _CELLS[keyword], "i8")
            elif keyword in _OTHER_CELLS:
                refuse_cells({_OTHER_CELLS[keyword]: whole_number(head)})
            elif keyword == "BOUND":
                bounds = _numbers(rows, whole_number(head), 3, "i8")
            elif keyword == "VALUE":
                count, width = (whole_number(word) for word in (head + ";1").split(";")[:2])
                values = _numbers(rows, count, width, "f8")
    edges, triangles = cells["EDGE2"], cells["TRIA3"]
    content = Content(points, triangles[:, :3], triangles[:, 3], edges[:, :2], edges[:, 2])
    if len(bounds) and not len(triangles):
        with located("BOUND"):
            content.hole_seeds, content.region_seeds = _seeds(points, edges[:, :2], bounds)
    if values is not None and len(values) == len(points):
        content.point_fields["value"] = values[:, 0] if values.shape[1] == 1 else values
    return content


def _seeds(points: Array, edges: Array, bounds: Array) -> tuple[Array, dict[int, Array]]:
    """Points in what no part covers, and in each part, by its number."""
    import shapely

    check_vertices("edge", edges, len(points))
    wrong = np.flatnonzero((bounds[:, 1] < 0) | (bounds[:, 1] >= len(edges)))
    if len(wrong):
        raise FormatError(
            f"row {wrong[0]} has edge {bounds[wrong[0], 1]}, but the edges are numbered from 0 to "
            f"{len(edges) - 1}"
        )
    faces = {}
    for part in np.unique(bounds[:, 0]).tolist():
        sides = edges[bounds[bounds[:, 0] == part, 1]]
        faces[part] = shapely.build_area(shapely.MultiLineString(list(points[sides])))
        if faces[part].is_empty:
            raise FormatError(f"the edges of part {part} are not closed")
    holes, regions = seeds_of(faces, {str(part): [part] for part in faces})
    seeds = {int(part): np.array(places) for part, places in regions.items() if part != "0"}
    return np.array(holes).reshape(-1, 2), seeds


def _tables(text: str) -> Iterator[tuple[str, str, list[str]]]:
    """Each keyword, what stands behind its =, and the rows after it."""
    rows: list[str] = []
    head: tuple[str, str] | None = None
    for line in text.split("\n"):
        words = line.split("#", 1)[0].strip()
        match = _TABLE.fullmatch(words)
        if match:
            if head:
                yield *head, rows
            head, rows = (match[1].upper(), match[2].strip()), []
        elif words:
            rows.append(words)
    if head:
        yield *head, rows


def _numbers(rows: list[str], count: int, width: int, code: str) -> Array:
    if len(rows) != count:
        raise FormatError(f"{count} rows are announced, {len(rows)} are there: is it complete?")
    words = [row.rstrip(";").split(";") for row in rows]
    wrong = next((k for k, row in enumerate(words) if len(row) != width), None)
    if wrong is not None:
        raise FormatError(f"row {wrong} has not {width} numbers: {rows[wrong][:60]!r}")
    cursor = TextCursor(" ".join(word or "?" for row in words for word in row).encode())
    return cursor.rows(count, (code, width))[0]
