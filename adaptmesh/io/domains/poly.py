"""The .poly format of Triangle (Shewchuk): points, segments, holes, regions.

https://www.cs.cmu.edu/~quake/triangle.poly.html ::

    <points> 2 <attributes> <0 or 1 marker>
    <number> <x> <y> [attributes] [marker]        ... each point; numbers start at 0 or 1
    <segments> <0 or 1 marker>
    <number> <point> <point> [marker]             ... each segment
    <holes>
    <number> <x> <y>                              ... each hole
    <regions>                                     ... optional
    <number> <x> <y> <attribute> [greatest area]  ... each region

If the number of points is 0 they are in the .node file beside.
"""

from __future__ import annotations

import os
from pathlib import Path

from adaptmesh.domain.outline import Outline
from adaptmesh.io.meshes.triangle_tables import Table, read_points, read_segments

_LARGEST_TAG = 2**31 - 1


def read_poly(path: str | os.PathLike[str]) -> Outline:
    """Read points and segments in Triangle's .poly format.

    Parameters
    ----------
    path : str or path
        The file; if it says that it has no points they are read from the .node file beside it.

    Returns
    -------
    Outline
        What the file says, unchecked. Segments with a marker other than 0 have it as their tag, and
        for a name its decimal form (``"2"``), unless a comment of ours says what it is; regions are
        named after their attribute, likewise. Area limits of regions are not used: sizes are the
        business of the metric.

    Raises
    ------
    FormatError
        With the line, where the file is truncated or holds something else than it should.
    """
    path = Path(path)
    table = Table(path)
    points = read_points(table)
    if not len(points.places):
        points = read_points(Table(path.with_suffix(".node")))
    segments, markers = read_segments(table, points.first, len(points.places))
    (n_holes,) = table.header("holes")
    holes = table.rows("hole", n_holes, 3)[:, 1:]
    said = {tag: name for name, tag in table.names("edge_tags").items()}
    names: dict[str, list[int]] = {}
    for i, tag in enumerate(markers.tolist()):
        if tag:
            names.setdefault(said.get(tag, str(tag)), []).append(i)
    tags = {name: int(markers[numbers[0]]) for name, numbers in names.items()}
    regions, region_tags = _regions(table) if table else ({}, {})
    table.finish()
    return Outline(points.places, segments, holes, regions, names, tags, region_tags)


def _regions(table: Table) -> tuple[dict[str, list[tuple[float, float]]], dict[str, int]]:
    """Seeds of each region attribute, by its name, and whole numbers of names."""
    said = {float(number): name for name, number in table.names("regions").items()}
    tags: dict[str, int] = {}
    regions: dict[str, list[tuple[float, float]]] = {}
    (count,) = table.header("regions")
    rows = table.rows("region", count, 4)
    for _, x, y, attribute in rows.tolist():
        is_whole = attribute == int(attribute) and abs(attribute) <= _LARGEST_TAG
        name = said.get(attribute, str(int(attribute)) if is_whole else f"{attribute:g}")
        regions.setdefault(name, []).append((x, y))
        if is_whole:
            tags[name] = int(attribute)
    return regions, tags
