"""Times of domains grow as n log n at most: shown by doubling twice, in CPU time.

What is quadratic takes 16 times as long; half of that leaves room for noise.
"""

import time

import numpy as np
import pytest

import adaptmesh as am
from adaptmesh.curves import Arc, Line


def seconds(work):
    best = np.inf
    for _ in range(2):
        start = time.process_time()
        work()
        best = min(best, time.process_time() - start)
    return best


def star(n):
    a = np.linspace(0, 2 * np.pi, n, endpoint=False)
    return np.stack([np.cos(a), np.sin(a)], 1) * (1 + 0.2 * np.sin(17 * a))[:, None]


def of_lines(n):
    p = star(n)
    lines = [Line(p[i], p[(i + 1) % n]) for i in range(n)]
    return lambda: am.Domain.from_curves(lines)


def of_arcs(n):
    p, q = star(n), np.roll(star(n), -1, axis=0)
    arcs = [Arc.through(a, 1.00001 * (a + b) / 2, b) for a, b in zip(p, q, strict=True)]
    return lambda: am.Domain.from_curves(arcs)


def of_grains(n):
    """n² regions of eight triangles."""
    n = int(np.sqrt(n))
    size = 2 * n + 1
    g = np.linspace(0, 1, size)
    points = np.stack(np.meshgrid(g, g, indexing="ij"), axis=-1).reshape(-1, 2)
    i, j = (k.ravel() for k in np.meshgrid(*2 * [np.arange(size - 1)], indexing="ij"))
    a, b = i * size + j, (i + 1) * size + j
    triangles = np.concatenate([np.stack([a, b, b + 1], 1), np.stack([a, b + 1, a + 1], 1)])
    regions = np.tile((i // 2) * n + j // 2 + 1, 2)
    mesh = am.Mesh(points, triangles, regions=regions)
    return lambda: mesh.to_domain()


def of_holes(n):
    """About n holes, as rings, and by points."""
    k = int(np.sqrt(n))
    g = (np.arange(k) + 0.5) / k
    centres = np.stack(np.meshgrid(g, g), axis=-1).reshape(-1, 1, 2)
    rings = centres + 0.2 / k * np.array([(-1, -1), (1, -1), (1, 1), (-1, 1)])
    square = np.array([(0, 0), (1, 0), (1, 1), (0, 1)])
    domain = am.Domain.polygon(square, list(rings))
    outline = am.Outline(domain.points, domain.segments, centres[:, 0])

    def work():
        am.Domain.polygon(square, list(rings))
        am.repair(outline)

    return work


def of_nested_rings(n):
    """Rings in rings: an outline, holes, islands in these, holes in the islands, ..."""
    square = np.array([(-1, -1), (1, -1), (1, 1), (-1, 1)])
    rings = [square * (1 - k / (n + 1)) for k in range(n)]

    def work():
        domain = am.Domain.polygon(rings[0], rings[1:])
        repaired, _ = am.repair([rings])
        assert domain.area == pytest.approx(repaired.area, rel=1e-12)

    return work


def of_names(n):
    domain = am.Domain.polygon(star(n))
    names = {f"side {i}": [i] for i in range(n)}
    return lambda: am.repair(am.Outline(domain.points, domain.segments, names=names))


@pytest.mark.fast_cases(1)
@pytest.mark.parametrize(
    ("make", "n"),
    [
        (of_lines, 500),
        (of_arcs, 250),
        (of_grains, 576),
        (of_holes, 400),
        (of_nested_rings, 300),
        (of_names, 1000),
    ],
)
def test_four_times_as_much_takes_about_four_times_as_long(make, n):
    small, large = seconds(make(n)), seconds(make(4 * n))
    assert large < 8 * max(small, 0.02), f"{n}: {small:.2f} s, {4 * n}: {large:.2f} s"
