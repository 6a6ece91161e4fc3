"""Right meshes of every kind: random domains, generated, adapted, kept, repaired, curved, periodic.

``right_mesh(number)`` is the mesh of that number and what it is, the same each time; each lies
somewhere else: turned, reflected, scaled, offset.
"""

from __future__ import annotations

import numpy as np
from reference.transforms import SIMILARITIES, TRANSFORMS

import adaptmesh as am
from adaptmesh.curves import Arc, BSpline, Circle, EllipticArc, Line, Spline


def right_mesh(number):
    """A mesh, and the kind of it in words."""
    rng = np.random.default_rng(number)
    kind = KINDS[number % len(KINDS)]
    straight = kind in (blob, grid_of_regions, needles, repaired)
    place = (TRANSFORMS if straight else SIMILARITIES)[rng.integers(len(SIMILARITIES))]
    domain = kind(rng, place)
    h = float(np.ptp(domain.points, axis=0).max()) * rng.choice([0.08, 0.15, 0.4, 3.0])
    metric = slanted(rng, h, domain) if rng.random() < 0.5 else h
    mesh = am.generate(domain, metric)
    how = rng.integers(4)
    if how == 1:
        mesh = am.adapt(mesh, slanted(rng, h, domain))
    elif how == 2:
        mesh = am.adapt(mesh, slanted(rng, h, domain), keep=True)
    elif how == 3 and domain.names and not domain.periodic:
        mesh = am.adapt(mesh, slanted(rng, h, domain), frozen=[next(iter(domain.names))])
    words = ["generated", "adapted", "kept", "frozen"][how]
    return mesh, f"{number}: {kind.__name__}, {words}, {place}"


def slanted(rng, h, domain):
    """Sizes that change along a line, longer across it."""
    d = rng.normal(size=2)
    d /= np.hypot(*d)
    low, extent = domain.points.min(axis=0), np.ptp(domain.points, axis=0).max()
    stretch = rng.choice([1.0, 3.0, 20.0])

    def metric(x):
        t = (x - low) @ d / extent
        h1 = h * (0.3 + np.abs(np.sin(3 * t)))
        l1, l2 = h1**-2, (stretch * h1) ** -2
        c, s = d
        return np.stack([l1 * c * c + l2 * s * s, (l1 - l2) * c * s, l1 * s * s + l2 * c * c], 1)

    return metric


def star_shaped(rng, n, low=0.5, high=1.0):
    angles = np.sort(rng.uniform(0, 2 * np.pi, n)) + 1e-3 * np.arange(n)
    radii = rng.uniform(low, high, n)
    return np.stack([radii * np.cos(angles), radii * np.sin(angles)], axis=1)


def ring(n, first=0):
    i = np.arange(n)
    return np.stack([i, (i + 1) % n], axis=1) + first


def blob(rng, place):
    """A polygon with a hole, a line inside and a point."""
    n = int(rng.integers(4, 12))
    outer, hole = star_shaped(rng, n, 0.8), 0.2 * star_shaped(rng, 4, 0.8)
    points = [*outer, *hole, (0.3, 0.3), (0.42, 0.35), (-0.4, 0.1)]
    segments = np.concatenate([ring(n), ring(4, n), [[n + 4, n + 5]]])
    names = {"outer": list(range(n)), "hole": [n, n + 1], "fin": [n + 6 - 2]}
    if not is_star_around(outer, 0.6):
        return grid_of_regions(rng, place)
    return am.Domain(place(points), segments, holes=[place([0, 0])], names=names)


def is_star_around(p, radius):
    """Whether the origin sees all sides, none nearer than the radius."""
    q = np.roll(p, -1, axis=0)
    cross = p[:, 0] * q[:, 1] - p[:, 1] * q[:, 0]
    return bool((cross / np.hypot(*(q - p).T) > radius).all())


def grid_of_regions(rng, place):
    """Rectangles side by side, each a region, some of them holes."""
    nx, ny = rng.integers(2, 5, 2)
    x, y = np.cumsum(rng.uniform(0.1, 1, nx)), np.cumsum(rng.uniform(0.1, 1, ny))
    number = np.arange(nx * ny).reshape(ny, nx)
    across = np.stack([number[:, :-1].ravel(), number[:, 1:].ravel()], 1)
    up = np.stack([number[:-1].ravel(), number[1:].ravel()], 1)
    segments = np.concatenate([across, up])
    grid = np.stack(np.meshgrid(x, y), -1)
    centres = (0.25 * (grid[1:, 1:] + grid[:-1, 1:] + grid[1:, :-1] + grid[:-1, :-1])).reshape(
        -1, 2
    )
    regions = {f"r{k}": place(c) for k, c in enumerate(centres) if rng.random() < 0.7}
    return am.Domain(
        place(grid.reshape(-1, 2)),
        segments,
        regions=regions,
        names={"across": range(len(across)), "first": [len(across)]},
    )


def needles(rng, place):
    """Sides a hair apart, and some of one or two units in the last place."""
    p = place(np.array([(0, 0), (1, 0), (1, 1), (0, 1)]) + rng.uniform(-0.3, 0.3, (4, 2)))
    near = p[1].copy()
    for _ in range(rng.integers(1, 4)):
        near[1] = np.nextafter(near[1], p[2, 1])
    slit = p.mean(axis=0) + 0.1 * (p[:2] - p.mean(axis=0))
    third = slit.mean(axis=0) + 10.0 ** -rng.integers(2, 7) * (slit[1] - slit[0])[::-1] * [-1, 1]
    points = np.array([p[0], p[1], near, p[2], p[3], *slit, third])
    hole = [points[5:].mean(axis=0)]
    return am.Domain(points, np.concatenate([ring(5), ring(3, 5)]), holes=hole, names={"a": [1]})


def repaired(rng, place):
    """An outline that crosses itself, repaired."""
    n = int(rng.integers(5, 12))
    points = rng.uniform(-1, 1, (n, 2))
    return am.repair([place(points)])[0]


def thin_ellipse(rng, place):
    """From a disc to a needle, with a hole."""
    b = 10.0 ** rng.uniform(-4, 0)
    turn = rng.uniform(0, np.pi)
    s = place.scale
    curves = [EllipticArc(place([0, 0]), (s, b * s), turn)]
    if b > 0.05:
        curves.append(Circle(place([0, 0]), 0.3 * b * s))
    return am.Domain.from_curves(curves, names={"rim": [0]})


def two_halves(rng, place):
    """A disc of two arcs, parted by a spline: three lines between the same two corners."""
    s, turn = place.scale, rng.uniform(0, 2 * np.pi)
    a = Arc(place([0, 0]), s, turn, turn + np.pi)
    b = Arc(place([0, 0]), s, turn + np.pi, turn + 2 * np.pi)
    share = np.linspace(0, 1, 6)[1:-1, None]
    chord = a.end - a.start
    across = np.array([-chord[1], chord[0]]) * rng.uniform(-0.2, 0.2, (4, 1))
    middle = Spline(np.concatenate([[a.start], a.start + share * chord + across, [a.end]]))
    return am.Domain.from_curves([a, b, middle], names={"a": [0], "b": [1], "between": [2]})


def splines(rng, place):
    """A closed B-spline with a spline inside that ends nowhere."""
    p = star_shaped(rng, 9, 0.8)
    if not is_star_around(p, 0.5):
        return thin_ellipse(rng, place)
    inner = place(np.array([(-0.15, 0), (0, 0.1), (0.1, -0.1), (0.2, 0.05)]))
    rim = BSpline(place(p), closed=True) if rng.random() < 0.5 else Spline(place(p), closed=True)
    return am.Domain.from_curves([rim, Spline(inner)], names={"rim": [0], "inner": [1]})


def periodic(rng, place):
    """A channel, one pair of its sides curved."""
    x = np.linspace(0, 2, 9)
    bends = 0.1 * np.sin(np.pi * x + rng.uniform(0, 6)) * (1 if rng.random() < 0.5 else 0)
    bends -= bends[0]
    up = rng.uniform(0.3, 1)
    low, high = (place(np.stack([x, y + bends], axis=1)) for y in (0.0, up))
    curves = [Spline(low), Line(low[-1], high[-1]), Spline(high), Line(high[0], low[0])]
    names = {"low": [0], "right": [1], "high": [2], "left": [3]}
    domain = am.Domain.from_curves(curves, names=names)
    domain = domain.with_periodic("left", "right")
    return domain.with_periodic("low", "high") if rng.random() < 0.5 else domain


KINDS = (
    blob,
    grid_of_regions,
    needles,
    repaired,
    thin_ellipse,
    two_halves,
    splines,
    periodic,
)
