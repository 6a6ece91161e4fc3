"""Shewchuk's Triangle (PyPI: triangle): sizes as bounds on areas, refined until nearly all hold.

Its only notion of size is an area, so isotropic cases only. A triangle may have at most LARGEST
times the area of the unit one; with 1.45 the count is nearest to what is asked. Bounds are lowered
at most sixteenfold at a time, as a large triangle does not know the sizes within it.
"""

from __future__ import annotations

import numpy as np
import triangle
from mesher import Direct, Run, Stopwatch

LARGEST = 1.45
MOST_PASSES = 30
SATISFIED = 0.999  # share of the triangles that are small enough
DENSITY_AT = np.array([[4, 1, 1], [1, 4, 1], [1, 1, 4], [2, 2, 2]]) / 6


class Triangle(Direct):
    def make(self):
        domain = self.problem.domain
        mesh = {"vertices": domain.points.copy(), "segments": domain.segments.copy()}
        if len(domain.holes) or domain.nesting:
            mesh["holes"] = hole_points(domain)
        cpu = 0.0
        with Stopwatch() as all_of_it:
            with Stopwatch() as clock:
                mesh = triangle.triangulate(mesh, "pzQq20")
            cpu += clock.cpu
            for _ in range(MOST_PASSES):
                areas, largest = self._areas(mesh)
                too_large = areas > largest
                if too_large.mean() <= 1 - SATISFIED:
                    break
                bounds = np.where(too_large, np.maximum(largest, areas / 16), -1.0)
                with Stopwatch() as clock:
                    mesh = triangle.triangulate(
                        {**mesh, "triangle_max_area": bounds[:, None]}, "przQq20a"
                    )
                cpu += clock.cpu
        return Run(mesh["vertices"], mesh["triangles"], cpu, all_of_it.wall)

    def _areas(self, mesh):
        """The area of each triangle, and the largest allowed by the mean density in it."""
        corners = mesh["vertices"][mesh["triangles"]]
        where = np.einsum("qi,kid->qkd", DENSITY_AT, corners)
        sizes = self.problem.sizes(where.reshape(-1, 2)).reshape(len(DENSITY_AT), -1)
        u, v = corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0]
        areas = 0.5 * (u[:, 0] * v[:, 1] - u[:, 1] * v[:, 0])
        return areas, LARGEST * np.sqrt(3) / 4 / (sizes**-2.0).mean(axis=0)


def hole_points(domain):
    """A point in each hole: as given, or, for nested rings, in the ring of each hole."""
    if not domain.nesting:
        return domain.holes
    import shapely

    lines = shapely.linestrings(domain.points[domain.segments])
    rings = shapely.get_parts(shapely.polygonize(lines))
    inside = shapely.points(domain.points[domain.triangles].mean(axis=1))
    holes = [ring for ring in rings if not shapely.contains(ring, inside).any()]
    return np.array([ring.representative_point().coords[0] for ring in holes])
