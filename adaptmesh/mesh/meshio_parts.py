"""What a mesh of meshio holds, and what of that is a plane mesh of triangles.

Regions of triangles and tags of edges are numbers in an array of cell data, with their names in
``field_data`` or in families; or cells are in sets by name. What is in several sets gets a tag of
its own and the names of all, ``"a|b"``. A tag without a name is the set ``tag_7``, a region
``region_7``, and such names are numbers again when read.
"""

from __future__ import annotations

import re
import warnings
from collections import Counter
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, field

import numpy as np

from adaptmesh.errors import FormatError, FormatWarning
from adaptmesh.types import Array

from .incoming import Content, refuse_cells

NUMBERS = (
    "gmsh:physical", "medit:ref", "cell_tags", "nastran:ref", "netgen:index", "su2:tag",
    "avsucd:material", "ugrid:ref", "regions", "gmsh:geometrical",
)  # fmt: skip
"""What readers of meshio call the numbers of regions and boundaries, the most telling first."""
DIMENSIONS = {"triangle": 2, "line": 1}
NUMBERED = {"triangle": "region_", "line": "tag_"}
"""Names of sets that stand for a number without a name: ``tag_7``."""
_CORNERS = {
    "triangle": ("triangle", 3), "triangle6": ("triangle", 3), "triangle7": ("triangle", 3),
    "triangle10": ("triangle", 3), "line": ("line", 2), "line3": ("line", 2), "line4": ("line", 2),
}  # fmt: skip
_OWN = re.compile(
    r"(nastran|medit|gmsh|netgen|su2|avsucd|ugrid|obj):.*|point_tags|facet_normals|GLOBAL_ID"
)
"""Data that are numbers of parts or made by meshio, not fields."""
_LARGEST = 2.0**62
_MADE_UP = re.compile(r"cd\d_-?\d+")
"""Names that meshio writes for Netgen where there are none."""


@dataclass
class Parts:
    """Blocks of cells of one kind, and values for each block.

    Sets and data have an array, or None, for each block; families are sets of a number.
    """

    points: Array
    cells: list[tuple[str, Array]]
    point_data: dict[str, Array] = field(default_factory=dict)
    cell_data: Mapping[str, Sequence[Array | None]] = field(default_factory=dict)
    cell_sets: Mapping[str, Sequence[Array | None]] = field(default_factory=dict)
    field_data: Mapping[str, Array] = field(default_factory=dict)
    families: dict[int, list[str]] = field(default_factory=dict)
    point_sets: list[str] = field(default_factory=list)
    said: str = ""


# ---------------------------------------------------------------------------------------- reading


def content_of(parts: Parts) -> Content:
    """The triangles, lines, numbers, names and fields of a mesh of meshio.

    Raises
    ------
    FormatError
        For cells that are not triangles, lines or vertices.
    """
    counts = Counter[str]()
    for kind, cells in parts.cells:
        counts[kind] += len(cells)
    refuse_cells({k: c for k, c in counts.items() if k not in _CORNERS and k != "vertex"})
    points = np.asarray(parts.points, np.float64)
    if points.ndim != 2 or points.shape[1] not in (2, 3):
        raise FormatError(f"expected points of 2 or 3 coordinates, got shape {points.shape}")
    triangles, regions, region_names = _labelled(parts, "triangle")
    edges, tags, names = _labelled(parts, "line")
    others = [
        cells[:, _CORNERS[kind][1] :].ravel() for kind, cells in parts.cells if kind in _CORNERS
    ]
    point_fields = {k: v for k, v in parts.point_data.items() if not _OWN.fullmatch(k)}
    metric = point_fields.get("metric")
    if metric is not None and metric.shape == (len(points), 3):
        del point_fields["metric"]
    else:
        metric = None
    return Content(
        points, triangles, regions, edges, tags, names, region_names,
        point_fields=point_fields,
        triangle_fields=_triangle_fields(parts),
        metric=metric,
        others=np.concatenate([np.empty(0, np.int64), *others]).astype(np.int64),
    )  # fmt: skip


def _blocks(parts: Parts, kind: str) -> list[int]:
    return [i for i, (of, _) in enumerate(parts.cells) if _CORNERS.get(of, ("",))[0] == kind]


def _labelled(parts: Parts, kind: str) -> tuple[Array, Array, dict[str, int]]:
    """The cells of a kind by their corners; the tag of each; the tag of each name."""
    blocks = _blocks(parts, kind)
    width = DIMENSIONS[kind] + 1
    if not blocks:
        return np.empty((0, width), np.int64), np.empty(0, np.int64), {}
    for i in blocks:
        if parts.cells[i][1].ndim != 2 or parts.cells[i][1].shape[1] < width:
            raise FormatError(f"a block of {kind} cells has shape {parts.cells[i][1].shape}")
    cells = np.concatenate([parts.cells[i][1][:, :width] for i in blocks]).astype(np.int64)
    for key in NUMBERS:
        numbers = _of_blocks(parts.cell_data.get(key, ()), parts, blocks)
        if numbers is not None and numbers.ndim == 1 and _are_whole(numbers):
            tags = numbers.astype(np.int64)
            if key == "cell_tags":
                return cells, *_of_families(tags, parts.families, kind)
            return cells, tags, _names(parts.field_data, DIMENSIONS[kind])
    starts = np.cumsum([0, *(len(parts.cells[i][1]) for i in blocks)])
    sets: dict[str, Array] = {}
    for name, of in parts.cell_sets.items():
        items = [
            start + np.asarray(part, np.int64).ravel()
            for start, i in zip(starts, blocks, strict=False)
            if i < len(of) and (part := of[i]) is not None and len(part)
        ]
        if items and not name.startswith("gmsh:"):
            sets[name] = np.concatenate(items)
    return cells, *_of_sets(sets, len(cells), kind)


def _are_whole(numbers: Array) -> bool:
    """Whether all are whole numbers that fit into 64 bits."""
    small = np.abs(numbers.astype(np.float64)) < _LARGEST  # false for NaN
    return bool(small.all()) and np.array_equal(numbers, np.rint(numbers))


def _of_blocks(values: Sequence[Array | None], parts: Parts, blocks: Iterable[int]) -> Array | None:
    """The values of all these blocks, if there are as many as cells."""
    found = [values[i] if i < len(values) else None for i in blocks]
    given = [v for v in found if v is not None]
    lengths = [len(parts.cells[i][1]) for i in blocks]
    if len(given) < len(found) or [len(v) for v in given] != lengths:
        return None
    if len({v.shape[1:] for v in given}) != 1:
        return None
    return np.concatenate(given)


def _names(field_data: Mapping[str, Array], dimension: int) -> dict[str, int]:
    out: dict[str, int] = {}
    for name, entry in field_data.items():
        values = np.ravel(entry)
        if len(values) != 2:
            raise FormatError(f"field_data[{name!r}] is {entry}, not a number and a dimension")
        if values[1] == dimension and not _MADE_UP.fullmatch(name):
            out[name] = int(values[0])
    return out


def _of_families(
    numbers: Array, families: Mapping[int, list[str]], kind: str
) -> tuple[Array, dict[str, int]]:
    """Tags and names of cells that have the number of a family of sets."""
    found = sorted(np.unique(numbers[numbers != 0]).tolist(), key=abs)
    sets = {number: "|".join(families.get(number, [])) for number in found}
    if not any(sets.values()):
        return numbers, {}
    items = {sets[n] or str(n): np.flatnonzero(numbers == n) for n in found}
    return _of_sets(items, len(numbers), kind)


def _of_sets(sets: Mapping[str, Array], count: int, kind: str) -> tuple[Array, dict[str, int]]:
    """Tags of cells from sets of their numbers, and the tag of each name."""
    for name, items in sets.items():
        if ((items < 0) | (items >= count)).any():
            raise FormatError(f"the set {name!r} holds a {kind} that there is not")
    member_of: list[list[str]] = [[] for _ in range(count if sets else 0)]
    for name, items in sets.items():
        for item in np.unique(items).tolist():
            member_of[item].append(name)
    labels = ["|".join(of) for of in member_of]
    several = sorted({label for label, of in zip(labels, member_of, strict=True) if len(of) > 1})
    if several:
        warnings.warn(
            f"{kind} cells that are in several sets get a tag and name for all of these: "
            f"{', '.join(map(repr, several[:5]))}",
            FormatWarning,
            stacklevel=7,
        )
    numbered = re.compile(re.escape(NUMBERED[kind]) + r"(-?\d{1,9})")
    number_of = {
        name: int(match[1])
        for name in [*sets, *several]
        if (match := numbered.fullmatch(name)) is not None
    }
    taken = set(number_of.values())
    used = set(labels)
    names: dict[str, int] = {}
    free = 1
    for name in [*sets, *several]:
        if name in number_of or (name not in used and name in sets and len(sets[name])):
            continue
        while free in taken:
            free += 1
        names[name] = free
        taken.add(free)
    tag_of = {"": 0, **number_of, **names}
    return np.array([tag_of[label] for label in labels] or np.zeros(count), np.int64), names


def _triangle_fields(parts: Parts) -> dict[str, Array]:
    out = {}
    blocks = _blocks(parts, "triangle")
    for name, values in parts.cell_data.items():
        if name in NUMBERS or _OWN.fullmatch(name):
            continue
        found = _of_blocks(values, parts, blocks)
        if found is not None:
            out[name] = found
    return out


# ---------------------------------------------------------------------------------------- writing


def sets_of(numbers: Array, names: Mapping[str, int], kind: str) -> dict[str, Array]:
    """The cells under each name; those of a number without a name under ``tag_7``."""
    found = np.unique(numbers[numbers != 0]).tolist()
    name_of = {number: f"{NUMBERED[kind]}{number}" for number in found}
    name_of.update({number: name for name, number in names.items()})
    return {name_of[n]: np.flatnonzero(numbers == n) for n in sorted(name_of)}
