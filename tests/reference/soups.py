"""Random segments that cross, overlap, repeat and end anywhere, and what has to come of them."""

import re
from collections import deque

import numpy as np
import shapely
from reference.transforms import TRANSFORMS

import adaptmesh as am


def soup(seed):
    """(what `repair` takes, a tolerance, the rounding of points): segments between few points."""
    rng = np.random.default_rng(seed)
    n = int(rng.integers(5, 16))
    points = rng.random((n, 2))
    if rng.random() < 0.3:
        points = np.round(4 * points) / 4
    segments = rng.integers(0, n, (int(rng.integers(n, 3 * n)), 2))
    if rng.random() < 0.7:  # a closed border around it, so that not all is open
        points = np.concatenate([points, [(-0.1, -0.1), (1.1, -0.1), (1.1, 1.1), (-0.1, 1.1)]])
        ring = n + np.array([(0, 1), (1, 2), (2, 3), (3, 0)])
        segments = np.concatenate([segments, ring])
    if rng.random() < 0.3:
        points = np.concatenate([points, rng.uniform(-0.5, 1.5, (3, 2))])
    owner = rng.integers(0, 4, len(segments))
    names = {f"line {k}": np.flatnonzero(owner == k).tolist() for k in range(3)}
    transform = TRANSFORMS[int(rng.integers(len(TRANSFORMS)))]
    holes = ["nesting", "nesting", None, [], transform(rng.random((2, 2)))][int(rng.integers(5))]
    tolerance = [None, None, 1e-6, 1e-3, 0.05][int(rng.integers(5))]
    if tolerance is not None:
        tolerance *= transform.scale
    outline = am.Outline(transform(points), segments, holes, names=names)
    return outline, tolerance, transform.rounding


def check_soup(seed):
    """Repair and mesh a soup; returns what came of it. Anything that may not be raises."""
    outline, tolerance, rounding = soup(seed)
    try:
        domain, repairs = am.repair(outline, tolerance)
    except am.DomainError as error:
        assert re.search(r"\(-?[\d.]+(e[+-]\d+)?, ", str(error)) or "nothing" in str(error), error
        return "refused"
    assert set(domain.piece_segments.tolist()) == set(range(len(domain.segments)))
    mesh = am.generate(domain, np.sqrt(domain.area / 30))
    assert mesh.validate().ok, str(mesh.validate())
    lost = {record.what for record in repairs if record.kind == "name lost"}
    for name, mine in outline.names.items():
        there = name in mesh.names and len(mesh.edges_named(name)) > 0
        assert there or not mine or any(f"{name!r}" in what for what in lost), name
    if tolerance is None and isinstance(outline.holes, str) and rounding < 1e-14:
        expected = nested_area(outline)
        error = abs(mesh.areas.sum() / expected - 1)
        assert error < 1e-6, f"area {mesh.areas.sum()!r} instead of {expected!r}"
    return "repaired" if repairs else "clean"


def nested_area(outline):
    """The area of the faces that an odd number of lines, as few as possible, are around."""
    points = outline.points - outline.points[0]
    grid = 1e-9 * np.ptp(points, axis=0).max()
    lines = shapely.union_all(shapely.linestrings(points[outline.segments]), grid_size=grid)
    faces = shapely.get_parts(shapely.polygonize(shapely.get_parts(lines)))
    faces = [face for face in faces if face.area > 1e-14 * shapely.area(shapely.envelope(lines))]
    around = shapely.union_all(faces)
    beside = [[] for _ in range(len(faces) + 1)]  # the last one is the outside
    for i, face in enumerate(faces):
        for j in range(i):
            if face.boundary.intersection(faces[j].boundary).length > 0:
                beside[i].append(j)
                beside[j].append(i)
        shells = shapely.union_all([p.boundary for p in shapely.get_parts(around)])
        if face.boundary.intersection(shells).length > 0:
            beside[i].append(len(faces))
            beside[-1].append(i)
    depth, queue = {len(faces): 0}, deque([len(faces)])
    while queue:
        i = queue.popleft()
        for j in beside[i]:
            if j not in depth:
                depth[j] = depth[i] + 1
                queue.append(j)
    return sum(face.area for i, face in enumerate(faces) if depth[i] % 2 == 1)
