"""Triangle's meshes (Shewchuk): `.ele` with `.node`, and with `.poly` for the edges beside it.

https://www.cs.cmu.edu/~quake/triangle.node.html, and there .ele and .poly ::

    .node   <points> 2 <attributes> <0 or 1 marker>
            <number> <x> <y> [attributes] [marker]         ... each point; from 0 or 1
    .ele    <triangles> 3 <attributes>
            <number> <point> <point> <point> [attributes]  ... each triangle
    .poly   0 2 0 0                                        ... the points are in .node
            <segments> <0 or 1 marker>
            <number> <point> <point> [marker]              ... each constrained edge
            <holes> ...

Attributes of points are fields, the first of triangles is the region, the others are fields.
Everything after ``#`` is a comment; what the formats have no place for is in comments of ours, and
comes back::

    # adaptmesh                  first; the last line is then "# end", or the file was cut short
    # field 1 "u"                a field by its number of columns, in the order of attributes
    # edge_tags 3 "inlet"        the name of a tag, in .poly
    # regions 7 "steel"          and of a region, in .ele
"""

from __future__ import annotations

import json
import re
from collections.abc import Mapping
from dataclasses import dataclass, field
from pathlib import Path

import numpy as np

from ..errors import FormatError
from .content import Array, Content
from .files import read_bytes

_COMMENT = re.compile(r"#[^\n]*")
_OURS, _END = "adaptmesh", "end"

# ---------------------------------------------------------------------------------------- writing


def encode(content: Content, path: Path) -> dict[Path, bytes]:
    """The bytes of `.node`, `.poly` and `.ele`."""
    n, m, k = len(content.points), len(content.triangles), len(content.edges)
    point_fields = dict(content.point_fields)
    if content.metric is not None:
        point_fields["metric"] = content.metric
    of_points = [_columns(v) for v in point_fields.values()]
    of_triangles = [content.regions[:, None], *map(_columns, content.triangle_fields.values())]
    on_edge = np.zeros((n, 1), np.int64)
    on_edge[content.edges.ravel()] = 1
    node = [
        *_field_comments(point_fields),
        _header(n, 2, sum(v.shape[1] for v in of_points), 1),
        _rows(content.points, *of_points, on_edge),
    ]
    ele = [
        *_field_comments(content.triangle_fields),
        *_name_comments("regions", content.region_names),
        _header(m, 3, sum(v.shape[1] for v in of_triangles)),
        _rows(content.triangles, *of_triangles),
    ]
    poly = [
        *_name_comments("edge_tags", content.names),
        _header(0, 2, 0, 0),
        _header(k, 1),
        _rows(content.edges, content.edge_tags[:, None]),
        _header(0),
    ]
    files = {".node": node, ".poly": poly, ".ele": ele}
    return {
        path.with_suffix(end): "".join([f"# {_OURS}\n", *parts, f"# {_END}\n"]).encode()
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


def decode(path: Path) -> Content:
    """What `.ele`, `.node` and, if it is there, `.poly` say."""
    ele, node = _Table.of(path), _Table.of(path.with_suffix(".node"))
    points, first, point_fields = _points(node)
    triangles, regions, triangle_fields = _triangles(ele, first)
    edges, tags, names = _segments(path.with_suffix(".poly"), first)
    content = Content(
        points,
        triangles,
        regions=regions,
        edges=edges,
        edge_tags=tags,
        names=names,
        region_names=ele.names("regions"),
        point_fields=point_fields,
        triangle_fields=triangle_fields,
    )
    content.metric = content.point_fields.pop("metric", None)
    return content


@dataclass
class _Table:
    """The numbers of a file, taken from the front, and its comments."""

    path: Path
    words: list[str]
    comments: list[list[str]]
    used: int = field(default=0)

    @classmethod
    def of(cls, path: Path) -> _Table:
        try:
            text = read_bytes(path).decode()
        except UnicodeDecodeError as error:
            raise FormatError(f"{path} is not a text file: {error}") from None
        comments = [c[1:].split(maxsplit=2) for c in _COMMENT.findall(text)]
        if [_OURS] in comments and comments[-1] != [_END]:
            raise FormatError(f"{path} does not end with '# {_END}': the file is cut short")
        return cls(path, _COMMENT.sub("", text).split(), comments)

    def header(self, what: str, count: int) -> list[int]:
        values = self._numbers(what, count)
        if not ((values >= 0) & (values < 2.0**53) & (values == np.round(values))).all():
            raise FormatError(f"{self.path}: {what} is {values.tolist()}, not whole numbers")
        out: list[int] = values.astype(np.int64).tolist()
        return out

    def rows(self, what: str, count: int, width: int) -> Array:
        """The next rows, (count, width)."""
        return self._numbers(what, count * width).reshape(count, width)

    def _numbers(self, what: str, count: int) -> Array:
        words = self.words[self.used : self.used + count]
        if len(words) < count:
            raise FormatError(
                f"{self.path} ends in {what}: {count} numbers were expected there and {len(words)} "
                "came; is the file complete?"
            )
        self.used += count
        try:
            return np.array(words, np.float64)
        except ValueError as error:
            raise FormatError(f"{self.path}: in {what}: {error}") from None

    def fields(self, values: Array, skip: int = 0) -> dict[str, Array]:
        """Attributes by the names in comments, or as attribute_0, attribute_1, ..."""
        out: dict[str, Array] = {}
        at = skip
        for name, width in self._said("field"):
            if not 0 < width <= values.shape[1] - at:
                raise FormatError(f"{self.path}: the comment on field {name!r} fits no attributes")
            columns = values[:, at : at + width]
            out[name] = columns[:, 0] if width == 1 else columns
            at += width
        for k in range(at, values.shape[1]):
            out[f"attribute_{k - skip}"] = values[:, k]
        return out

    def names(self, kind: str) -> dict[str, int]:
        return dict(self._said(kind))

    def _said(self, kind: str) -> list[tuple[str, int]]:
        """Names and numbers in comments of ours of that kind."""
        found = [words for words in self.comments if len(words) == 3 and words[0] == kind]
        try:
            return [(str(json.loads(name)), int(number)) for _, number, name in found]
        except ValueError:
            raise FormatError(f"{self.path}: a comment on {kind} has no number and name") from None


def _points(node: _Table) -> tuple[Array, int, dict[str, Array]]:
    """The points, the number of the first, and their fields."""
    count, dimension, attributes, markers = node.header("the header", 4)
    if dimension != 2 or markers not in (0, 1):
        raise FormatError(
            f"{node.path}: the header has {dimension} coordinates and {markers} "
            "markers a point, not 2, and 0 or 1"
        )
    rows = node.rows("the points", count, 3 + attributes + markers)
    first = int(rows[0, 0]) if count else 0
    if first not in (0, 1) or (rows[:, 0] != first + np.arange(count)).any():
        raise FormatError(f"{node.path}: the points are not numbered 0, 1, 2, ... or 1, 2, 3, ...")
    return rows[:, 1:3], first, node.fields(rows[:, 3 : 3 + attributes])


def _triangles(ele: _Table, first: int) -> tuple[Array, Array, dict[str, Array]]:
    count, corners, attributes = ele.header("the header", 3)
    if corners not in (3, 6):
        raise FormatError(f"{ele.path}: triangles of {corners} points; 3 can be read, or 6")
    rows = ele.rows("the triangles", count, 1 + corners + attributes)
    extra = rows[:, 1 + corners :]
    is_region = attributes > 0 and (extra[:, 0] == np.round(extra[:, 0])).all()
    regions = extra[:, 0] if is_region else np.zeros(count)
    vertices = _whole(ele.path, "triangle", rows[:, 1:4]) - first
    return vertices, _whole(ele.path, "region", regions), ele.fields(extra, skip=int(is_region))


def _segments(path: Path, first: int) -> tuple[Array, Array, dict[str, int]]:
    """Constrained edges, their tags, and names of these."""
    if not path.exists():
        return np.empty((0, 2), np.int64), np.empty(0, np.int64), {}
    poly = _Table.of(path)
    n, _, attributes, markers = poly.header("the header", 4)
    poly.rows("the points", n, 3 + attributes + markers)  # those in .node count
    count, markers = poly.header("the number of segments", 2)
    rows = _whole(path, "segment", poly.rows("the segments", count, 3 + min(markers, 1)))
    tags = rows[:, 3] if markers else np.zeros(count, np.int64)
    return rows[:, 1:3] - first, tags, poly.names("edge_tags")


def _whole(path: Path, what: str, values: Array) -> Array:
    good = (np.abs(values) < 2.0**53) & (values == np.round(values))
    if not good.all():
        row = int(np.argwhere(~good)[0, 0])
        raise FormatError(f"{path}: {what} {row} has a number that is not whole: {values[row]}")
    out: Array = values.astype(np.int64)
    return out
