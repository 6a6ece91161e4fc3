"""Pairs of meshes of one domain, of every kind that conservative transfer has to cope with.

`random_pair(rng, kind)` gives two meshes of 10 to 200 triangles each. Their domains are slanted,
of unit size; tests take both through the maps of `reference.transforms`, which rounds vertices that
were on one line off it, in each mesh differently.
"""

import numpy as np

import adaptmesh as am
from adaptmesh.curves import Circle


def polygon(rng):
    """A star-shaped polygon with up to 8 corners."""
    n = int(rng.integers(3, 9))
    angles = 2 * np.pi * (np.arange(n) + rng.uniform(-0.3, 0.3, n)) / n
    radii = rng.uniform(0.6, 1.2, n)
    return am.Domain.polygon(radii[:, None] * np.stack([np.cos(angles), np.sin(angles)], axis=1))


def with_interface(rng):
    """A quadrangle in two regions; the line between is slanted, and cut by each mesh for itself."""
    a, b = rng.uniform(0.2, 0.8, 2)
    return am.Domain(
        [(0, 0), (1, 0.1), (1.1, 1), (0.1, 0.9), (a, 0.1 * a), (0.1 + b, 0.9 + 0.1 * b)],
        [(0, 4), (4, 1), (1, 2), (2, 5), (5, 3), (3, 0), (4, 5)],
        regions={"A": (0.1, 0.5), "B": (1.0, 0.5)},
    )


def with_hole(rng):
    angles = rng.uniform(0, 6) + np.pi / 2 * np.arange(4)
    hole = rng.uniform(-0.1, 0.1, 2) + 0.25 * np.stack([np.cos(angles), np.sin(angles)], axis=1)
    return am.Domain.polygon([(-1, -0.7), (1, -0.8), (0.8, 0.9), (-0.9, 0.7)], holes=[hole[::-1]])


def periodic(rng):
    h = rng.uniform(0.5, 1)
    domain = am.Domain(
        [(0, 0), (1, 0.3), (1, 0.3 + h), (0, h)],
        [(0, 1), (1, 2), (2, 3), (3, 0)],
        names={"low": [0], "high": [2]},
    )
    return domain.with_periodic("low", "high", translation=(0, h))


def curved(rng):
    """A ring between circles, which each mesh replaces by chords of its own."""
    inner = Circle((0.1, 0.3), rng.uniform(0.3, 0.5))
    return am.Domain.from_curves([Circle((0.1, 0.2), rng.uniform(0.9, 1.1)), inner])


def chords(rng):
    n = int(rng.integers(8, 40))
    angles = rng.uniform(0, 6) + 2 * np.pi * np.arange(n) / n
    return am.Domain.polygon(np.stack([np.cos(angles), np.sin(angles)], axis=1))


def uniform(rng):
    return float(rng.uniform(0.12, 0.6))


def graded(rng):
    h, g = rng.uniform(0.12, 0.6), rng.normal(0, 0.5, 2)
    return lambda x: h * (0.5 + 0.5 * np.abs(0.8 + x @ g))


def refined(mesh):
    """Every triangle cut into four, at the midpoints of its edges."""
    n, ends = len(mesh.points), mesh.unique_edges
    number = {(a, b): n + i for i, (a, b) in enumerate(ends.tolist())}

    def middle(a, b):
        return number[min(a, b), max(a, b)]

    triangles = []
    for a, b, c in mesh.triangles.tolist():
        p, q, r = middle(b, c), middle(c, a), middle(a, b)
        triangles += [(a, r, q), (r, b, p), (q, p, c), (p, q, r)]
    return am.Mesh(np.concatenate([mesh.points, mesh.points[ends].mean(axis=1)]), triangles)


def renumbered(mesh, rng):
    order = rng.permutation(len(mesh.points))
    triangles = np.argsort(order)[mesh.triangles]
    rolled = [np.roll(t, rng.integers(3)) for t in rng.permutation(triangles)]
    return am.Mesh(mesh.points[order], rolled)


def moved_by_ulps(mesh, rng):
    steps = rng.integers(-2, 3, mesh.points.shape)
    return am.Mesh(mesh.points + steps * np.spacing(mesh.points), mesh.triangles)


DOMAINS = {
    "polygon": polygon,
    "interface": with_interface,
    "hole": with_hole,
    "periodic": periodic,
    "curved": curved,
}
KINDS = [*DOMAINS, "chords", "refined", "coarsened", "renumbered", "moved by ulps"]
SAME_DOMAIN = [kind for kind in KINDS if kind not in ("curved", "chords")]


# ---- Delaunay triangulations of the unit square with points anywhere ----

BOX = np.array([(0.0, 0.0), (1.0, 0.0), (1.0, 1.0), (0.0, 1.0)])


def strips(rng, axis):
    """Points on two sides only: thin triangles across, and on turned sides slivers along."""
    along, across = rng.random(30), np.repeat([0.0, 1.0], 15)
    return np.stack([along, across] if axis == 0 else [across, along], axis=1)


def cluster(rng, size):
    return rng.uniform(0.25, 0.75, 2) + size * rng.normal(size=(20, 2))


def log_grid():
    """Sizes from 1e-12 to 1, and areas from 1e-24, before rounding turns some to slivers."""
    steps = np.concatenate([[0], np.logspace(-12, 0, 7)])
    return np.stack(np.meshgrid(steps, steps), axis=-1).reshape(-1, 2)


HARD = {
    "strips that cross": lambda rng: (strips(rng, 0), strips(rng, 1)),
    "strips side by side": lambda rng: (strips(rng, 0), strips(rng, 0)),
    "two clusters": lambda rng: (cluster(rng, 1e-3), cluster(rng, 1e-3)),
    "a cluster": lambda rng: (cluster(rng, 1e-6), BOX),
    "a dot": lambda rng: (BOX, cluster(rng, 1e-12)),
    "fine in a corner": lambda rng: (rng.random((20, 2)), log_grid()),
    "coarse in a corner": lambda rng: (log_grid(), rng.random((20, 2))),
}


def hard_pair(rng, kind, transform):
    """Two meshes of the square, of triangles as thin and as different in size as can be."""

    def mesh(points):
        points = transform(np.unique(np.concatenate([points, BOX]), axis=0))
        return am.Mesh(points, am.delaunay(points))

    old, new = HARD[kind](rng)
    return mesh(old), mesh(new)


def random_pair(rng, kind, carry=lambda mesh: mesh):
    """Two meshes; `carry` maps each to the plane of the test, before new vertices are put in."""
    if kind in DOMAINS:
        domain = DOMAINS[kind](rng)
        return tuple(carry(am.generate(domain, size(rng))) for size in (uniform, graded))
    if kind == "chords":
        return tuple(carry(am.generate(chords(rng), size(rng))) for size in (uniform, graded))
    mesh = carry(am.generate(polygon(rng), graded(rng)))
    if kind == "refined":
        return mesh, refined(mesh)
    if kind == "coarsened":
        return refined(mesh), mesh
    if kind == "renumbered":
        return mesh, renumbered(mesh, rng)
    return mesh, moved_by_ulps(mesh, rng)
