"""Names and fields between a mesh and other libraries: sets and tags, values by their number."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import replace

import numpy as np
from numpy.typing import ArrayLike, NDArray

from adaptmesh.errors import FormatError
from adaptmesh.files.located import located
from adaptmesh.mesh.incoming import Content, mesh_of
from adaptmesh.mesh.mesh import Mesh
from adaptmesh.mesh.to_domain import with_interfaces
from adaptmesh.types import Array, Ints

Fields = dict[str, Array]


def incoming(content: Content, origin: str) -> Mesh:
    """The mesh that an object of another library holds, with all its borders and interfaces."""
    with located(origin):
        mesh = mesh_of(content)
    edges, tags = with_interfaces(mesh)
    return replace(mesh, edges=edges, edge_tags=tags)


def names_of_tags(tags: Ints, names: Mapping[str, int]) -> dict[int, str]:
    """The name of each tag that occurs or has one; 0 is left out."""
    found = {int(tag): str(tag) for tag in np.unique(tags) if tag}
    return found | {tag: name for name, tag in names.items() if tag}


def members(tags: Ints, names: Mapping[str, int]) -> dict[str, NDArray[np.intp]]:
    """The numbers of the items under each name."""
    return {name: np.flatnonzero(tags == t) for t, name in names_of_tags(tags, names).items()}


def tags_of_sets(
    sets: Mapping[str, ArrayLike] | None, count: int, what: str, chosen: Iterable[str] | None
) -> tuple[Ints, dict[str, int]]:
    """Tags of `count` items from sets of their numbers, and the tag of each name.

    Parameters
    ----------
    sets : mapping of str to array of int
    what : str
        What the items are, for messages.
    chosen : iterable of str, optional
        The names to be taken; all if not given.
    """
    sets = sets or {}
    names = list(sets if chosen is None else chosen)
    tags = np.zeros(count, np.int32)
    for tag, name in enumerate(names, start=1):
        if name not in sets:
            raise FormatError(f"no {what} is in a set {name!r}; the sets are: {', '.join(sets)}")
        items = np.asarray(sets[name], dtype=np.int64)
        outside = (items < 0) | (items >= count)
        if outside.any():
            raise FormatError(
                f"{name!r} holds {what} {items[outside][0]}, but they are numbered from 0 to "
                f"{count - 1}"
            )
        twice = items[tags[items] != 0]
        if len(twice):
            other = names[tags[twice[0]] - 1]
            raise FormatError(
                f"{what} {twice[0]} is in both {other!r} and {name!r}; a mesh has one name for "
                "each: say which names to take"
            )
        tags[items] = tag
    return tags, {name: tag for tag, name in enumerate(names, start=1)}


def split_fields(mesh: Mesh, fields: Mapping[str, ArrayLike]) -> tuple[Fields, Fields]:
    """The fields at the points, and those of the triangles."""
    n, m = len(mesh.points), len(mesh.triangles)
    at_points: Fields = {}
    of_triangles: Fields = {}
    for name, given in fields.items():
        values = np.asarray(given)
        if values.ndim and len(values) == n:
            at_points[name] = values
        elif values.ndim and len(values) == m:
            of_triangles[name] = values
        else:
            raise ValueError(
                f"the field {name!r}: expected {n} values at the points, or {m} of the triangles, "
                f"got shape {values.shape}"
            )
    return at_points, of_triangles
