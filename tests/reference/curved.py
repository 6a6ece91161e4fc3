"""Domains of curves that several tests mesh."""

import numpy as np

from adaptmesh import Domain
from adaptmesh.curves import Arc, Circle, EllipticArc, Line, Parametric, Spline


def box(x0, y0, x1, y1):
    c = [(x0, y0), (x1, y0), (x1, y1), (x0, y1)]
    return [Line(c[i], c[(i + 1) % 4]) for i in range(4)]


def aerofoil(n=60):
    x = 0.5 * (1 - np.cos(np.linspace(0, np.pi, n)))
    powers = x[:, None] ** [0.5, 1, 2, 3, 4]
    y = 0.6 * powers @ [0.2969, -0.126, -0.3516, 0.2843, -0.1036]
    y[-1] = 0
    return np.concatenate([np.stack([x, y], 1)[::-1], np.stack([x, -y], 1)[1:]])


def sine(t):
    return np.stack([4 * t, 1 + 0.3 * np.sin(4 * np.pi * t)], axis=1)


def spiral(t):
    a, r = 4 * np.pi * t, 0.1 + 0.8 * t
    return np.stack([r * np.cos(a), r * np.sin(a)], axis=1)


def parabola(factor):
    return Parametric(lambda t: np.stack([t, factor * t**2], axis=1))


def figure_eight(t):
    return np.stack([np.sin(2 * np.pi * t), np.sin(4 * np.pi * t)], axis=1)


def kinked(t):
    return np.stack([2 * t - 1, np.abs(2 * t - 1.1)], axis=1)


DISC = Domain.from_curves([Circle((0, 0), 1)], names={"rim": [0]})


CASES = {
    "disc": (lambda: DISC, 0.15),
    "aerofoil": (
        lambda: Domain.from_curves([*box(-1, -1, 2, 1), Spline(aerofoil())], names={"wing": [4]}),
        lambda x: 0.02 + 0.2 * np.hypot(np.maximum(0, np.abs(x[:, 0] - 0.5) - 0.5), x[:, 1]),
    ),
    "plate with holes": (
        lambda: Domain.from_curves(
            [*box(0, 0, 4, 2), Circle((1, 1), 0.4), EllipticArc((2.8, 1), (0.7, 0.25), 0.5)]
        ),
        0.2,
    ),
    "two regions": (
        lambda: Domain.from_curves(
            [*box(0, 0, 4, 2), Parametric(sine)],
            names={"interface": [4]},
            regions={"low": (2, 0.1), "high": (2, 1.9)},
        ),
        0.2,
    ),
    "dangling spiral": (
        lambda: Domain.from_curves([Circle((0, 0), 1.2), Parametric(spiral)], names={"s": [1]}),
        0.12,
    ),
    "disc of two halves": (
        lambda: Domain.from_curves(
            [Arc((0, 0), 1, 0, np.pi), Arc((0, 0), 1, np.pi, 2 * np.pi), Line((-1, 0), (1, 0))],
            names={"top": [0], "bottom": [1]},
            regions={"north": (0, 0.5), "south": (0, -0.5)},
        ),
        0.2,
    ),
    "slanted": (
        lambda: Domain.from_curves([Circle((0, 0), 1), EllipticArc((0.2, 0), (0.5, 0.2), 0.5)]),
        lambda x: np.tile([[5012.5, 4987.5, 5012.5]], (len(x), 1)),
    ),
    # coarser than the curves allow: chords are added
    "disc in six": (lambda: DISC, 10.0),
    "thin annulus": (lambda: Domain.from_curves([Circle((0, 0), 1), Circle((0, 0), 0.999)]), 0.3),
    "hole in a bulge": (
        lambda: Domain.from_curves([Circle((0, 0), 1), Circle((0.97, 0.1), 0.01)]),
        1.0,
    ),
    "two arcs a hair apart": (
        lambda: Domain.from_curves(
            [*box(-2, -2, 2, 2), Arc((0, 0), 1, 0, 3), Arc((0, 0), 1.001, 0, 3)]
        ),
        0.5,
    ),
    "lens": (
        lambda: Domain.from_curves(
            [Arc.through((-1, 0), (0, 0.1), (1, 0)), Arc.through((-1, 0), (0, -0.1), (1, 0))]
        ),
        10.0,
    ),
    "cusp": (
        lambda: Domain.from_curves([parabola(2), parabola(1), Line((1, 2), (1, 1))]),
        0.2,
    ),
    "tangent circles": (lambda: Domain.from_curves([Circle((0, 0), 2), Circle((1, 0), 1)]), 0.3),
    "tiny": (lambda: Domain.from_curves([Circle((0, 0), 1e-6), Circle((0, 0), 5e-7)]), 2e-7),
    "huge": (lambda: Domain.from_curves([Circle((1e6, 0), 1e6), Circle((1e6, 0), 5e5)]), 2e5),
    "far off": (lambda: Domain.from_curves([Circle((1e6, 1e6), 1), Circle((1e6, 1e6), 0.5)]), 0.2),
}
