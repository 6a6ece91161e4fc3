"""Location of points of one mesh in another, and checks of both."""

from __future__ import annotations

from dataclasses import dataclass
from numbers import Real

import numpy as np

from adaptmesh._core import Locator
from adaptmesh.errors import TransferError
from adaptmesh.mesh.mesh import Mesh
from adaptmesh.types import Floats, Ints

OUTSIDE = 0.25
"""How far outside of the old mesh a place may be, relative to the longest edge beside it.

The chords of a circle, cut into edges of a right angle each, are off by a fifth of their length.
"""

SMALLEST_AREA, LARGEST_AREA = 1e-250, 1e250
"""Of triangles, so that areas of parts of them neither underflow nor overflow."""

REMEDIES = {
    "old": "outside=inf takes the nearest values of the border all the same",
    "new": "outside=inf leaves out all the same what the new mesh does not cover",
}


@dataclass(frozen=True)
class MeshLocator:
    """A mesh, what it is called in errors, and what finds points in its triangles."""

    mesh: Mesh
    which: str
    locator: Locator


def make_locator(mesh: Mesh, which: str) -> MeshLocator:
    """The "old" or the "new" mesh, with what finds points in it.

    Raises
    ------
    TransferError
        As for `check_mesh`; a triangle is not counter-clockwise, or too small or large for its area
        to be a number of full precision; or the triangles are not a mesh.
    """
    check_mesh(mesh, which)
    bad = np.flatnonzero(~((mesh.areas >= SMALLEST_AREA) & (mesh.areas <= LARGEST_AREA)))
    if len(bad):
        t = int(bad[0])
        area = float(mesh.areas[t])
        remedy = (
            "expected a size between 1e-125 and 1e125, in other units"
            if area > 0
            else "triangles must be counter-clockwise"
        )
        raise TransferError(
            f"triangle {t} = {tuple(mesh.triangles[t].tolist())} of the {which} mesh has the area "
            f"{area:g}: {remedy}"
        )
    try:
        return MeshLocator(mesh, which, Locator(mesh.points, mesh.triangles))
    except ValueError as error:
        raise TransferError(f"the {which} mesh is not one: {error}") from error


def check_mesh(mesh: Mesh, which: str) -> None:
    """Raise for what is not a mesh, points that are not finite, and numbers of missing points.

    Raises
    ------
    TransferError
    """
    if not isinstance(mesh, Mesh):
        raise TransferError(f"the {which} mesh: expected a Mesh, got {type(mesh).__name__}")
    points, triangles = mesh.points, mesh.triangles
    if not len(triangles):
        raise TransferError(f"the {which} mesh has no triangles: expected one at least")
    bad = np.flatnonzero(~np.isfinite(points).all(axis=1))
    if len(bad):
        raise TransferError(
            f"point {bad[0]} of the {which} mesh is {tuple(points[bad[0]].tolist())}: expected "
            "finite coordinates"
        )
    bad = np.flatnonzero(((triangles < 0) | (triangles >= len(points))).any(axis=1))
    if len(bad):
        raise TransferError(
            f"triangle {bad[0]} = {tuple(triangles[bad[0]].tolist())} of the {which} mesh: "
            f"expected numbers of points from 0 to {len(points) - 1}"
        )


def check_no_loose_points(mesh: Mesh, which: str) -> None:
    """Refuse a mesh with a point in no triangle, where no field is known."""
    loose = np.flatnonzero(np.bincount(mesh.triangles.ravel(), minlength=len(mesh.points)) == 0)
    if len(loose):
        x, y = mesh.points[loose[0]].tolist()
        raise TransferError(
            f"point {loose[0]} of the {which} mesh, at ({x:g}, {y:g}), is in no triangle: leave it "
            'out, or use method="interpolation"'
        )


def check_outside(outside: float) -> None:
    """Refuse an `outside` that is not a number from 0 on."""
    if not isinstance(outside, Real) or not outside >= 0:
        raise TransferError(f"outside={outside!r}: expected a share of an edge, 0 or more")


def check_triangles(numbers: Ints, ours: MeshLocator, theirs: MeshLocator, outside: float) -> None:
    """Refuse triangles of our mesh whose centroids are far outside of the other mesh."""
    centroids = ours.mesh.points[ours.mesh.triangles[numbers]].mean(axis=1)
    nearest, _, distances = theirs.locator.locate(centroids)
    edges = np.maximum(longest_edges(ours.mesh)[numbers], longest_edges(theirs.mesh)[nearest])
    what = f"triangles of the {ours.which} mesh"
    check_distances(centroids, distances, edges, outside, what, theirs.which)


def check_distances(
    places: Floats, distances: Floats, edges: Floats, outside: float, what: str, which: str
) -> None:
    """Refuse places (k, 2) that are farther from the mesh `which` than `outside` times an edge."""
    check_outside(outside)
    far = np.flatnonzero(distances > outside * edges)
    if len(far):
        worst = int(far[np.argmax(distances[far])])
        x, y = places[worst].tolist()
        raise TransferError(
            f"{len(far)} {what} lie far outside of the {which} mesh, one at ({x:g}, {y:g}) by "
            f"{distances[worst]:g}: both meshes must cover the same domain ({REMEDIES[which]})"
        )


def longest_edges(mesh: Mesh) -> Floats:
    """Length of the longest edge of each triangle, (m,)."""
    p = mesh.points[mesh.triangles]
    return np.linalg.norm(p - np.roll(p, 1, axis=1), axis=2).max(axis=1)
