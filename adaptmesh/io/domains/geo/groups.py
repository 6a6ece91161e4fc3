"""Names of curves and surfaces by their physical groups; those in several have all names."""

from __future__ import annotations

import warnings
from collections.abc import Iterable
from pathlib import Path

from adaptmesh.errors import FormatWarning


def names_of_groups(
    path: Path, groups: Iterable[tuple[str, Iterable[int]]], what: str
) -> dict[str, list[int]]:
    """Members by name, where each has one name; a `FormatWarning` lists those made of several.

    Parameters
    ----------
    path : Path
        The script, for the warning.
    groups : iterable of (name, members)
        A member may be listed twice, and in several groups.
    what : str
        The kind of the members, in the plural.
    """
    groups_of: dict[int, dict[str, None]] = {}
    for name, members in groups:
        for member in members:
            groups_of.setdefault(member, {})[name] = None
    names: dict[str, list[int]] = {}
    for member in sorted(groups_of):
        names.setdefault("|".join(groups_of[member]), []).append(member)
    several = sorted({"|".join(of) for of in groups_of.values() if len(of) > 1})
    if several:
        warnings.warn(
            f"{path}: {what} that are in several physical groups have the names of all: "
            f"{', '.join(several)}",
            FormatWarning,
            stacklevel=4,
        )
    return names
