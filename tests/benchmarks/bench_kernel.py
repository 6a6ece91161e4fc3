"""How fast points are triangulated, beside Shewchuk's Triangle (PyPI: triangle), in one run.

    python tests/benchmarks/bench_kernel.py [case ...]

Every case runs both programs in turn, five times; the table has the medians in seconds. Times are
of the calls from Python, with the sort and the copies in and out. "per point" compares with the
first case: the degenerate ones should not be much slower per point.
"""

from __future__ import annotations

import statistics
import sys
import time

import numpy as np
import triangle

from adaptmesh import _core

REPEATS = 5
NOTHING = np.empty((0, 2))
NO_SEGMENTS = np.empty((0, 2), np.int32)


def uniform(n):
    return np.random.default_rng(0).random((n, 2))


def grid(side, step):
    x, y = np.meshgrid(np.arange(side) * step, np.arange(side) * step)
    return np.stack([x, y], axis=-1).reshape(-1, 2)


def circle(n):
    angle = np.random.default_rng(1).random(n) * 2 * np.pi
    return np.stack([np.cos(angle), np.sin(angle)], axis=1)


def parabola(n):
    x = np.linspace(-1, 1, n)
    return np.stack([x, x * x], axis=1)


def clusters(n):
    rng = np.random.default_rng(2)
    return rng.integers(0, 20, (n, 2)) + 1e-12 * rng.normal(size=(n, 2))


def line_and_point(n):
    x = np.arange(n - 1.0)
    return np.vstack([np.stack([x, np.zeros(n - 1)], axis=1), [[n / 3, 5.0]]])


def two_lines(n):
    x = np.arange(n // 2) * 1.0
    return np.vstack([np.stack([x, 0 * x], axis=1), np.stack([x, 0 * x + n], axis=1)])


def rings(n, depth=40):
    """Half of the points on nested rings of segments, the others anywhere."""
    per_ring = n // (2 * depth)
    angle = 2 * np.pi * np.arange(per_ring) / per_ring
    wave = (1 + 0.2 * np.cos(60 * angle))[:, None]
    loop = wave * np.stack([np.cos(angle), np.sin(angle)], axis=1)
    radii = np.linspace(0.1, 1, depth)
    k = np.arange(per_ring)
    side = np.stack([k, (k + 1) % per_ring], axis=1)
    segments = np.concatenate([side + per_ring * d for d in range(depth)])
    disc = np.random.default_rng(3).normal(size=(n // 2, 2)) * 0.1
    disc = disc[np.hypot(*disc.T) < 0.7]
    return np.concatenate([*(r * loop for r in radii), disc]), segments.astype(np.int32)


def long_segments(n, count=300):
    """Nearly parallel segments right through n random points."""
    y = np.linspace(0.001, 0.999, count)
    ends = np.stack([np.full(2 * count, 0.0), np.repeat(y, 2)], axis=1)
    ends[1::2] += [1.0, 1e-4]
    frame = [[-1, -1], [2, -1], [2, 2], [-1, 2]]
    k = np.arange(4)
    sides = np.stack([k, (k + 1) % 4], axis=1) + 2 * count
    segments = np.concatenate([np.arange(2 * count).reshape(-1, 2), sides])
    return np.concatenate([ends, frame, uniform(n)]), segments.astype(np.int32)


CASES = {
    "uniform 1e6": (uniform(1_000_000), NO_SEGMENTS),
    "grid 1000 x 1000": (grid(1000, 1.0), NO_SEGMENTS),
    "grid of 0.1, 1000 x 1000": (grid(1000, 0.1), NO_SEGMENTS),
    "uniform 2e5": (uniform(200_000), NO_SEGMENTS),
    "circle 2e5": (circle(200_000), NO_SEGMENTS),
    "parabola 2e5": (parabola(200_000), NO_SEGMENTS),
    "clusters 2e5": (clusters(200_000), NO_SEGMENTS),
    "line and point 2e5": (line_and_point(200_000), NO_SEGMENTS),
    "two lines 2e5": (two_lines(200_000), NO_SEGMENTS),
    "rings of segments 2e5": rings(200_000),
    "long segments 2e5": long_segments(200_000),
}


def timed(run):
    start = time.perf_counter()
    run()
    return time.perf_counter() - start


def main():
    chosen = sys.argv[1:] or list(CASES)
    header = f"{'case':26}{'points':>9}{'ours':>9}{'Triangle':>10}{'ratio':>7}{'us/point':>10}"
    print(header)
    for name in chosen:
        points, segments = CASES[name]
        if len(segments):
            given = {"vertices": points, "segments": segments}

            def ours(points=points, segments=segments):
                _core.triangulate(points, segments, NOTHING, NOTHING, False)

            def theirs(given=given):
                triangle.triangulate(given, "pQ")
        else:

            def ours(points=points):
                _core.delaunay(points)

            def theirs(points=points):
                triangle.triangulate({"vertices": points}, "Q")

        times = [(timed(ours), timed(theirs)) for _ in range(REPEATS)]
        mine, other = (statistics.median(column) for column in zip(*times, strict=True))
        print(
            f"{name:26}{len(points):9}{mine:9.3f}{other:10.3f}{other / mine:7.2f}"
            f"{1e6 * mine / len(points):10.3f}"
        )


if __name__ == "__main__":
    main()
