"""Where points of one mesh are in another, and how far outside they may be."""

from __future__ import annotations

import numpy as np

from . import _core
from .errors import TransferError
from .mesh import Mesh
from .spaces import Floats

OUTSIDE = 0.25
"""How far outside of the old mesh a place may be, relative to the longest edge beside it.

The chords of a circle, cut into edges of a right angle each, are off by a fifth of their length.
"""


def located(mesh: Mesh, which: str) -> _core.Locator:
    """What finds points in the triangles of a mesh; `which` names it in errors."""
    flat = np.flatnonzero(~(mesh.areas > 0))
    if len(flat):
        t = int(flat[0])
        raise TransferError(
            f"triangle {t} = {tuple(mesh.triangles[t].tolist())} of the {which} mesh has the area "
            f"{mesh.areas[t]:g}: triangles must be counter-clockwise"
        )
    try:
        return _core.Locator(mesh.points, mesh.triangles)
    except ValueError as error:
        raise TransferError(f"the {which} mesh is not one: {error}") from error


def check_distances(
    places: Floats, distances: Floats, edges: Floats, outside: float, what: str
) -> None:
    """Refuse places (k, 2) that are farther from the old mesh than `outside` times an edge."""
    if not outside >= 0:
        raise TransferError(f"outside={outside!r}: a share of an edge is wanted, 0 or more")
    far = np.flatnonzero(distances > outside * edges)
    if len(far):
        worst = int(far[np.argmax(distances[far])])
        x, y = places[worst].tolist()
        raise TransferError(
            f"{len(far)} {what} lie far outside of the old mesh, one at ({x:g}, {y:g}) by "
            f"{distances[worst]:g}: both meshes must cover the same domain (outside=inf takes the "
            "nearest value of the border all the same)"
        )


def longest_edges(mesh: Mesh) -> Floats:
    """Length of the longest edge of each triangle, (m,)."""
    p = mesh.points[mesh.triangles]
    out: Floats = np.linalg.norm(p - np.roll(p, 1, axis=1), axis=2).max(axis=1)
    return out
