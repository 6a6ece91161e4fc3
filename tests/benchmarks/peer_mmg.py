"""MMG2D through its bindings (PyPI: mmgpy).

No gradation, no sizes from required vertices, no detection of corners by angle (every point of the
domain is a corner), straight boundaries (`hausd` far above the domain). An `hmax` far above the
domain as well would cost it half of the triangles of thin layers.
"""

from __future__ import annotations

import numpy as np
from mesher import Remesher, Run, Stopwatch
from mmgpy import MmgMesh2D
from outline import coarse_mesh
from scipy.spatial import KDTree


class Mmg(Remesher):
    def start(self):
        mesh = coarse_mesh(self.problem)
        extra = {"regions": mesh.regions, "edges": mesh.edges}
        return Run(mesh.points, mesh.triangles, 0.0, 0.0, extra)

    def remesh(self, previous, tensors):
        diameter = self.problem.diameter
        with Stopwatch() as all_of_it:
            mesh = self._given(previous, tensors)
            with Stopwatch() as meshing:
                mesh.remesh(
                    hgrad=-1.0,
                    hgradreq=-1.0,
                    nosizreq=1,
                    angle=0,
                    hausd=1e6 * diameter,
                    hmin=1e-9 * diameter,
                    hmax=2 * diameter,
                    verbose=-1,
                )
            points = np.array(mesh.get_vertices())
            triangles, regions = mesh.get_triangles_with_refs()
            edges = mesh.get_edges()
        extra = {"regions": np.array(regions), "edges": np.array(edges)}
        return Run(points, np.array(triangles), meshing.cpu, all_of_it.wall, extra)

    def _given(self, previous, tensors):
        edges = previous.extra["edges"]
        _, corners = KDTree(previous.points).query(self.problem.domain.points)
        mesh = MmgMesh2D()
        mesh.set_mesh_size(
            vertices=len(previous.points), triangles=len(previous.triangles), edges=len(edges)
        )
        mesh.set_vertices(np.ascontiguousarray(previous.points))
        mesh.set_triangles(
            np.ascontiguousarray(previous.triangles, np.int32),
            refs=previous.extra["regions"].astype(np.int64),
        )
        mesh.set_edges(np.ascontiguousarray(edges, np.int32))
        mesh.set_corners(corners.astype(np.int32))
        mesh.set_required_vertices(corners.astype(np.int32))
        mesh["tensor"] = np.ascontiguousarray(tensors)
        return mesh
