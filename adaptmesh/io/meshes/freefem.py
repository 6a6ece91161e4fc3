"""FreeFEM's own meshes, `.msh`, as its `savemesh` and BAMG write them; read, not written. ::

<vertices> <triangles> <edges>
<x> <y> <label>                       by row
<vertex> <vertex> <vertex> <region>   from 1
<vertex> <vertex> <label>
"""

from __future__ import annotations

from adaptmesh.errors import FormatError
from adaptmesh.files.records import TextCursor
from adaptmesh.files.whole import text_of
from adaptmesh.mesh.incoming import Content


def decode(data: bytes) -> Content:
    """What the file says."""
    cursor = TextCursor(text_of(data).encode())
    vertices, triangles, edges = cursor.rows(1, ("i8", 3))[0][0].tolist()
    points, _ = cursor.rows(vertices, ("f8", 2), ("i8", 1))
    cells, regions = cursor.rows(triangles, ("i8", 3), ("i8", 1))
    sides, labels = cursor.rows(edges, ("i8", 2), ("i8", 1))
    if cursor.left_over():
        raise FormatError(
            f"holds more than {vertices} vertices, {triangles} triangles and {edges} edges, as it "
            "says: it is damaged, or of another program"
        )
    return Content(points, cells - 1, regions[:, 0], sides - 1, labels[:, 0])
