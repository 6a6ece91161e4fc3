"""``adaptmesh demo``: two meshes with pictures, one for a size map and one for a metric.

Each case is a domain and a field, in a few lines of numpy and shapely.
"""

from __future__ import annotations

import json
from collections.abc import Callable
from dataclasses import dataclass
from functools import cached_property
from pathlib import Path
from typing import Any

import numpy as np

import adaptmesh as am
from adaptmesh.domain.domain import Domain
from adaptmesh.domain.polygons.shared_borders import given_of_polygons
from adaptmesh.types import Floats

Field = Callable[[Floats], Floats]


@dataclass(frozen=True)
class View:
    """Options of a picture of a mesh; its file is named after the case and the suffix."""

    suffix: str
    show: str
    bounds: tuple[float, float, float, float] | None = None
    """Visible box (x0, y0, x1, y1); by default everything."""
    ellipses: bool = False


@dataclass(frozen=True)
class Case:
    """A domain, the size or metric field, and the pictures to draw."""

    name: str
    title: str
    domain: Domain
    field: Field
    views: tuple[View, ...]


def make_demo(
    out: Path, say: Callable[[str], object] = print, coarsening: float = 1.0
) -> list[Path]:
    """Mesh the cases, print reports, and write the meshes and their pictures.

    Parameters
    ----------
    out : Path
        An existing folder.
    say : callable
        Called with each line to print.
    coarsening : float
        Factor on all sizes; the number of triangles falls with its square.

    Returns
    -------
    list of Path
        The files written.
    """
    written: list[Path] = []
    for make in (iceland, aerofoil):
        case = make(coarsening)
        mesh = am.generate(case.domain, case.field)
        say(f"\n{case.title}\n{am.measure(mesh, case.field)}")
        path = out / f"{case.name}.vtu"
        am.write(path, mesh)
        written.append(path)
        for view in case.views:
            path = out / f"{case.name}{view.suffix}.png"
            am.plot(
                mesh,
                case.field,
                show=view.show,
                ellipses=view.ellipses,
                bounds=view.bounds,
                title=case.title,
                path=path,
            )
            written.append(path)
    for path in written:
        say(f"wrote {path}")
    return written


def iceland(coarsening: float = 1.0) -> Case:
    """Iceland and the sea around it, fine along the coast: a size in kilometres.

    The original coast crosses itself. Shapely repairs it, and simplifies it to half of the finest
    size, because smaller capes and inlets would need smaller triangles. The coast is the interface
    between the regions "land" and "sea".
    """
    import shapely
    from scipy.spatial import cKDTree

    finest, growth = 1.5 * coarsening, 0.2
    outline = json.loads(_data_file("iceland.geojson").read_text(encoding="utf-8"))
    coast = shapely.from_geojson(json.dumps(outline["features"][0]["geometry"]))
    islands = shapely.get_parts(shapely.simplify(shapely.make_valid(coast), 0.5 * finest))
    land = shapely.multipolygons([island for island in islands if island.area > finest**2])
    sea = shapely.difference(shapely.Polygon(ellipse((0.0, 0.0), 400.0, 320.0, 72)), land)

    shore = shapely.get_coordinates(shapely.segmentize(land.boundary, 0.25 * finest))
    tree = cKDTree(shore)

    def size(x: Floats) -> Floats:
        distance: Floats = tree.query(x)[0]
        return finest + growth * distance

    return Case(
        name="iceland",
        title="Iceland: the size grows away from the coast",
        domain=Domain.of_given(given_of_polygons([sea, land], ["sea", "land"])),
        field=size,
        views=(
            View("", "region"),
            View("-westfjords", "region", bounds=(-215.0, 55.0, -95.0, 150.0)),
        ),
    )


def _data_file(name: str) -> Path:
    """Return the path of a data file of the package; in a source tree it is in the examples."""
    package = Path(__file__).parent.parent
    installed = package / "data" / name
    return installed if installed.is_file() else package.parent / "examples" / "data" / name


def aerofoil(coarsening: float = 1.0) -> Case:
    """A NACA 0012 in a far field of 30 chords, with thin triangles along its wall: a metric.

    At distance d from the wall the size across is ``h_wall + growth d``, and the size along is the
    spacing at the nearest point of the wall (see `Wing.spacing`) plus ``growth d``. Both grow at
    the same rate, so that the triangles are isotropic within a chord.
    """
    growth, h_wall, farthest = 0.1, 2e-4 * coarsening, 30.0
    wing = Wing(h_edges=h_wall, coarsening=coarsening)

    def metric(x: Floats) -> Floats:
        distance, normal, spacing = wing.nearest(x)
        across = h_wall + growth * distance
        along = spacing + growth * distance
        return packed_metric(normal, across, along)

    far_field = ellipse((0.5, 0.0), farthest, farthest, 64)
    wall = wing.unit_spaced()
    n, k = len(far_field), len(wall)
    ring, loop = np.arange(n), n + np.arange(k)
    domain = Domain(
        np.concatenate([far_field, wall]),
        np.concatenate(
            [np.stack([ring, np.roll(ring, -1)], 1), np.stack([loop, np.roll(loop, -1)], 1)]
        ),
        holes=[(0.5, 0.0)],
        names={"far field": ring, "wall": loop},
    )
    return Case(
        name="naca0012",
        title="NACA 0012: thin triangles along the wall",
        domain=domain,
        field=metric,
        views=(
            View("", "mesh", bounds=(-0.35, -0.55, 1.35, 0.55)),
            View("-nose", "length", bounds=(-0.02, -0.022, 0.03, 0.022), ellipses=True),
        ),
    )


def ellipse(centre: tuple[float, float], a: float, b: float, n: int) -> Floats:
    """Return points (n, 2) on an ellipse with half axes a and b."""
    t = np.linspace(0.0, 2.0 * np.pi, n, endpoint=False)
    return np.array(centre) + np.stack([a * np.cos(t), b * np.sin(t)], axis=1)


def packed_metric(normal: Floats, across: Floats, along: Floats) -> Floats:
    """Return metrics (n, 3) of size `across` along the unit `normal` and `along` normal to it."""
    nx, ny = normal.T
    p, q = across**-2.0, along**-2.0
    return np.stack(
        [p * nx * nx + q * ny * ny, (p - q) * nx * ny, p * ny * ny + q * nx * nx], axis=1
    )


@dataclass(frozen=True)
class Wing:
    """The closed contour of a NACA 0012 of chord 1, and the spacing of points on it.

    Half thickness y(x) = 0.6 (0.2969 √x − 0.1260 x − 0.3516 x² + 0.2843 x³ − 0.1036 x⁴); the last
    coefficient, 0.1036 for the original 0.1015, closes the trailing edge (Abbott and von Doenhoff,
    Theory of Wing Sections, 6.4).
    """

    h_edges: float
    """Spacing at the trailing edge."""
    coarsening: float = 1.0

    @cached_property
    def contour(self) -> Floats:
        """Points (n, 2), dense near both edges, counter-clockwise from the trailing edge."""
        theta = np.linspace(0.0, 2.0 * np.pi, 2001)
        x = 0.5 * (1.0 + np.cos(theta))
        root = np.abs(np.cos(0.5 * theta))
        half = 0.6 * (0.2969 * root - 0.1260 * x - 0.3516 * x**2 + 0.2843 * x**3 - 0.1036 * x**4)
        xy = np.stack([x, np.where(theta <= np.pi, half, -half)], axis=1)
        xy[[0, -1]] = 1.0, 0.0
        return xy

    @cached_property
    def normals(self) -> Floats:
        """Unit normals (n, 2) at the contour points; along the chord at the trailing edge."""
        ahead, behind = (
            np.roll(self.contour[:-1], -1, axis=0),
            np.roll(self.contour[:-1], 1, axis=0),
        )
        tangent = ahead - behind
        normal = np.stack([tangent[:, 1], -tangent[:, 0]], axis=1)
        normal /= np.linalg.norm(normal, axis=1, keepdims=True)
        return np.concatenate([normal, normal[:1]])

    @cached_property
    def spacing(self) -> Floats:
        """Size along the wall (n,): fine at both edges, at most 0.025 between them.

        At the nose it is a tenth of the nose radius, 1.1019 · 0.12² = 0.0159 of the chord.
        """
        to_nose = np.linalg.norm(self.contour - (0.0, 0.0), axis=1)
        to_tail = np.linalg.norm(self.contour - (1.0, 0.0), axis=1)
        nose = 0.1 * 0.0159 * self.coarsening + 0.06 * to_nose
        tail = self.h_edges + 0.12 * to_tail
        return np.minimum(np.minimum(nose, tail), 0.025 * self.coarsening)

    def unit_spaced(self) -> Floats:
        """Return points (k, 2) on the closed contour, one step of `spacing` apart."""
        step = np.linalg.norm(np.diff(self.contour, axis=0), axis=1)
        mean = 0.5 * (1.0 / self.spacing[1:] + 1.0 / self.spacing[:-1])
        length = np.concatenate([[0.0], np.cumsum(step * mean)])
        half = max(4, round(0.5 * length[-1]))
        shares = np.linspace(0.0, length[-1], 2 * half + 1)[:-1]
        x, y = self.contour.T
        return np.stack([np.interp(shares, length, x), np.interp(shares, length, y)], axis=1)

    @cached_property
    def _tree(self) -> Any:
        from scipy.spatial import cKDTree

        return cKDTree(self.contour[:-1])

    def nearest(self, x: Floats) -> tuple[Floats, Floats, Floats]:
        """Return distance (n,) to the wall, unit direction (n, 2) from it, and spacing (n,)."""
        contour = self.contour[:-1]
        _, i = self._tree.query(x)
        distance = np.full(len(x), np.inf)
        offset = np.empty_like(x)
        for j in (i - 1, (i + 1) % len(contour)):
            start, side = contour[i], contour[j] - contour[i]
            along = np.einsum("ij,ij->i", x - start, side) / np.einsum("ij,ij->i", side, side)
            from_foot = x - start - np.clip(along, 0.0, 1.0)[:, None] * side
            d = np.linalg.norm(from_foot, axis=1)
            nearer = d < distance
            distance[nearer], offset[nearer] = d[nearer], from_foot[nearer]
        on_wall = distance < 1e-9
        direction = offset / np.where(on_wall, 1.0, distance)[:, None]
        direction[on_wall] = self.normals[i[on_wall]]
        return distance, direction, self.spacing[i]
