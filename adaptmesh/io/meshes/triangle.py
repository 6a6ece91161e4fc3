"""Triangle's meshes (Shewchuk): `.ele` with `.node`, and with `.poly` for the edges beside it.

https://www.cs.cmu.edu/~quake/triangle.node.html, and there .ele and .poly ::

    .node   <points> 2 <attributes> <0 or 1 marker>
            <number> <x> <y> [attributes] [marker]         ... each point; from 0 or 1
    .ele    <triangles> 3 <attributes>
            <number> <point> <point> <point> [attributes]  ... each triangle
    .poly   0 2 0 0                                        ... the points are in .node
            <segments> <0 or 1 marker>
            <number> <point> <point> [marker]              ... each constrained edge
            <holes>
            <number> <x> <y>                               ... a point in each hole
            <regions>
            <number> <x> <y> <region>                      ... and in each part of each region

Attributes of points are fields, the first of triangles is the region, the others are fields. What
the formats have no place for is in comments, see `adaptmesh.io.meshes.triangle_tables`.
"""

from __future__ import annotations

import json
from collections.abc import Mapping
from pathlib import Path

import numpy as np

from adaptmesh.files.located import located
from adaptmesh.mesh.incoming import Content
from adaptmesh.types import Array

from .counts import check_stated, stated
from .triangle_tables import COUNTS, END, OURS, Table, read_points, read_segments

# ---------------------------------------------------------------------------------------- writing


def save(path: Path, content: Content) -> dict[Path, bytes]:
    """The bytes of `.node`, `.poly` and `.ele`."""
    n, m, k = len(content.points), len(content.triangles), len(content.edges)
    point_fields = dict(content.point_fields)
    if content.metric is not None:
        point_fields["metric"] = content.metric
    of_points = [_columns(v) for v in point_fields.values()]
    of_triangles = [content.regions[:, None], *map(_columns, content.triangle_fields.values())]
    seeds = np.concatenate([np.empty((0, 2)), *content.region_seeds.values()])
    numbers = np.repeat([*content.region_seeds], [len(s) for s in content.region_seeds.values()])
    on_edge = np.zeros((n, 1), np.int64)
    on_edge[content.edges.ravel()] = 1
    node = [
        *_field_comments(point_fields),
        _header(n, 2, sum(v.shape[1] for v in of_points), 1),
        _rows(content.points, *of_points, on_edge),
    ]
    ele = [
        f"# {COUNTS} {stated(content)}\n",
        *_field_comments(content.triangle_fields),
        *_name_comments("regions", content.region_names),
        *([f"# periodic 1 {json.dumps(content.periodic)}\n"] if content.periodic else []),
        _header(m, 3, sum(v.shape[1] for v in of_triangles)),
        _rows(content.triangles, *of_triangles),
    ]
    poly = [
        *_name_comments("edge_tags", content.names),
        *_name_comments("regions", content.region_names),
        _header(0, 2, 0, 0),
        _header(k, 1),
        _rows(content.edges, content.edge_tags[:, None]),
        _header(len(content.hole_seeds)),
        _rows(content.hole_seeds),
        _header(len(seeds)),
        _rows(seeds, numbers[:, None]),
    ]
    files = {".node": node, ".poly": poly, ".ele": ele}
    return {
        path.with_suffix(end): "".join([f"# {OURS}\n", *parts, f"# {END}\n"]).encode()
        for end, parts in files.items()
    }


def _columns(values: Array) -> Array:
    return values.reshape(len(values), -1)


def _header(*numbers: int) -> str:
    return " ".join(map(str, numbers)) + "\n"


def _rows(*parts: Array) -> str:
    """Numbered rows of columns side by side; floats with all their digits."""
    columns = [map(repr, c.tolist()) for part in parts for c in part.T]
    rows = zip(map(str, range(len(parts[0]))), *columns, strict=True)
    return "".join(" ".join(row) + "\n" for row in rows)


def _field_comments(fields: Mapping[str, Array]) -> list[str]:
    return [
        f"# field {_columns(values).shape[1]} {json.dumps(name)}\n"
        for name, values in fields.items()
    ]


def _name_comments(kind: str, names: Mapping[str, int]) -> list[str]:
    return [f"# {kind} {number} {json.dumps(name)}\n" for name, number in names.items()]


# ---------------------------------------------------------------------------------------- reading


def load(path: Path, fields: bool) -> Content:
    """What `.ele`, `.node` and, if it is there, `.poly` say."""
    ele, node = Table(path), Table(path.with_suffix(".node"))
    points = read_points(node)
    triangles, others, regions, triangle_fields = _triangles(ele, points.first)
    edges, tags, names = _edges(path.with_suffix(".poly"), points.first, len(points.places))
    content = Content(
        points.places,
        triangles,
        regions=regions,
        edges=edges,
        edge_tags=tags,
        names=names,
        region_names=ele.names("regions"),
        point_fields=node.fields(points.attributes),
        triangle_fields=triangle_fields,
        others=others,
        periodic=ele.periodic(),
    )
    content.metric = content.point_fields.pop("metric", None)
    for table in (ele, node):
        table.finish()
    if ele.counts:
        with located(path):
            check_stated(ele.counts, content)
    return content


def _triangles(ele: Table, first: int) -> tuple[Array, Array, Array, dict[str, Array]]:
    """Corners, all other nodes, regions, and fields."""
    count, corners, attributes = ele.header("triangles", 3, 0)
    if corners not in (3, 6):
        raise ele.error(f"triangles of {corners} points; 3 can be read, or 6")
    rows = ele.rows("triangle", count, 1 + corners + attributes, finite=1 + corners)
    extra = rows[:, 1 + corners :]
    is_region = attributes > 0 and (extra[:, 0] == np.round(extra[:, 0])).all()
    regions = extra[:, :1] if is_region else np.zeros((count, 1))
    nodes = ele.whole("triangle", rows[:, 1 : 1 + corners]) - first
    regions = ele.whole("region", regions)[:, 0]
    fields = ele.fields(extra, skip=int(is_region))
    return nodes[:, :3], nodes[:, 3:].ravel(), regions, fields


def _edges(path: Path, first: int, n_points: int) -> tuple[Array, Array, dict[str, int]]:
    """Constrained edges, their tags, and names of these."""
    if not path.exists():
        return np.empty((0, 2), np.int64), np.empty(0, np.int64), {}
    poly = Table(path)
    read_points(poly)  # if there are any, they are those in .node
    return *read_segments(poly, first, n_points), poly.names("edge_tags")
