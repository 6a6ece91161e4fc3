"""The outline of a domain in the forms that peers ask for."""

from __future__ import annotations

import numpy as np
from mesher import Run

import adaptmesh as am


def region_loops(domain):
    """For each region its closed boundary loops, as point numbers with the inside on the left.

    The outer loop is first.
    """
    return [
        (int(region), _loops(domain, domain.triangles[domain.triangle_regions == region]))
        for region in np.unique(domain.triangle_regions)
    ]


def _loops(domain, triangles):
    sides = {(int(t[k]), int(t[(k + 1) % 3])) for t in triangles for k in range(3)}
    following = {a: b for a, b in sides if (b, a) not in sides}
    loops = []
    while following:
        loop = [next(iter(following))]
        while loop[-1] in following:
            loop.append(following.pop(loop[-1]))
        loops.append(loop[:-1])
    return sorted(loops, key=lambda loop: -_area(domain.points[loop]))


def _area(ring):
    (x, y), (x1, y1) = ring.T, np.roll(ring, -1, axis=0).T
    return 0.5 * np.sum(x * y1 - y * x1)


def segment_numbers(domain):
    """The segment between two points and 1 or -1 for its direction, by both points."""
    forward = {(int(a), int(b)): (k, 1) for k, (a, b) in enumerate(domain.segments)}
    return forward | {(b, a): (k, -1) for (a, b), (k, _) in forward.items()}


def coarse_mesh(problem):
    """A nearly uniform mesh of about two thousand triangles to start from."""
    size = np.sqrt(problem.domain.area / 2000 * 4 / np.sqrt(3))
    return am.generate(problem.domain, size)


def coarse_run(problem):
    mesh = coarse_mesh(problem)
    return Run(mesh.points, mesh.triangles, 0.0, 0.0, {"mesh": mesh})
