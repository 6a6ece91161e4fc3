"""Domains and metrics of many kinds, turned so that nothing is exact by luck."""

from __future__ import annotations

import numpy as np

import adaptmesh as am
from adaptmesh.curves import Arc, Circle, Line, Parametric, Spline


def turned(points, angle=0.7, scale=1.0, offset=(0.0, 0.0)):
    c, s = np.cos(angle), np.sin(angle)
    return scale * np.asarray(points, float) @ np.array([[c, s], [-s, c]]) + offset


def plate(**changes):
    """Two regions with an interface, a hole, names; turned."""
    points = turned(
        [(0, 0), (4, 0), (4, 2), (0, 2), (2, 0), (2, 2), (0.5, 0.5), (1, 0.5), (1, 1), (0.5, 1)],
        **changes,
    )
    segments = [(0, 4), (4, 1), (1, 2), (2, 5), (5, 3), (3, 0), (4, 5)]
    segments += [(6, 7), (7, 8), (8, 9), (9, 6)]
    hole, left, right = turned([(0.75, 0.75), (0.1, 0.1), (3, 1)], **changes)
    return am.Domain(
        points,
        segments,
        holes=[hole],
        regions={"left": left, "right": right},
        names={"bottom": [0, 1], "interface": [6], "hole": [7, 8, 9, 10]},
    )


def star(arms, radius=1.0, ratio=0.4):
    angles = np.pi * np.arange(2 * arms) / arms + 0.1
    radii = np.where(np.arange(2 * arms) % 2, ratio * radius, radius)
    return np.stack([radii * np.cos(angles), radii * np.sin(angles)], axis=1)


def front(x):
    """Anisotropic along a wave, as packed metrics."""
    slope = 1.2 * np.cos(6 * x[:, 0])
    length = np.hypot(1, slope)
    nx, ny = -slope / length, 1 / length
    distance = np.abs(x[:, 1] - 0.5 - 0.2 * np.sin(6 * x[:, 0])) / length
    across, along = (0.01 + 0.2 * distance) ** -2, np.full(len(x), 0.15**-2)
    return np.stack(
        [
            across * nx**2 + along * ny**2,
            (across - along) * nx * ny,
            across * ny**2 + along * nx**2,
        ],
        axis=1,
    )


def funnel(x):
    """Sizes that grow from a point."""
    return 0.02 + 0.15 * np.hypot(x[:, 0] - 0.6, x[:, 1] - 0.4)


def solution(mesh):
    x, y = mesh.points.T
    return np.tanh(30 * (y - 0.5 - 0.2 * np.sin(6 * x)))


def wave(t):
    return np.stack([4 * t, 1 + 0.3 * np.sin(4 * np.pi * t)], axis=1)


def channel():
    corners = [(0, 0), (4, 0), (4, 2), (0, 2)]
    sides = [Line(corners[i], corners[(i + 1) % 4]) for i in range(4)]
    return am.Domain.from_curves(
        [*sides, Parametric(wave)],
        names={"inlet": [3], "outlet": [1], "interface": [4]},
        regions={"water": (2, 0.1), "air": (2, 1.9)},
    )


def ring():
    return am.Domain.from_curves([Circle((0, 0), 2), Circle((0.2, 0), 1)], names={"hole": [1]})


def stadium(**keywords):
    curves = [
        Line((0, 0), (2, 0)),
        Arc((2, 1), 1, -np.pi / 2, np.pi / 2),
        Line((2, 2), (0, 2)),
        Arc((0, 1), 1, np.pi / 2, 3 * np.pi / 2),
    ]
    return am.Domain.from_curves(curves, **keywords)


def wavy_cell():
    """Left and right are splines that correspond, with a hole between."""
    left = Spline([(0, 0), (0.1, 0.3), (-0.05, 0.7), (0, 1)])
    right = Spline([(1, 0), (1.1, 0.3), (0.95, 0.7), (1, 1)])
    curves = [left, right, Line((0, 0), (1, 0)), Line((0, 1), (1, 1)), Circle((0.5, 0.5), 0.2)]
    domain = am.Domain.from_curves(
        curves, names={"left": [0], "right": [1], "bottom": [2], "top": [3], "hole": [4]}
    )
    return domain.with_periodic("left", "right").with_periodic("bottom", "top")


def sector():
    """Sixty degrees of a ring, whose straight sides correspond by a rotation."""
    angle = np.pi / 3
    inner, outer = 1.0, 2.0
    at = lambda r, a: (r * np.cos(a), r * np.sin(a))  # noqa: E731
    curves = [
        Line(at(inner, 0), at(outer, 0)),
        Arc((0, 0), outer, 0, angle),
        Line(at(outer, angle), at(inner, angle)),
        Arc((0, 0), inner, angle, 0),
    ]
    domain = am.Domain.from_curves(curves, names={"low": [0], "high": [2]})
    return domain.with_periodic("low", "high", rotation=60.0)
