"""Edges and triangles that are in several physical groups of Gmsh: they get a tag for all of these.

Version 4 lists the groups of an entity, version 2 the element once for each of its groups.
"""

from __future__ import annotations

import warnings

import numpy as np

from adaptmesh.errors import FormatWarning
from adaptmesh.types import Array

from .gmsh_sections import Elements, Sections

_KINDS = {1: "edges", 2: "triangles"}


def in_several(file: Sections, dim: int, elements: Elements) -> Elements:
    """Elements, where those with the same vertices and different groups are one."""
    if not len(elements.nodes):
        return elements
    _, cell = np.unique(np.sort(elements.nodes, axis=1), axis=0, return_inverse=True)
    cell = cell.reshape(-1)
    order = np.lexsort((elements.physical, cell))
    again = cell[order[1:]] == cell[order[:-1]]
    differs = elements.physical[order[1:]] != elements.physical[order[:-1]]
    shared = np.unique(cell[order[1:]][again & differs])
    kept = np.ones(len(cell), bool)
    starts = np.searchsorted(cell[order], [shared, shared + 1])
    for start, stop in starts.T.tolist():
        rows = np.sort(order[start:stop])
        groups = elements.physical[rows]
        elements.physical[rows[0]] = file.shared(dim, groups[groups != 0].tolist())
        kept[rows[1:]] = False
    return type(elements)(elements.tags[kept], elements.nodes[kept], elements.physical[kept])


def name_several(file: Sections, dim: int, tags: Array, names: dict[str, int]) -> None:
    """Give what is in several groups a tag of its own, and the names of all, in place."""
    name_of = {tag: name for name, tag in file.names.get(dim, {}).items()}
    found = {
        code: groups for (of, groups), code in file.several.items() if of == dim and code in tags
    }
    if not found:
        return
    free = 1 + max(0, *names.values(), *tags.tolist(), *(max(g) for g in found.values()))
    added = []
    for tag, (code, groups) in enumerate(found.items(), start=free):
        name = "|".join(name_of.get(g, str(g)) for g in groups)
        names[name] = tag
        tags[tags == code] = tag
        added.append(f"{name!r} ({tag})")
    warnings.warn(
        f"{_KINDS[dim]} that are in several physical groups get a tag and name for all of these: "
        f"{', '.join(added)}",
        FormatWarning,
        stacklevel=7,
    )
