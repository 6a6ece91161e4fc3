"""How good is a mesh, and is it one? The same report for everybody's, by the exact metric."""

from __future__ import annotations

import numpy as np

import adaptmesh as am
from adaptmesh.mesh.validate import fidelity
from adaptmesh.mesh.validate.domain_subject import DomainSubject
from metrics import mesh_edges

# Peers write coordinates with twelve digits, so points are off their segments by so much of the
# diameter.
ROUNDING = 1e-11
AREA_TOLERANCE = 1e-9

# Fractions of a triangle's sides where the error of interpolation is sampled: the centroids of
# its 64 similar parts.
FINENESS = 8


def judge(problem, points, triangles):
    """Numbers for the tables, as a dict ready for JSON."""
    mesh = _mesh(problem.domain, points, triangles)
    report = am.measure(mesh, problem.metric)
    out = {
        "triangles": report.n_triangles,
        "vertices": report.n_points,
        "unit": report.unit_fraction,
        "tau": report.efficiency_index,
        "length_max": report.length_max,
        "quality_min": report.quality_min,
        "quality_p1": report.quality_p1,
        "quality_mean": report.quality_mean,
        "count_ratio": report.n_triangles / problem.target,
        "broken": _broken(mesh),
    }
    if problem.case.function:
        out["error"] = interpolation_error(mesh, problem.case.function)
    return out


def _broken(mesh):
    """The names of the invariants that do not hold."""
    bare = am.Mesh(mesh.points, mesh.triangles, edges=mesh.edges)
    broken = [check.name for check in bare.validate() if not check]
    if broken:
        return broken
    subject = DomainSubject(mesh, ROUNDING * float(np.ptp(mesh.domain.points, axis=0).max()))
    checks = {
        "points present": fidelity.points_present(subject).broken == 0,
        "segments present": fidelity.segments_present(subject).broken == 0,
        "edges on segments": fidelity.edges_on_segments(subject).broken == 0,
        "vertices on segments": fidelity.vertices_on_segments(subject).broken == 0,
        "area": abs(mesh.areas.sum() / mesh.domain.area - 1) < AREA_TOLERANCE,
    }
    return [name for name, holds in checks.items() if not holds]


def _mesh(domain, points, triangles):
    """The mesh with its constrained edges: its border, and what lies on segments within."""
    triangles = np.asarray(triangles)
    u, v = (points[triangles[:, k]] - points[triangles[:, 0]] for k in (1, 2))
    if np.sum(u[:, 0] * v[:, 1] - u[:, 1] * v[:, 0]) < 0:
        triangles = triangles[:, ::-1]
    edges, sides = mesh_edges(triangles)
    is_border = np.bincount(sides.ravel(), minlength=len(edges)) == 1
    constrained = np.concatenate(
        [edges[is_border], *_edges_within(domain, points, edges[~is_border])]
    )
    return am.Mesh(
        points,
        triangles,
        edges=constrained,
        edge_tags=np.zeros(len(constrained), np.int32),
        domain=am.Domain(
            domain.points, domain.segments, "nesting" if domain.nesting else domain.holes
        ),
    )


def _edges_within(domain, points, edges):
    """For each piece of a segment that is not border, the edges with both ends on it."""
    tolerance = ROUNDING * float(np.ptp(domain.points, axis=0).max())
    for a, b in domain.points[domain.pieces[~domain.piece_is_boundary]]:
        along = (points - a) @ (b - a) / ((b - a) @ (b - a))
        off = points - a - np.clip(along, 0, 1)[:, None] * (b - a)
        is_on = np.hypot(*off.T) <= tolerance
        yield edges[is_on[edges].all(axis=1)]


def interpolation_error(mesh, function):
    """The L2 norm of a function minus its linear interpolant on the mesh."""
    corners, at_corners = mesh.points[mesh.triangles], function(mesh.points)[mesh.triangles]
    squares = np.zeros(len(corners))
    places = _centroids(FINENESS)
    for weights in places:
        exact = function(np.einsum("i,kid->kd", weights, corners))
        squares += (exact - at_corners @ weights) ** 2
    return float(np.sqrt(mesh.areas @ squares / len(places)))


def _centroids(n):
    """Barycentric coordinates of the centroids of the n² similar parts of a triangle."""
    upright = [(3 * i + 1, 3 * j + 1) for i in range(n) for j in range(n - i)]
    turned = [(3 * i + 2, 3 * j + 2) for i in range(n - 1) for j in range(n - 1 - i)]
    xy = np.array(upright + turned) / (3 * n)
    return np.column_stack([1 - xy.sum(axis=1), xy])
