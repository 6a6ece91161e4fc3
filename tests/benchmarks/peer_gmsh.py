"""Gmsh: Frontal-Delaunay for sizes, its own older copy of BAMG for tensors.

Both take a field that is linear on the previous mesh. For tensors Gmsh smooths sizes unless told
not to; for sizes the same option would leave the boundary uncut.
"""

from __future__ import annotations

import gmsh
import numpy as np
from mesher import Remesher, Run, Stopwatch
from outline import coarse_run, region_loops, segment_numbers

FRONTAL, BAMG = 6, 7


class Gmsh(Remesher):
    def start(self):
        return coarse_run(self.problem)

    def remesh(self, previous, tensors):
        gmsh.initialize(interruptible=False)
        try:
            with Stopwatch() as all_of_it:
                self._set_options()
                self._build_domain()
                self._set_field(previous, tensors)
                with Stopwatch() as meshing:
                    gmsh.model.mesh.generate(2)
                points, triangles = _mesh()
        finally:
            gmsh.finalize()
        return Run(points, triangles, meshing.cpu, all_of_it.wall)

    def _set_options(self):
        isotropic = self.problem.case.is_isotropic
        options = {
            "General.Terminal": 0,
            "General.NumThreads": 1,
            "Mesh.Algorithm": FRONTAL if isotropic else BAMG,
            "Mesh.MeshSizeExtendFromBoundary": 0,
            "Mesh.MeshSizeFromPoints": 0,
            "Mesh.MeshSizeMin": 0,
            "Mesh.MeshSizeMax": 1e22,
            "Mesh.LcIntegrationPrecision": 1e-4,
        }
        if not isotropic:
            options |= {"Mesh.SmoothRatio": 0, "Mesh.AnisoMax": 1e12}
        for name, value in options.items():
            gmsh.option.setNumber(name, value)

    def _build_domain(self):
        domain, shapes = self.problem.domain, gmsh.model.geo
        gmsh.model.add("domain")
        for k, (x, y) in enumerate(domain.points):
            shapes.addPoint(x, y, 0, 0, k + 1)
        for k, (a, b) in enumerate(domain.segments):
            shapes.addLine(int(a) + 1, int(b) + 1, k + 1)
        segment = segment_numbers(domain)
        for _, loops in region_loops(domain):
            curves = []
            for loop in loops:
                sides = (segment[pair] for pair in zip(loop, loop[1:] + loop[:1], strict=True))
                curves.append(shapes.addCurveLoop([way * (k + 1) for k, way in sides]))
            shapes.addPlaneSurface(curves)
        shapes.synchronize()

    def _set_field(self, previous, tensors):
        corners = previous.points[previous.triangles]
        n = len(corners)
        places = np.concatenate([corners[:, :, 0], corners[:, :, 1], np.zeros((n, 3))], axis=1)
        if self.problem.case.is_isotropic:
            sizes = (tensors[:, 0] * tensors[:, 2] - tensors[:, 1] ** 2) ** -0.25
            kind, values = "ST", sizes[previous.triangles]
        else:
            in_space = np.zeros((len(tensors), 9))
            in_space[:, [0, 1, 3, 4]] = tensors[:, [0, 1, 1, 2]]
            in_space[:, 8] = 1
            kind, values = "TT", in_space[previous.triangles].reshape(n, 27)
        view = gmsh.view.add("metric")
        gmsh.view.addListData(view, kind, n, np.concatenate([places, values], axis=1).ravel())
        field = gmsh.model.mesh.field.add("PostView")
        gmsh.model.mesh.field.setNumber(field, "ViewTag", view)
        gmsh.model.mesh.field.setAsBackgroundMesh(field)


def _mesh():
    tags, coordinates, _ = gmsh.model.mesh.getNodes()
    _, corners = gmsh.model.mesh.getElementsByType(2)
    used, triangles = np.unique(corners, return_inverse=True)
    row = np.empty(int(tags.max()) + 1, int)
    row[tags] = np.arange(len(tags))
    points = coordinates.reshape(-1, 3)[row[used], :2]
    return points, triangles.reshape(-1, 3)
