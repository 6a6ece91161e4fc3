"""Is it a mesh of its domain? The slow and obvious answer, in whole numbers.

Nothing of the package is used, neither its predicates nor the triangulation that a `Domain` makes
of itself: only points, segments, holes and seeds as they were given, and the arrays of the mesh.
Domains are of straight segments; a vertex is on a segment if it is off it by no more than a few
units in the last place of the largest coordinate. Whether the mesh is one, whatever its domain,
says `exact_mesh`.

    assert faults_of_mesh(mesh) == []                 # of the mesh alone
    assert faults_against_domain(mesh, domain) == []  # of the domain in it
"""

from __future__ import annotations

import itertools
from collections import defaultdict
from fractions import Fraction

import numpy as np

PLACES = 8
"""So many units in the last place may rounding have moved a vertex off its segment."""


def faults_against_domain(mesh, domain):
    """What of a domain of straight segments is missing in its mesh, or what is too much."""
    everything, unit = _whole(np.concatenate([mesh.points, domain.points]))
    points, corners = everything[: len(mesh.points)], everything[len(mesh.points) :]
    number = {p: v for v, p in enumerate(points)}
    faults = [
        f"point {i} of the domain is missing" for i, p in enumerate(corners) if p not in number
    ]
    if faults:
        return faults
    off = PLACES * unit * Fraction(float(np.spacing(np.abs(domain.points).max())))

    left = {
        frozenset(e): t for e, t in zip(mesh.edges.tolist(), mesh.edge_tags.tolist(), strict=True)
    }
    for i, (a, b) in enumerate(domain.segments.tolist()):
        v, b = number[corners[a]], number[corners[b]]
        tag = int(domain.segment_tags[i])
        while v != b:  # each turn takes an edge away
            follow = [
                e
                for e in left
                if v in e
                and _leads(points, v, *(e - {v}), b)
                and _on_way(points, e, a, b, corners, off)
            ]
            if not follow:
                faults.append(f"segment {i} ends at point {v}")
                break
            # of edges within rounding of each other, that which leads least far aside
            e = min(follow, key=lambda e: _aside(points, *(e - {v}), corners[a], points[b]))
            if left.pop(e) != tag:
                faults.append(f"edge {set(e)} on segment {i} has another tag")
            (v,) = e - {v}
    faults += [f"edge {set(e)} is on no segment" for e in left]
    return faults + _region_faults(mesh, domain, points, unit) + _name_faults(mesh, domain)


def _region_faults(mesh, domain, points, unit):
    """Every seed gives its region to what it can reach; holes and the outside are empty."""
    triangles = [tuple(t) for t in mesh.triangles.tolist()]
    walls = {frozenset(e) for e in mesh.edges.tolist()}
    beside = defaultdict(list)
    for k, t in enumerate(triangles):
        for side in _sides(t):
            beside[frozenset(side)].append(k)

    def part_of(start):
        part, new = {start}, [start]
        while new:
            for side in _sides(triangles[new.pop()]):
                if frozenset(side) not in walls:
                    for other in set(beside[frozenset(side)]) - part:
                        part.add(other)
                        new.append(other)
        return part

    def holder(place):
        place = tuple(unit * Fraction(x) for x in place)
        for k, t in enumerate(triangles):
            p = [points[v] for v in t]
            if all(_area(p[i], p[i - 2], place) >= 0 for i in range(3)):
                return k
        return None

    expected = [0] * len(triangles)
    faults = []
    for seed, region in zip(domain.seeds.tolist(), domain.seed_regions.tolist(), strict=True):
        k = holder(seed)
        if k is None:
            faults.append(f"the seed {seed} is in no triangle")
            continue
        for other in part_of(k):
            expected[other] = region
    faults += [
        f"triangle {k} is in region {found}, not {right}"
        for k, (found, right) in enumerate(zip(mesh.regions.tolist(), expected, strict=True))
        if found != right
    ]
    holes = [] if domain.nesting else domain.holes.tolist()
    return faults + [f"the hole {h} has a triangle" for h in holes if holder(h) is not None]


def _name_faults(mesh, domain):
    pairs = ((mesh.names, domain.names), (mesh.region_names, domain.region_names))
    return [f"names {dict(a)}, not {dict(b)}" for a, b in pairs if dict(a) != dict(b)]


def _whole(coordinates):
    """Points times a power of two that makes whole numbers of them, and that number."""
    points = [tuple(map(Fraction, p)) for p in coordinates.tolist()]
    unit = max(x.denominator for x in itertools.chain(*points))
    return [(int(unit * x), int(unit * y)) for x, y in points], unit


def _sides(t):
    return ((t[0], t[1]), (t[1], t[2]), (t[2], t[0]))


def _area(a, b, c):
    """Twice the area of a triangle."""
    return (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0])


def _is_on(p, a, b, off):
    """Whether p is between a and b, and no further than `off` from the line through them."""
    if not all(min(u, v) - off <= x <= max(u, v) + off for x, u, v in zip(p, a, b, strict=True)):
        return False
    d, w = (b[0] - a[0], b[1] - a[1]), (p[0] - a[0], p[1] - a[1])
    along, length = d[0] * w[0] + d[1] * w[1], d[0] ** 2 + d[1] ** 2
    beside = d[0] * w[1] - d[1] * w[0]
    return 0 <= along <= length and beside**2 <= off**2 * length


def _on_way(points, edge, a, b, corners, off):
    return all(_is_on(points[v], corners[a], points[b], off) or v == b for v in edge)


def _leads(points, v, w, b):
    """Whether from v to w is nearer to b."""
    near, far = (
        (points[b][0] - points[x][0]) ** 2 + (points[b][1] - points[x][1]) ** 2 for x in (w, v)
    )
    return near < far


def _aside(points, w, a, b):
    d = (b[0] - a[0], b[1] - a[1])
    return abs(d[0] * (points[w][1] - a[1]) - d[1] * (points[w][0] - a[0]))
