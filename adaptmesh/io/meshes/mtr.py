"""Metrics of BAMG, `.mtr`: how many, 1 or 3 columns, and the rows: sizes h, or m11 m12 m22.

::

    7 3
    100 0 25
    ...
"""

from __future__ import annotations

import re

from adaptmesh.errors import FormatError
from adaptmesh.files.records import TextCursor, one
from adaptmesh.files.whole import text_of
from adaptmesh.types import Array


def decode(data: bytes) -> Array:
    """The sizes (n,) or packed metrics (n, 3) of a file."""
    cursor = TextCursor(re.sub(r"#[^\n]*", "", text_of(data)).encode())
    count, columns = one(cursor), one(cursor)
    if columns not in (1, 3):
        raise FormatError(f"expected rows of 1 size or 3 entries of a metric, got {columns}")
    values = cursor.rows(count, ("f8", columns))[0]
    if cursor.left_over():
        raise FormatError(f"has more than {count} rows of {columns} values")
    return values[:, 0] if columns == 1 else values
